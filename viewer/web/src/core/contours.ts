// Contour lines: which heights have one at a zoom.
import {roundAbove} from './round_numbers';

/** Two sets of lines that blend into each other as the camera moves. */
export interface Contours {
  readonly intervalM: number;
  readonly nextIntervalM: number;
  /** 0: only lines of intervalM; 1: only those of the next. */
  readonly blend: number;
}

/** Pixels in which the ground should rise by an interval at least, on a slope of 45 degrees. */
const kSpacingPx = 6;

/** The share of an interval's reach in which the next one fades in. */
const kBlendShare = 0.3;

/** @param metresPerPx what a pixel covers in the middle of the picture */
export function contoursFor(metresPerPx: number): Contours {
  const smallestM = kSpacingPx * metresPerPx;
  const intervalM = roundAbove(smallestM);
  const nextIntervalM = roundAbove(intervalM * 1.01);
  const left = Math.log(intervalM / smallestM) / Math.log(nextIntervalM / intervalM);
  return {intervalM, nextIntervalM, blend: Math.max(0, 1 - left / kBlendShare)};
}
