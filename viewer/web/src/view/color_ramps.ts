// The colours of heights, slopes, errors and levels; on the terrain, and in the legend.
import {DataTexture, LinearFilter} from 'three';
import type {Look} from '../core/settings';

/** A share of the range, 0 to 1, and the sRGB colour there. */
type Stop = readonly [number, number];

/** Land: lowland greens, straw, rock, snow. */
const kHeights: readonly Stop[] = [
  [0.0, 0x6f9a6b],
  [0.16, 0x97b274],
  [0.34, 0xcdc68b],
  [0.52, 0xc2a26f],
  [0.7, 0xa38469],
  [0.85, 0xb7aca5],
  [1.0, 0xfafafa],
];

/** Gentle to steep, in degrees 0 to 60. */
const kSlopes: readonly Stop[] = [
  [0.0, 0xf4f1e6],
  [0.25, 0xf2dc8a],
  [0.5, 0xe99a4c],
  [0.67, 0xcf5340],
  [0.83, 0x8f2f55],
  [1.0, 0x4a1f4f],
];

/** Error on the screen, in wanted tolerances 0 to 1.25: over 1 is too much. */
const kErrors: readonly Stop[] = [
  [0.0, 0x2f5f9e],
  [0.3, 0x55a3b5],
  [0.55, 0xe8dc8f],
  [0.78, 0xe08a3c],
  [0.8, 0xd1362f],
  [1.0, 0xb0106a],
];

export const kSteepestDeg = 60;
export const kLargestErrorShare = 1.25;

const kRamps = {relief: kHeights, slope: kSlopes, error: kErrors} as const;
export type RampName = keyof typeof kRamps;

export function rampOf(look: Look): RampName | undefined {
  return look in kRamps ? (look as RampName) : undefined;
}

/** Set apart by hue, neighbours by lightness too; level 0 is the warmest. */
const kLevels = [0xe4572e, 0xf3a712, 0xa8c686, 0x669bbc, 0x8c6bb1, 0xd98cb3, 0x8d99ae];

export function levelColor(level: number): number {
  return kLevels[level % kLevels.length]!;
}

export function cssColor(hex: number): string {
  return `#${hex.toString(16).padStart(6, '0')}`;
}

/** The ramp as CSS, from left to right. */
export function cssGradient(name: RampName): string {
  const stops = kRamps[name].map(([at, color]) => `${cssColor(color)} ${100 * at}%`);
  return `linear-gradient(to right, ${stops.join(', ')})`;
}

const kWidth = 256;

/** A texture of one row, smallest value on the left. Values are sRGB, as they go to the screen. */
export function rampTexture(name: RampName): DataTexture {
  const pixels = new Uint8Array(4 * kWidth);
  for (let i = 0; i < kWidth; ++i) {
    pixels.set([...colorAt(kRamps[name], i / (kWidth - 1)), 255], 4 * i);
  }
  const texture = new DataTexture(pixels, kWidth, 1);
  texture.minFilter = LinearFilter;
  texture.magFilter = LinearFilter;
  texture.needsUpdate = true;
  return texture;
}

function colorAt(stops: readonly Stop[], share: number): [number, number, number] {
  const next = Math.max(
    1,
    stops.findIndex(([at]) => at >= share),
  );
  const [[low, from], [high, to]] = [stops[next - 1]!, stops[next]!];
  const t = (share - low) / (high - low);
  const channel = (shift: number) =>
    Math.round((1 - t) * ((from >> shift) & 255) + t * ((to >> shift) & 255));
  return [channel(16), channel(8), channel(0)];
}
