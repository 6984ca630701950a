// A small tileset of analytic hills in the format of docs/formats.md: regular grids whose odd
// vertices morph onto their even neighbours. For tests of the viewer by itself.
//
//     level l, 2 x 2 cells      t = 1, which is level l + 1
//     +--+--+                   +-----+
//     | /| /|                   |    /|
//     +--+--+        ->         |  /  |      a vertex (i, j) goes to the even (i, j) at its left
//     | /| /|                   |/    |      and above; six of eight triangles lose their area
//     +--+--+                   +-----+
import {mkdir, writeFile} from 'node:fs/promises';
import {dirname, join} from 'node:path';
import {MeshoptEncoder} from 'meshoptimizer';

const kTileCells = 32;
const kCellM = 30;
const kTopLevel = 3;
const kCells = kTileCells * 2 ** kTopLevel;
const kFinestStepM = 1 / 16;
/** A level 1 tile without data, so that there is an outline beside the rim. */
const kHole = {level: 1, x: 2, y: 1};

/** Metres of height at a place: a caldera over rolling hills. */
export function heightM(x, y) {
  const r = Math.hypot(x - 400, y + 300) / 900;
  const caldera = 700 * Math.exp(-((r - 1) ** 2) * 3);
  const hills = 90 * Math.sin(x / 410) * Math.cos(y / 520) + 35 * Math.sin(x / 130 + y / 170);
  return 500 + caldera + hills + 12 * Math.sin(x / 45) * Math.sin(y / 52);
}

function stepOf(level) {
  return kFinestStepM * 2 ** level;
}

/** Lattice point (east, north, up) of a sample as level l holds it. */
function latticePoint(level, column, row) {
  const step = stepOf(level);
  const [x, y] = [(column - kCells / 2) * kCellM, (kCells / 2 - row) * kCellM];
  return [x / step, y / step, Math.round(heightM(x, y) / step)];
}

function isHole(column, row) {
  const size = kTileCells * 2 ** kHole.level;
  return Math.floor(column / size) === kHole.x && Math.floor(row / size) === kHole.y;
}

/** Index triples of a tile, counter-clockwise from above; vertex (i, j) is number 33 j + i. */
function trianglesOf(level, x, y) {
  const triangles = [];
  const at = (i, j) => j * (kTileCells + 1) + i;
  for (let j = 0; j < kTileCells; ++j) {
    for (let i = 0; i < kTileCells; ++i) {
      const [column, row] = [(x * kTileCells + i) * 2 ** level, (y * kTileCells + j) * 2 ** level];
      if (isHole(column, row)) continue;
      triangles.push(at(i, j), at(i, j + 1), at(i + 1, j));
      triangles.push(at(i + 1, j), at(i, j + 1), at(i + 1, j + 1));
    }
  }
  return triangles;
}

/** The stored normal: the step is the same on all axes, so it is the terrain's. */
function normalAt(column, row) {
  const [x, y] = [(column - kCells / 2) * kCellM, (kCells / 2 - row) * kCellM];
  const slope = (dx, dy) => (heightM(x + dx, y + dy) - heightM(x - dx, y - dy)) / (2 * kCellM);
  const n = [-slope(kCellM, 0), -slope(0, kCellM), 1];
  const size = Math.hypot(...n);
  return [n[0], n[2], -n[1]].map((value) => Math.round((127 * value) / size));
}

/** Everything about one tile; undefined where there is no data. */
export function makeTile(level, x, y) {
  const triangles = trianglesOf(level, x, y);
  if (triangles.length === 0) return undefined;
  const size = 2 ** level;
  const used = [...new Set(triangles)].sort((a, b) => a - b);
  const rank = new Map(used.map((vertex, i) => [vertex, i]));
  const origin = latticePoint(level, x * kTileCells * size, y * kTileCells * size);
  const tile = {level, x, y, origin, positions: [], toTargets: [], normals: [], places: []};
  for (const vertex of used) {
    const [i, j] = [vertex % (kTileCells + 1), Math.floor(vertex / (kTileCells + 1))];
    addVertex(tile, (x * kTileCells + i) * size, (y * kTileCells + j) * size);
  }
  return {...tile, indices: triangles.map((vertex) => rank.get(vertex))};
}

function addVertex(tile, column, row) {
  const {level, origin} = tile;
  const place = latticePoint(level, column, row);
  const target = level === kTopLevel ? place : targetOf(level, column, row);
  tile.positions.push(...gltf(place.map((value, k) => value - origin[k])));
  tile.toTargets.push(...gltf(target.map((value, k) => value - place[k])));
  tile.normals.push(...normalAt(column, row));
  tile.places.push(place, target);
}

/** Where a sample of level l stands in level l + 1, in steps of level l. */
function targetOf(level, column, row) {
  const coarse = 2 ** (level + 1);
  const even = (value) => coarse * Math.floor(value / coarse);
  return latticePoint(level + 1, even(column), even(row)).map((value) => 2 * value);
}

function gltf([east, north, up]) {
  return [east, up, -north];
}

