// What the user can set, and the permalink that holds all of it.
import type {Theme} from './daylight';
import type {Pose} from './pose';

export const kLooks = ['relief', 'hillshade', 'slope', 'imagery', 'levels', 'error'] as const;
export type Look = (typeof kLooks)[number];

export interface Settings {
  readonly look: Look;
  readonly contours: boolean;
  readonly wireframe: boolean;
  readonly borders: boolean;
  readonly haze: boolean;
  /** Largest error on the screen, in CSS pixels. */
  readonly tolerancePx: number;
  /** Heights are shown this many times as high. */
  readonly exaggeration: number;
  /** Local solar time; null: the light of shaded relief. */
  readonly hour: number | null;
  /** null: what the system prefers. */
  readonly theme: Theme | null;
}

export const kDefaults: Settings = {
  look: 'relief',
  contours: false,
  wireframe: false,
  borders: false,
  haze: true,
  tolerancePx: 1,
  exaggeration: 1,
  hour: null,
  theme: null,
};

export const kTolerancePx = {low: 0.5, high: 16};
export const kExaggeration = {low: 0.5, high: 4};

/** What a permalink holds; the camera is absent before the user has moved. */
export interface Permalink {
  readonly settings: Settings;
  readonly pose?: Pose;
}

/** "look=slope&camera=..." without a hash sign; defaults are left out. */
export function writePermalink({settings, pose}: Permalink): string {
  const words: string[] = [];
  for (const [name, value] of Object.entries(settings)) {
    if (value === kDefaults[name as keyof Settings]) continue;
    words.push(`${name}=${typeof value === 'boolean' ? Number(value) : value}`);
  }
  if (pose) {
    const eye = pose.eye.map((metres) => Number(metres.toFixed(1)));
    const angles = [pose.headingDeg, pose.pitchDeg].map((deg) => Number(deg.toFixed(2)));
    words.push(`camera=${[...eye, ...angles].join(',')}`);
  }
  return words.join('&');
}

/** Reads a permalink; what it lacks or says wrongly is left as in the defaults. */
export function readPermalink(text: string, defaults: Settings = kDefaults): Permalink {
  const words = new URLSearchParams(text);
  const flag = (name: 'contours' | 'wireframe' | 'borders' | 'haze') =>
    words.has(name) ? words.get(name) === '1' : defaults[name];
  const theme = words.get('theme');
  const settings: Settings = {
    look: kLooks.find((name) => name === words.get('look')) ?? defaults.look,
    contours: flag('contours'),
    wireframe: flag('wireframe'),
    borders: flag('borders'),
    haze: flag('haze'),
    tolerancePx: numberIn(words.get('tolerancePx'), kTolerancePx) ?? defaults.tolerancePx,
    exaggeration: numberIn(words.get('exaggeration'), kExaggeration) ?? defaults.exaggeration,
    hour: numberIn(words.get('hour'), {low: 0, high: 24}) ?? defaults.hour,
    theme: theme === 'light' || theme === 'dark' ? theme : defaults.theme,
  };
  const camera = words.get('camera')?.split(',').map(Number);
  if (camera?.length !== 5 || !camera.every(Number.isFinite)) return {settings};
  const [x, y, z, headingDeg, pitchDeg] = camera as [number, number, number, number, number];
  return {settings, pose: {eye: [x, y, z], headingDeg, pitchDeg}};
}

function numberIn(text: string | null, {low, high}: {low: number; high: number}) {
  const value = text === null || text === '' ? NaN : Number(text);
  return Number.isFinite(value) ? Math.min(high, Math.max(low, value)) : undefined;
}
