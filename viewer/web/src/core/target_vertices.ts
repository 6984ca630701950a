// Light and colour must not jump where levels change. A vertex at t = 1 stands on a vertex of the next
// coarser level, so it takes that vertex's normal and colour there. The parent tile holds them.
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

/** The parent's vertex at the place of each vertex at t = 1; -1 where the parent has none. */
export function targetVertices(child: TileVertices, parent: TileVertices): Int32Array {
  const find = finder(parent);
  const place = new Float64Array(3);
  const toParent = changeOfLattice(child, parent);
  const targets = new Int32Array(child.positions.length / 3);
  for (let i = 0; i < child.positions.length; i += 3) {
    for (let k = 0; k < 3; ++k) {
      const steps = child.positions[i + k]! + child.toTargets[i + k]!;
      place[k] = (steps + toParent.shift[k]!) * toParent.ratio[k]!;
    }
    targets[i / 3] = find(place[0]!, place[1]!, place[2]!);
  }
  return targets;
}

/**
 * The normal of each vertex's place at t = 1, in signed bytes (glTF triples, the child's steps).
 * A vertex without a target keeps its own.
 */
export function targetNormals(
  child: TileVertices,
  parent: TileVertices,
  targets = targetVertices(child, parent),
): Int8Array {
  const {ratio} = changeOfLattice(child, parent);
  const normals = Int8Array.from(child.normals);
  targets.forEach((target, i) => {
    if (target >= 0) restate(parent.normals, 3 * target, ratio, normals, 3 * i);
  });
  return normals;
}

/** The colour of each vertex's place at t = 1, in triples. A vertex without a target keeps its own. */
export function targetColors(
  colors: Uint8Array,
  parentColors: Uint8Array,
  targets: Int32Array,
): Uint8Array {
  const ends = Uint8Array.from(colors);
  targets.forEach((target, i) => {
    if (target >= 0) ends.set(parentColors.subarray(3 * target, 3 * target + 3), 3 * i);
  });
  return ends;
}

/** (steps of the child + shift) * ratio = steps of the parent; exact: steps are powers of two. */
function changeOfLattice(child: TileVertices, parent: TileVertices) {
  const ratio = [0, 2, 1].map((axis) => child.stepM[axis]! / parent.stepM[axis]!);
  const shift = [0, 2, 1].map((axis, k) => {
    const sign = k === 2 ? -1 : 1;
    return sign * (child.origin[axis]! - parent.origin[axis]! / ratio[k]!);
  });
  return {ratio, shift};
}

/** Finds the vertex at a place, by open addressing; -1: none is there. */
function finder({positions}: TileVertices): (x: number, y: number, z: number) => number {
  const count = positions.length / 3;
  const size = 2 ** Math.ceil(Math.log2(2 * count + 1));
  const slots = new Int32Array(size).fill(-1);
  const slotOf = (x: number, y: number, z: number) =>
    (Math.imul(x, 73856093) ^ Math.imul(y, 19349663) ^ Math.imul(z, 83492791)) & (size - 1);
  const search = (x: number, y: number, z: number) => {
    let slot = slotOf(x, y, z);
    for (let v = slots[slot]!; v >= 0; v = slots[slot]!) {
      if (positions[3 * v] === x && positions[3 * v + 1] === y && positions[3 * v + 2] === z) break;
      slot = (slot + 1) & (size - 1);
    }
    return slot;
  };
  for (let v = 0; v < count; ++v) {
    slots[search(positions[3 * v]!, positions[3 * v + 1]!, positions[3 * v + 2]!)] = v;
  }
  return (x, y, z) => slots[search(x, y, z)]!;
}

/** A normal for the steps of another lattice: stored normals are multiplied by the steps. */
function restate(
  from: ArrayLike<number>,
  at: number,
  ratio: readonly number[],
  to: Int8Array,
  i: number,
): void {
  const x = from[at]! * ratio[0]!;
  const y = from[at + 1]! * ratio[1]!;
  const z = from[at + 2]! * ratio[2]!;
  const scale = 127 / (Math.sqrt(x * x + y * y + z * z) || 1);
  to[i] = Math.round(scale * x);
  to[i + 1] = Math.round(scale * y);
  to[i + 2] = Math.round(scale * z);
}
