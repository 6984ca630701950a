import {describe, expect, it} from 'vitest';
import {
  boundsOf,
  corners,
  diagonal,
  distanceToBounds,
  distanceToBox,
  farthestDistance,
  type Box,
} from '../../src/core/box';

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
    const flat: Box = {
      center: [0, 0, 0],
      halfAxes: [
        [1, 0, 0],
        [0, 1, 0],
        [0, 0, 0],
      ],
    };
    expect(distanceToBox(flat, [0.5, 0.5, 7])).toBeCloseTo(7, 12);
    expect(distanceToBox(flat, [4, 0, 4])).toBeCloseTo(5, 12);
  });
});

describe('farthestDistance', () => {
  it('is that of the farthest of many points', () => {
    const bounds = {low: [0, 0, 0], high: [4, 30, 29]} as const;
    const shares = [-1, -0.5, 0, 0.5, 1];
    const points = shares.flatMap((a) =>
      shares.flatMap((b) =>
        shares.map((c) =>
          ([0, 1, 2] as const).map(
            (k) =>
              kTurned.center[k] +
              a * kTurned.halfAxes[0][k] +
              b * kTurned.halfAxes[1][k] +
              c * kTurned.halfAxes[2][k],
          ),
        ),
      ),
    );
    const distances = points.map(([x, y, z]) => distanceToBounds(bounds, [x!, y!, z!]));
    expect(farthestDistance(kTurned, bounds)).toBeCloseTo(Math.max(...distances), 12);
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
