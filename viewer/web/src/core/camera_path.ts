// A flight along given poses, for tests and films.
import {between, type Pose} from './pose';

/** A pose to pass, `s` seconds after the start. */
export interface Waypoint {
  readonly s: number;
  readonly pose: Pose;
}

interface PathJson {
  s: number;
  eye: [number, number, number];
  heading_deg: number;
  pitch_deg: number;
}

/**
 * Reads a JSON list of {s, eye, heading_deg, pitch_deg} in order of time.
 *
 * @throws Error that says which entry is wrong
 */
export function parsePath(json: unknown): Waypoint[] {
  if (!Array.isArray(json) || json.length === 0) throw new Error('camera path: no list of poses');
  return (json as PathJson[]).map(({s, eye, heading_deg, pitch_deg}, i) => {
    const numbers = [s, ...(eye ?? []), heading_deg, pitch_deg];
    if (numbers.length !== 6 || !numbers.every(Number.isFinite)) {
      throw new Error(`camera path, entry ${i}: needs s, eye (three), heading_deg and pitch_deg`);
    }
    return {s, pose: {eye, headingDeg: heading_deg, pitchDeg: pitch_deg}};
  });
}

/** The pose at a time; the first one before the start, the last one after the end. */
export function poseAt(path: readonly Waypoint[], s: number): Pose {
  const next = path.findIndex((point) => point.s > s);
  if (next === 0) return path[0]!.pose;
  if (next < 0) return path[path.length - 1]!.pose;
  const [from, to] = [path[next - 1]!, path[next]!];
  return between(from.pose, to.pose, (s - from.s) / (to.s - from.s));
}
