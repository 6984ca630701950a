import {describe, expect, it} from 'vitest';
import {Surface, type ShownTile} from '../../src/core/surface';
import type {Tile} from '../../src/core/tileset';
import type {Vec3} from '../../src/core/vec3';
import {quadtree} from './quadtree';
import {randomSource} from './random';

const {root} = quadtree(0);
const parent = {...root, level: 1, errorM: 7};
const tile: Tile = {...root, errorM: 2, parent};

/** Two triangles over (0, 0) to (1000, 1000) on the plane z = (x + 2 y) / 10; all sinks by 50. */
function shown(t: number): ShownTile {
  const corners = [
    [0, 0],
    [1000, 0],
    [0, 1000],
    [1000, 1000],
  ] as const;
  return {
    tile,
    positions: corners.flatMap(([x, y]) => [x, (x + 2 * y) / 10, -y]),
    toTargets: corners.flatMap(() => [0, -50, 0]),
    indices: [0, 1, 2, 2, 1, 3],
    uniforms: {
      stepM: [1, 1, 1],
      offsetM: [0, 0, 0],
      eyeM: [0, 0, 1e5],
      beginM: 0,
      perM: t > 0 ? t / 1e5 : 0,
      holdbacks: [],
    },
  };
}

const surface = (t: number) => new Surface([tile], [0, 0, 0], () => shown(t));

describe('Surface', () => {
  it('is the plane of its triangles', () => {
    const random = randomSource(1);
    for (let i = 0; i < 50; ++i) {
      const [x, y] = [1000 * random(), 1000 * random()];
      expect(surface(0).heightAt(x, y)).toBeCloseTo((x + 2 * y) / 10, 6);
    }
  });

  it('has no gap where triangles meet, and none at the edge', () => {
    for (const [x, y] of [
      [500, 500],
      [0, 0],
      [1000, 1000],
      [1000, 0],
      [250, 750],
    ] as const) {
      expect(surface(0).heightAt(x, y)).toBeCloseTo((x + 2 * y) / 10, 6);
    }
    expect(surface(0).heightAt(1001, 500)).toBeUndefined();
  });

  it('is the morphed one, as exact as the level that it goes to', () => {
    expect(surface(1).heightAt(400, 100)).toBeCloseTo(60 - 50, 1);
    expect(surface(0).pointAt(400, 100)!.errorM).toBe(2);
    expect(surface(1).pointAt(400, 100)!.errorM).toBe(7);
  });

  it('is met by rays from the side', () => {
    const direction: Vec3 = [0.6, 0, -0.8];
    const point = surface(0).hit([0, 500, 400], direction)!;
    // 500 + 0.6 s over 10 = 400 - 0.8 s: s = 300 / 0.86
    expect(point.place[0]).toBeCloseTo((0.6 * 300) / 0.86, 6);
    expect(surface(0).hit([0, 500, 400], [0, 0, 1])).toBeUndefined();
  });
});