/** Largest distance of a level's surface to the heights of all samples. */
function measureErrorM(level) {
  const size = 2 ** level;
  let worst = stepOf(level) / 2;
  const sample = (column, row) =>
    heightM((column - kCells / 2) * kCellM, (kCells / 2 - row) * kCellM);
  for (let row = 0; row < kCells; ++row) {
    for (let column = 0; column < kCells; ++column) {
      const [c, r] = [size * Math.floor(column / size), size * Math.floor(row / size)];
      const [u, v] = [(column - c) / size, (row - r) / size];
      const [b, d] = [sample(c + size, r), sample(c, r + size)];
      const flat =
        u + v <= 1
          ? sample(c, r) * (1 - u - v) + b * u + d * v
          : sample(c + size, r + size) * (u + v - 1) + b * (1 - v) + d * (1 - u);
      worst = Math.max(worst, Math.abs(flat - sample(column, row)) + stepOf(level) / 2);
    }
  }
  return worst;
}

/** A buffer of rows of 3 values, padded to 4 as GPUs like it. */
function padded(ArrayType, triples) {
  const rows = new ArrayType((triples.length / 3) * 4);
  for (let i = 0; i < triples.length; ++i) rows[Math.floor(i / 3) * 4 + (i % 3)] = triples[i];
  return new Uint8Array(rows.buffer);
}

/** Land, and water where a tile says how many of its indices are land's. */
function partsOf({indices, landIndices = indices.length}) {
  const parts = [
    {indices: indices.slice(0, landIndices), material: 0},
    {indices: indices.slice(landIndices), material: 1},
  ];
  return parts.filter((part) => part.indices.length > 0);
}

/** Compressed streams and what their buffer views say. */
function encodeStreams(tile) {
  const count = tile.positions.length / 3;
  const vertices = (ArrayType, triples, stride) => ({
    count,
    stride,
    mode: 'ATTRIBUTES',
    bytes: MeshoptEncoder.encodeVertexBuffer(padded(ArrayType, triples), count, stride),
  });
  const triangles = (indices) => ({
    count: indices.length,
    stride: 2,
    mode: 'TRIANGLES',
    bytes: MeshoptEncoder.encodeIndexBuffer(
      new Uint8Array(Uint16Array.from(indices).buffer),
      indices.length,
      2,
    ),
  });
  return [
    vertices(Int16Array, tile.positions, 8),
    vertices(Int16Array, tile.toTargets, 8),
    vertices(Int8Array, tile.normals, 4),
    ...partsOf(tile).map(({indices}) => triangles(indices)),
  ];
}

function bufferViewsOf(streams) {
  let [offset, fallback] = [0, 0];
  return streams.map(({count, stride, mode, bytes}) => {
    const extension = {
      buffer: 0,
      byteOffset: offset,
      byteLength: bytes.length,
      byteStride: stride,
      count,
      mode,
    };
    const view = {buffer: 1, byteOffset: fallback, byteLength: count * stride};
    if (mode === 'ATTRIBUTES') view.byteStride = stride;
    offset += Math.ceil(bytes.length / 4) * 4;
    fallback += Math.ceil((count * stride) / 4) * 4;
    return {...view, extensions: {EXT_meshopt_compression: extension}};
  });
}

function extremes(triples) {
  const pick = (best) => [0, 1, 2].map((k) => triples.filter((_, i) => i % 3 === k).reduce(best));
  return {min: pick((a, b) => Math.min(a, b)), max: pick((a, b) => Math.max(a, b))};
}

function gltfJson(tile, streams) {
  const {level, x, y, origin} = tile;
  const step = stepOf(level);
  const bufferViews = bufferViewsOf(streams);
  const last = bufferViews.at(-1);
  const parts = partsOf(tile);
  const vectors = (bufferView, componentType, rest) => ({
    bufferView,
    componentType,
    count: streams[bufferView].count,
    type: 'VEC3',
    ...rest,
  });
  return {
    asset: {version: '2.0', generator: 'terrane viewer test'},
    extensionsUsed: ['KHR_mesh_quantization', 'EXT_meshopt_compression'],
    extensionsRequired: ['KHR_mesh_quantization', 'EXT_meshopt_compression'],
    scene: 0,
    scenes: [{nodes: [0]}],
    nodes: [{mesh: 0, scale: [step, step, step], translation: gltf(origin).map((v) => v * step)}],
    meshes: [
      {
        primitives: parts.map(({material}, k) => ({
          attributes: {POSITION: 0, _MORPH: 1, NORMAL: 2},
          indices: 3 + k,
          material,
          targets: [{POSITION: 1}],
        })),
        weights: [0],
        extras: {terrane: {level, x, y, origin}},
      },
    ],
    accessors: [
      vectors(0, 5122, extremes(tile.positions)),
      vectors(1, 5122, extremes(tile.toTargets)),
      vectors(2, 5120, {normalized: true}),
      ...parts.map(({indices}, k) => ({
        bufferView: 3 + k,
        componentType: 5123,
        count: indices.length,
        type: 'SCALAR',
      })),
    ],
    materials: [{}, {name: 'water'}],
    bufferViews,
    buffers: [
      {byteLength: streams.reduce((sum, {bytes}) => sum + Math.ceil(bytes.length / 4) * 4, 0)},
      {
        byteLength: last.byteOffset + last.byteLength,
        extensions: {EXT_meshopt_compression: {fallback: true}},
      },
    ],
  };
}

