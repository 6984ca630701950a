// Light must not jump where levels change. A vertex at t = 1 stands on a vertex of the next coarser
// level, so it takes that vertex's normal there. The parent tile holds it.
import type {Vec3} from './vec3';

/** A tile as its glb holds it; glTF triples. */
export interface TileVertices {
  /** Lattice point (east, north, up) of the glb's origin, in steps. */
  readonly origin: Vec3;
  /** Metres of a step along east, north, up. */
  readonly stepM: Vec3;
  readonly positions: ArrayLike<number>;
  readonly toTargets: ArrayLike<number>;
  /** Signed bytes, of length 127. */
  readonly normals: ArrayLike<number>;
}

/**
 * The normal of each vertex's place at t = 1, in signed bytes (glTF triples, the child's steps).
 * A vertex whose place the parent does not hold keeps its own.
 */
export function targetNormals(child: TileVertices, parent: TileVertices): Int8Array {
  const byPlace = new Map<string, number>();
  const count = parent.positions.length / 3;
  for (let i = 0; i < count; ++i) byPlace.set(String(place(parent, i, 0)), i);

  const normals = Int8Array.from(child.normals);
  for (let i = 0; 3 * i < normals.length; ++i) {
    const match = byPlace.get(String(place(child, i, 1)));
    if (match !== undefined) normals.set(restate(parent, match, child), 3 * i);
  }
  return normals;
}

/** World metres of vertex i at morph t, in glTF axes; exact because steps are powers of two. */
function place(tile: TileVertices, i: number, t: number): Vec3 {
  const at = (k: number) => tile.positions[3 * i + k]! + t * tile.toTargets[3 * i + k]!;
  const [sx, sy, sz] = tile.stepM;
  const [ox, oy, oz] = tile.origin;
  return [(ox + at(0)) * sx, (oz + at(1)) * sz, (-oy + at(2)) * sy];
}

/** A normal of one tile for the steps of another: stored normals are multiplied by the steps. */
function restate(from: TileVertices, i: number, to: TileVertices): Vec3 {
  const ratios = [0, 2, 1].map((axis) => to.stepM[axis]! / from.stepM[axis]!);
  const scaled = ratios.map((ratio, k) => ratio * from.normals[3 * i + k]!);
  const size = Math.hypot(...scaled) || 1;
  return scaled.map((value) => Math.round((127 * value) / size)) as unknown as Vec3;
}
