import {add, cross, length, normalize, scale, subtract, type Vec3} from './vec3';

/** An oriented box of 3D Tiles: its centre and three half axes, in metres. */
export interface Box {
  readonly center: Vec3;
  readonly halfAxes: readonly [Vec3, Vec3, Vec3];
}

/** The smallest box along the axes of the world around something. */
export interface Bounds {
  readonly low: Vec3;
  readonly high: Vec3;
}

const known = new WeakMap<Box, Bounds>();

/** What a box covers along the axes. */
export function boundsOf(box: Box): Bounds {
  let bounds = known.get(box);
  if (!bounds) {
    // from the corners, so that rounding puts none of them outside
    const extreme = (pick: (...values: number[]) => number) =>
      ([0, 1, 2] as const).map((k) => pick(...corners(box).map((corner) => corner[k])));
    const [low, high] = [extreme(Math.min), extreme(Math.max)] as unknown as [Vec3, Vec3];
    bounds = {low, high};
    known.set(box, bounds);
  }
  return bounds;
}

/** Metres from a point to the box; 0 inside. */
export function distanceToBounds({low, high}: Bounds, point: Vec3): number {
  const x = Math.max(0, low[0] - point[0], point[0] - high[0]);
  const y = Math.max(0, low[1] - point[1], point[1] - high[1]);
  const z = Math.max(0, low[2] - point[2], point[2] - high[2]);
  return Math.sqrt(x * x + y * y + z * z);
}

/** Half axes as directions of length 1 (any direction for a flat box) and lengths. */
interface Axes {
  readonly directions: readonly [Vec3, Vec3, Vec3];
  readonly lengths: Vec3;
}

const knownAxes = new WeakMap<Box, Axes>();

function axesOf(box: Box): Axes {
  let axes = knownAxes.get(box);
  if (!axes) {
    const lengths = box.halfAxes.map(length) as unknown as Vec3;
    const [u, v, w] = box.halfAxes.map(normalize) as [Vec3, Vec3, Vec3];
    // a flat box has still a direction that it is flat in
    const directions = [
      lengths[0] > 0 ? u : normalize(cross(v, w)),
      lengths[1] > 0 ? v : normalize(cross(w, u)),
      lengths[2] > 0 ? w : normalize(cross(u, v)),
    ] as const;
    axes = {directions, lengths};
    knownAxes.set(box, axes);
  }
  return axes;
}

/** Metres from a point to an oriented box, whose axes stand at right angles; 0 inside. */
export function distanceToBox(box: Box, point: Vec3): number {
  const {directions, lengths} = axesOf(box);
  const [x, y, z] = subtract(point, box.center);
  let squared = 0;
  for (let k = 0; k < 3; ++k) {
    const [u, v, w] = directions[k]!;
    const beyond = Math.abs(x * u + y * v + z * w) - lengths[k]!;
    if (beyond > 0) squared += beyond * beyond;
  }
  return Math.sqrt(squared);
}

/** Length of the longest diagonal, in metres. */
export function diagonal(box: Box): number {
  return 2 * Math.hypot(...axesOf(box).lengths);
}

/** The largest distance from a point of a box to bounds. */
export function farthestDistance(box: Box, bounds: Bounds): number {
  return Math.max(...corners(box).map((corner) => distanceToBounds(bounds, corner)));
}

const knownCorners = new WeakMap<Box, readonly Vec3[]>();

/** The eight corners. */
export function corners(box: Box): readonly Vec3[] {
  let found = knownCorners.get(box);
  if (!found) {
    const [u, v, w] = box.halfAxes;
    const signs = [-1, 1];
    found = signs.flatMap((a) =>
      signs.flatMap((b) =>
        signs.map((c) => add(box.center, add(scale(u, a), add(scale(v, b), scale(w, c))))),
      ),
    );
    knownCorners.set(box, found);
  }
  return found;
}
