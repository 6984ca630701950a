import {describe, expect, it} from 'vitest';
import {morphUniforms} from '../../src/core/render_origin';
import {areTouching, checkSeams, type DrawnTile} from '../../src/core/seams';
import type {Vec3} from '../../src/core/vec3';
import {makeTile} from '../synthetic_tiles.mjs';

const kCellM = 30;
const kEye: Vec3 = [-3000, 2500, 900];

interface Stored {
  level: number;
  x: number;
  y: number;
  origin: Vec3;
  positions: number[];
  toTargets: number[];
  indices: number[];
}

/** A tile of the synthetic tileset as drawn with the given ranges. */
function drawn(level: number, x: number, y: number, ranges: number[], change = (_: Stored) => {}) {
  const stored = structuredClone(makeTile(level, x, y)) as unknown as Stored;
  change(stored);
  const step = 2 ** level / 16;
  const place = {level, origin: stored.origin, stepM: [step, step, step] as Vec3, morphShare: 0.25};
  const tile: DrawnTile = {
    ...stored,
    octave: level,
    uniforms: morphUniforms(place, ranges, kEye, [0, 0, 0]),
  };
  return tile;
}

/** All vertices of level 0 at t = 1, those of level 1 at t = 0: how a border must be. */
const kApart = [10, 1e6];

/** Number of a vertex on the east border of a tile of 33 x 33 vertices. */
const east = (row: number) => 33 * row + 32;

describe('checkSeams', () => {
  it('finds nothing between equal levels, in the middle of their morph too', () => {
    const ranges = [4500, 1e6];
    const tiles = [drawn(0, 0, 0, ranges), drawn(0, 1, 0, ranges), drawn(0, 1, 1, ranges)];
    const {uniforms, positions} = tiles[0]!;
    expect(uniforms.beginM).toBeLessThan(4500);
    expect(positions.length).toBe(3 * 33 * 33);
    const report = checkSeams(tiles, kCellM);
    const vertices = 2 * (33 + 33 + 1);
    expect(report).toEqual({tiles: 3, pairs: 3, vertices, mismatches: 0, worst_m: 0});
  });

  it('finds nothing between level 0 at t = 1 and level 1 at t = 0', () => {
    const report = checkSeams([drawn(0, 1, 0, kApart), drawn(1, 1, 0, kApart)], kCellM);
    // 33 vertices stand on 17 places, which are those of the coarse side
    expect(report).toEqual({tiles: 2, pairs: 1, vertices: 33 + 17, mismatches: 0, worst_m: 0});
  });

  it('finds a fine side that has not ended its morph', () => {
    const report = checkSeams([drawn(0, 1, 0, [1e6, 1e7]), drawn(1, 1, 0, [1e6, 1e7])], kCellM);
    // the even vertices stand right but for their rounding, the odd ones have no partner
    expect(report.mismatches).toBeGreaterThanOrEqual(16);
    expect(report.worst_m).toBeGreaterThan(1);
  });

  it('finds a coarse side that has begun to morph', () => {
    const report = checkSeams([drawn(0, 1, 0, [10, 20]), drawn(1, 1, 0, [10, 20])], kCellM);
    expect(report.mismatches).toBeGreaterThanOrEqual(8);
  });

  it('finds a vertex that stands one step too high', () => {
    const raise = (tile: Stored) => void ++tile.positions[3 * east(7) + 1]!;
    const tiles = [drawn(0, 0, 0, [1e6, 1e7], raise), drawn(0, 1, 0, [1e6, 1e7])];
    const report = checkSeams(tiles, kCellM);
    expect(report).toEqual({tiles: 2, pairs: 1, vertices: 66, mismatches: 2, worst_m: 1 / 16});
  });

  it('finds a vertex that morphs elsewhere', () => {
    const turn = (tile: Stored) => void (tile.toTargets[3 * east(7)]! -= 999);
    const tiles = [drawn(0, 0, 0, kApart, turn), drawn(0, 1, 0, kApart)];
    // its neighbour's vertex still has others at its place: the even one it collapses onto
    expect(checkSeams(tiles, kCellM).mismatches).toBe(1);
  });

  it('finds a vertex that one side does not have', () => {
    const drop = (tile: Stored) => {
      const [gone, kept] = [east(7), east(6)];
      tile.indices = tile.indices.map((vertex) => (vertex === gone ? kept : vertex));
      const triples = [...Array(tile.indices.length / 3).keys()].map((i) =>
        tile.indices.slice(3 * i, 3 * i + 3),
      );
      tile.indices = triples.filter((triple) => new Set(triple).size === 3).flat();
    };
    const tiles = [drawn(0, 0, 0, [1e6, 1e7], drop), drawn(0, 1, 0, [1e6, 1e7])];
    const report = checkSeams(tiles, kCellM);
    expect(report.mismatches).toBe(1);
    expect(report.worst_m).toBeGreaterThan(20);
  });
});

describe('areTouching', () => {
  it('sees borders and corners across levels', () => {
    const fine = {octave: 0, x: 3, y: 0};
    expect(areTouching(fine, {octave: 1, x: 2, y: 0})).toBe(true);
    expect(areTouching(fine, {octave: 1, x: 2, y: 1})).toBe(false);
    expect(areTouching({octave: 0, x: 3, y: 1}, {octave: 1, x: 2, y: 1})).toBe(true);
    expect(areTouching(fine, {octave: 0, x: 5, y: 0})).toBe(false);
  });
});
