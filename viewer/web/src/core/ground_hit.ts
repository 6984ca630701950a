import {corners, type Box} from './box';
import {add, length, scale, subtract, type Vec3} from './vec3';

const kSteps = 96;
const kHalvings = 10;

/**
 * Metres from the eye to the first ground along a ray; undefined where it meets none. Ground
 * that is thinner than a step of the search, a fiftieth of the distance or less, may be missed.
 *
 * @param direction of length 1
 * @param box holds all ground
 * @param groundZ world z of the ground at a place; undefined where there is none
 */
export function hitDistance(
  eye: Vec3,
  direction: Vec3,
  box: Box,
  groundZ: (x: number, y: number) => number | undefined,
): number | undefined {
  const farM = Math.max(...corners(box).map((corner) => length(subtract(corner, eye))));
  const isBelow = (distanceM: number) => {
    const [x, y, z] = add(eye, scale(direction, distanceM));
    return z < (groundZ(x, y) ?? -Infinity);
  };
  // even steps on the screen matter, not on the ground: they grow with the square
  const stepM = (i: number) => farM * (i / kSteps) ** 2;
  for (let i = 1; i <= kSteps; ++i) {
    if (isBelow(stepM(i))) return halve(stepM(i - 1), stepM(i), isBelow);
  }
  return undefined;
}

function halve(aboveM: number, belowM: number, isBelow: (distanceM: number) => boolean): number {
  let [low, high] = [aboveM, belowM];
  for (let i = 0; i < kHalvings; ++i) {
    const middle = (low + high) / 2;
    if (isBelow(middle)) high = middle;
    else low = middle;
  }
  return (low + high) / 2;
}
