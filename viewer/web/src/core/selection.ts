// Which tiles to show for a camera: a cut through the quadtree.
import {distanceToBox} from './box';
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
 * the eye than ranges[l]. The visits that are not split cover the root exactly once.
 */
export function selectTiles(root: Tile, eye: Vec3, ranges: Ranges): Visit[] {
  const visits: Visit[] = [];
  const open = [root];
  for (let tile = open.pop(); tile; tile = open.pop()) {
    const distanceM = distanceToBox(tile.box, eye);
    const split = tile.children.length > 0 && distanceM < ranges[tile.level - 1]!;
    visits.push({tile, distanceM, split});
    if (split) open.push(...tile.children);
  }
  return visits;
}

/** The tiles that are shown. */
export function cutOf(visits: readonly Visit[]): Tile[] {
  return visits.filter((visit) => !visit.split).map((visit) => visit.tile);
}
