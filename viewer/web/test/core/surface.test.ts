import {describe, expect, it} from 'vitest';
import {Surface, type ShownTile} from '../../src/core/surface';
import type {Tile} from '../../src/core/tileset';
import {length, subtract, type Vec3} from '../../src/core/vec3';
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

  it('leaves out no triangle of a large mesh, wherever its vertices are on their way', () => {
    const bumpy = bumps();
    const surfaceOf = (shown: ShownTile) => new Surface([tile], [0, 0, 0], () => shown);
    const random = randomSource(2);
    let hits = 0;
    for (let i = 0; i < 300; ++i) {
      const eye: Vec3 = [1000 * random(), 1000 * random(), 300];
      const direction: Vec3 = i % 2 ? [0, 0, -1] : [random() - 0.5, random() - 0.5, -0.3 * random()];
      // each triangle a mesh of its own: the least of all hits
      const alone = bumpy.map((one) => surfaceOf(one).hit(eye, direction)?.place);
      const away = (place?: Vec3) => (place ? length(subtract(place, eye)) : Infinity);
      const nearest = Math.min(...alone.map(away));
      const found = surfaceOf(joined(bumpy)).hit(eye, direction)?.place;
      if (nearest === Infinity) expect(found).toBeUndefined();
      else expect(away(found)).toBeCloseTo(nearest, 9);
      if (found) ++hits;
    }
    expect(hits).toBeGreaterThan(150);
  });
});

/** 200 triangles, each as a mesh, on a grid whose vertices have moved by different shares of long ways. */
function bumps(): ShownTile[] {
  const random = randomSource(3);
  const {uniforms} = shown(0.5);
  const corner = new Map<string, {at: number[]; to: number[]}>();
  const cornerAt = (x: number, y: number) => {
    const key = `${x} ${y}`;
    if (!corner.has(key)) {
      const to = [40 * random() - 20, 200 * random() - 100, 40 * random() - 20];
      corner.set(key, {at: [100 * x, 100 * random(), -100 * y], to});
    }
    return corner.get(key)!;
  };
  const ofCorners = (places: readonly (readonly [number, number])[]): ShownTile => {
    const corners = places.map(([x, y]) => cornerAt(x, y));
    return {
      tile,
      positions: corners.flatMap(({at}) => at),
      toTargets: corners.flatMap(({to}) => to),
      indices: [0, 1, 2],
      uniforms: {...uniforms, eyeM: [0, 0, 0], beginM: 0, perM: 1 / 1500},
    };
  };
  const cells = [...Array(100).keys()].map((i) => [i % 10, Math.floor(i / 10)] as const);
  return cells.flatMap(([x, y]) => [
    ofCorners([
      [x, y],
      [x + 1, y],
      [x, y + 1],
    ]),
    ofCorners([
      [x, y + 1],
      [x + 1, y],
      [x + 1, y + 1],
    ]),
  ]);
}

function joined(tiles: readonly ShownTile[]): ShownTile {
  return {
    ...tiles[0]!,
    positions: tiles.flatMap(({positions}) => Array.from(positions)),
    toTargets: tiles.flatMap(({toTargets}) => Array.from(toTargets)),
    indices: tiles.flatMap((_, i) => [3 * i, 3 * i + 1, 3 * i + 2]),
  };
}
