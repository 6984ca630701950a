// Where the sun stands and what colour the light and the sky have.
import type {Vec3} from './vec3';

/** sRGB, each 0 to 1. */
export type Rgb = readonly [number, number, number];

export interface Daylight {
  /** Towards the light, of length 1; (east, north, up). */
  readonly sun: Vec3;
  readonly sunlight: Rgb;
  /** Light from all over the sky. */
  readonly skylight: Rgb;
  readonly horizon: Rgb;
  readonly zenith: Rgb;
}

export type Theme = 'light' | 'dark';

const kRad = Math.PI / 180;

/** A day in early summer on the northern half, in winter on the southern. */
const kDeclinationDeg = 15;

interface Colors {
  readonly sunlight: Rgb;
  readonly skylight: Rgb;
  readonly horizon: Rgb;
  readonly zenith: Rgb;
}

/** Height of the sun in degrees, and the light then. */
const kDay: readonly (readonly [number, Colors])[] = [
  [-14, hexColors(0x3d4964, 0x333b4f, 0x141d2c, 0x070b14)],
  [-4, hexColors(0x434666, 0x424a64, 0x4b4763, 0x141d38)],
  [0, hexColors(0x8a5a48, 0x55566c, 0xd98f6c, 0x31456f)],
  [6, hexColors(0xd99a66, 0x636c84, 0xf0c39a, 0x5f86b8)],
  [20, hexColors(0xcdb894, 0x6b7684, 0xd9e3ea, 0x5f96cc)],
  [60, hexColors(0xbfb8ac, 0x757d85, 0xdbe8f1, 0x4f8cc9)],
];

/** The light of shaded relief: from the north-west, where readers of maps expect it. */
const kRelief: Readonly<Record<Theme, Colors>> = {
  light: hexColors(0xe6e2da, 0x5d6168, 0xe2ecf3, 0x86b4da),
  dark: hexColors(0xd2cfca, 0x4d525b, 0x263341, 0x0b1118),
};

/**
 * @param hour local solar time, 0 to 24; null: the light of shaded relief
 * @param latitudeDeg where the terrain is
 */
export function daylight(hour: number | null, latitudeDeg: number, theme: Theme): Daylight {
  if (hour === null) return {sun: [-0.5, 0.5, Math.SQRT1_2], ...kRelief[theme]};
  const sun = sunDirection(hour, latitudeDeg);
  const colors = colorsAt(Math.asin(sun[2]) / kRad);
  // the moon takes over where the sun has set
  return {sun: sun[2] > -0.05 ? lifted(sun) : [0.4, -0.3, Math.sqrt(0.75)], ...colors};
}

/** Towards the sun. Source: the hour angle formulas of any almanac. */
export function sunDirection(hour: number, latitudeDeg: number): Vec3 {
  const angle = (hour - 12) * 15 * kRad;
  const [latitude, declination] = [latitudeDeg * kRad, kDeclinationDeg * kRad];
  const [sinLat, cosLat] = [Math.sin(latitude), Math.cos(latitude)];
  const [sinDec, cosDec] = [Math.sin(declination), Math.cos(declination)];
  return [
    -cosDec * Math.sin(angle),
    sinDec * cosLat - cosDec * sinLat * Math.cos(angle),
    sinDec * sinLat + cosDec * cosLat * Math.cos(angle),
  ];
}

/** A sun on the horizon still lights what faces it. */
function lifted([x, y, z]: Vec3): Vec3 {
  const up = Math.max(z, 0.06);
  const size = Math.hypot(x, y, up);
  return [x / size, y / size, up / size];
}

function colorsAt(elevationDeg: number): Colors {
  const next = kDay.findIndex(([at]) => at >= elevationDeg);
  if (next === 0) return kDay[0]![1];
  if (next < 0) return kDay[kDay.length - 1]![1];
  const [[low, from], [high, to]] = [kDay[next - 1]!, kDay[next]!];
  const t = (elevationDeg - low) / (high - low);
  return {
    sunlight: mix(from.sunlight, to.sunlight, t),
    skylight: mix(from.skylight, to.skylight, t),
    horizon: mix(from.horizon, to.horizon, t),
    zenith: mix(from.zenith, to.zenith, t),
  };
}

function mix(a: Rgb, b: Rgb, t: number): Rgb {
  return [0, 1, 2].map((k) => a[k]! + (b[k]! - a[k]!) * t) as unknown as Rgb;
}

function hexColors(sunlight: number, skylight: number, horizon: number, zenith: number): Colors {
  const rgb = (hex: number): Rgb =>
    [hex >> 16, (hex >> 8) & 255, hex & 255].map((v) => v / 255) as unknown as Rgb;
  return {
    sunlight: rgb(sunlight),
    skylight: rgb(skylight),
    horizon: rgb(horizon),
    zenith: rgb(zenith),
  };
}
