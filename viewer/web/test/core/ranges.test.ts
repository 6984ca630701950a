import {describe, expect, it} from 'vitest';
import {
  morphInterval,
  morphShareOf,
  pixelsPerRadian,
  reducedRanges,
  wantedRanges,
  type Ranges,
} from '../../src/core/ranges';
import type {Level} from '../../src/core/tileset';
import {nearestBoxes} from '../../src/core/selection';
import {quadtree, randomEye} from './quadtree';
import {randomSource} from './random';

/** Ladders and boxes without any regularity but growth. */
function randomLevels(random: () => number): Level[] {
  const morphShare = morphShareOf(1 + Math.floor(4 * random()));
  let [toleranceM, diagonalM] = [0.1 + random(), 100 + 1000 * random()];
  return [...Array(2 + Math.floor(8 * random())).keys()].map((level) => {
    toleranceM *= 1.05 + 3 * random();
    diagonalM *= 1.1 + 2 * random();
    return {level, toleranceM, diagonalM, morphShare, stepM: [1, 1, 1] as const};
  });
}

/** An eye within all boxes. */
const kWithin = Array<number>(20).fill(0);

/** r_l + diagonal_(l+1) <= (1 - m) r_(l+1) wherever level l is shown at all. */
function expectTight(levels: readonly Level[], ranges: Ranges) {
  for (let l = 0; l + 1 < ranges.length; ++l) {
    if (ranges[l] === 0) continue;
    expect(ranges[l]! + levels[l + 1]!.diagonalM).toBeLessThan((1 - levels[l + 1]!.morphShare) * ranges[l + 1]!);
  }
}

describe('wantedRanges', () => {
  it('keeps neighbours within one level for any ladder', () => {
    const random = randomSource(1);
    for (let i = 0; i < 500; ++i) {
      const levels = randomLevels(random);
      expectTight(levels, wantedRanges(levels, 500, 0.5 * 32 ** random(), kWithin));
    }
  });

  it('never lets a tolerance cover more pixels than wanted', () => {
    const random = randomSource(2);
    for (let i = 0; i < 500; ++i) {
      const levels = randomLevels(random);
      const tolerancePx = 0.5 * 32 ** random();
      wantedRanges(levels, 500, tolerancePx, kWithin).forEach((range, l) =>
        expect((levels[l + 1]!.toleranceM * 500) / range / tolerancePx).toBeLessThan(1 + 1e-12),
      );
    }
  });

  it.each([1, 2, 3, 4])('is the error alone where boxes are small, %i levels to an octave', (k) => {
    // 0.25 / k leaves this much of a range for the boxes of the next level
    const roomShare = (1 - 0.25 / k) * 2 ** (1 / k) - 1;
    expect(roomShare).toBeGreaterThan(0.1);
    const levels = [...Array(9).keys()].map((level) => ({
      level,
      toleranceM: 2 ** (level / k),
      diagonalM: 0.95 * roomShare * 250 * 2 ** (level / k),
      morphShare: morphShareOf(k),
      stepM: [1, 1, 1] as const,
    }));
    const forError = levels.slice(1).map(({toleranceM}) => (toleranceM * 500) / 2);
    expect(wantedRanges(levels, 500, 2, kWithin)).toEqual(forError);
  });
});

describe('wantedRanges, from afar', () => {
  it('does not make room for levels that are not shown', () => {
    const levels = randomLevels(randomSource(6));
    const ranges = wantedRanges(levels, 500, 2, Array<number>(20).fill(1e9));
    ranges.forEach((range, l) => expect(range).toBe((levels[l + 1]!.toleranceM * 500) / 2));
  });

  it('is continuous in the distance, and has all room where a level begins', () => {
    const random = randomSource(7);
    for (let i = 0; i < 20; ++i) {
      const levels = randomLevels(random).slice(0, 3);
      if (levels.length < 3) continue;
      const all = wantedRanges(levels, 500, 2, kWithin);
      const from = (m: number) => wantedRanges(levels, 500, 2, [m, m, m]);
      expect(from(all[0]!)[1]! / all[1]!).toBeCloseTo(1, 12);
      for (let m = 0; m < 4 * all[0]!; m += all[0]! / 200) {
        const step = from(m)[1]! - from(m + all[0]! / 200)[1]!;
        expect(step).toBeGreaterThanOrEqual(0);
        expect(step).toBeLessThan(all[1]! / 200);
      }
    }
  });

  it('shows every level as if it had all room', () => {
    const random = randomSource(8);
    const {root, levels} = quadtree(5);
    let levelsShown = 0;
    for (let i = 0; i < 200; ++i) {
      const eye = randomEye(5, random);
      const nearestM = nearestBoxes(root, eye);
      const wanted = wantedRanges(levels, 500, 0.5 * 32 ** random(), nearestM);
      reducedRanges(levels, wanted, 1).forEach((range, l) => {
        // a level whose range reaches a box keeps that range: it is never taken out
        if (nearestM[l + 1]! >= wanted[l]!) return;
        expect(range).toBeCloseTo(wanted[l]!, 6);
        ++levelsShown;
      });
    }
    expect(levelsShown).toBeGreaterThan(200);
  });
});

describe('reducedRanges', () => {
  it('keeps neighbours within one level for any share', () => {
    const random = randomSource(3);
    for (let i = 0; i < 500; ++i) {
      const levels = randomLevels(random);
      expectTight(levels, reducedRanges(levels, wantedRanges(levels, 500, 2, kWithin), random()));
    }
  });

  it('goes from the root alone to what is wanted', () => {
    const levels = randomLevels(randomSource(4));
    const wanted = wantedRanges(levels, 500, 2, kWithin);
    expect(reducedRanges(levels, wanted, 0).every((range) => range === 0)).toBe(true);
    const all = reducedRanges(levels, wanted, 1);
    all.forEach((range, l) => expect(range).toBeCloseTo(wanted[l]!, 6));
  });

  it('grows with the share', () => {
    const levels = randomLevels(randomSource(5));
    const wanted = wantedRanges(levels, 500, 2, kWithin);
    let last = reducedRanges(levels, wanted, 0);
    for (let share = 0.01; share <= 1; share += 0.01) {
      const ranges = reducedRanges(levels, wanted, share);
      ranges.forEach((range, l) => expect(range).toBeGreaterThanOrEqual(last[l]!));
      last = ranges;
    }
  });
});

describe('morphInterval', () => {
  it('ends below the range, so that float32 distances from it on are at t = 1', () => {
    const {beginM, endM} = morphInterval(1000, 0.25);
    expect(beginM).toBe(750);
    expect(endM).toBeLessThan(1000 * (1 - 1e-4));
    expect(endM).toBeGreaterThan(beginM);
  });
});

describe('pixelsPerRadian', () => {
  it('is half the picture for an opening angle of 90 degrees', () => {
    expect(pixelsPerRadian(480, 90)).toBeCloseTo(240, 9);
  });
});
