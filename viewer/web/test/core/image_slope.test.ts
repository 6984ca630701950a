import {describe, expect, it} from 'vitest';
import {imageSlope} from '../../src/core/image_slope';
import {randomSource} from './random';

describe('imageSlope', () => {
  it('leads to the place in the image where a vertex ends its morph', () => {
    const random = randomSource(1);
    // an image turned by 20 degrees against the tile, its rows 1.3 times as long as its columns
    const [cos, sin] = [Math.cos(0.35), Math.sin(0.35)];
    const placeOf = (x: number, z: number) => [
      0.4 + (cos * x - sin * z) / 40000,
      0.6 + (1.3 * (sin * x + cos * z)) / 40000,
    ];
    const plan = [...Array(50).keys()].map(() => [16000 * random(), 16000 * random()]);
    const positions = plan.flatMap(([x, z]) => [x!, 5000 * random(), z!]);
    const places = plan.flatMap(([x, z]) => placeOf(x!, z!));
    const [ue, un, ve, vn] = imageSlope(positions, places);
    const [dx, dz] = [-3000, 1700];
    const [u, v] = placeOf(plan[0]![0]! + dx, plan[0]![1]! + dz);
    expect(places[0]! + ue * dx + un * -dz).toBeCloseTo(u!, 9);
    expect(places[1]! + ve * dx + vn * -dz).toBeCloseTo(v!, 9);
  });

  it('is nothing where all vertices are on one line', () => {
    expect(imageSlope([0, 0, 0, 1, 0, 1, 2, 0, 2], [0, 0, 1, 1, 2, 2])).toEqual([0, 0, 0, 0]);
  });
});
