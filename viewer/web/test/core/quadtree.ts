import type {Level, Tile, Tileset} from '../../src/core/tileset';
import type {Vec3} from '../../src/core/vec3';

/** Side of a finest tile. */
export const kLeafM = 1000;

const kHalfHeightM = 150;

/**
 * A regular quadtree of 4^top finest tiles; its lowest corner stands at (0, 0). Tolerances double
 * from 1 m.
 *
 * @param isThere tiles for which this is false are left out, with all below them
 */
export function quadtree(top: number, isThere: (id: Id) => boolean = () => true): Tileset {
  const levels: Level[] = [...Array(top + 1).keys()].map((level) => ({
    level,
    toleranceM: 2 ** level,
    stepM: [0.125, 0.125, 0.125].map((step) => step * 2 ** level) as unknown as Vec3,
    diagonalM: Math.hypot(kLeafM * 2 ** level, kLeafM * 2 ** level, 2 * kHalfHeightM),
    morphShare: 0.25,
  }));
  return {
    root: makeTile(null, {level: top, x: 0, y: 0}, isThere),
    levels,
    tileCells: 64,
    levelsPerOctave: 1,
    minHeightM: -kHalfHeightM,
    maxHeightM: kHalfHeightM,
    cellM: kLeafM / 64,
    curved: false,
    frame: {kind: 'local', x: 0, y: 0},
    attribution: '',
  };
}

interface Id {
  level: number;
  x: number;
  y: number;
}

function makeTile(parent: Tile | null, id: Id, isThere: (id: Id) => boolean): Tile {
  const size = kLeafM * 2 ** id.level;
  const children: Tile[] = [];
  const tile: Tile = {
    ...id,
    key: `${id.level}/${id.x}/${id.y}`,
    box: {
      center: [(id.x + 0.5) * size, (id.y + 0.5) * size, 0],
      halfAxes: [
        [size / 2, 0, 0],
        [0, size / 2, 0],
        [0, 0, kHalfHeightM],
      ],
    },
    url: '',
    triangles: 1,
    errorM: 2 ** id.level,
    parent,
    children,
  };
  for (let k = 0; id.level > 0 && k < 4; ++k) {
    const child = {level: id.level - 1, x: 2 * id.x + (k % 2), y: 2 * id.y + (k >> 1)};
    if (isThere(child)) children.push(makeTile(tile, child, isThere));
  }
  return tile;
}

/** Somewhere over, in or beside the quadtree: heights from 50 m to four times its width. */
export function randomEye(top: number, random: () => number): Vec3 {
  const size = kLeafM * 2 ** top;
  const height = 50 * ((4 * size) / 50) ** random();
  return [size * (1.6 * random() - 0.3), size * (1.6 * random() - 0.3), height];
}
