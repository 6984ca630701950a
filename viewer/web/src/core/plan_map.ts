// From longitude and latitude to the plan of the DEM's own CRS: the polynomials of terrane.json
// (docs/formats.md), so that no PROJ is needed here.

/** A CRS and the way into its plan. */
export interface PlanMap {
  /** As people call it: "NAD27 / UTM zone 10N". */
  readonly name: string;
  /** What its axes count: "metre", "US survey foot", "degree". */
  readonly unit: string;
  readonly degree: number;
  /** Longitude, latitude. */
  readonly middleDeg: readonly [number, number];
  readonly halfDeg: readonly [number, number];
  /** Coefficients in the order 1, u, v, u^2, u v, v^2, ... */
  readonly x: readonly number[];
  readonly y: readonly number[];
}

/** The member "plan" of terrane.json. */
export interface PlanJson {
  readonly degree: number;
  readonly middle_deg: [number, number];
  readonly half_deg: [number, number];
  readonly x: number[];
  readonly y: number[];
}

/** @param wkt the CRS as WKT 2 */
export function parsePlan(plan: PlanJson | undefined, wkt: string): PlanMap | undefined {
  if (!plan) return undefined;
  const {degree, middle_deg: middleDeg, half_deg: halfDeg, x, y} = plan;
  return {name: crsName(wkt), unit: crsUnit(wkt), degree, middleDeg, halfDeg, x, y};
}

/** x and y in the unit of the CRS. */
export function toPlan(map: PlanMap, longitudeDeg: number, latitudeDeg: number): [number, number] {
  const fromMiddle = longitudeDeg - map.middleDeg[0];
  const u = (fromMiddle - 360 * Math.round(fromMiddle / 360)) / map.halfDeg[0];
  const v = (latitudeDeg - map.middleDeg[1]) / map.halfDeg[1];
  let [x, y, k] = [0, 0, 0];
  for (let sum = 0; sum <= map.degree; ++sum) {
    for (let j = 0; j <= sum; ++j, ++k) {
      const term = u ** (sum - j) * v ** j;
      x += map.x[k]! * term;
      y += map.y[k]! * term;
    }
  }
  return [x, y];
}

/** The CRS's name; for one without, those of its datum and projection. */
function crsName(wkt: string): string {
  const named = (keyword: string) => new RegExp(`${keyword}\\["([^"]+)"`).exec(wkt)?.[1];
  const name = /^\w+\["([^"]+)"/.exec(wkt)?.[1];
  if (name && !/^(unnamed|unknown)$/i.test(name)) return name;
  return [named('BASEGEOGCRS'), named('CONVERSION')].filter(Boolean).join(' / ');
}

/** Axes come last in a WKT, and their unit with them. */
function crsUnit(wkt: string): string {
  const axes = wkt.slice(wkt.lastIndexOf('CS['));
  return /(?:LENGTH|ANGLE)UNIT\["([^"]+)"/.exec(axes)?.[1] ?? '';
}
