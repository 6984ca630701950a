// The ranges r_l: the camera distance from which on level l shows as level l + 1.
//
// A vertex of level l has t = 0 up to (1 - m) r_l and t = 1 from r_l on. Where a tile of level l
// meets one of level l + 1, the fine side must be at t = 1 and the coarse side still at t = 0:
//
//     distance   0 --------(1-m) r_0 ~~~ r_0 ------------------(1-m) r_1 ~~~ r_1 ---->
//     level      0         0 -> 1        1                      1 -> 2       2
//                                        |<- diagonal of a level 1 box ->|
//
// A box of level l + 1 is split when its nearest point is closer than r_l; its farthest one is then
// closer than r_l + diagonal. So r_l + diagonal_(l+1) <= (1 - m) r_(l+1) is what keeps cracks out,
// and neighbours within one level. A range of 0 says that the level is never shown: the ranges
// above it are then free.
import type {Level} from './tileset';

/** m where every level doubles the tolerance. */
const kMorphShare = 0.25;

/** Room for float32 distances on the graphics card: they are good to about 1e-6. */
export const kSlack = 1 / 1024;

/** In ranges of a level: from where on the coarser ones make room for it. */
const kPrepareFrom = 3;

/** Index = level; one entry for each level except the root's, in metres. */
export type Ranges = readonly number[];

/**
 * m: the share of a range in which vertices morph. Ranges grow by 2^(1/k) from level to level: the
 * inequality leaves boxes some room only if (1 - m) 2^(1/k) is above 1. 0.25 / k leaves half of the finer
 * range for k = 1, then 0.24, 0.15 and 0.11 of it.
 *
 * @param levelsPerOctave k
 */
export function morphShareOf(levelsPerOctave: number): number {
  return kMorphShare / levelsPerOctave;
}

/**
 * K: pixels that a metre covers at a distance of a metre.
 *
 * @param heightPx height of the picture
 * @param fovDeg vertical opening angle
 */
export function pixelsPerRadian(heightPx: number, fovDeg: number): number {
  return heightPx / (2 * Math.tan((fovDeg * Math.PI) / 360));
}

/**
 * The ranges at which no level's tolerance covers more than tolerancePx, made larger where the
 * inequality above asks for it, from the finest up. It asks only where the finer level is shown:
 * a level that begins at three times its range from the eye makes the coarser ranges grow little by
 * little, so that nothing jumps when the eye comes near.
 *
 * Far from the terrain some of these ranges break the inequality; reducedRanges() takes those
 * levels out, which are not shown from there.
 *
 * @param pixelScale K of pixelsPerRadian()
 * @param tolerancePx wanted error on the screen, above 0
 * @param nearestM index = level: distance from the eye to that level's nearest box with children
 */
export function wantedRanges(
  levels: readonly Level[],
  pixelScale: number,
  tolerancePx: number,
  nearestM: readonly number[],
): Ranges {
  const ranges: number[] = [];
  for (let l = 0; l + 1 < levels.length; ++l) {
    const forError = (levels[l + 1]!.toleranceM * pixelScale) / tolerancePx;
    const finerM = ranges[l - 1];
    const floor = finerM
      ? smallestAbove(finerM, levels[l]!) * needOf(finerM, nearestM[l]!)
      : 0;
    ranges.push(Math.max(forError, floor));
  }
  return ranges;
}

/**
 * The ranges to show: `share` times the wanted ones, made smaller where the inequality asks for it,
 * from the coarsest down. What is not all loaded is shown with a share below 1. Continuous and
 * growing with share: 0 shows the root alone, 1 what is wanted.
 */
export function reducedRanges(levels: readonly Level[], wanted: Ranges, share: number): Ranges {
  const ranges = wanted.map((range) => range * share);
  for (let l = ranges.length - 2; l >= 0; --l) {
    const largest = largestBelow(ranges[l + 1]!, levels[l + 1]!);
    ranges[l] = Math.max(0, Math.min(ranges[l]!, largest));
  }
  return ranges;
}

/** Where vertices of a level begin and end to morph, in metres from the camera. */
export function morphInterval(
  rangeM: number,
  morphShare: number,
): {beginM: number; endM: number} {
  return {beginM: rangeM * (1 - morphShare), endM: rangeM * (1 - kSlack)};
}

/** 1 where a level with this range is shown, 0 where it is far from it. */
function needOf(rangeM: number, nearestM: number): number {
  const share = (kPrepareFrom * rangeM - nearestM) / ((kPrepareFrom - 1) * rangeM);
  return Math.min(1, Math.max(0, share));
}

function smallestAbove(finerRangeM: number, {diagonalM, morphShare}: Level): number {
  return ((finerRangeM + diagonalM) * (1 + kSlack)) / (1 - morphShare);
}

function largestBelow(coarserRangeM: number, {diagonalM, morphShare}: Level): number {
  return (coarserRangeM * (1 - morphShare)) / (1 + kSlack) - diagonalM;
}
