// Exact questions to the terrain as it is shown: morphed vertices, flat triangles.
import {boundsOf, type Bounds} from './box';
import {clustersOf} from './clusters';
import {shownPlace, morphFactor, basePlace, zUp, type MorphUniforms} from './morph';
import type {Tile} from './tileset';
import {add, scale, type Vec3} from './vec3';

/** A tile as one frame shows it. */
export interface ShownTile {
  readonly tile: Tile;
  readonly positions: ArrayLike<number>;
  readonly toTargets: ArrayLike<number>;
  readonly indices: ArrayLike<number>;
  readonly uniforms: MorphUniforms;
}

/** A point of the shown terrain. */
export interface SurfacePoint {
  /** World metres. */
  readonly place: Vec3;
  /** Largest vertical distance of the shown terrain to a sample here. */
  readonly errorM: number;
  readonly tile: Tile;
}

interface Mesh {
  readonly shown: ShownTile;
  /** From the render origin, three per vertex; NaN until a question meets them. */
  readonly places: Float64Array;
}

/** One frame's surface; vertices are morphed when a question first comes near them. */
export class Surface {
  private readonly meshes = new Map<Tile, Mesh>();

  /**
   * @param cut what is shown
   * @param originM the render origin, in the world
   */
  constructor(
    private readonly cut: readonly Tile[],
    private readonly originM: Vec3,
    private readonly shownTile: (tile: Tile) => ShownTile,
  ) {}

  /** World z of the terrain at a place; undefined beside it. */
  heightAt(x: number, y: number): number | undefined {
    return this.pointAt(x, y)?.place[2];
  }

  pointAt(x: number, y: number): SurfacePoint | undefined {
    return this.hit([x, y, 1e7], [0, 0, -1]);
  }

  /** The first point of the terrain along a ray, seen from either side; undefined: there is none. */
  hit(eye: Vec3, direction: Vec3): SurfacePoint | undefined {
    const near = this.cut
      .map((tile) => ({tile, enterM: entry(boundsOf(tile.box), eye, direction)}))
      .filter(({enterM}) => enterM < Infinity)
      .sort((a, b) => a.enterM - b.enterM);
    let best: {at: number; mesh: Mesh; triangle: number} | undefined;
    for (const {tile, enterM} of near) {
      if (best && enterM > best.at) break;
      const mesh = this.meshOf(tile);
      const from: Vec3 = [0, 1, 2].map((k) => eye[k]! - this.originM[k]!) as unknown as Vec3;
      const found = nearestTriangle(mesh, from, direction, best?.at);
      if (found && (!best || found.at < best.at)) best = {...found, mesh};
    }
    if (!best) return undefined;
    const place = add(eye, scale(direction, best.at));
    const {tile} = best.mesh.shown;
    return {place, errorM: errorOf(best.mesh.shown, best.triangle), tile};
  }

  private meshOf(tile: Tile): Mesh {
    let mesh = this.meshes.get(tile);
    if (!mesh) {
      const shown = this.shownTile(tile);
      mesh = {shown, places: new Float64Array(shown.positions.length).fill(NaN)};
      this.meshes.set(tile, mesh);
    }
    return mesh;
  }
}

/** Morphs the corners of a run of triangles. */
function completePlaces({shown, places}: Mesh, begin: number, end: number): void {
  const {indices, positions, toTargets, uniforms} = shown;
  for (let i = 3 * begin; i < 3 * end; ++i) {
    const vertex = indices[i]!;
    if (!Number.isNaN(places[3 * vertex])) continue;
    places.set(shownPlace(zUp(positions, vertex), zUp(toTargets, vertex), uniforms), 3 * vertex);
  }
}

/** A vertex on its way to the next level may be as far off as that level. */
function errorOf({tile, positions, indices, uniforms}: ShownTile, triangle: number): number {
  const isAtHome = [0, 1, 2].every((k) => {
    const base = basePlace(zUp(positions, indices[3 * triangle + k]!), uniforms);
    return morphFactor(base, uniforms) === 0;
  });
  return isAtHome || !tile.parent ? tile.errorM : tile.parent.errorM;
}

