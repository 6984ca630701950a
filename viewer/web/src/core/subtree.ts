// Reads the parts of a tree that are written apart: external tilesets, and the subtrees of implicit
// ones (docs/formats.md). A tile is read on when it is loaded; before, nothing needs its children.
//
// Source: 3D Tiles 1.1, Implicit Tiling and Metadata.
import type {Box} from './box';
import {
  parseBox,
  parseTile,
  TilesetError,
  type GrowingTile,
  type ImplicitTiling,
  type Tile,
  type TileJson,
} from './tileset';

/** The bytes at an address. */
export type Read = (url: string) => Promise<ArrayBuffer>;

/**
 * Gives a tile its content's address and its children.
 *
 * @throws TilesetError where the file does not describe this tile
 */
export async function readBelow(tile: Tile, read: Read): Promise<void> {
  const {below} = tile;
  if (!below) return;
  const growing = tile as GrowingTile;
  if (below.kind === 'tileset') {
    const text = new TextDecoder().decode(await read(below.url));
    growTileset(growing, JSON.parse(text) as {root?: TileJson}, below.url);
  } else {
    const url = addressOf(below.tiling.subtreeUrl, tile, below.tiling);
    growSubtree(growing, parseSubtree(await read(url), url), below.tiling);
  }
  growing.below = undefined;
}

function growTileset(tile: GrowingTile, json: {root?: TileJson}, url: string): void {
  if (!json.root) throw new TilesetError(`${url}: no "root"`);
  const root = parseTile(json.root, tile.parent, url);
  if (root.key !== tile.key || root.below) {
    throw new TilesetError(`${url}: its root is ${root.key}, not ${tile.key} with a glb`);
  }
  tile.url = root.url;
  tile.errorM = root.errorM;
  tile.children = root.children;
  for (const child of root.children) (child as GrowingTile).parent = tile;
}

/** One .subtree file. */
interface Subtree {
  /** Which tiles are there; number of a tile: those of the depths before, then its Morton code. */
  readonly hasTile: (number: number) => boolean;
  readonly hasChildSubtree: (morton: number) => boolean;
  /** By row: the tiles that are there, in order of their numbers. */
  readonly boxes: Float64Array;
  readonly errorsM: Float64Array;
  readonly triangles: Uint32Array;
}

function growSubtree(root: GrowingTile, subtree: Subtree, tiling: ImplicitTiling): void {
  const made = new Map<number, GrowingTile>([[0, root]]);
  let row = 0;
  for (let depth = 0; depth < tiling.subtreeLevels; ++depth) {
    const first = (4 ** depth - 1) / 3;
    for (let morton = 0; morton < 4 ** depth; ++morton) {
      if (!subtree.hasTile(first + morton)) continue;
      const above = depth > 0 ? made.get((4 ** (depth - 1) - 1) / 3 + (morton >> 2)) : undefined;
      const tile = above ? addChild(above, morton & 3) : root;
      describe(tile, subtree, row++, tiling);
      made.set(first + morton, tile);
    }
  }
  const last = (4 ** (tiling.subtreeLevels - 1) - 1) / 3;
  for (let morton = 0; morton < 4 ** tiling.subtreeLevels; ++morton) {
    if (!subtree.hasChildSubtree(morton)) continue;
    const above = made.get(last + (morton >> 2))!;
    addChild(above, morton & 3).below = {kind: 'subtree', tiling};
  }
}

/** Adds a child; its box is its parent's until its own is read: that holds it. */
function addChild(parent: GrowingTile, quarter: number): GrowingTile {
  const [x, y] = [2 * parent.x + (quarter & 1), 2 * parent.y + (quarter >> 1)];
  const level = parent.level - 1;
  const child: GrowingTile = {
    ...{key: `${level}/${x}/${y}`, level, x, y, parent},
    ...{box: parent.box, url: '', triangles: 0, errorM: parent.errorM, children: []},
  };
  parent.children.push(child);
  return child;
}

function describe(tile: GrowingTile, subtree: Subtree, row: number, tiling: ImplicitTiling): void {
  tile.url = addressOf(tiling.contentUrl, tile, tiling);
  tile.box = boxOf(subtree.boxes.subarray(12 * row, 12 * row + 12), tile.key);
  tile.errorM = subtree.errorsM[row] ?? tile.errorM;
  tile.triangles = subtree.triangles[row] ?? 0;
}

function boxOf(numbers: Float64Array, key: string): Box {
  return parseBox([...numbers], key, 'subtree');
}

function addressOf(template: string, {level, x, y}: Tile, {rootLevel}: ImplicitTiling): string {
  const numbers: Record<string, number> = {level: rootLevel - level, x, y};
  return template.replace(/\{(level|x|y)\}/g, (_, name: string) => String(numbers[name]));
}

interface Availability {
  constant?: number;
  bitstream?: number;
}

interface SubtreeJson {
  bufferViews?: {buffer: number; byteOffset: number; byteLength: number}[];
  buffers?: {uri?: string}[];
  propertyTables?: {properties: Record<string, {values: number}>}[];
  tileMetadata?: number;
  tileAvailability: Availability;
  childSubtreeAvailability: Availability;
}

function parseSubtree(file: ArrayBuffer, url: string): Subtree {
  const view = new DataView(file);
  if (file.byteLength < 24 || view.getUint32(0, true) !== 0x74627573) {
    throw new TilesetError(`${url}: not a .subtree file`);
  }
  const jsonBytes = Number(view.getBigUint64(8, true));
  const text = new TextDecoder().decode(new Uint8Array(file, 24, jsonBytes));
  const json = JSON.parse(text) as SubtreeJson;
  if (json.buffers?.some(({uri}) => uri)) {
    throw new TilesetError(`${url}: buffers outside the file cannot be read`);
  }
  // a copy of each view: typed arrays need an aligned start
  const bytesOf = (index: number) => {
    const {byteOffset, byteLength} = json.bufferViews![index]!;
    const begin = 24 + jsonBytes + byteOffset;
    return file.slice(begin, begin + byteLength);
  };
  const properties = json.propertyTables?.[json.tileMetadata ?? 0]?.properties;
  if (!properties?.box) throw new TilesetError(`${url}: its tiles have no property "box"`);
  const column = (name: string) => {
    const property = properties[name];
    return property ? bytesOf(property.values) : new ArrayBuffer(0);
  };
  return {
    hasTile: bitsOf(json.tileAvailability, bytesOf),
    hasChildSubtree: bitsOf(json.childSubtreeAvailability, bytesOf),
    boxes: new Float64Array(column('box')),
    errorsM: new Float64Array(column('max_error_m')),
    triangles: new Uint32Array(column('triangles')),
  };
}

function bitsOf(
  {constant, bitstream}: Availability,
  bytesOf: (view: number) => ArrayBuffer,
): (index: number) => boolean {
  if (bitstream === undefined) return () => constant === 1;
  const bytes = new Uint8Array(bytesOf(bitstream));
  return (index) => ((bytes[index >> 3]! >> (index & 7)) & 1) === 1;
}
