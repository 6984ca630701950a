import {describe, expect, it} from 'vitest';
import {kDefaults, readPermalink, writePermalink, type Settings} from '../../src/core/settings';

const kChanged: Settings = {
  look: 'slope',
  contours: true,
  wireframe: true,
  borders: true,
  haze: false,
  tolerancePx: 4,
  exaggeration: 1.5,
  hour: 18.5,
  theme: 'dark',
};

describe('a permalink', () => {
  it('holds everything', () => {
    const pose = {eye: [1234.5, -77, 990.1], headingDeg: 12.25, pitchDeg: -33} as const;
    const text = writePermalink({settings: kChanged, pose});
    expect(readPermalink(text)).toEqual({settings: kChanged, pose});
  });

  it('is empty where nothing has changed', () => {
    expect(writePermalink({settings: kDefaults})).toBe('');
    expect(readPermalink('')).toEqual({settings: kDefaults});
  });

  it('takes what it can from a text that people have changed', () => {
    const {settings, pose} = readPermalink('look=none&tolerancePx=1e9&hour=x&camera=1,2,3');
    expect(settings).toEqual({...kDefaults, tolerancePx: 16});
    expect(pose).toBeUndefined();
  });
});
