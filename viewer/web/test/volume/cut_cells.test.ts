import {describe, expect, it} from 'vitest';
import {cutCells, valuesAt, zeroSet, type Cut} from '../../src/volume/cut_cells';
import {materialAt, parseVolume, type Material} from '../../src/volume/volume_data';

/** A box from -1 to 1 in n^3 cubes of six tetrahedra around their diagonals. */
function boxOfCells(n: number) {
  const at = (i: number, j: number, k: number) => (k * (n + 1) + j) * (n + 1) + i;
  const positions: number[] = [];
  const corners: number[] = [];
  for (let k = 0; k <= n; ++k)
    for (let j = 0; j <= n; ++j)
      for (let i = 0; i <= n; ++i) positions.push((2 * i) / n - 1, (2 * j) / n - 1, (2 * k) / n - 1);
  const steps = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
  const orders = [[0, 1, 2], [0, 2, 1], [1, 0, 2], [1, 2, 0], [2, 0, 1], [2, 1, 0]];
  for (let k = 0; k < n; ++k)
    for (let j = 0; j < n; ++j)
      for (let i = 0; i < n; ++i)
        for (const order of orders) {
          let place = [i, j, k];
          corners.push(at(i, j, k));
          for (const axis of order) {
            place = place.map((x, a) => x + steps[axis][a]);
            corners.push(at(place[0], place[1], place[2]));
          }
        }
  return {positions: Float32Array.from(positions), corners: Uint32Array.from(corners)};
}

const kPlaces = {stride: 3, first: 0, count: 3, width: 3};

function areaOf(cut: Cut, places: Float32Array): number {
  let area = 0;
  for (let t = 0; t < cut.triangles.length; t += 3) {
    const [a, b, c] = [0, 1, 2].map((k) => [...places.slice(3 * cut.triangles[t + k], 3 * cut.triangles[t + k] + 3)]);
    const [u, v] = [b, c].map((p) => p.map((x, k) => x - a[k]));
    area +=
      Math.hypot(u[1] * v[2] - u[2] * v[1], u[2] * v[0] - u[0] * v[2], u[0] * v[1] - u[1] * v[0]) / 2;
  }
  return area;
}

describe('cutCells', () => {
  const {positions, corners} = boxOfCells(5);

  it.each([
    // a square, a square turned by 45 degrees through the middle, a hexagon with sides of root 2
    {normal: [0, 0, 1], offset: 0.13, area: 4},
    {normal: [Math.SQRT1_2, Math.SQRT1_2, 0], offset: 0, area: 2 * Math.SQRT2 * 2},
    {normal: [1, 1, 1].map((x) => x / Math.sqrt(3)), offset: 0, area: 3 * Math.sqrt(3)},
    // through vertices and along faces: once, not twice
    {normal: [0, 0, 1], offset: 0.2, area: 4},
  ])('covers the section of the box with $normal at $offset', ({normal, offset, area}) => {
    const plane = {normal: normal as [number, number, number], offset};
    const cut = cutCells(positions, corners, plane);
    const places = valuesAt(cut, positions, kPlaces);
    expect(areaOf(cut, places)).toBeCloseTo(area, 4);
    for (let i = 0; i < places.length; i += 3) {
      const height = normal[0] * places[i] + normal[1] * places[i + 1] + normal[2] * places[i + 2];
      expect(height).toBeCloseTo(offset, 5);
    }
  });

  it('has nothing outside the box', () => {
    expect(cutCells(positions, corners, {normal: [1, 0, 0], offset: 1.5}).cells).toBe(0);
  });

  it('keeps what is linear over the cells linear in the plane', () => {
    const linear = Float32Array.from({length: positions.length / 3}, (_, v) => 2 * positions[3 * v] - positions[3 * v + 2]);
    const cut = cutCells(positions, corners, {normal: [0.6, 0.8, 0], offset: 0.21});
    const places = valuesAt(cut, positions, kPlaces);
    const values = valuesAt(cut, linear, {stride: 1, first: 0, count: 1, width: 4});
    for (let i = 0; i < cut.from.length; ++i) {
      expect(values[4 * i]).toBeCloseTo(2 * places[3 * i] - places[3 * i + 2], 5);
    }
  });
});

describe('zeroSet', () => {
  it('is the surface, in the cells where it parts materials', () => {
    const {positions, corners} = boxOfCells(4);
    // two surfaces side by side: z = 0.1 is the second
    const distances = Float32Array.from({length: (2 * positions.length) / 3}, (_, i) =>
      i % 2 === 0 ? 5 : positions[3 * ((i - 1) / 2) + 2] - 0.1,
    );
    const parting = new Uint8Array(corners.length / 4).fill(2);
    const cut = zeroSet(distances, 1, 2, corners, parting);
    expect(areaOf(cut, valuesAt(cut, positions, kPlaces))).toBeCloseTo(4, 4);
    expect(zeroSet(distances, 1, 2, corners, parting.fill(1)).cells).toBe(0);
  });
});

describe('materialAt', () => {
  it('is the first whose sides all hold', () => {
    const material = (below: number, above: number): Material => ({name: '', isEmpty: false, below, above});
    const materials = [material(1, 0), material(2, 1), material(0, 0)];
    expect([0b11, 0b01, 0b10, 0b00].map((below) => materialAt(materials, below))).toEqual([0, 0, 1, 2]);
  });
});

describe('parseVolume', () => {
  it('refuses arrays that the file is too short for', () => {
    const json = {
      format: 'terrane-volume/1',
      box_m: {low: [0, 0, 0], high: [1, 1, 1]},
      surfaces: [],
      fields: [],
      materials: [],
      cells_bin: {positions: {type: 'float32', components: 3, count: 8, offset: 0}},
    };
    expect(() => parseVolume(json, new ArrayBuffer(95))).toThrow('positions');
    expect(parseVolume(json, new ArrayBuffer(96)).positions.length).toBe(24);
  });
});
