import {describe, expect, it} from 'vitest';
import {reducedRanges, wantedRanges} from '../../src/core/ranges';
import {cutOf, nearestBoxes, selectTiles} from '../../src/core/selection';
import {glideShare, largestReadyShare} from '../../src/core/shown_cut';
import {tilesOf, type Tile} from '../../src/core/tileset';
import {quadtree, randomEye} from './quadtree';
import {randomSource} from './random';

const kTop = 4;

describe('largestReadyShare', () => {
  it('gives a cut of loaded tiles only, whatever is loaded', () => {
    const random = randomSource(1);
    const {root, levels} = quadtree(kTop);
    const tiles = [...tilesOf(root)];
    let reduced = 0;
    for (let i = 0; i < 200; ++i) {
      const missingShare = random() ** 2;
      const loaded = new Set(tiles.filter((tile) => tile === root || random() > missingShare));
      const eye = randomEye(kTop, random);
      const wanted = wantedRanges(levels, 500, 0.5 * 32 ** random(), nearestBoxes(root, eye));
      const isReady = (tile: Tile) => loaded.has(tile);
      const share = largestReadyShare(root, eye, levels, wanted, isReady);
      const cut = cutOf(selectTiles(root, eye, reducedRanges(levels, wanted, share)));
      expect(cut.every(isReady)).toBe(true);
      if (share > 0 && share < 1) ++reduced;
    }
    expect(reduced).toBeGreaterThan(20);
  });

  it('is the finest such cut: a little more would meet a missing tile', () => {
    const {root, levels} = quadtree(kTop);
    const missing = '0/3/3';
    const isReady = (tile: Tile) => tile.key !== missing;
    // half a kilometre from the parent of the missing tile, whose range is one kilometre
    const eye = [4500, 3500, 100] as const;
    const wanted = wantedRanges(levels, 500, 1, nearestBoxes(root, eye));
    const share = largestReadyShare(root, eye, levels, wanted, isReady);
    expect(share).toBeGreaterThan(0);
    expect(share).toBeLessThan(1);
    const more = selectTiles(root, eye, reducedRanges(levels, wanted, share + 1e-5));
    expect(more.some((visit) => visit.tile.key === missing)).toBe(true);
  });

  it('is 1 where all is loaded and 0 where the root alone is', () => {
    const {root, levels} = quadtree(kTop);
    const eye = [3000, 3000, 800] as const;
    const wanted = wantedRanges(levels, 500, 1, nearestBoxes(root, eye));
    expect(largestReadyShare(root, eye, levels, wanted, () => true)).toBe(1);
    const cut = (share: number) =>
      cutOf(selectTiles(root, eye, reducedRanges(levels, wanted, share)));
    const share = largestReadyShare(root, eye, levels, wanted, (tile) => tile === root);
    expect(cut(share)).toEqual([root]);
  });
});

describe('glideShare', () => {
  it('falls at once and rises at a limited rate', () => {
    expect(glideShare(0.9, 0.2, 0.1)).toBe(0.2);
    expect(glideShare(0.2, 1, 0.1)).toBeCloseTo(0.35, 9);
    expect(glideShare(0.95, 1, 0.1)).toBe(1);
  });
});
