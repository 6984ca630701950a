// bytes_per_triangle.mjs TILE_SET...: bytes per triangle of the level-0 tiles of tile sets, and of the same
// triangles as quantized-mesh 1.0 with normals. The table of docs/formats.md; not a test.
import {readFile} from 'node:fs/promises';
import {join} from 'node:path';
import {gzipSync} from 'node:zlib';
import {plainGlb, readGlb} from './plain_glb.mjs';
import {contentsOf} from './tree.mjs';

const zigzag = (n) => (n << 1) ^ (n >> 31);

/** The arrays of quantized-mesh: u, v, height as 16-bit deltas, high-water indices, oct normals. */
async function quantizedMesh(bytes) {
  const {json, glb} = await plainGlb(bytes);
  const {binary} = readGlb(glb);
  const {attributes, indices} = json.meshes[0].primitives[0];
  const view = (index) => {
    const {byteOffset, byteStride} = json.bufferViews[json.accessors[index].bufferView];
    return [new DataView(binary.buffer, binary.byteOffset + byteOffset), byteStride];
  };
  const {count, min, max, componentType} = json.accessors[attributes.POSITION];
  const [positions, stride] = view(attributes.POSITION);
  const read = (v, axis) => componentType === 5122
    ? positions.getInt16(v * stride + 2 * axis, true) : positions.getFloat32(v * stride + 4 * axis, true);
  const out = [];
  for (const axis of [0, 2, 1]) {
    let last = 0;
    for (let v = 0; v < count; ++v) {
      const q = Math.round((32767 * (read(v, axis) - min[axis])) / Math.max(1, max[axis] - min[axis]));
      out.push(zigzag(q - last) & 0xffff);
      last = q;
    }
  }
  const [corners] = view(indices);
  let highest = 0;
  for (let i = 0; i < json.accessors[indices].count; ++i) {
    const index = corners.getUint16(2 * i, true);
    out.push(highest - index);
    if (index === highest) ++highest;
  }
  const [normals, normalStride] = view(attributes.NORMAL);
  const oct = [];
  for (let v = 0; v < count; ++v) {
    const n = [0, 1, 2].map((k) => normals.getInt8(v * normalStride + k) / 127);
    const sum = Math.abs(n[0]) + Math.abs(n[1]) + Math.abs(n[2]);
    oct.push(Math.round(127.5 + (127.5 * n[0]) / sum), Math.round(127.5 + (127.5 * n[2]) / sum));
  }
  // a header of 88 bytes, 5 counts, an extension header of 5 bytes
  return Buffer.concat([Buffer.alloc(113), Buffer.from(Uint16Array.from(out).buffer), Buffer.from(oct)]);
}

for (const folder of process.argv.slice(2)) {
  const sums = {triangles: 0, tiles: 0, glb: 0, gzip: 0, withoutMorph: 0, quantized: 0, quantizedGzip: 0};
  for (const [file, {level, triangles}] of await contentsOf(folder)) {
    if (level !== 0) continue;
    const bytes = new Uint8Array(await readFile(join(folder, file)));
    const {json} = readGlb(bytes);
    const {attributes} = json.meshes[0].primitives[0];
    const morph = json.bufferViews[json.accessors[attributes._MORPH].bufferView];
    sums.triangles += triangles;
    ++sums.tiles;
    sums.glb += bytes.length;
    sums.gzip += gzipSync(bytes).length;
    if (!morph) continue;
    sums.withoutMorph += bytes.length - (morph.extensions?.EXT_meshopt_compression ?? morph).byteLength;
    if (json.accessors[attributes.NORMAL].componentType !== 5120) continue;
    const quantized = await quantizedMesh(bytes);
    sums.quantized += quantized.length;
    sums.quantizedGzip += gzipSync(quantized).length;
  }
  const per = (key) => (sums[key] / sums.triangles).toFixed(2);
  console.log(`${folder}: ${sums.tiles} tiles, ${sums.triangles} triangles; bytes per triangle: ` +
    ['glb', 'gzip', 'withoutMorph', 'quantized', 'quantizedGzip'].map((key) => `${key} ${per(key)}`).join(', '));
}