function chunk(type, bytes, padding) {
  const length = Math.ceil(bytes.length / 4) * 4;
  const out = Buffer.alloc(8 + length, padding);
  out.writeUInt32LE(length, 0);
  out.write(type, 4, 'latin1');
  out.set(bytes, 8);
  return out;
}

/** The bytes of a tile's glb. */
export function glbOf(tile) {
  const streams = encodeStreams(tile);
  const json = Buffer.from(JSON.stringify(gltfJson(tile, streams)));
  const aligned = streams.map(({bytes}) => Buffer.concat([bytes, Buffer.alloc(-bytes.length & 3)]));
  const chunks = [chunk('JSON', json, ' '), chunk('BIN\0', Buffer.concat(aligned), 0)];
  const header = Buffer.alloc(12);
  header.write('glTF', 0, 'latin1');
  header.writeUInt32LE(2, 4);
  header.writeUInt32LE(12 + chunks[0].length + chunks[1].length, 8);
  return Buffer.concat([header, ...chunks]);
}

/** World bounds [low, high] of a tile, its morph and its children. */
function boundsOf(tile, children) {
  const step = stepOf(tile.level);
  const points = tile.places.map((place) => place.map((value) => value * step));
  points.push(...children.flatMap((child) => child.bounds));
  const pick = (best) => [0, 1, 2].map((k) => points.map((point) => point[k]).reduce(best));
  return [pick((a, b) => Math.min(a, b)), pick((a, b) => Math.max(a, b))];
}

function node(level, x, y, errors) {
  const tile = makeTile(level, x, y);
  if (!tile) return undefined;
  const below = level === 0 ? [] : [0, 1, 2, 3];
  const children = below
    .map((k) => node(level - 1, 2 * x + (k % 2), 2 * y + Math.floor(k / 2), errors))
    .filter((child) => child !== undefined);
  return {tile, children, bounds: boundsOf(tile, children), errorM: errors[level]};
}

function tileJson({tile, children, bounds: [low, high], errorM}) {
  const {level, x, y, indices} = tile;
  const half = low.map((value, k) => (high[k] - value) / 2);
  const center = low.map((value, k) => value + half[k]);
  const box = [...center, half[0], 0, 0, 0, half[1], 0, 0, 0, half[2]];
  return {
    boundingVolume: {box},
    geometricError: errorM,
    refine: 'REPLACE',
    content: {uri: `tiles/${level}/${x}/${y}.glb`},
    extras: {terrane: {level, x, y, triangles: indices.length / 3, bytes: 0, max_error_m: errorM}},
    children: children.map(tileJson),
  };
}

function* nodesOf(root) {
  yield root;
  for (const child of root.children) yield* nodesOf(child);
}

function levelJson(level, nodes, errors) {
  const here = nodes.filter(({tile}) => tile.level === level);
  const step = stepOf(level);
  return {
    level,
    tolerance_m: errors[level],
    step_m: [step, step, step],
    tiles: here.length,
    triangles: here.reduce((sum, {tile}) => sum + tile.indices.length / 3, 0),
    bytes: 0,
    max_error_m: errors[level],
    rms_error_m: errors[level] / 4,
    largest_diagonal_m: Math.max(
      ...here.map(({bounds: [low, high]}) => Math.hypot(...low.map((v, k) => high[k] - v))),
    ),
  };
}

/** The whole data set in memory: both JSON files and the tree of tiles. */
export function makeTileset() {
  const levels = [...Array(kTopLevel + 1).keys()];
  const errors = levels.map(measureErrorM);
  const root = node(kTopLevel, 0, 0, errors);
  const nodes = [...nodesOf(root)];
  const [low, high] = root.bounds;
  return {
    nodes,
    tileset: {asset: {version: '1.1'}, geometricError: 2 * errors.at(-1), root: tileJson(root)},
    terrane: {
      format: 'terrane/1',
      generator: 'terrane viewer test',
      dem: {
        columns: kCells + 1,
        rows: kCells + 1,
        valid_samples: (kCells + 1) ** 2,
        min_height_m: low[2],
        max_height_m: high[2],
        fingerprint: '',
        crs_wkt: '',
      },
      frame: {kind: 'local', x: 0, y: 0},
      tile_cells: kTileCells,
      levels: levels.map((level) => levelJson(level, nodes, errors)),
    },
  };
}

/** Writes the data set as `terrane build` would, without the viewer. */
export async function writeTileset(folder) {
  await MeshoptEncoder.ready;
  const {nodes, tileset, terrane} = makeTileset();
  for (const {tile} of nodes) {
    const file = join(folder, 'tiles', String(tile.level), String(tile.x), `${tile.y}.glb`);
    await mkdir(dirname(file), {recursive: true});
    await writeFile(file, glbOf(tile));
  }
  await writeFile(join(folder, 'tileset.json'), JSON.stringify(tileset));
  await writeFile(join(folder, 'terrane.json'), JSON.stringify(terrane));
}
