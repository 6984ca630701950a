import {beforeAll, describe, expect, it} from 'vitest';
import {parseTileset, tilesOf, TilesetError} from '../../src/core/tileset';
import {makeTileset} from '../synthetic_tiles.mjs';

const kUrl = 'http://host/folder/tileset.json';

describe('parseTileset', () => {
  let made: {tileset: any; terrane: any};
  beforeAll(() => {
    made = makeTileset();
  });

  it('reads the tree, the ladder and the addresses', () => {
    const {root, levels, cellM, tileCells} = parseTileset(made.tileset, made.terrane, kUrl);
    // 85 tiles of a whole tree less a level 1 tile and its four children
    expect([...tilesOf(root)].length).toBe(80);
    expect(root.children[0]!.parent).toBe(root);
    expect(root.children[0]!.url).toMatch(/^http:\/\/host\/folder\/tiles\/2\/0\/0\.glb$/);
    expect(levels.map(({level}) => level)).toEqual([0, 1, 2, 3]);
    expect(levels[3]!.diagonalM).toBeGreaterThan(Math.hypot(7680, 7680));
    expect(cellM).toBeCloseTo(30, 9);
    expect(tileCells).toBe(32);
  });

  const refused: [string, (made: any) => void, RegExp][] = [
    ['a tileset of someone else', ({terrane}) => (terrane.format = 'x'), /not terrane\/1/],
    ['no root', ({tileset}) => delete tileset.root, /tileset\.json: no "root"/],
    ['a tile without an id', ({tileset}) => delete tileset.root.extras, /no extras\.terrane/],
    ['a sphere', ({tileset}) => (tileset.root.boundingVolume = {}), /3\/0\/0 has no bound/],
    ['no content', ({tileset}) => delete tileset.root.content, /3\/0\/0 has no content/],
    ['a skipped level', ({tileset: {root}}) => ++root.extras.terrane.level, /one level/],
    ['a missing level', ({terrane}) => terrane.levels.pop(), /levels are not 0 to 3/],
  ];
  it.each(refused)('refuses %s and says where', (_, spoil, message) => {
    const spoilt = structuredClone({tileset: made.tileset, terrane: made.terrane});
    spoil(spoilt);
    const parse = () => parseTileset(spoilt.tileset, spoilt.terrane, kUrl);
    expect(parse).toThrow(TilesetError);
    expect(parse).toThrow(message);
  });
});
