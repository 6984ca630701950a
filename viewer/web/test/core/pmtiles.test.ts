import {gzipSync} from 'node:zlib';
import {describe, expect, it} from 'vitest';
import {PmtilesArchive, tileId, type ReadRange} from '../../src/core/pmtiles';

/** 7 bits a byte, lowest first. */
function varint(value: number): number[] {
  return value < 128 ? [value] : [(value % 128) | 128, ...varint(Math.floor(value / 128))];
}

/** Columns of the specification: ids as differences, runs, lengths, offsets plus one. */
function directory(entries: {id: number; run: number; offset: number; length: number}[]): Buffer {
  const bytes = varint(entries.length);
  entries.forEach(({id}, i) => bytes.push(...varint(id - (entries[i - 1]?.id ?? 0))));
  for (const {run} of entries) bytes.push(...varint(run));
  for (const {length} of entries) bytes.push(...varint(length));
  for (const {offset} of entries) bytes.push(...varint(offset + 1));
  return gzipSync(Buffer.from(bytes));
}

/** An archive with tiles of zoom 1 and a leaf directory, put together by hand. */
function makeArchive(): Buffer {
  const tiles = Buffer.from('finest!root{"a":1}');
  const leaf = directory([{id: 2, run: 2, offset: 0, length: 7}]);
  const root = directory([
    {id: 0, run: 1, offset: 7, length: 4},
    {id: 2, run: 0, offset: 0, length: leaf.length},
  ]);
  const metadata = gzipSync(
    JSON.stringify({
      terrane_archive: {
        version: 1,
        tiles: {path: 'tiles/{l}/{x}/{y}.glb', first_zoom: 1, zoom_step: -1},
        files: {'tileset.json': {asset: {}}, 'build.toml': 'a = 1'},
        stored: {'sub/a.json': {offset: 11, length: 7, compression: 'none'}},
      },
    }),
  );
  const header = Buffer.alloc(127);
  header.write('PMTiles');
  header[7] = 3;
  const sections = [root.length, metadata.length, leaf.length, tiles.length];
  let offset = 127;
  sections.forEach((length, i) => {
    header.writeBigUInt64LE(BigInt(offset), 8 + 16 * i);
    header.writeBigUInt64LE(BigInt(length), 16 + 16 * i);
    offset += length;
  });
  header[97] = 2;
  header[98] = 1;
  return Buffer.concat([header, root, metadata, leaf, tiles]);
}

function rangesOf(bytes: Buffer): ReadRange {
  return (offset, length) => {
    const part = Uint8Array.from(bytes.subarray(offset, offset + length));
    return Promise.resolve(part.buffer);
  };
}

describe('tileId', () => {
  it('is that of the specification', () => {
    // PMTiles 3, section 4.1.1
    const known = [
      [0, 0, 0, 0],
      [1, 0, 0, 1],
      [1, 0, 1, 2],
      [1, 1, 1, 3],
      [1, 1, 0, 4],
      [2, 0, 0, 5],
    ];
    for (const [z, x, y, id] of known) expect(tileId(z!, x!, y!)).toBe(id);
    expect(tileId(12, 3423, 1763)).toBe(19078479);
  });

  it('gives each tile of a zoom its own number, next to its neighbours', () => {
    const places = [...Array(256).keys()].map((i) => ({x: i % 16, y: Math.floor(i / 16)}));
    const byId = places.map(({x, y}) => ({x, y, id: tileId(4, x, y)})).sort((a, b) => a.id - b.id);
    byId.forEach(({x, y, id}, i) => {
      expect(id).toBe(85 + i);
      const before = byId[i - 1];
      if (before) expect(Math.abs(before.x - x) + Math.abs(before.y - y)).toBe(1);
    });
  });
});

describe('PmtilesArchive', () => {
  const text = (bytes: ArrayBuffer | undefined) => bytes && new TextDecoder().decode(bytes);

  it('finds tiles in the root, in leaves and in runs, and files in the metadata', async () => {
    const archive = await PmtilesArchive.open(rangesOf(makeArchive()));
    expect(text(await archive.read('tiles/1/0/0.glb'))).toBe('root');
    expect(text(await archive.read('tiles/0/0/1.glb'))).toBe('finest!');
    expect(text(await archive.read('tiles/0/1/1.glb'))).toBe('finest!');
    expect(await archive.read('tiles/0/1/0.glb')).toBeUndefined();
    expect(text(await archive.read('tileset.json'))).toBe('{"asset":{}}');
    expect(text(await archive.read('build.toml'))).toBe('a = 1');
    expect(text(await archive.read('sub/a.json'))).toBe('{"a":1}');
    expect(await archive.read('nothing')).toBeUndefined();
  });

  it('says what is wrong with a file', async () => {
    const open = (bytes: Buffer) => PmtilesArchive.open(rangesOf(bytes));
    await expect(open(Buffer.from('x'.repeat(200)))).rejects.toThrow('not a PMTiles file');
    const old = makeArchive();
    old[7] = 2;
    await expect(open(old)).rejects.toThrow('version 2');
  });
});
