import {corners, type Box} from './box';
import {add, dot, scale, subtract, type Vec3} from './vec3';

/** Where the eye is and what it looks at, in world metres. */
export interface Camera {
  readonly eye: Vec3;
  readonly target: Vec3;
}

/** What the picture can hold. */
export interface Lens {
  /** Vertical opening angle. */
  readonly fovDeg: number;
  /** Width over height. */
  readonly aspect: number;
}

/** The share of the picture that the terrain may fill. */
const kFill = 0.94;

/**
 * The nearest camera, looking north and pitchDeg below the horizon, that has the whole box in view.
 */
export function firstCamera(box: Box, lens: Lens, pitchDeg = 32): Camera {
  const pitch = (pitchDeg * Math.PI) / 180;
  const forward: Vec3 = [0, Math.cos(pitch), -Math.sin(pitch)];
  const up: Vec3 = [0, Math.sin(pitch), Math.cos(pitch)];
  const tangent = kFill * Math.tan((lens.fovDeg * Math.PI) / 360);
  const vertical = fit(box, up, forward, tangent);
  const horizontal = fit(box, [1, 0, 0], forward, tangent * lens.aspect);
  const back = Math.max(vertical.back, horizontal.back);
  const aside: Vec3 = add(scale(up, vertical.offset), [horizontal.offset, 0, 0]);
  const eye = add(box.center, add(aside, scale(forward, -back)));
  // what the eye looks at lies as high as the box's centre: orbits then turn about the terrain
  const far = (eye[2] - box.center[2]) / Math.sin(pitch);
  return {eye, target: add(eye, scale(forward, far))};
}

/**
 * How far to step aside and back from the box's centre so that two sides of the picture touch it.
 * A corner (a along the side, f forward) is seen if |a - offset| <= tangent (f + back).
 */
function fit(box: Box, side: Vec3, forward: Vec3, tangent: number) {
  const reach = (sign: number) =>
    Math.max(
      ...corners(box).map((corner) => {
        const offset = subtract(corner, box.center);
        return sign * dot(offset, side) - tangent * dot(offset, forward);
      }),
    );
  const [upper, lower] = [reach(1), reach(-1)];
  return {offset: (upper - lower) / 2, back: (upper + lower) / (2 * tangent)};
}
