import {describe, expect, it} from 'vitest';
import {corners, type Box} from '../../src/core/box';
import {firstCamera} from '../../src/core/first_camera';
import {cross, dot, normalize, subtract} from '../../src/core/vec3';

const box = (x: number, y: number, z: number): Box => ({
  center: [100, -200, 1500],
  halfAxes: [
    [x, 0, 0],
    [0, y, 0],
    [0, 0, z],
  ],
});

describe('firstCamera', () => {
  it.each([
    ['wide', box(20000, 5000, 900), 16 / 9],
    ['long', box(3000, 30000, 900), 4 / 3],
    ['high', box(500, 500, 2000), 1],
    ['in a narrow picture', box(7000, 7000, 900), 0.5],
  ])('has all of a box that is %s in view, as large as can be', (_, terrain, aspect) => {
    const fovDeg = 45;
    const {eye, target} = firstCamera(terrain, {fovDeg, aspect});
    const forward = normalize(subtract(target, eye));
    const right = normalize(cross(forward, [0, 0, 1]));
    const up = cross(right, forward);
    const tangent = Math.tan((fovDeg * Math.PI) / 360);
    const reach = corners(terrain).map((corner) => {
      const ray = subtract(corner, eye);
      const depth = dot(ray, forward);
      expect(depth).toBeGreaterThan(0);
      const across = Math.abs(dot(ray, right)) / (depth * tangent * aspect);
      return Math.max(across, Math.abs(dot(ray, up)) / (depth * tangent));
    });
    expect(Math.max(...reach)).toBeCloseTo(0.94, 6);
  });

  it('looks north from the south, 32 degrees down', () => {
    const {eye, target} = firstCamera(box(7000, 7000, 900), {fovDeg: 45, aspect: 1.5});
    const forward = normalize(subtract(target, eye));
    expect(forward[0]).toBeCloseTo(0, 12);
    expect(forward[1]).toBeGreaterThan(0);
    expect((Math.asin(-forward[2]) * 180) / Math.PI).toBeCloseTo(32, 9);
    expect(target[2]).toBeCloseTo(1500, 6);
  });
});
