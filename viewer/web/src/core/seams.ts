// Looks for cracks: compares the places at which neighbouring tiles draw their common border.
//
// Which border vertices of tile A does it share with tile B? Those whose place *before* the morph
// lies on B's border before the morph, in plan, to a quarter of the distance of two samples.
// - Heights do not count, so a vertical crack cannot hide. Neither can a vertex that only one side
//   has (it lies on the other side's border line all the same), nor one that morphs elsewhere.
// - Vertices of the outline of the data stand at least 0.7 samples beside the neighbour's border,
//   so they are not taken for shared ones. (They may morph *into* the end of a shared border; that
//   is why places after the morph do not decide.)
//
// Each shared vertex must coincide with a drawn border vertex of B, in all three float32
// coordinates; and each of B's with one of A.
import {borderOf, type Border} from './border';
import {basePlace, shownPlace, zUp, type MorphUniforms} from './morph';
import type {Vec3} from './vec3';

/** A tile as it is drawn in one frame. */
export interface DrawnTile {
  /** Tiles of an octave are 2^octave finest tiles wide. */
  readonly octave: number;
  readonly x: number;
  readonly y: number;
  /** Lattice steps from the tile's origin, glTF triples. */
  readonly positions: ArrayLike<number>;
  /** Lattice steps to the place in the next coarser level, glTF triples. */
  readonly toTargets: ArrayLike<number>;
  readonly indices: ArrayLike<number>;
  readonly uniforms: MorphUniforms;
}

/** What checkSeams() found. */
export interface SeamReport {
  readonly tiles: number;
  /** Pairs of touching tiles that share at least one border vertex. */
  readonly pairs: number;
  /** Shared border vertices compared, counted from each side. */
  readonly vertices: number;
  /** Those without a vertex of the neighbour at exactly the same place. */
  readonly mismatches: number;
  /** Largest distance of one of them to the neighbour's nearest border vertex, in metres. */
  readonly worst_m: number;
}

interface DrawnBorder {
  readonly tile: DrawnTile;
  readonly base: readonly Vec3[];
  readonly shown: readonly Vec3[];
  readonly shownKeys: ReadonlySet<string>;
  /** Pairs of numbers into base. */
  readonly edges: readonly (readonly [number, number])[];
  /** Bounds of base in plan. */
  readonly low: readonly [number, number];
  readonly high: readonly [number, number];
}

/**
 * Compares every pair of touching tiles.
 *
 * @param tiles a cut: no tile covers another
 * @param cellM plan distance of two samples, the smaller of its two directions
 */
export function checkSeams(tiles: readonly DrawnTile[], cellM: number): SeamReport {
  const borders = tiles.map(drawBorder);
  let [pairs, vertices, mismatches, worstM] = [0, 0, 0, 0];
  for (const a of borders) {
    for (const b of borders) {
      if (a === b || !areTouching(a.tile, b.tile)) continue;
      const found = compare(a, b, cellM / 4);
      // each pair comes twice, once from each side: count it where its first tile comes first
      if (found.vertices > 0 && isBefore(a.tile, b.tile)) ++pairs;
      vertices += found.vertices;
      mismatches += found.mismatches;
      worstM = Math.max(worstM, found.worstM);
    }
  }
  return {tiles: tiles.length, pairs, vertices, mismatches, worst_m: worstM};
}

function drawBorder(tile: DrawnTile): DrawnBorder {
  const border: Border = borderOf(tile.indices, tile.positions.length / 3);
  const rank = new Map(border.vertices.map((vertex, i) => [vertex, i]));
  const base = border.vertices.map((v) => basePlace(zUp(tile.positions, v), tile.uniforms));
  const shown = border.vertices.map((v) =>
    shownPlace(zUp(tile.positions, v), zUp(tile.toTargets, v), tile.uniforms),
  );
  const extreme = (pick: (...values: number[]) => number, axis: 0 | 1) =>
    base.reduce((best, place) => pick(best, place[axis]), base[0]![axis]);
  return {
    tile,
    base,
    shown,
    shownKeys: new Set(shown.map(String)),
    edges: border.edges.map(([a, b]) => [rank.get(a)!, rank.get(b)!] as const),
    low: [extreme(Math.min, 0), extreme(Math.min, 1)],
    high: [extreme(Math.max, 0), extreme(Math.max, 1)],
  };
}

function compare(a: DrawnBorder, b: DrawnBorder, nearM: number) {
  let [vertices, mismatches, worstM] = [0, 0, 0];
  a.shown.forEach((place, i) => {
    if (b.shownKeys.has(String(place))) {
      ++vertices;
    } else if (isOnBorder(a.base[i]!, b, nearM)) {
      ++vertices;
      ++mismatches;
      worstM = Math.max(worstM, Math.min(...b.shown.map((other) => distance(place, other))));
    }
  });
  return {vertices, mismatches, worstM};
}

/** Whether a place is closer than nearM in plan to the border before its morph. */
function isOnBorder(place: Vec3, border: DrawnBorder, nearM: number): boolean {
  const isOutside = [0, 1].some((axis) => {
    const at = place[axis as 0 | 1];
    return at < border.low[axis]! - nearM || at > border.high[axis]! + nearM;
  });
  if (isOutside) return false;
  const {base, edges} = border;
  return edges.some(([i, j]) => planDistance(place, base[i]!, base[j]!) < nearM);
}

/** Distance in plan from p to the line from a to b. */
function planDistance(p: Vec3, a: Vec3, b: Vec3): number {
  const [dx, dy] = [b[0] - a[0], b[1] - a[1]];
  const squared = dx * dx + dy * dy;
  const along = squared > 0 ? ((p[0] - a[0]) * dx + (p[1] - a[1]) * dy) / squared : 0;
  const t = Math.min(1, Math.max(0, along));
  return Math.hypot(p[0] - a[0] - t * dx, p[1] - a[1] - t * dy);
}

function distance(a: Vec3, b: Vec3): number {
  return Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]);
}

interface TilePlace {
  readonly octave: number;
  readonly x: number;
  readonly y: number;
}

/** Whether two tiles of the quadtree have a border or a corner in common. */
export function areTouching(a: TilePlace, b: TilePlace): boolean {
  const meet = (p: number, q: number) => {
    const [pSize, qSize] = [2 ** a.octave, 2 ** b.octave];
    return p * pSize <= (q + 1) * qSize && q * qSize <= (p + 1) * pSize;
  };
  return meet(a.x, b.x) && meet(a.y, b.y);
}

function isBefore(a: TilePlace, b: TilePlace): boolean {
  return a.octave - b.octave < 0 || (a.octave === b.octave && (a.x - b.x || a.y - b.y) < 0);
}
