// Reads a tile's glb (docs/formats.md, section glb) without a scene graph: one mesh, its land and its water.
import type {Vec3} from './vec3';

/** Whole numbers of lattice steps: 16 bits where they fit, else floats. */
export type Steps = Int16Array | Float32Array;
export type Indices = Uint16Array | Uint32Array;

/** Numbers of a tile, without gaps; glTF triples. */
export interface GlbTile {
  /** Lattice point (east, north, up) of the glb's origin, in steps. */
  readonly origin: Vec3;
  readonly positions: Steps;
  readonly toTargets: Steps;
  /** Signed bytes, of length 127. */
  readonly normals: Int8Array;
  /** Land first, then water. */
  readonly indices: Indices;
  /** How many of the indices are land's. */
  readonly landIndices: number;
  /** Red, green, blue of each vertex, 0 to 255; and where it lies in the image. */
  readonly colors?: Uint8Array;
  readonly places?: Float32Array;
  readonly image?: {readonly bytes: Uint8Array; readonly type: string};
}

/** decodeGltfBuffer of the meshopt decoder. */
export type DecodeMeshopt = (
  target: Uint8Array,
  count: number,
  stride: number,
  source: Uint8Array,
  mode: string,
  filter?: string,
) => void;

interface Stored {
  buffer?: number;
  byteOffset?: number;
  byteLength: number;
  byteStride?: number;
}

interface ViewJson extends Stored {
  extensions?: {
    EXT_meshopt_compression?: Stored & {count: number; mode: string; filter?: string};
  };
}

interface AccessorJson {
  bufferView: number;
  byteOffset?: number;
  componentType: number;
  count: number;
  type: string;
}

interface GltfJson {
  accessors: AccessorJson[];
  bufferViews: ViewJson[];
  extensionsRequired?: string[];
  nodes?: {scale?: number[]}[];
  images?: {bufferView?: number; mimeType?: string}[];
  materials?: {name?: string}[];
  meshes: {extras?: {terrane?: {origin?: Vec3}}; primitives: PrimitiveJson[]}[];
}

interface PrimitiveJson {
  attributes: Record<string, number>;
  indices?: number;
  material?: number;
  extras?: {terrane?: {skirt?: boolean}};
}

const kArrays = {
  5120: Int8Array,
  5121: Uint8Array,
  5122: Int16Array,
  5123: Uint16Array,
  5125: Uint32Array,
  5126: Float32Array,
} as const;

const kComponents: Record<string, number> = {SCALAR: 1, VEC2: 2, VEC3: 3, VEC4: 4};

/**
 * @param stepM lattice steps of the tile's level (east, north, up)
 * @throws Error that says what the file lacks
 */
export function readGlb(file: ArrayBuffer, stepM: Vec3, decode: DecodeMeshopt): GlbTile {
  const {json, binary} = chunksOf(file);
  if (json.extensionsRequired?.includes('KHR_draco_mesh_compression')) {
    throw new Error('Draco cannot be read. Build with --compression meshopt or none');
  }
  const mesh = json.meshes?.[0];
  const {land, water} = surfacesOf(json, mesh?.primitives ?? []);
  const primitive = land ?? water;
  const origin = mesh?.extras?.terrane?.origin;
  if (!primitive || !origin) throw new Error('no mesh with extras.terrane.origin');

  const bytesOf = memoized((view: number) => decoded(json.bufferViews[view]!, binary, decode));
  const numbers = (accessor: number) => packed(json.accessors[accessor]!, bytesOf);
  const attribute = (name: string) => {
    const accessor = primitive.attributes[name];
    if (accessor === undefined) throw new Error(`no attribute ${name}`);
    return numbers(accessor);
  };
  const indicesOf = (surface: PrimitiveJson | undefined) => {
    if (surface && surface.indices === undefined) throw new Error('no indices');
    if (surface && surface.attributes.POSITION !== primitive.attributes.POSITION) {
      throw new Error('water with vertices of its own');
    }
    return surface && (numbers(surface.indices!) as Indices);
  };
  const [positions, toTargets] = [attribute('POSITION') as Steps, attribute('_MORPH') as Steps];
  const normals = attribute('NORMAL');
  // without a scale, numbers are metres
  const metres = json.nodes?.[0]?.scale === undefined ? gltfSteps(stepM) : undefined;
  return {
    origin,
    positions: metres ? divided(positions, metres) : positions,
    toTargets: metres ? divided(toTargets, metres) : toTargets,
    normals: normals instanceof Int8Array ? normals : signedBytes(normals, metres),
    ...joined(indicesOf(land), indicesOf(water)),
    ...drape(json, primitive.attributes, numbers, bytesOf),
  };
}

/** Land and water of a tile. Skirts are left out. */
function surfacesOf(json: GltfJson, primitives: PrimitiveJson[]) {
  const surfaces = primitives.filter(({extras}) => !extras?.terrane?.skirt);
  const isWater = ({material}: PrimitiveJson) => json.materials?.[material ?? -1]?.name === 'water';
  const water = surfaces.find(isWater);
  return {land: surfaces.find((surface) => surface !== water), water};
}

