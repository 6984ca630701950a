// bytes_per_triangle.mjs TILE_SET...: bytes per triangle of the level-0 tiles of tile sets, and of the same
// triangles as quantized-mesh 1.0 with normals. The tables of docs/formats.md; not a test.
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
    const {bufferView, byteOffset: inView = 0} = json.accessors[index];
    const {byteOffset, byteStride} = json.bufferViews[bufferView];
    return [new DataView(binary.buffer, binary.byteOffset + byteOffset + inView), byteStride];
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

/** Bytes of each part of a glb: its text, and its views by the attributes in them. */
function partsOf({json, jsonBytes}) {
  const {attributes, indices} = json.meshes[0].primitives[0];
  const names = new Map();
  for (const [name, index] of [...Object.entries(attributes), ['indices', indices]]) {
    const {bufferView} = json.accessors[index];
    if (bufferView !== undefined) names.set(bufferView, [...(names.get(bufferView) ?? []), name]);
  }
  const parts = {json: jsonBytes};
  for (const [index, inView] of names) {
    const view = json.bufferViews[index];
    parts[inView.join('+')] = (view.extensions?.EXT_meshopt_compression ?? view).byteLength;
  }
  return parts;
}

for (const folder of process.argv.slice(2)) {
  const sums = {glb: 0, gzip: 0};
  let triangleCount = 0, tileCount = 0;
  const add = (key, bytes) => (sums[key] = (sums[key] ?? 0) + bytes);
  for (const [file, {level, triangles}] of await contentsOf(folder)) {
    if (level !== 0) continue;
    const bytes = new Uint8Array(await readFile(join(folder, file)));
    const {json} = readGlb(bytes);
    triangleCount += triangles;
    ++tileCount;
    add('glb', bytes.length);
    add('gzip', gzipSync(bytes).length);
    const jsonBytes = new DataView(bytes.buffer, bytes.byteOffset).getUint32(12, true);
    for (const [name, size] of Object.entries(partsOf({json, jsonBytes}))) add(name, size);
    const {attributes} = json.meshes[0].primitives[0];
    if (json.accessors[attributes.NORMAL].componentType !== 5120) continue;
    const quantized = await quantizedMesh(bytes);
    add('quantized-mesh', quantized.length);
    add('quantized-mesh gzip', gzipSync(quantized).length);
  }
  const each = Object.entries(sums).map(([key, size]) => `${key} ${(size / triangleCount).toFixed(2)}`);
  console.log(`${folder}: ${tileCount} tiles, ${triangleCount} triangles; bytes per triangle: ${each.join(', ')}`);
}
