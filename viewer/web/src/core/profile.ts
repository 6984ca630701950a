// The terrain along a line.
import type {Vec3} from './vec3';

/** Heights at equal steps; undefined where there is no terrain. */
export interface Profile {
  /** In plan. */
  readonly lengthM: number;
  readonly heights: readonly (number | undefined)[];
  readonly lowM: number;
  readonly highM: number;
  /** Metres up and down on the way. */
  readonly climbM: number;
  readonly descentM: number;
}

/** @param heightAt height at a world place; asked `count` times, both ends included */
export function profileAlong(
  from: Vec3,
  to: Vec3,
  heightAt: (x: number, y: number) => number | undefined,
  count = 160,
): Profile {
  const heights = Array.from({length: count}, (_, i) => {
    const t = i / (count - 1);
    return heightAt(from[0] + t * (to[0] - from[0]), from[1] + t * (to[1] - from[1]));
  });
  const known = heights.filter((height) => height !== undefined);
  const steps = known.slice(1).map((height, i) => height - known[i]!);
  return {
    lengthM: Math.hypot(to[0] - from[0], to[1] - from[1]),
    heights,
    lowM: Math.min(...known),
    highM: Math.max(...known),
    climbM: steps.reduce((sum, step) => sum + Math.max(0, step), 0),
    descentM: steps.reduce((sum, step) => sum + Math.max(0, -step), 0),
  };
}
