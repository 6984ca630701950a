// What the page says in numbers: positions, lengths, contours, profiles, the sun.
import {describe, expect, it} from 'vitest';
import {parsePath, poseAt} from '../../src/core/camera_path';
import {contoursFor} from '../../src/core/contours';
import {sunDirection} from '../../src/core/daylight';
import {toGeodetic} from '../../src/core/geodetic';
import {profileAlong} from '../../src/core/profile';
import {bytesText, lengthText, roundAbove, roundBelow} from '../../src/core/round_numbers';

describe('toGeodetic', () => {
  const plane = {longitudeDeg: -122.19, latitudeDeg: 46.18};

  it('gives the origin of the plane back', () => {
    const found = toGeodetic([0, 0, 0], plane);
    expect(found.longitudeDeg).toBeCloseTo(-122.19, 11);
    expect(found.latitudeDeg).toBeCloseTo(46.18, 11);
    expect(found.heightM).toBeCloseTo(0, 6);
  });

  it('agrees with published radii of the ellipsoid', () => {
    // a degree of latitude at the equator and at the pole: 110,574.3 m and 111,693.9 m (WGS84)
    const north = toGeodetic([0, 1000, 0], {longitudeDeg: 0, latitudeDeg: 0});
    expect(1000 / north.latitudeDeg).toBeCloseTo(110574.3, -1);
    const polar = toGeodetic([0, 1000, 0], {longitudeDeg: 0, latitudeDeg: 89.9});
    expect(1000 / (polar.latitudeDeg - 89.9)).toBeCloseTo(111693.9, -1);
    // and of longitude at the equator: 111,319.5 m
    const east = toGeodetic([1000, 0, 0], {longitudeDeg: 0, latitudeDeg: 0});
    expect(1000 / east.longitudeDeg).toBeCloseTo(111319.5, -1);
  });

  it('rises above the tangent plane with the square of the distance', () => {
    const {heightM} = toGeodetic([0, 20000, 0], {longitudeDeg: 0, latitudeDeg: 0});
    // the meridian's radius at the equator is 6,335,439 m
    expect(heightM).toBeCloseTo(20000 ** 2 / (2 * 6335439), 2);
  });
});

describe('round numbers', () => {
  it('are 1, 2 or 5 times a power of ten', () => {
    expect([0.03, 1, 1.9, 4.9, 99, 700].map(roundBelow)).toEqual([0.02, 1, 1, 2, 50, 500]);
    expect([1, 1.1, 2.1, 5.1, 99].map(roundAbove)).toEqual([1, 2, 5, 10, 100]);
  });

  it('are said as people say them', () => {
    expect(lengthText(0.5)).toBe('0.5 m');
    expect(lengthText(250)).toBe('250 m');
    expect(lengthText(12345)).toBe('12.3 km');
    expect(bytesText(12345678)).toBe('12.3 MB');
  });
});

describe('contoursFor', () => {
  it('never has lines closer than a few pixels on a slope of 45 degrees', () => {
    for (let m = 0.05; m < 500; m *= 1.1) {
      expect(contoursFor(m).intervalM / m).toBeGreaterThan(5.9);
      expect(contoursFor(m).intervalM / m).toBeLessThan(20);
    }
  });

  it('blends into the next interval without a jump', () => {
    let last = contoursFor(0.05);
    for (let m = 0.05; m < 500; m *= 1.005) {
      const now = contoursFor(m);
      if (now.intervalM === last.intervalM) {
        expect(Math.abs(now.blend - last.blend)).toBeLessThan(0.05);
      } else {
        expect(now.intervalM).toBe(last.nextIntervalM);
        expect(last.blend).toBeGreaterThan(0.95);
        expect(now.blend).toBe(0);
      }
      last = now;
    }
  });
});

describe('profileAlong', () => {
  it('adds up the ways up and down', () => {
    const ridge = (x: number) => (x < 60 ? 100 + x : 160 - 2 * (x - 60));
    const profile = profileAlong([0, 0, 0], [100, 0, 0], ridge, 101);
    expect(profile).toMatchObject({lengthM: 100, lowM: 80, highM: 160});
    expect(profile.climbM).toBeCloseTo(60, 9);
    expect(profile.descentM).toBeCloseTo(80, 9);
  });
});

describe('sunDirection', () => {
  it('rises in the east, culminates in the south and sets in the west', () => {
    const [east, noon, west] = [6, 12, 18].map((hour) => sunDirection(hour, 45));
    expect(east![0]).toBeGreaterThan(0.9);
    expect(noon![1]).toBeLessThan(0);
    expect(west![0]).toBeLessThan(-0.9);
    // at noon: 90 degrees less the latitude, plus the declination of 15
    expect((Math.asin(noon![2]) * 180) / Math.PI).toBeCloseTo(60, 9);
  });
});

describe('a camera path', () => {
  const path = parsePath([
    {s: 0, eye: [0, 0, 0], heading_deg: 0, pitch_deg: -10},
    {s: 2, eye: [10, 0, 0], heading_deg: 90, pitch_deg: -20},
  ]);

  it('passes its poses in time', () => {
    expect(poseAt(path, 1)).toEqual({eye: [5, 0, 0], headingDeg: 45, pitchDeg: -15});
    expect(poseAt(path, 9).eye).toEqual([10, 0, 0]);
  });

  it('says which entry is wrong', () => {
    expect(() => parsePath([{s: 0, eye: [0, 0], heading_deg: 0, pitch_deg: 0}])).toThrow('entry 0');
  });
});
