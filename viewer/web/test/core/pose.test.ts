import {describe, expect, it} from 'vitest';
import * as poses from '../../src/core/pose';
import {add, dot, length, normalize, scale, subtract, type Vec3} from '../../src/core/vec3';
import {randomSource} from './random';

const random = randomSource(3);

function randomPose(): poses.Pose {
  const eye = [1000 * random(), 1000 * random(), 500 + 1000 * random()] as const;
  return {eye, headingDeg: 360 * random() - 180, pitchDeg: -80 * random() - 5};
}

/** Where a point is in the picture of a pose: along its axes, per metre of depth. */
function inPicture(pose: poses.Pose, point: Vec3): [number, number] {
  const from = subtract(point, pose.eye);
  const up = poses.forward({...pose, pitchDeg: pose.pitchDeg + 90});
  const depth = dot(from, poses.forward(pose));
  return [dot(from, poses.rightOf(pose)) / depth, dot(from, up) / depth];
}

function expectSamePlace(a: [number, number], b: [number, number]) {
  a.forEach((value, k) => expect(value).toBeCloseTo(b[k]!, 9));
}

describe('orbit', () => {
  it('keeps its pivot where it is in the picture, and as far away', () => {
    for (let i = 0; i < 50; ++i) {
      const pose = randomPose();
      const pivot = add(pose.eye, scale(poses.forward(pose), 300));
      const aside = add(pivot, scale(poses.rightOf(pose), 80));
      const turned = poses.orbit(pose, aside, 40 * random(), 3 * random());
      expectSamePlace(inPicture(turned, aside), inPicture(pose, aside));
      const [before, after] = [pose, turned].map(({eye}) => length(subtract(eye, aside)));
      expect(after).toBeCloseTo(before!, 6);
    }
  });

  it('does not go over the top', () => {
    const pose = poses.orbit(randomPose(), [0, 0, 0], 0, -500);
    expect(pose.pitchDeg).toBe(poses.kSteepestDeg);
  });
});

describe('zoom', () => {
  it('keeps the point under the cursor there', () => {
    for (let i = 0; i < 50; ++i) {
      const pose = randomPose();
      const point: Vec3 = add(pose.eye, scale(poses.forward(pose), 200 + 300 * random()));
      const aside = add(point, scale(poses.rightOf(pose), 50));
      const near = poses.zoom(pose, aside, 0.5);
      expectSamePlace(inPicture(near, aside), inPicture(pose, aside));
      expect(length(subtract(near.eye, aside))).toBeCloseTo(
        length(subtract(pose.eye, aside)) / 2,
        6,
      );
    }
  });
});

describe('drag', () => {
  it('brings the point under the new place of the cursor', () => {
    for (let i = 0; i < 50; ++i) {
      const pose = {...randomPose(), pitchDeg: -60};
      const point = add(pose.eye, scale(poses.forward(pose), 400));
      const direction = normalize(add(poses.forward(pose), [0.1, -0.05, 0]));
      const moved = poses.drag(pose, point, direction);
      expect(moved.eye[2]).toBe(pose.eye[2]);
      const seen = normalize(subtract(point, moved.eye));
      seen.forEach((value, k) => expect(value).toBeCloseTo(direction[k]!, 6));
    }
  });

  it('does not run away at the horizon', () => {
    const pose: poses.Pose = {eye: [0, 0, 100], headingDeg: 0, pitchDeg: -5};
    const point: Vec3 = [0, 1000, 0];
    const moved = poses.drag(pose, point, normalize([0, 1, -1e-4]));
    expect(length(subtract(moved.eye, pose.eye))).toBeLessThan(1100);
  });
});

describe('poseOf', () => {
  it('looks at the target', () => {
    for (let i = 0; i < 20; ++i) {
      const pose = randomPose();
      const target = add(pose.eye, scale(poses.forward(pose), 123));
      const found = poses.poseOf({eye: pose.eye, target});
      expect(found.headingDeg).toBeCloseTo(pose.headingDeg, 9);
      expect(found.pitchDeg).toBeCloseTo(pose.pitchDeg, 9);
    }
  });
});

describe('between', () => {
  it('turns the short way', () => {
    const [a, b] = [170, -170].map(
      (headingDeg) => ({eye: [0, 0, 0], headingDeg, pitchDeg: 0}) as const,
    );
    expect(Math.abs(poses.between(a!, b!, 0.5).headingDeg)).toBeCloseTo(180, 9);
  });
});
