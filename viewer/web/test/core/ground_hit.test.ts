import {describe, expect, it} from 'vitest';
import type {Box} from '../../src/core/box';
import {hitDistance} from '../../src/core/ground_hit';
import {normalize} from '../../src/core/vec3';

const kBox: Box = {
  center: [0, 0, 0],
  halfAxes: [[5000, 0, 0], [0, 5000, 0], [0, 0, 500]],
};

describe('hitDistance', () => {
  it('is the distance to a plane', () => {
    const distance = hitDistance([0, -4000, 3000], normalize([0, 4, -3]), kBox, () => 0)!;
    expect(distance / 5000).toBeCloseTo(1, 3);
  });

  it('ends at a ridge in front of what lies behind it', () => {
    const ridge = (_: number, y: number) => (y > -1000 && y < -500 ? 400 : 0);
    const distance = hitDistance([0, -4000, 300], [0, 1, 0], kBox, ridge)!;
    expect(distance / 3000).toBeCloseTo(1, 2);
  });

  it('is undefined over the horizon and where there is no data', () => {
    expect(hitDistance([0, 0, 600], [0, 0, 1], kBox, () => 0)).toBeUndefined();
    expect(hitDistance([0, 0, 600], [0, 0, -1], kBox, () => undefined)).toBeUndefined();
  });
});
