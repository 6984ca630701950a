// Takes the compression out of a glb and leaves all else as it is: accessors with their min and max,
// nodes, extras. gltf-validator does not look inside compressed data, and what rewrites a file
// (gltf-transform) computes the bounds anew.
import draco3d from 'draco3dgltf';
import {MeshoptDecoder} from 'meshoptimizer';

const kMeshopt = 'EXT_meshopt_compression';
const kDraco = 'KHR_draco_mesh_compression';
const kArrays = {
  5120: Int8Array,
  5121: Uint8Array,
  5122: Int16Array,
  5123: Uint16Array,
  5125: Uint32Array,
  5126: Float32Array,
};
const kComponents = {SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4};

/** Splits a glb into its document and its binary chunk. */
export function readGlb(bytes) {
  const words = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const jsonBytes = words.getUint32(12, true);
  const json = JSON.parse(new TextDecoder().decode(bytes.subarray(20, 20 + jsonBytes)));
  return {json, binary: bytes.subarray(28 + jsonBytes)};
}

/**
 * @param bytes a glb
 * @returns {Promise<{json: object, glb: Uint8Array}>} the same without compression
 */
export async function plainGlb(bytes) {
  const {json, binary} = readGlb(bytes);
  const target = new Binary();
  await takeMeshopt(json, binary, target);
  if (json.extensionsUsed?.includes(kDraco)) await takeDraco(json, binary, target);
  for (const key of ['extensionsUsed', 'extensionsRequired']) {
    json[key] = json[key]?.filter((name) => name !== kMeshopt && name !== kDraco);
    if (!json[key]?.length) delete json[key];
  }
  json.buffers = [{byteLength: target.size}];
  return {json, glb: packGlb(json, target.bytes())};
}

class Binary {
  chunks = [];
  size = 0;

  add(bytes) {
    const offset = this.size;
    this.chunks.push([offset, bytes]);
    this.size += Math.ceil(bytes.length / 4) * 4;
    return offset;
  }

  bytes() {
    const all = new Uint8Array(this.size);
    for (const [offset, bytes] of this.chunks) all.set(bytes, offset);
    return all;
  }
}

async function takeMeshopt(json, binary, target) {
  await MeshoptDecoder.ready;
  for (const view of json.bufferViews ?? []) {
    const coded = view.extensions?.[kMeshopt];
    const from = coded ?? view;
    let bytes = binary.subarray(from.byteOffset ?? 0, (from.byteOffset ?? 0) + from.byteLength);
    if (coded) {
      const plain = new Uint8Array(coded.count * coded.byteStride);
      MeshoptDecoder.decodeGltfBuffer(plain, coded.count, coded.byteStride, bytes, coded.mode, coded.filter);
      if (plain.length !== view.byteLength) throw new Error('a view is not as long as it says');
      bytes = plain;
      delete view.extensions;
    }
    Object.assign(view, {buffer: 0, byteOffset: target.add(bytes)});
  }
}

async function takeDraco(json, binary, target) {
  const draco = await draco3d.createDecoderModule();
  for (const primitive of json.meshes.flatMap((mesh) => mesh.primitives)) {
    const coded = primitive.extensions?.[kDraco];
    if (!coded) continue;
    const mesh = new DracoMesh(draco, viewBytes(json, target, coded.bufferView));
    setView(json, target, primitive.indices, mesh.indices(), 34963);
    for (const [name, id] of Object.entries(coded.attributes)) {
      const accessor = json.accessors[primitive.attributes[name]];
      setView(json, target, primitive.attributes[name], mesh.attribute(id, accessor), 34962);
    }
    delete primitive.extensions;
  }
  // the coded bytes are nobody's any more
  const used = new Set(json.accessors.map((a) => a.bufferView).concat((json.images ?? []).map((i) => i.bufferView)));
  const kept = [...json.bufferViews.keys()].filter((n) => used.has(n));
  for (const holder of [...json.accessors, ...(json.images ?? [])]) {
    holder.bufferView = kept.indexOf(holder.bufferView);
  }
  json.bufferViews = kept.map((n) => json.bufferViews[n]);
}

function viewBytes(json, target, index) {
  const view = json.bufferViews[index];
  return target.chunks.find(([offset]) => offset === view.byteOffset)[1];
}

/** Puts values of Draco's into the accessor's own type, padded to whole words. */
function setView(json, target, index, values, kind) {
  const accessor = json.accessors[index];
  const Type = kArrays[accessor.componentType];
  const width = kComponents[accessor.type];
  if (values.length !== accessor.count * width) throw new Error('an accessor is not as long as Draco says');
  const bytesPerElement = width * Type.BYTES_PER_ELEMENT;
  const stride = kind === 34962 ? Math.ceil(bytesPerElement / 4) * 4 : bytesPerElement;
  const bytes = new Uint8Array(accessor.count * stride);
  for (let i = 0; i < accessor.count; ++i) {
    const element = Type.from(values.subarray(i * width, (i + 1) * width));
    bytes.set(new Uint8Array(element.buffer), i * stride);
  }
  accessor.bufferView = json.bufferViews.length;
  const view = {buffer: 0, byteOffset: target.add(bytes), byteLength: bytes.length, target: kind};
  if (kind === 34962) view.byteStride = stride;
  json.bufferViews.push(view);
}

class DracoMesh {
  constructor(draco, bytes) {
    this.draco = draco;
    this.decoder = new draco.Decoder();
    const buffer = new draco.DecoderBuffer();
    buffer.Init(bytes, bytes.length);
    this.mesh = new draco.Mesh();
    const status = this.decoder.DecodeBufferToMesh(buffer, this.mesh);
    if (!status.ok()) throw new Error(status.error_msg());
  }

  indices() {
    const count = this.mesh.num_faces() * 3;
    return this.copy(Uint32Array, count, (size, at) => this.decoder.GetTrianglesUInt32Array(this.mesh, size, at));
  }

  attribute(id, accessor) {
    const attribute = this.decoder.GetAttributeByUniqueId(this.mesh, id);
    const count = this.mesh.num_points() * attribute.num_components();
    const isFloat = accessor.componentType === 5126;
    const kind = isFloat ? this.draco.DT_FLOAT32 : this.draco.DT_INT32;
    return this.copy(isFloat ? Float32Array : Int32Array, count, (size, at) =>
      this.decoder.GetAttributeDataArrayForAllPoints(this.mesh, attribute, kind, size, at));
  }

  copy(Type, count, fill) {
    const size = count * 4;
    const at = this.draco._malloc(size);
    fill(size, at);
    const values = new Type(this.draco.HEAPU8.slice(at, at + size).buffer);
    this.draco._free(at);
    return values;
  }
}

function packGlb(json, binary) {
  const text = new TextEncoder().encode(JSON.stringify(json));
  const jsonBytes = Math.ceil(text.length / 4) * 4;
  const glb = new Uint8Array(28 + jsonBytes + binary.length).fill(0x20, 0, 28 + jsonBytes);
  const words = new DataView(glb.buffer);
  const set = (offset, value) => words.setUint32(offset, value, true);
  set(0, 0x46546c67), set(4, 2), set(8, glb.length);
  set(12, jsonBytes), set(16, 0x4e4f534a), glb.set(text, 20);
  set(20 + jsonBytes, binary.length), set(24 + jsonBytes, 0x004e4942), glb.set(binary, 28 + jsonBytes);
  return glb;
}
