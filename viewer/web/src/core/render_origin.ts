// Floats are fine near 0 only: everything is drawn from an origin near the eye. It lies on the
// coarsest level's lattice, hence on every level's, so a tile's offset from it is a whole number of
// the tile's steps and exact in float32.
import type {Holdback} from './holdback';
import type {HoldbackUniform, MorphUniforms} from './morph';
import {morphInterval, type Ranges} from './ranges';
import {add, scale, subtract, type Vec3} from './vec3';

/** The lattice point next to the eye. */
export function renderOrigin(eye: Vec3, coarsestStepM: Vec3): Vec3 {
  const snap = (axis: 0 | 1 | 2) => {
    const stepM = coarsestStepM[axis];
    return Math.round(eye[axis] / stepM) * stepM;
  };
  return [snap(0), snap(1), snap(2)];
}

/** A tile's place on the lattice. */
export interface LatticePlace {
  readonly level: number;
  /** Lattice point of the tile's origin, in steps. */
  readonly origin: Vec3;
  readonly stepM: Vec3;
  /** That of the tile's level. */
  readonly morphShare: number;
}

/**
 * What the shader needs for a tile.
 *
 * @param ranges without an entry for the root's level: the root never morphs
 * @param eyeM the eye less the render origin
 */
export function morphUniforms(
  tile: LatticePlace,
  ranges: Ranges,
  eyeM: Vec3,
  originM: Vec3,
  holdbacks: readonly HoldbackUniform[] = [],
): MorphUniforms {
  const offset = (axis: 0 | 1 | 2) => tile.origin[axis] * tile.stepM[axis] - originM[axis];
  const rangeM = ranges[tile.level];
  const interval = rangeM ? morphInterval(rangeM, tile.morphShare) : undefined;
  return {
    stepM: tile.stepM,
    offsetM: [offset(0), offset(1), offset(2)],
    eyeM,
    beginM: interval?.beginM ?? 0,
    perM: interval ? 1 / (interval.endM - interval.beginM) : 0,
    holdbacks,
  };
}

/** What the shader needs of a holdback. */
export function holdbackUniform({bounds, heightM}: Holdback, originM: Vec3): HoldbackUniform {
  const middle = scale(add(bounds.low, bounds.high), 0.5);
  const halfM = scale(subtract(bounds.high, bounds.low), 0.5);
  return {centerM: subtract(middle, originM), halfM, heightM};
}
