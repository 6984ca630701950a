// The finest cut that is completely loaded, so that what loads is seen as detail fading in and
// never as a hole or a crack.
import {reducedRanges, type Ranges} from './ranges';
import {selectTiles} from './selection';
import type {Level, Tile} from './tileset';
import type {Vec3} from './vec3';

/** 2^-20: ranges of kilometres are found to millimetres. */
const kHalvings = 20;

/**
 * The largest share (0 to 1) of the wanted ranges at which every tile that the selection meets is
 * ready. Because the ranges grow with the share, so does the set of split tiles: a search by
 * halving finds the limit. 0 where the root's children are not ready.
 */
export function largestReadyShare(
  root: Tile,
  eye: Vec3,
  levels: readonly Level[],
  wanted: Ranges,
  isReady: (tile: Tile) => boolean,
): number {
  const isComplete = (share: number) =>
    selectTiles(root, eye, reducedRanges(levels, wanted, share)).every((v) => isReady(v.tile));
  if (isComplete(1)) return 1;
  let ready = 0;
  let missing = 1;
  for (let i = 0; i < kHalvings; ++i) {
    const middle = (ready + missing) / 2;
    if (isComplete(middle)) ready = middle;
    else missing = middle;
  }
  return ready;
}

/** Shares of the wanted ranges that detail fades in by, per second. */
const kGlidePerSecond = 1.5;

/** The next share to show: down at once (the tiles are not there), up at a limited rate. */
export function glideShare(shown: number, ready: number, elapsedS: number): number {
  return Math.min(ready, shown + kGlidePerSecond * elapsedS);
}
