import {describe, expect, it} from 'vitest';
import {boundsOf, corners, diagonal, distanceToBounds, type Box} from '../../src/core/box';

/** 6 x 8 x 2, turned by 45 degrees about the vertical: 7 sqrt 2 wide both ways. */
const kTurned: Box = {
  center: [10, 20, 30],
  halfAxes: [
    [3 * Math.SQRT1_2, 3 * Math.SQRT1_2, 0],
    [-4 * Math.SQRT1_2, 4 * Math.SQRT1_2, 0],
    [0, 0, 1],
  ],
};

describe('boundsOf', () => {
  it('is the smallest box along the axes around all corners', () => {
    const {low, high} = boundsOf(kTurned);
    for (const axis of [0, 1, 2] as const) {
      const values = corners(kTurned).map((corner) => corner[axis]);
      expect(low[axis]).toBeCloseTo(Math.min(...values), 12);
      expect(high[axis]).toBeCloseTo(Math.max(...values), 12);
    }
  });
});

describe('distanceToBounds', () => {
  const bounds = {low: [0, 0, 0], high: [6, 8, 2]} as const;

  it('is 0 inside and the distance to side, edge or corner outside', () => {
    expect(distanceToBounds(bounds, [3, 4, 1])).toBe(0);
    expect(distanceToBounds(bounds, [3, 4, 7])).toBe(5);
    expect(distanceToBounds(bounds, [9, 12, 1])).toBe(5);
    expect(distanceToBounds(bounds, [-2, -3, 8])).toBe(7);
  });

  it('counts the height over a flat box', () => {
    const flat = {low: [0, 0, 0], high: [1, 1, 0]} as const;
    expect(distanceToBounds(flat, [0.5, 0.5, 7])).toBe(7);
    expect(distanceToBounds(flat, [4, 0, 4])).toBe(5);
  });
});

describe('diagonal', () => {
  it('is that of the bounds', () => {
    expect(diagonal(kTurned)).toBeCloseTo(Math.hypot(7 * Math.SQRT2, 7 * Math.SQRT2, 2), 12);
  });
});
