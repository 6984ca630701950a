import {DataTexture, LinearFilter} from 'three';

/** Share of the height range, and the colour there: lowland greens, browns, rock, snow. */
const kStops: readonly (readonly [number, number])[] = [
  [0.0, 0x5f8f5a],
  [0.18, 0x8fae6c],
  [0.36, 0xc8c385],
  [0.54, 0xb99a66],
  [0.72, 0x9a7d62],
  [0.86, 0xb5aaa3],
  [1.0, 0xfafafa],
];

const kWidth = 256;

/** A texture of one row: lowest height on the left. Values are sRGB, as they go to the screen. */
export function heightColors(): DataTexture {
  const pixels = new Uint8Array(4 * kWidth);
  for (let i = 0; i < kWidth; ++i) pixels.set([...colorAt(i / (kWidth - 1)), 255], 4 * i);
  const texture = new DataTexture(pixels, kWidth, 1);
  texture.minFilter = LinearFilter;
  texture.magFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

function colorAt(share: number): [number, number, number] {
  const next = Math.max(1, kStops.findIndex(([at]) => at >= share));
  const [[low, from], [high, to]] = [kStops[next - 1]!, kStops[next]!];
  const t = (share - low) / (high - low);
  const channel = (shift: number) =>
    Math.round((1 - t) * ((from >> shift) & 255) + t * ((to >> shift) & 255));
  return [channel(16), channel(8), channel(0)];
}
