import {describe, expect, it} from 'vitest';
import {boundsOf, distanceToBounds, farthestDistance, type Box} from '../../src/core/box';
import {
  Holdbacks,
  holdsBack,
  kMostHoldbacks,
  kOctaveS,
  tilesWithoutChildren,
  type Holdback,
} from '../../src/core/holdback';
import {reducedRanges, wantedRanges, type Ranges} from '../../src/core/ranges';
import {nearestBoxes} from '../../src/core/selection';
import {tilesOf, type Tile} from '../../src/core/tileset';
import type {Vec3} from '../../src/core/vec3';
import {kLeafM, quadtree, randomEye} from './quadtree';
import {randomSource} from './random';

const kTop = 4;
const {root, levels} = quadtree(kTop);

function rangesFrom(eye: Vec3, tolerancePx: number): Ranges {
  return reducedRanges(levels, wantedRanges(levels, 500, tolerancePx, nearestBoxes(root, eye)), 1);
}

/** How high a patch stands over the distance to the eye, at most, on a grid of places. */
function largestRise(holdbacks: readonly Holdback[], eye: Vec3): number {
  let rise = 0;
  for (let x = 0; x <= kLeafM * 2 ** kTop; x += 250) {
    for (let y = 0; y <= kLeafM * 2 ** kTop; y += 250) {
      const awayM = Math.hypot(x - eye[0], y - eye[1], eye[2]);
      for (const {bounds, heightM} of holdbacks) {
        rise = Math.max(rise, heightM - distanceToBounds(bounds, [x, y, 0]) - awayM);
      }
    }
  }
  return rise;
}

describe('Holdbacks', () => {
  const missingKey = '0/3/3';
  const isReady = (tile: Tile) => tile.key !== missingKey;

  it('rise out of the distance without a step as the eye comes near', () => {
    const holdbacks = new Holdbacks();
    let [lastRise, largestStep] = [0, 0];
    for (let x = 12000; x > 5000; x -= 10) {
      const eye: Vec3 = [x, 3500, 300];
      const ranges = rangesFrom(eye, 0.5);
      const missing = tilesWithoutChildren(root, eye, ranges, isReady);
      const rise = largestRise(holdbacks.step(missing, eye, ranges, 0.01), eye);
      largestStep = Math.max(largestStep, Math.abs(rise - lastRise));
      lastRise = rise;
    }
    expect(lastRise).toBeGreaterThan(200);
    // the ranges move a little with the eye too
    expect(largestStep).toBeLessThan(2 * 10);
  });

  it('keep a tile whole whose children are missing, however its box is turned', () => {
    const random = randomSource(4);
    for (let i = 0; i < 2000; ++i) {
      const [cos, sin] = [Math.cos(random()), Math.sin(random())];
      const [x, y, z] = [300 * random(), 200 * random(), 50 * random()];
      const turned: Box = {
        center: [1e4 * random(), 1e4 * random(), 1e3 * random()],
        halfAxes: [
          [x * cos, x * sin, 0.01 * random()],
          [-y * sin, y * cos, 0.02 * random()],
          [0.1 * random(), 0, z],
        ],
      };
      const rangeM = 1e4 * random();
      expect(holdsBack({bounds: boundsOf(turned), heightM: rangeM}, turned, rangeM)).toBe(true);
    }
  });

  it('sink, once the tile is there, until nothing stands out', () => {
    const holdbacks = new Holdbacks();
    const eye: Vec3 = [4500, 3500, 100];
    const ranges = rangesFrom(eye, 1);
    const missing = tilesWithoutChildren(root, eye, ranges, isReady);
    const heightsM = [holdbacks.step(missing, eye, ranges, 0)[0]!.heightM];
    expect(holdbacks.gliding).toBe(false);
    for (;;) {
      const [hold] = holdbacks.step([], eye, ranges, kOctaveS / 4);
      if (!hold) break;
      heightsM.push(hold.heightM);
    }
    expect(heightsM.length).toBeGreaterThan(2);
    for (let i = 1; i < heightsM.length; ++i) {
      expect(heightsM[i]! / heightsM[i - 1]!).toBeCloseTo(2 ** -0.25, 9);
    }
    expect(holdbacks.gliding).toBe(false);
  });

  it('are no more than the shader has room for, and hold all that is missing', () => {
    const random = randomSource(2);
    let gathered = 0;
    for (let i = 0; i < 50; ++i) {
      const tiles = [...tilesOf(root)].filter((tile) => tile.level === 1 && random() < 0.95);
      const eye = randomEye(kTop, random);
      // a larger tree than 64 tiles of level 1 needs two of them
      const twice = quadtree(kTop + 1);
      const many = [...tilesOf(twice.root)].filter(({level}) => level === 1 && random() < 0.7);
      const ranges = Array<number>(kTop + 1).fill(1e5);
      for (const missing of [tiles, many]) {
        const holds = new Holdbacks().step(missing, eye, ranges, 0);
        expect(holds.length).toBeLessThanOrEqual(kMostHoldbacks);
        if (holds.length < missing.length) ++gathered;
        for (const {box} of missing) {
          const isHeld = holds.some(
            ({bounds, heightM}) => heightM >= 1e5 && farthestDistance(box, bounds) === 0,
          );
          expect(isHeld).toBe(true);
        }
      }
    }
    expect(gathered).toBeGreaterThan(20);
  });
});
