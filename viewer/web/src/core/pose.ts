// Where the eye is and where it looks, and the ways to move it. World metres, z up; angles in
// degrees: heading clockwise from north, pitch above the horizon.
import type {Camera} from './first_camera';
import {add, dot, length, scale, subtract, type Vec3} from './vec3';

export interface Pose {
  readonly eye: Vec3;
  readonly headingDeg: number;
  readonly pitchDeg: number;
}

/** Straight down has no heading, straight up no use. */
export const kSteepestDeg = -89.5;
export const kHighestDeg = 60;

const kRad = Math.PI / 180;

export function forward({headingDeg, pitchDeg}: Pose): Vec3 {
  const [heading, pitch] = [headingDeg * kRad, pitchDeg * kRad];
  const flat = Math.cos(pitch);
  return [flat * Math.sin(heading), flat * Math.cos(heading), Math.sin(pitch)];
}

export function rightOf({headingDeg}: Pose): Vec3 {
  return [Math.cos(headingDeg * kRad), -Math.sin(headingDeg * kRad), 0];
}

export function poseOf({eye, target}: Camera): Pose {
  const [x, y, z] = subtract(target, eye);
  const flat = Math.hypot(x, y);
  // looking straight down: north is up
  const headingDeg = flat > 1e-6 * Math.abs(z) ? Math.atan2(x, y) / kRad : 0;
  return {eye, headingDeg, pitchDeg: limitPitch(Math.atan2(z, flat) / kRad)};
}

/** Turns the eye about a point, which keeps its place in the picture while no limit is met. */
export function orbit(pose: Pose, pivot: Vec3, turnDeg: number, tiltDeg: number): Pose {
  const next = {
    headingDeg: wrap(pose.headingDeg + turnDeg),
    pitchDeg: limitPitch(pose.pitchDeg + tiltDeg),
  };
  const from = subtract(pose.eye, pivot);
  const axes = (p: Pose) => [rightOf(p), upOf(p), forward(p)] as const;
  const [old, now] = [axes(pose), axes({...pose, ...next})];
  const moved = old.reduce<Vec3>(
    (sum, axis, k) => add(sum, scale(now[k]!, dot(from, axis))),
    [0, 0, 0],
  );
  return {eye: add(pivot, moved), ...next};
}

/** Looks around from where the eye is. */
export function look(pose: Pose, turnDeg: number, tiltDeg: number): Pose {
  return {
    eye: pose.eye,
    headingDeg: wrap(pose.headingDeg + turnDeg),
    pitchDeg: limitPitch(pose.pitchDeg + tiltDeg),
  };
}

/** Moves towards a point: it stays where it is in the picture. Factor 0.5 halves the distance. */
export function zoom(pose: Pose, point: Vec3, factor: number): Pose {
  return {...pose, eye: add(point, scale(subtract(pose.eye, point), factor))};
}

/**
 * Moves sideways so that a point that was seen in one direction is then seen in another. What is
 * near the horizon would run away: no drag moves farther than the point is.
 */
export function drag(pose: Pose, point: Vec3, direction: Vec3): Pose {
  const depth = point[2] - pose.eye[2];
  const reach = length(subtract(point, pose.eye));
  const along = Math.abs(direction[2]) > 1e-6 ? depth / direction[2] : Infinity;
  if (along <= 0 || along > 4 * reach) return pose;
  const [x, y] = subtract(point, add(pose.eye, scale(direction, along)));
  const shorten = Math.min(1, reach / (Math.hypot(x, y) || 1));
  return {...pose, eye: add(pose.eye, [x * shorten, y * shorten, 0])};
}

/** Moves along the view's own directions, in metres. */
export function move(pose: Pose, rightM: number, forwardM: number, upM: number): Pose {
  const step = add(scale(rightOf(pose), rightM), scale(forward(pose), forwardM));
  return {...pose, eye: add(pose.eye, add(step, [0, 0, upM]))};
}

/** Between two poses, t from 0 to 1; headings turn the short way. */
export function between(a: Pose, b: Pose, t: number): Pose {
  return {
    eye: add(a.eye, scale(subtract(b.eye, a.eye), t)),
    headingDeg: wrap(a.headingDeg + wrap(b.headingDeg - a.headingDeg) * t),
    pitchDeg: a.pitchDeg + (b.pitchDeg - a.pitchDeg) * t,
  };
}

/** An angle from -180 to 180. */
export function wrap(deg: number): number {
  return deg - 360 * Math.round(deg / 360);
}

function upOf(pose: Pose): Vec3 {
  const {headingDeg, pitchDeg} = pose;
  return forward({eye: pose.eye, headingDeg, pitchDeg: pitchDeg + 90});
}

function limitPitch(deg: number): number {
  return Math.min(kHighestDeg, Math.max(kSteepestDeg, deg));
}
