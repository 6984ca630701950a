// Which tiles to show for a camera: a cut through the tree.
import {distanceToBox} from './box';
import {holdsBack, type Holdback} from './holdback';
import type {Ranges} from './ranges';
import type {Tile} from './tileset';
import type {Vec3} from './vec3';

/** One tile that the walk from the root met. */
export interface Visit {
  readonly tile: Tile;
  readonly distanceM: number;
  /** True: its children stand in for it; false: it is shown. */
  readonly split: boolean;
}

/**
 * Walks from the root: a tile of level l + 1 gives way to its children where its box is closer to
 * the eye than ranges[l], and no holdback keeps all of the box farther away. The visits that are
 * not split cover the root exactly once.
 */
export function selectTiles(
  root: Tile,
  eye: Vec3,
  ranges: Ranges,
  holdbacks: readonly Holdback[] = [],
): Visit[] {
  const visits: Visit[] = [];
  const open = [root];
  for (let tile = open.pop(); tile; tile = open.pop()) {
    const distanceM = distanceToBox(tile.box, eye);
    const rangeM = tile.children.length > 0 ? ranges[tile.level - 1]! : 0;
    const split =
      distanceM < rangeM && !holdbacks.some((hold) => holdsBack(hold, tile.box, rangeM));
    visits.push({tile, distanceM, split});
    if (split) open.push(...tile.children);
  }
  return visits;
}

/** The tiles that are shown. */
export function cutOf(visits: readonly Visit[]): Tile[] {
  return visits.filter((visit) => !visit.split).map((visit) => visit.tile);
}

/**
 * Index = level: metres from the eye to the nearest box of that level that has children; Infinity
 * where there is none.
 */
export function nearestBoxes(root: Tile, eye: Vec3): number[] {
  const nearestM = Array<number>(root.level + 1).fill(Infinity);
  const search = (tile: Tile, distanceM: number): void => {
    // a box lies in its parent's: nothing below can be nearer
    if (nearestM.every((m, l) => l === 0 || m <= distanceM)) return;
    if (tile.children.length === 0 && !tile.below) return;
    nearestM[tile.level] = Math.min(nearestM[tile.level]!, distanceM);
    // what has not been read yet may be as near
    for (let l = 1; tile.below && l < tile.level; ++l) {
      nearestM[l] = Math.min(nearestM[l]!, distanceM);
    }
    const below = tile.children.map((child) => [child, distanceToBox(child.box, eye)] as const);
    for (const [child, m] of below.sort((a, b) => a[1] - b[1])) search(child, m);
  };
  search(root, distanceToBox(root.box, eye));
  return nearestM;
}