/** All corners, those of water last. */
function joined(land: Indices | undefined, water: Indices | undefined) {
  const landIndices = land?.length ?? 0;
  if (!land || !water) return {indices: land ?? water!, landIndices};
  const ArrayType = land.constructor as new (length: number) => Indices;
  const indices = new ArrayType(landIndices + water.length);
  indices.set(land);
  indices.set(water, landIndices);
  return {indices, landIndices};
}

function gltfSteps([east, north, up]: Vec3): Vec3 {
  return [east, up, north];
}

/** Metres as steps; exact, steps are powers of two. */
function divided(triples: Steps, steps: Vec3): Float32Array {
  return Float32Array.from(triples, (value, i) => value / steps[i % 3]!);
}

/** Normals as bytes of length 127, multiplied by the steps as those of lattice tiles are. */
function signedBytes(triples: ArrayLike<number>, steps: Vec3 | undefined): Int8Array {
  const bytes = new Int8Array(triples.length);
  for (let i = 0; i < triples.length; i += 3) {
    const scaled = [0, 1, 2].map((k) => triples[i + k]! * (steps?.[k] ?? 1));
    const size = Math.hypot(...scaled) || 1;
    scaled.forEach((value, k) => (bytes[i + k] = Math.round((127 * value) / size)));
  }
  return bytes;
}

/** What lies on the terrain: colours of the vertices, or an image. */
function drape(
  json: GltfJson,
  attributes: Record<string, number>,
  numbers: (accessor: number) => ArrayLike<number>,
  bytesOf: (view: number) => {bytes: Uint8Array},
): Pick<GlbTile, 'colors' | 'places' | 'image'> {
  const [color, place] = [attributes.COLOR_0, attributes.TEXCOORD_0];
  const image = json.images?.[0];
  return {
    ...(color !== undefined && {colors: bytesOfColors(json.accessors[color]!, numbers(color))}),
    ...(place !== undefined && {places: fractions(json.accessors[place]!, numbers(place))}),
    ...(image?.bufferView !== undefined && {
      image: {bytes: bytesOf(image.bufferView).bytes, type: image.mimeType ?? 'image/jpeg'},
    }),
  };
}

function chunksOf(file: ArrayBuffer): {json: GltfJson; binary: Uint8Array} {
  const view = new DataView(file);
  if (file.byteLength < 20 || view.getUint32(0, true) !== 0x46546c67) throw new Error('no glb');
  const jsonBytes = view.getUint32(12, true);
  const text = new TextDecoder().decode(new Uint8Array(file, 20, jsonBytes));
  return {json: JSON.parse(text) as GltfJson, binary: new Uint8Array(file, 28 + jsonBytes)};
}

/** Bytes of a buffer view and how far its elements stand apart; stride 0: as their type says. */
function decoded(view: ViewJson, binary: Uint8Array, decode: DecodeMeshopt) {
  const packedView = view.extensions?.EXT_meshopt_compression;
  const from = packedView ?? view;
  const stored = binary.subarray(from.byteOffset ?? 0, (from.byteOffset ?? 0) + from.byteLength);
  if (!packedView) return {bytes: stored, stride: view.byteStride ?? 0};
  const {count, byteStride: stride = 0, mode, filter} = packedView;
  const bytes = new Uint8Array(count * stride);
  decode(bytes, count, stride, stored, mode, filter);
  return {bytes, stride};
}

/** Copies an accessor's numbers into an array of their type, without gaps. */
function packed(
  {bufferView, byteOffset = 0, componentType, count, type}: AccessorJson,
  bytesOf: (view: number) => {bytes: Uint8Array; stride: number},
) {
  const ArrayType = kArrays[componentType as keyof typeof kArrays];
  const width = kComponents[type];
  if (!ArrayType || !width) throw new Error(`accessor of ${type} ${componentType}`);
  const {bytes, stride} = bytesOf(bufferView);
  const size = ArrayType.BYTES_PER_ELEMENT;
  const apart = stride || width * size;
  const out = new ArrayType(count * width);
  const target = new Uint8Array(out.buffer);
  for (let i = 0; i < count; ++i) {
    const at = byteOffset + i * apart;
    target.set(bytes.subarray(at, at + width * size), i * width * size);
  }
  return out;
}

/** Colours as three bytes; a fourth component and 16 bits are left out, floats are scaled. */
function bytesOfColors({type, componentType}: AccessorJson, from: ArrayLike<number>): Uint8Array {
  const width = kComponents[type]!;
  const scale = 255 / largestOf(componentType);
  const colors = new Uint8Array((from.length / width) * 3);
  for (let i = 0; i < colors.length; ++i) {
    colors[i] = Math.round(scale * from[Math.floor(i / 3) * width + (i % 3)]!);
  }
  return colors;
}

function fractions({componentType}: AccessorJson, from: ArrayLike<number>): Float32Array {
  const scale = 1 / largestOf(componentType);
  return Float32Array.from(from, (value) => value * scale);
}

/** What stands for 1. */
function largestOf(componentType: number): number {
  return componentType === 5126 ? 1 : componentType === 5123 ? 65535 : 255;
}

function memoized<T>(make: (key: number) => T): (key: number) => T {
  const made = new Map<number, T>();
  return (key) => {
    if (!made.has(key)) made.set(key, make(key));
    return made.get(key)!;
  };
}
