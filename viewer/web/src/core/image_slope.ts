// How an image lies on a tile, so that it stays where it is while vertices move over it in a morph.

/** Image widths a lattice step: u to the east, u to the north, v to the east, v to the north. */
export type ImageSlope = readonly [number, number, number, number];

/**
 * The affine map from plan to image, without its constant, that fits all vertices best. It is exact to the
 * bend of the DEM's grid in the tile: far less than a pixel of the image.
 *
 * @param positions lattice steps, glTF triples (east, up, south)
 * @param places of the vertices in the image, pairs
 */
export function imageSlope(positions: ArrayLike<number>, places: ArrayLike<number>): ImageSlope {
  const count = places.length / 2;
  const mean = [0, 0, 0, 0];
  const values = (i: number) =>
    [positions[3 * i]!, -positions[3 * i + 2]!, places[2 * i]!, places[2 * i + 1]!] as const;
  for (let i = 0; i < count; ++i) values(i).forEach((value, k) => (mean[k]! += value / count));
  let [ee, en, nn, ue, un, ve, vn] = [0, 0, 0, 0, 0, 0, 0];
  for (let i = 0; i < count; ++i) {
    const [e, n, u, v] = values(i).map((value, k) => value - mean[k]!) as [
      number,
      number,
      number,
      number,
    ];
    ee += e * e;
    en += e * n;
    nn += n * n;
    ue += u * e;
    un += u * n;
    ve += v * e;
    vn += v * n;
  }
  // normal equations of two unknowns
  const determinant = ee * nn - en * en;
  if (determinant === 0) return [0, 0, 0, 0];
  const solve = (toEast: number, toNorth: number) =>
    [(toEast * nn - toNorth * en) / determinant, (toNorth * ee - toEast * en) / determinant] as const;
  return [...solve(ue, un), ...solve(ve, vn)];
}
