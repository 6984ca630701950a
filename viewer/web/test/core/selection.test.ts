import {describe, expect, it} from 'vitest';
import {Holdbacks, tilesWithoutChildren, type Holdback} from '../../src/core/holdback';
import {morphInterval, reducedRanges, wantedRanges, type Ranges} from '../../src/core/ranges';
import {areTouching} from '../../src/core/seams';
import {cutOf, nearestBoxes, selectTiles} from '../../src/core/selection';
import {distanceToBounds, distanceToBox} from '../../src/core/box';
import {tilesOf, type Tile} from '../../src/core/tileset';
import {length, subtract, type Vec3} from '../../src/core/vec3';
import {kLeafM, quadtree, randomEye} from './quadtree';
import {randomSource} from './random';

const kTop = 5;
const kPixelScale = 500;

/** With a level to each octave. */
function areNeighbours(a: Tile, b: Tile): boolean {
  return areTouching({...a, octave: a.level}, {...b, octave: b.level});
}

/** How many tiles of a cut cover each finest tile. */
function coverage(cut: readonly Tile[]): number[] {
  const side = 2 ** kTop;
  const count = Array<number>(side * side).fill(0);
  for (const {level, x, y} of cut) {
    const size = 2 ** level;
    for (let j = y * size; j < (y + 1) * size; ++j) {
      for (let i = x * size; i < (x + 1) * size; ++i) ++count[j * side + i]!;
    }
  }
  return count;
}

/** Cuts for random eyes; half of them with tiles missing at random. */
function* randomCuts(seed: number, count: number) {
  const random = randomSource(seed);
  const {root, levels} = quadtree(kTop);
  for (let i = 0; i < count; ++i) {
    const eye = randomEye(kTop, random);
    const nearestM = nearestBoxes(root, eye);
    const wanted = wantedRanges(levels, kPixelScale, 0.5 * 32 ** random(), nearestM);
    const ranges: Ranges = reducedRanges(levels, wanted, 1);
    const missingShare = random() < 0.5 ? 0 : random() ** 3;
    const missing = new Set(
      [...tilesOf(root)].filter((tile) => tile !== root && random() < missingShare),
    );
    const isReady = (tile: Tile) => !missing.has(tile);
    const without = tilesWithoutChildren(root, eye, ranges, isReady);
    const holdbacks = new Holdbacks().step(without, eye, ranges, 0);
    const cut = cutOf(selectTiles(root, eye, ranges, holdbacks));
    yield {eye, ranges, holdbacks, missing, cut};
  }
}

describe('selectTiles', () => {
  it('covers the root exactly once', () => {
    for (const {cut} of randomCuts(1, 100)) {
      expect(coverage(cut).every((count) => count === 1)).toBe(true);
    }
  });

  it('shows neighbours within one level of each other', () => {
    let mixed = 0;
    for (const {cut} of randomCuts(2, 100)) {
      for (const a of cut) {
        for (const b of cut) {
          if (!areNeighbours(a, b)) continue;
          expect(Math.abs(a.level - b.level)).toBeLessThanOrEqual(1);
          if (a.level !== b.level) ++mixed;
        }
      }
    }
    expect(mixed).toBeGreaterThan(1000);
  });

  it('has the fine side of a border at t = 1 and the coarse side at t = 0', () => {
    let corners = 0;
    for (const {eye, ranges, holdbacks, cut} of randomCuts(3, 200)) {
      for (const fine of cut) {
        for (const coarse of cut) {
          if (fine.level + 1 !== coarse.level || !areNeighbours(fine, coarse)) continue;
          for (const corner of sharedCorners(fine, coarse)) {
            const distanceM = shownDistance(corner, eye, holdbacks);
            const {endM} = morphInterval(ranges[fine.level]!, 0.25);
            expect(distanceM).toBeGreaterThan(endM);
            const above = ranges[coarse.level];
            if (above) expect(distanceM).toBeLessThan(morphInterval(above, 0.25).beginM);
            ++corners;
          }
        }
      }
    }
    expect(corners).toBeGreaterThan(1000);
  });

  it('shows finest tiles below the eye when they are wanted', () => {
    const {root, levels} = quadtree(kTop);
    const eye: Vec3 = [1.5 * kLeafM, 1.5 * kLeafM, 200];
    const ranges = wantedRanges(levels, kPixelScale, 0.5, nearestBoxes(root, eye));
    const cut = cutOf(selectTiles(root, eye, ranges));
    expect(cut.find(({level, x, y}) => level === 0 && x === 1 && y === 1)).toBeDefined();
  });

  it('leaves nothing out but what has no data', () => {
    const isThere = ({level, x}: {level: number; x: number}) => level !== 1 || x > 2;
    const {root, levels} = quadtree(3, isThere);
    const eye: Vec3 = [0, 0, 100];
    const ranges = wantedRanges(levels, kPixelScale, 0.5, nearestBoxes(root, eye));
    const cut = cutOf(selectTiles(root, eye, ranges));
    const leaves = (tiles: Iterable<Tile>) =>
      [...tiles].filter((tile) => tile.children.length === 0);
    const below = cut.flatMap((tile) => leaves(tilesOf(tile)));
    expect(new Set(below)).toEqual(new Set(leaves(tilesOf(root))));
    expect(below.length).toBe(new Set(below).size);
  });
});

describe('selectTiles, with tiles missing', () => {
  it('shows none of them', () => {
    let held = 0;
    for (const {holdbacks, missing, cut} of randomCuts(5, 200)) {
      expect(cut.some((tile) => missing.has(tile))).toBe(false);
      if (holdbacks.length > 0) ++held;
    }
    expect(held).toBeGreaterThan(25);
  });
});

describe('nearestBoxes', () => {
  it('finds what a look at every box finds', () => {
    const random = randomSource(4);
    const isThere = ({level, x, y}: {level: number; x: number; y: number}) =>
      level > 1 || (x + 3 * y) % 5 > 1;
    const {root} = quadtree(kTop, isThere);
    for (let i = 0; i < 100; ++i) {
      const eye = randomEye(kTop, random);
      const expected = Array<number>(kTop + 1).fill(Infinity);
      for (const tile of tilesOf(root)) {
        if (tile.children.length === 0) continue;
        expected[tile.level] = Math.min(expected[tile.level]!, distanceToBox(tile.box, eye));
      }
      expect(nearestBoxes(root, eye)).toEqual(expected);
    }
  });
});

/** The definition of holdback.ts, in doubles. */
function shownDistance(place: Vec3, eye: Vec3, holdbacks: readonly Holdback[]): number {
  const held = holdbacks.map(({bounds, heightM}) => heightM - distanceToBounds(bounds, place));
  return Math.max(length(subtract(place, eye)), ...held);
}

/** Corners, at half height, that two tiles have in common. */
function sharedCorners(fine: Tile, coarse: Tile): Vec3[] {
  const size = kLeafM * 2 ** fine.level;
  const [low, high] = [coarse.x * 2 * size, (coarse.x + 1) * 2 * size];
  const [south, north] = [coarse.y * 2 * size, (coarse.y + 1) * 2 * size];
  return [0, 1, 2, 3]
    .map((k): Vec3 => [(fine.x + (k % 2)) * size, (fine.y + (k >> 1)) * size, 0])
    .filter(([x, y]) => x >= low && x <= high && y >= south && y <= north);
}
