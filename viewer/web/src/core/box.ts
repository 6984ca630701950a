import {add, length, scale, subtract, type Vec3} from './vec3';

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

/** What a box covers along the axes. terrane's boxes are along them already. */
export function boundsOf(box: Box): Bounds {
  let bounds = known.get(box);
  if (!bounds) {
    const half = ([0, 1, 2] as const).map((k) =>
      box.halfAxes.reduce((sum, axis) => sum + Math.abs(axis[k]), 0),
    ) as unknown as Vec3;
    bounds = {low: subtract(box.center, half), high: add(box.center, half)};
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

/** Length of the longest diagonal of what a box covers, in metres. */
export function diagonal(box: Box): number {
  const {low, high} = boundsOf(box);
  return length(subtract(high, low));
}

/** The eight corners. */
export function corners(box: Box): Vec3[] {
  const [u, v, w] = box.halfAxes;
  return [-1, 1].flatMap((a) =>
    [-1, 1].flatMap((b) =>
      [-1, 1].map((c) => add(box.center, add(scale(u, a), add(scale(v, b), scale(w, c))))),
    ),
  );
}