/** Metres along a ray to a box; 0 inside, Infinity: it passes by. */
function entry({low, high}: Bounds, eye: Vec3, direction: Vec3): number {
  let [near, far] = [0, Infinity];
  for (let k = 0; k < 3; ++k) {
    const [a, b] = [(low[k]! - eye[k]!) / direction[k]!, (high[k]! - eye[k]!) / direction[k]!];
    if (direction[k] === 0) {
      if (eye[k]! < low[k]! || eye[k]! > high[k]!) return Infinity;
      continue;
    }
    near = Math.max(near, Math.min(a, b));
    far = Math.min(far, Math.max(a, b));
  }
  return near <= far ? near : Infinity;
}

/** The first triangle of a tile that a ray meets nearer than nearestM. */
function nearestTriangle(mesh: Mesh, eye: Vec3, direction: Vec3, nearestM = Infinity) {
  const {stepM, offsetM} = mesh.shown.uniforms;
  // a ray keeps its distances in lattice steps along glTF's axes
  const from: Vec3 = [
    (eye[0] - offsetM[0]) / stepM[0],
    (eye[2] - offsetM[2]) / stepM[2],
    (offsetM[1] - eye[1]) / stepM[1],
  ];
  const along: Vec3 = [direction[0] / stepM[0], direction[2] / stepM[2], -direction[1] / stepM[1]];
  let found: {at: number; triangle: number} | undefined;
  for (const cluster of clustersOf(mesh.shown)) {
    if (entry(cluster, from, along) > (found?.at ?? nearestM)) continue;
    completePlaces(mesh, cluster.begin, cluster.end);
    for (let triangle = cluster.begin; triangle < cluster.end; ++triangle) {
      const at = distanceAlong(mesh, triangle, eye, direction);
      if (at < (found?.at ?? nearestM)) found = {at, triangle};
    }
  }
  return found;
}

/**
 * Where a ray meets a triangle; Infinity: it passes by. Borders belong to both sides, with some room for rounding:
 * no ray slips through between two triangles.
 *
 * \par Source
 * Moeller, Trumbore, "Fast, Minimum Storage Ray/Triangle Intersection" (1997).
 */
function distanceAlong(
  {shown: {indices}, places}: Mesh,
  triangle: number,
  eye: Vec3,
  [dx, dy, dz]: Vec3,
): number {
  const kRoom = 1e-9;
  const i = 3 * triangle;
  const [a, b, c] = [3 * indices[i]!, 3 * indices[i + 1]!, 3 * indices[i + 2]!];
  const [ax, ay, az] = [places[a]!, places[a + 1]!, places[a + 2]!];
  const [ux, uy, uz] = [places[b]! - ax, places[b + 1]! - ay, places[b + 2]! - az];
  const [vx, vy, vz] = [places[c]! - ax, places[c + 1]! - ay, places[c + 2]! - az];
  const [px, py, pz] = [dy * vz - dz * vy, dz * vx - dx * vz, dx * vy - dy * vx];
  const determinant = ux * px + uy * py + uz * pz;
  if (determinant === 0) return Infinity;
  const [tx, ty, tz] = [eye[0] - ax, eye[1] - ay, eye[2] - az];
  const u = (tx * px + ty * py + tz * pz) / determinant;
  if (u < -kRoom || u > 1 + kRoom) return Infinity;
  const [qx, qy, qz] = [ty * uz - tz * uy, tz * ux - tx * uz, tx * uy - ty * ux];
  const v = (dx * qx + dy * qy + dz * qz) / determinant;
  if (v < -kRoom || u + v > 1 + kRoom) return Infinity;
  const at = (vx * qx + vy * qy + vz * qz) / determinant;
  return at >= 0 ? at : Infinity;
}
