import {describe, expect, it} from 'vitest';
import {readBelow} from '../../src/core/subtree';
import {parseTileset, tilesOf, type Tile} from '../../src/core/tileset';
import {makeTileset} from '../synthetic_tiles.mjs';

interface Node {
  boundingVolume: {box: number[]};
  content?: {uri: string};
  children?: Node[];
  extras: {terrane: {level: number; x: number; y: number; triangles: number; max_error_m: number}};
}

const made = makeTileset();
const whole = made.tileset as {root: Node};
const expected = [...tilesOf(parseTileset(whole, made.terrane, 'http://host/a/tileset.json').root)];

/** Reads everything, in the order in which a viewer would come to it. */
async function readAll(root: Tile, read: (url: string) => Promise<ArrayBuffer>): Promise<Tile[]> {
  const open = [root];
  const all: Tile[] = [];
  for (let tile = open.pop(); tile; tile = open.pop()) {
    await readBelow(tile, read);
    all.push(tile);
    open.push(...tile.children);
  }
  return all;
}

/** What tells tiles apart, in any order. */
function summary(tiles: readonly Tile[]) {
  return tiles
    .map(({key, url, box, errorM, triangles, parent}) => ({
      ...{key, url, errorM, triangles, parent: parent?.key},
      box: [box.center, ...box.halfAxes],
    }))
    .sort((a, b) => (a.key < b.key ? -1 : 1));
}

const bytes = (text: string) => new TextEncoder().encode(text).buffer as ArrayBuffer;

describe('an external tileset', () => {
  it('gives the same tree as one file', async () => {
    const files = new Map<string, string>();
    /** Cuts the tree below each tile of level 1. */
    const cut = (node: Node): Node => {
      const {level, x, y} = node.extras.terrane;
      if (level !== 1) return {...node, children: node.children!.map(cut)};
      const name = `http://host/a/tilesets/1/${x}/${y}.json`;
      const moved = (inner: Node): Node => ({
        ...inner,
        content: {uri: `../../../${inner.content!.uri}`},
        children: (inner.children ?? []).map(moved),
      });
      files.set(name, JSON.stringify({root: moved(node)}));
      const {children: _, ...rest} = node;
      return {...rest, content: {uri: `tilesets/1/${x}/${y}.json`}};
    };
    const tileset = {root: cut(whole.root)};
    const {root} = parseTileset(tileset, made.terrane, 'http://host/a/tileset.json');
    expect([...tilesOf(root)].some(({level}) => level === 0)).toBe(false);
    const all = await readAll(root, (url) => Promise.resolve(bytes(files.get(url)!)));
    expect(summary(all)).toEqual(summary(expected));
  });

  it('refuses a file about another tile', async () => {
    const root = {...whole.root, content: {uri: 'b.json'}, children: []};
    const parsed = parseTileset({root}, made.terrane, 'http://host/a/tileset.json').root;
    const other = JSON.stringify({root: whole.root.children![0]});
    await expect(readBelow(parsed, () => Promise.resolve(bytes(other)))).rejects.toThrow('2/0/0');
  });
});

const kSubtreeLevels = 2;
const kTop = 3;

/** x and y with their bits in turn, x first. */
function morton(x: number, y: number): number {
  return [0, 1, 2].reduce(
    (code, bit) => code | (((x >> bit) & 1) << (2 * bit)) | (((y >> bit) & 1) << (2 * bit + 1)),
    0,
  );
}

/** The subtree file of a tile at a depth, as the specification lays it out. */
function subtreeFile(depth: number, x: number, y: number): ArrayBuffer {
  const here = (down: number) =>
    expected
      .filter(({level}) => level === kTop - depth - down)
      .filter((tile) => tile.x >> down === x && tile.y >> down === y)
      .map((tile) => ({tile, code: morton(tile.x - (x << down), tile.y - (y << down))}))
      .sort((a, b) => a.code - b.code);
  const rows = [0, 1].flatMap((down) =>
    here(down).map(({tile, code}) => ({tile, number: (4 ** down - 1) / 3 + code})),
  );
  const tileBits = new Uint8Array(8);
  for (const {number} of rows) tileBits[number >> 3]! |= 1 << (number & 7);
  const childBits = new Uint8Array(8);
  for (const {code} of here(kSubtreeLevels)) childBits[code >> 3]! |= 1 << (code & 7);
  const boxes = rows.flatMap(({tile: {box}}) => [...box.center, ...box.halfAxes.flat()]);
  const columns = [
    tileBits,
    childBits,
    new Uint8Array(Float64Array.from(boxes).buffer),
    new Uint8Array(Float64Array.from(rows.map(({tile}) => tile.errorM)).buffer),
    new Uint8Array(Uint32Array.from(rows.map(({tile}) => tile.triangles)).buffer),
  ];
  let byteOffset = 0;
  const bufferViews = columns.map(({byteLength}) => {
    const view = {buffer: 0, byteOffset, byteLength};
    byteOffset += Math.ceil(byteLength / 8) * 8;
    return view;
  });
  const properties = {box: {values: 2}, max_error_m: {values: 3}, triangles: {values: 4}};
  const json = {
    buffers: [{byteLength: byteOffset}],
    bufferViews,
    propertyTables: [{class: 'tile', count: rows.length, properties}],
    tileMetadata: 0,
    tileAvailability: {bitstream: 0},
    contentAvailability: [{bitstream: 0}],
    childSubtreeAvailability: depth === 0 ? {bitstream: 1} : {constant: 0},
  };
  const text = JSON.stringify(json).padEnd(Math.ceil(JSON.stringify(json).length / 8) * 8);
  const file = Buffer.alloc(24 + text.length + byteOffset);
  file.write('subt');
  file.writeUInt32LE(1, 4);
  file.writeBigUInt64LE(BigInt(text.length), 8);
  file.writeBigUInt64LE(BigInt(byteOffset), 16);
  file.write(text, 24);
  columns.forEach((column, i) => file.set(column, 24 + text.length + bufferViews[i]!.byteOffset));
  return Uint8Array.from(file).buffer;
}

describe('an implicit tileset', () => {
  it('gives the same tree as an explicit one', async () => {
    const root = {
      boundingVolume: whole.root.boundingVolume,
      geometricError: 1,
      content: {uri: 'content/{level}/{x}/{y}.glb'},
      implicitTiling: {
        subdivisionScheme: 'QUADTREE',
        subtreeLevels: kSubtreeLevels,
        availableLevels: kTop + 1,
        subtrees: {uri: 'subtrees/{level}/{x}/{y}.subtree'},
      },
    };
    const asked: string[] = [];
    const read = (url: string) => {
      asked.push(url);
      const [level, x, y] = /subtrees\/(\d)\/(\d)\/(\d)\.subtree$/.exec(url)!.slice(1).map(Number);
      return Promise.resolve(subtreeFile(level!, x!, y!));
    };
    const parsed = parseTileset({root}, made.terrane, 'http://host/a/tileset.json').root;
    const all = await readAll(parsed, read);
    const named = expected.map((tile) => ({
      ...tile,
      url: `http://host/a/content/${kTop - tile.level}/${tile.x}/${tile.y}.glb`,
    }));
    expect(summary(all)).toEqual(summary(named));
    expect(asked).toHaveLength(1 + expected.filter(({level}) => level === 1).length);
  });
});
