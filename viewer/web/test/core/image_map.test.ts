import {describe, expect, it} from 'vitest';
import {imageMap, mapOfParent, type ImageMap} from '../../src/core/image_map';
import {randomSource} from './random';

/** Where an image, turned by 20 degrees, shows a world place: metres east and north. */
function placeOf(east: number, north: number, widthM: number): [number, number] {
  const [cos, sin] = [Math.cos(0.35), Math.sin(0.35)];
  return [
    0.4 + (cos * east + sin * north) / widthM,
    0.6 + (1.3 * (sin * east - cos * north)) / widthM,
  ];
}

/** A tile with 50 vertices, and the map that fits an image on it. */
function mapOf(lattice: {origin: number[]; stepM: number[]}, widthM: number): ImageMap {
  const random = randomSource(1);
  const positions: number[] = [];
  const places: number[] = [];
  for (let i = 0; i < 50; ++i) {
    const [east, north] = [16000 * random(), 16000 * random()];
    positions.push(east, 5000 * random(), -north);
    const world = [east, north].map((step, k) => (lattice.origin[k]! + step) * lattice.stepM[k]!);
    places.push(...placeOf(world[0]!, world[1]!, widthM));
  }
  return imageMap(positions, places);
}

const at = ({start, slope}: ImageMap, east: number, north: number) => [
  start[0] + slope[0] * east + slope[1] * north,
  start[1] + slope[2] * east + slope[3] * north,
];

const kChild = {origin: [4000, -9000, 7], stepM: [0.5, 0.25, 1]} as const;
const kParent = {origin: [1500, 300, 11], stepM: [1, 1, 2]} as const;

describe('imageMap', () => {
  it('leads to the place in the image where a vertex ends its morph', () => {
    const map = mapOf({origin: [...kChild.origin], stepM: [...kChild.stepM]}, 9000);
    const [u, v] = placeOf((4000 - 3000) * 0.5, (-9000 + 1700) * 0.25, 9000);
    expect(at(map, -3000, 1700)[0]).toBeCloseTo(u, 9);
    expect(at(map, -3000, 1700)[1]).toBeCloseTo(v, 9);
  });

  it('is one place where all vertices are on one line', () => {
    const map = imageMap([0, 0, 0, 1, 0, 1, 2, 0, 2], [0, 0, 1, 1, 2, 2]);
    expect(map).toEqual({start: [1, 1], slope: [0, 0, 0, 0]});
  });
});

describe('mapOfParent', () => {
  it("leads from a child's steps to the place in the parent's image", () => {
    const parent = mapOf({origin: [...kParent.origin], stepM: [...kParent.stepM]}, 18000);
    const map = mapOfParent(parent, kParent, kChild);
    const [u, v] = placeOf((4000 + 600) * 0.5, (-9000 + 80) * 0.25, 18000);
    expect(at(map, 600, 80)[0]).toBeCloseTo(u, 9);
    expect(at(map, 600, 80)[1]).toBeCloseTo(v, 9);
  });
});
