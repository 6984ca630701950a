// From world metres (a tangent plane of the WGS84 ellipsoid) to longitude, latitude and height.
import type {Vec3} from './vec3';

/** Where the world's origin is. */
export interface TangentPlane {
  readonly longitudeDeg: number;
  readonly latitudeDeg: number;
}

export interface Geodetic {
  readonly longitudeDeg: number;
  readonly latitudeDeg: number;
  /** Over the ellipsoid. */
  readonly heightM: number;
}

const kRad = Math.PI / 180;
const kA = 6378137;
const kF = 1 / 298.257223563;
const kE2 = kF * (2 - kF);

/**
 * Exact to a micrometre near the surface: Bowring's start, then three steps of the fixed point
 * iteration of the latitude.
 */
export function toGeodetic(world: Vec3, plane: TangentPlane): Geodetic {
  const [x, y, z] = toEarthCentred(world, plane);
  const p = Math.hypot(x, y);
  let latitude = Math.atan2(z, p * (1 - kE2));
  for (let i = 0; i < 5; ++i) {
    const sin = Math.sin(latitude);
    latitude = Math.atan2(z + kE2 * primeVertical(sin) * sin, p);
  }
  const sin = Math.sin(latitude);
  const heightM = p * Math.cos(latitude) + z * sin - kA * Math.sqrt(1 - kE2 * sin * sin);
  return {longitudeDeg: Math.atan2(y, x) / kRad, latitudeDeg: latitude / kRad, heightM};
}

function toEarthCentred([east, north, up]: Vec3, plane: TangentPlane): Vec3 {
  const [longitude, latitude] = [plane.longitudeDeg * kRad, plane.latitudeDeg * kRad];
  const [sinLon, cosLon] = [Math.sin(longitude), Math.cos(longitude)];
  const [sinLat, cosLat] = [Math.sin(latitude), Math.cos(latitude)];
  const n = primeVertical(sinLat);
  return [
    n * cosLat * cosLon - sinLon * east - sinLat * cosLon * north + cosLat * cosLon * up,
    n * cosLat * sinLon + cosLon * east - sinLat * sinLon * north + cosLat * sinLon * up,
    n * (1 - kE2) * sinLat + cosLat * north + sinLat * up,
  ];
}

function primeVertical(sinLatitude: number): number {
  return kA / Math.sqrt(1 - kE2 * sinLatitude * sinLatitude);
}
