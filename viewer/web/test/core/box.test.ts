import {describe, expect, it} from 'vitest';
import {corners, diagonal, distanceToBox, type Box} from '../../src/core/box';

/** 6 x 8 x 2, turned by 45 degrees about the vertical. */
const kTurned: Box = {
  center: [10, 20, 30],
  halfAxes: [
    [3 * Math.SQRT1_2, 3 * Math.SQRT1_2, 0],
    [-4 * Math.SQRT1_2, 4 * Math.SQRT1_2, 0],
    [0, 0, 1],
  ],
};

describe('distanceToBox', () => {
  it('is 0 inside and the distance to side, edge or corner outside', () => {
    expect(distanceToBox(kTurned, [10, 20, 30.9])).toBe(0);
    expect(distanceToBox(kTurned, [10, 20, 36])).toBeCloseTo(5, 12);
    const along = (u: number, v: number, w: number) =>
      [10 + (u - v) * Math.SQRT1_2, 20 + (u + v) * Math.SQRT1_2, 30 + w] as const;
    expect(distanceToBox(kTurned, along(6, 8, 0))).toBeCloseTo(5, 12);
    expect(distanceToBox(kTurned, along(5, 7, 7))).toBeCloseTo(7, 12);
  });

  it('counts the height over a flat box', () => {
    const flat: Box = {center: [0, 0, 0], halfAxes: [[1, 0, 0], [0, 1, 0], [0, 0, 0]]};
    expect(distanceToBox(flat, [0.5, 0.5, 7])).toBeCloseTo(7, 12);
    expect(distanceToBox(flat, [4, 0, 4])).toBeCloseTo(5, 12);
  });
});

describe('diagonal', () => {
  it('is the distance of opposite corners', () => {
    expect(diagonal(kTurned)).toBeCloseTo(Math.hypot(6, 8, 2), 12);
    const all = corners(kTurned);
    expect(all.length).toBe(8);
    const [first, last] = [all[0]!, all[7]!];
    expect(Math.hypot(...first.map((v, k) => v - last[k]!))).toBeCloseTo(diagonal(kTurned), 12);
  });
});
