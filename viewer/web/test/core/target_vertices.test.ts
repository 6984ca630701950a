import {describe, expect, it} from 'vitest';
import {
  targetColors,
  targetNormals,
  targetVertices,
  type TileVertices,
} from '../../src/core/target_vertices';

/** Vertices 0 and 1 go to the parent's vertex at (4, 2, 8) steps, vertex 2 to none. */
const child: TileVertices = {
  origin: [100, 200, 300],
  stepM: [1, 1, 1],
  positions: [3, 7, -2, 4, 8, -2, 9, 9, 9],
  toTargets: [1, 1, 0, 0, 0, 0, 0, 0, 0],
  normals: [0, 127, 0, 127, 0, 0, 0, 0, 127],
};

const parent: TileVertices = {
  origin: [50, 100, 150],
  stepM: [2, 2, 2],
  positions: [0, 0, 0, 2, 4, -1],
  toTargets: [0, 0, 0, 0, 0, 0],
  normals: [0, 127, 0, 76, 102, 0],
};

describe('targetColors', () => {
  it('takes the colour of the parent vertex that a vertex ends at', () => {
    const colors = Uint8Array.from([1, 1, 1, 2, 2, 2, 3, 3, 3]);
    const parentColors = Uint8Array.from([7, 7, 7, 8, 9, 10]);
    const targets = targetVertices(child, parent);
    expect([...targetColors(colors, parentColors, targets)]).toEqual([8, 9, 10, 8, 9, 10, 3, 3, 3]);
  });
});

describe('targetNormals', () => {
  it('takes the normal of the parent vertex that a vertex ends at', () => {
    expect([...targetNormals(child, parent)]).toEqual([76, 102, 0, 76, 102, 0, 0, 0, 127]);
  });

  it('restates it for the steps of the child', () => {
    // the parent's step up is four times the child's: stored normals are multiplied by the step
    const flat = {...parent, stepM: [2, 2, 4] as const, origin: [50, 100, 75] as const};
    const positions = [0, 0, 0, 2, 2, -1];
    const normals = targetNormals(child, {...flat, positions});
    const size = Math.hypot(76 / 2, 102 / 4);
    const expected = [38, 25.5, 0].map((value) => Math.round((127 * value) / size));
    expect([...normals].slice(0, 3)).toEqual(expected);
  });
});
