import {describe, expect, it} from 'vitest';
import {basePlace, morphFactor, shownPlace, type MorphUniforms} from '../../src/core/morph';
import {morphUniforms, renderOrigin} from '../../src/core/render_origin';
import type {Vec3} from '../../src/core/vec3';
import {randomSource} from './random';

const kRoot: Vec3 = [16, 16, 8];

/** What the shader gets for a tile of level 0 that morphs from 750 m to 1000 m. */
function uniformsAt(origin: Vec3, eye: Vec3, rangeM = 1000): MorphUniforms {
  const originM = renderOrigin(eye, kRoot);
  const eyeM = eye.map((value, k) => value - originM[k]!) as unknown as Vec3;
  const stepM: Vec3 = [0.0625, 0.0625, 0.03125];
  const place = {level: 0, origin, stepM, morphShare: 0.25};
  return morphUniforms(place, [rangeM], eyeM, originM);
}

describe('shownPlace', () => {
  it('is the coarse lattice point exactly at t = 1', () => {
    const random = randomSource(1);
    const integer = (size: number) => Math.floor(size * (2 * random() - 1));
    for (let i = 0; i < 1000; ++i) {
      const origin: Vec3 = [integer(2e6), integer(2e6), integer(3e4)];
      // level 1 has steps twice as large; its own origin lies elsewhere
      const coarseOrigin: Vec3 = [integer(1e6), integer(1e6), integer(1e4)];
      const local: Vec3 = [integer(16000), integer(16000), integer(16000)];
      const coarse = local.map((v, k) => Math.floor((origin[k]! + v) / 2)) as unknown as Vec3;
      const toTarget = coarse.map((v, k) => 2 * v - origin[k]! - local[k]!) as unknown as Vec3;
      const eye: Vec3 = [1e5 * random(), 1e5 * random(), 1e4 + 1e4 * random()];
      const fine = uniformsAt(origin, eye, 10);
      const originM = renderOrigin(eye, kRoot);
      const stepM: Vec3 = [0.125, 0.125, 0.0625];
      const coarseTile = {level: 1, origin: coarseOrigin, stepM, morphShare: 0.25};
      const coarseLocal = coarse.map((v, k) => v - coarseOrigin[k]!) as unknown as Vec3;
      const still = morphUniforms(coarseTile, [10], fine.eyeM, originM);
      expect(shownPlace(local, toTarget, fine)).toEqual(shownPlace(coarseLocal, [3, 1, 2], still));
    }
  });

  it('does not depend on the tile that holds the vertex', () => {
    const random = randomSource(2);
    const integer = (size: number) => Math.floor(size * (2 * random() - 1));
    let between = 0;
    for (let i = 0; i < 1000; ++i) {
      const place: Vec3 = [integer(1e4), integer(1e4), integer(1e4)];
      const toTarget: Vec3 = [integer(3000), integer(3000), integer(3000)];
      const eye: Vec3 = [place[0] / 16 + 500 + 123.4 * random(), place[1] / 16, 700 * random()];
      const shown = [integer(2e4), integer(2e4)].map((shift) => {
        const uniforms = uniformsAt([shift, -shift, 7], eye);
        const local: Vec3 = [place[0] - shift, place[1] + shift, place[2] - 7];
        const t = morphFactor(basePlace(local, uniforms), uniforms);
        if (t > 0 && t < 1) ++between;
        return shownPlace(local, toTarget, uniforms);
      });
      expect(shown[0]).toEqual(shown[1]);
    }
    expect(between).toBeGreaterThan(100);
  });
});

describe('morphFactor', () => {
  it('is 0 up to three quarters of the range and 1 from the range on', () => {
    const uniforms = uniformsAt([0, 0, 0], [0, 0, 0]);
    const at = (x: number) => morphFactor([x, 0, 0], uniforms);
    expect([at(0), at(749.9), at(1000), at(1e6)]).toEqual([0, 0, 1, 1]);
    expect(at(875)).toBeCloseTo(0.5, 2);
  });

  it('is 0 everywhere for a level without a range', () => {
    const uniforms = morphUniforms(
      {level: 3, origin: [0, 0, 0], stepM: [1, 1, 1], morphShare: 0.25},
      [1, 2, 3],
      [0, 0, 0],
      [0, 0, 0],
    );
    expect(morphFactor([1e7, 0, 0], uniforms)).toBe(0);
  });
});
