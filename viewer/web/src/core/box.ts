import {add, dot, length, scale, subtract, type Vec3} from './vec3';

/** An oriented box of 3D Tiles: its centre and three half axes at right angles, in metres. */
export interface Box {
  readonly center: Vec3;
  readonly halfAxes: readonly [Vec3, Vec3, Vec3];
}

/** Metres from a point to the box; 0 inside. */
export function distanceToBox(box: Box, point: Vec3): number {
  let left = subtract(point, box.center);
  let squared = 0;
  for (const axis of box.halfAxes) {
    const half = length(axis);
    if (half === 0) continue;
    const along = dot(left, axis) / half;
    left = subtract(left, scale(axis, along / half));
    squared += Math.max(0, Math.abs(along) - half) ** 2;
  }
  // nothing is left but rounding, unless the box is flat: an axis of length 0 spans nothing
  const isFlat = box.halfAxes.some((axis) => length(axis) === 0);
  return Math.sqrt(isFlat ? squared + dot(left, left) : squared);
}

/** Length of the longest diagonal, in metres. */
export function diagonal(box: Box): number {
  return 2 * Math.hypot(...box.halfAxes.map(length));
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
