import {describe, expect, it} from 'vitest';
import {parsePlan, toPlan, type PlanJson} from '../../src/core/plan_map';

// the plan that terrane.json has of the St. Helens DEM, and places of that DEM by PROJ:
// gdaltransform -s_srs EPSG:4326 -t_srs EPSG:26710
const kStHelens: PlanJson = {
  degree: 2,
  middle_deg: [-122.18851705006594, 46.18729645099266],
  half_deg: [0.0642876058709092, 0.06348887853755159],
  x: [562715.668725854, 4961.080271450324, -72.10046982511724, -0.0015764321171224695, -5.712693103070816, -0.03871495090488271],
  y: [5114983.17678963, 50.706545693013965, 7054.23448658005, 2.008799611338408, -0.004482940191289314, 0.03854683748435215],
};
const kWkt =
  'PROJCRS["unnamed",BASEGEOGCRS["NAD27",DATUM["North American Datum 1927",ELLIPSOID[' +
  '"Clarke 1866",6378206.4,294.978698213898,LENGTHUNIT["metre",1]]]],CONVERSION["UTM zone 10N",' +
  'METHOD["Transverse Mercator"]],CS[Cartesian,2],AXIS["(E)",east,ORDER[1],LENGTHUNIT["metre",1]]' +
  ',AXIS["(N)",north,ORDER[2],LENGTHUNIT["metre",1]]]';

describe('toPlan', () => {
  it.each([
    [-122.19, 46.19, 562598.1643, 5115282.3989],
    [-122.145, 46.14, 566130.4533, 5109763.3470],
    [-122.23, 46.235, 559462.9988, 5120251.6478],
    [-122.16, 46.22, 564877.8768, 5118639.7576],
  ])('agrees with PROJ at %d, %d', (longitudeDeg, latitudeDeg, x, y) => {
    const [foundX, foundY] = toPlan(parsePlan(kStHelens, kWkt)!, longitudeDeg, latitudeDeg);
    expect(Math.hypot(foundX - x, foundY - y)).toBeLessThan(0.002);
  });

  it('takes longitudes of either turn', () => {
    const map = parsePlan(kStHelens, kWkt)!;
    const [a, b] = [toPlan(map, -122.2, 46.2), toPlan(map, 237.8, 46.2)];
    expect(Math.hypot(a[0] - b[0], a[1] - b[1])).toBeLessThan(1e-6);
  });
});

describe('parsePlan', () => {
  it('names the CRS and its unit', () => {
    const {name, unit} = parsePlan(kStHelens, kWkt)!;
    expect([name, unit]).toEqual(['NAD27 / UTM zone 10N', 'metre']);
    const feet = kWkt.replace('unnamed', 'Utopia').replaceAll('"metre",1', '"US survey foot",0.3048');
    expect(parsePlan(kStHelens, feet)).toMatchObject({name: 'Utopia', unit: 'US survey foot'});
  });

  it('is nothing where the file has none', () => {
    expect(parsePlan(undefined, kWkt)).toBeUndefined();
  });
});
