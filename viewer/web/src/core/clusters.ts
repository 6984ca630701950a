// Which triangles of a tile a ray may meet, without a look at each of them.
import type {Vec3} from './vec3';

/** Triangles that follow one another, and the box that holds them at every moment of their morph. */
export interface Cluster {
  /** Numbers of triangles; end is not one of them. */
  readonly begin: number;
  readonly end: number;
  /** Lattice steps from the tile's origin, glTF triples; with room for the rounding of drawn places. */
  readonly low: Vec3;
  readonly high: Vec3;
}

/** A tile's triangles: lattice steps from its origin, and on to the next coarser level; glTF triples. */
export interface Morphing {
  readonly indices: ArrayLike<number>;
  readonly positions: ArrayLike<number>;
  readonly toTargets: ArrayLike<number>;
}

/**
 * Tiles come in an order that graphics cards like, neighbours after one another: boxes of so many triangles cover a
 * tile of St. Helens 3.1 to 4.0 times. Along a curve over the plan they would do so 3.6 to 3.9 times.
 */
const kTriangles = 16;

/** Drawn places are float32: off by less than this many lattice steps. */
const kRoundingSteps = 0.5;

const known = new WeakMap<object, readonly Cluster[]>();

/** The clusters of a mesh; made when it is first asked for. */
export function clustersOf(mesh: Morphing): readonly Cluster[] {
  let clusters = known.get(mesh.positions);
  if (!clusters) {
    const triangles = mesh.indices.length / 3;
    clusters = Array.from({length: Math.ceil(triangles / kTriangles)}, (_, i) => {
      const begin = i * kTriangles;
      const end = Math.min(triangles, begin + kTriangles);
      return {begin, end, ...boxOf(begin, end, mesh)};
    });
    known.set(mesh.positions, clusters);
  }
  return clusters;
}

/** Vertices move along straight lines, so what holds their ends holds them on the way. */
function boxOf(begin: number, end: number, {indices, positions, toTargets}: Morphing) {
  const low = [Infinity, Infinity, Infinity];
  const high = [-Infinity, -Infinity, -Infinity];
  for (let i = 3 * begin; i < 3 * end; ++i) {
    for (let k = 0; k < 3; ++k) {
      const from = positions[3 * indices[i]! + k]!;
      const to = from + toTargets[3 * indices[i]! + k]!;
      low[k] = Math.min(low[k]!, from - kRoundingSteps, to - kRoundingSteps);
      high[k] = Math.max(high[k]!, from + kRoundingSteps, to + kRoundingSteps);
    }
  }
  return {low, high} as unknown as {low: Vec3; high: Vec3};
}
