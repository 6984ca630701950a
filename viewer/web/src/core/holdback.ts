// What is not loaded yet holds back the detail around it, and nowhere else.
//
// Levels and morphs are chosen by the distance to the eye. Cuts stay whole and seams stay closed
// for any function of the place instead, as long as it changes by at most a metre per metre: that
// is all that the inequality of ranges.ts uses. So the place where a tile's children are missing
// keeps its distance at least at the tile's range r, and the places around it as little less as the
// rule allows. It shows as a patch of coarser terrain that blends into its surroundings:
//
//     shown distance = max(distance to the eye, r - distance to the box, ... for each such tile)
//
//                 r _____
//                  /     \                          the box of a tile whose children are missing
//     \           /       \            ___---
//      \_________/         \____----```             distance to the eye
//
// When the children arrive, the height r of the patch sinks until nothing of it stands out: detail
// fades in. A camera that comes near makes a patch rise out of the distance without a step.
import {
  boundsOf,
  distanceToBounds,
  distanceToBox,
  farthestDistance,
  type Bounds,
  type Box,
} from './box';
import type {Ranges} from './ranges';
import type {Tile} from './tileset';
import type {Vec3} from './vec3';

/** One patch: distances in and around a box are at least heightM less the distance to the box. */
export interface Holdback {
  readonly bounds: Bounds;
  readonly heightM: number;
}

interface Patch {
  readonly tile: Tile;
  readonly heightM: number;
}

/** Seconds in which a patch sinks by half: one level of a ladder that doubles fades in. */
export const kOctaveS = 0.15;

/** A box may stick out of its parent's by the last digits that a file holds. */
const kRounding = 1e-9;

/** What the vertex shader has room for. */
export const kMostHoldbacks = 64;

/** Whether a patch keeps all of a box at a distance of rangeM or more. */
export function holdsBack({bounds, heightM}: Holdback, box: Box, rangeM: number): boolean {
  // mostly its middle decides
  if (heightM - distanceToBounds(bounds, box.center) < rangeM) return false;
  return heightM - farthestDistance(box, bounds) >= rangeM * (1 - kRounding);
}

/**
 * The tiles that the camera alone would split, and cannot be because a child is missing; without
 * those below another one.
 */
export function tilesWithoutChildren(
  root: Tile,
  eye: Vec3,
  ranges: Ranges,
  isReady: (tile: Tile) => boolean,
): Tile[] {
  const found: Tile[] = [];
  const open = [root];
  for (let tile = open.pop(); tile; tile = open.pop()) {
    if (tile.children.length === 0) continue;
    if (distanceToBox(tile.box, eye) >= ranges[tile.level - 1]!) continue;
    if (tile.children.every(isReady)) open.push(...tile.children);
    else found.push(tile);
  }
  return found;
}

/** The patches of one view, from frame to frame. */
export class Holdbacks {
  private patches = new Map<string, Patch>();
  private missing: ReadonlySet<string> = new Set();

  /** Whether a patch is sinking: the next frame shows more though nothing arrives. */
  get gliding(): boolean {
    return [...this.patches.keys()].some((key) => !this.missing.has(key));
  }

  /**
   * Moves on by one frame.
   *
   * @param missing what tilesWithoutChildren() found
   */
  step(missing: readonly Tile[], eye: Vec3, ranges: Ranges, elapsedS: number): Holdback[] {
    this.missing = new Set(missing.map((tile) => tile.key));
    const sunk = [...this.patches.values()]
      .filter(({tile}) => !this.missing.has(tile.key))
      .map(({tile, heightM}) => ({tile, heightM: heightM * 2 ** (-elapsedS / kOctaveS)}))
      .filter(({tile, heightM}) => standsOut(tile, heightM, eye, ranges));
    const held = missing.map((tile) => ({tile, heightM: ranges[tile.level - 1]!}));
    this.patches = new Map([...sunk, ...held].map((patch) => [patch.tile.key, patch]));
    for (const patch of sunk) {
      if (isCovered(patch, this.patches)) this.patches.delete(patch.tile.key);
    }
    const shown = [...this.patches.values()].filter((patch) => !isCovered(patch, this.patches));
    return gathered(shown).map(({tile, heightM}) => ({bounds: boundsOf(tile.box), heightM}));
  }
}

/** Whether a patch changes anything: it is above the eye's distance, and above the finest morph. */
function standsOut(tile: Tile, heightM: number, eye: Vec3, ranges: Ranges): boolean {
  const finestM = ranges.find((rangeM) => rangeM > 0) ?? Infinity;
  return heightM > Math.max(finestM / 2, distanceToBounds(boundsOf(tile.box), eye));
}

/** Whether the patch of a tile above is at least as high: then it is so everywhere. */
function isCovered({tile, heightM}: Patch, patches: ReadonlyMap<string, Patch>): boolean {
  for (let above = tile.parent; above; above = above.parent) {
    if ((patches.get(above.key)?.heightM ?? 0) >= heightM) return true;
  }
  return false;
}

/** Puts patches of the finest tiles together, on their parents, until there are few enough. */
function gathered(patches: readonly Patch[]): readonly Patch[] {
  if (patches.length <= kMostHoldbacks) return patches;
  const finest = Math.min(...patches.map(({tile}) => tile.level));
  const byTile = new Map<string, Patch>();
  for (const {tile, heightM} of patches) {
    const place = (tile.level === finest && tile.parent) || tile;
    const other = byTile.get(place.key)?.heightM ?? 0;
    byTile.set(place.key, {tile: place, heightM: Math.max(heightM, other)});
  }
  return gathered([...byTile.values()]);
}
