// How images lie on tiles, so that they stay where they are while vertices move over them in a morph.
//
// A vertex moves anywhere within the parent tile, also beyond its own tile and thus beyond the image of
// that. What is drawn there is the parent's image; elsewhere the tile's own, blended into the parent's.
import type {Vec3} from './vec3';

/** The affine map from lattice steps of a tile (east, north) to u, v of an image. */
export interface ImageMap {
  /** u, v at the tile's origin. */
  readonly start: readonly [number, number];
  /** Image widths a step: u to the east, u to the north, v to the east, v to the north. */
  readonly slope: readonly [number, number, number, number];
}

export const kNoImage: ImageMap = {start: [0, 0], slope: [0, 0, 0, 0]};

/** A tile's lattice. */
interface Lattice {
  /** Lattice point (east, north, up) of the tile's origin, in steps. */
  readonly origin: Vec3;
  readonly stepM: Vec3;
}

/**
 * The map that fits all vertices best. It is exact to the bend of the DEM's grid in the tile: far less than
 * a pixel of the image.
 *
 * @param positions lattice steps, glTF triples (east, up, south)
 * @param places of the vertices in the image, pairs
 */
export function imageMap(positions: ArrayLike<number>, places: ArrayLike<number>): ImageMap {
  const count = places.length / 2;
  const values = (i: number) =>
    [positions[3 * i]!, -positions[3 * i + 2]!, places[2 * i]!, places[2 * i + 1]!] as const;
  const mean = [0, 0, 0, 0] as [number, number, number, number];
  for (let i = 0; i < count; ++i) values(i).forEach((value, k) => (mean[k]! += value / count));
  const sums = momentsOf(count, values, mean);
  const [ee, en, nn, ue, un, ve, vn] = sums;
  // normal equations of two unknowns
  const determinant = ee * nn - en * en;
  if (determinant === 0) return {...kNoImage, start: [mean[2], mean[3]]};
  const solve = (toEast: number, toNorth: number) =>
    [(toEast * nn - toNorth * en) / determinant, (toNorth * ee - toEast * en) / determinant] as const;
  const slope = [...solve(ue, un), ...solve(ve, vn)] as const;
  const [u, v] = along(slope, mean[0], mean[1]);
  return {start: [mean[2] - u, mean[3] - v], slope};
}

/** The parent's map for steps of one of its children. */
export function mapOfParent(parent: ImageMap, parentLattice: Lattice, child: Lattice): ImageMap {
  const ratio = [0, 1].map((k) => child.stepM[k]! / parentLattice.stepM[k]!);
  const shift = [0, 1].map((k) => child.origin[k]! * ratio[k]! - parentLattice.origin[k]!);
  const [u, v] = along(parent.slope, shift[0]!, shift[1]!);
  const {start, slope} = parent;
  return {
    start: [start[0] + u, start[1] + v],
    slope: [slope[0] * ratio[0]!, slope[1] * ratio[1]!, slope[2] * ratio[0]!, slope[3] * ratio[1]!],
  };
}

function along(slope: ImageMap['slope'], east: number, north: number): [number, number] {
  return [slope[0] * east + slope[1] * north, slope[2] * east + slope[3] * north];
}

type Values = readonly [number, number, number, number];

/** Sums of products of east, north, u and v about their means. */
function momentsOf(count: number, values: (i: number) => Values, mean: Values) {
  const sums: [number, number, number, number, number, number, number] = [0, 0, 0, 0, 0, 0, 0];
  for (let i = 0; i < count; ++i) {
    const [e, n, u, v] = values(i).map((value, k) => value - mean[k]!) as unknown as Values;
    [e * e, e * n, n * n, u * e, u * n, v * e, v * n].forEach((term, k) => (sums[k]! += term));
  }
  return sums;
}
