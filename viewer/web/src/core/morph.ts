// The vertex shader's arithmetic, in float32 as there. src/view/terrain_material.ts holds the same
// expressions in GLSL: change both together.
//
// A vertex stands at `local` steps from its tile's origin. Steps are powers of two and the tile's
// offset from the render origin is a whole number of them, so local * step + offset is exact: two
// tiles that hold the same lattice point compute the same floats, whatever their origins.
import type {Vec3} from './vec3';

const f = Math.fround;

/** What the shader gets for one tile. */
export interface MorphUniforms {
  /** Lattice steps of the tile's level. */
  readonly stepM: Vec3;
  /** Tile origin less the render origin. */
  readonly offsetM: Vec3;
  /** The eye less the render origin. */
  readonly eyeM: Vec3;
  /** Distance at which vertices begin to morph. */
  readonly beginM: number;
  /** 1 / (distance from begin to end); 0 for tiles that never morph. */
  readonly perM: number;
  /** The same for all tiles of a frame. */
  readonly holdbacks: readonly HoldbackUniform[];
}

/** A holdback (holdback.ts) as the shader gets it. */
export interface HoldbackUniform {
  /** Middle of the box, from the render origin. */
  readonly centerM: Vec3;
  readonly halfM: Vec3;
  readonly heightM: number;
}

/** The place of a vertex before its morph, from the render origin. */
export function basePlace(local: Vec3, uniforms: MorphUniforms): Vec3 {
  const {stepM, offsetM} = uniforms;
  return [
    f(f(local[0] * f(stepM[0])) + f(offsetM[0])),
    f(f(local[1] * f(stepM[1])) + f(offsetM[1])),
    f(f(local[2] * f(stepM[2])) + f(offsetM[2])),
  ];
}

/** Distance to the eye, or more where something is held back. */
export function shownDistance(base: Vec3, {eyeM, holdbacks}: MorphUniforms): number {
  let distanceM = size(f(base[0] - f(eyeM[0])), f(base[1] - f(eyeM[1])), f(base[2] - f(eyeM[2])));
  for (const {centerM, halfM, heightM} of holdbacks) {
    const beside = (k: 0 | 1 | 2) =>
      Math.max(0, f(f(Math.abs(f(base[k] - f(centerM[k])))) - f(halfM[k])));
    const held = f(f(heightM) - size(beside(0), beside(1), beside(2)));
    distanceM = Math.max(distanceM, held);
  }
  return distanceM;
}

function size(x: number, y: number, z: number): number {
  return f(Math.sqrt(f(f(f(x * x) + f(y * y)) + f(z * z))));
}

/** t of a vertex: 0 shows its level, 1 the next coarser one. */
export function morphFactor(base: Vec3, uniforms: MorphUniforms): number {
  const {beginM, perM} = uniforms;
  const past = f(shownDistance(base, uniforms) - f(beginM));
  return Math.min(1, Math.max(0, f(past * f(perM))));
}

/**
 * Where a vertex is drawn, from the render origin.
 *
 * @param local lattice steps from the tile's origin
 * @param toTarget lattice steps from the vertex to its place in the next coarser level
 */
export function shownPlace(local: Vec3, toTarget: Vec3, uniforms: MorphUniforms): Vec3 {
  const {stepM} = uniforms;
  const base = basePlace(local, uniforms);
  const t = morphFactor(base, uniforms);
  return [
    f(base[0] + f(t * f(toTarget[0] * f(stepM[0])))),
    f(base[1] + f(t * f(toTarget[1] * f(stepM[1])))),
    f(base[2] + f(t * f(toTarget[2] * f(stepM[2])))),
  ];
}

/** Vertex i of an array of glTF triples (east, up, south) as (east, north, up). */
export function zUp(triples: ArrayLike<number>, i: number): Vec3 {
  return [triples[3 * i]!, -triples[3 * i + 2]!, triples[3 * i + 1]!];
}
