// What the page says of the place under the cursor: position, height and how exact it is.
import {toGeodetic} from '../core/geodetic';
import {toPlan} from '../core/plan_map';
import {lengthText, roundBelow} from '../core/round_numbers';
import type {SurfacePoint} from '../core/surface';
import type {Frame, Tileset} from '../core/tileset';
import type {Vec3} from '../core/vec3';
import {element} from './page';

/** Longitude, latitude, height, and the plan of the DEM's CRS. */
export function placeText({place, errorM}: SurfacePoint, {frame, plan}: Tileset): string {
  const bound = errorM < 10 ? errorM.toFixed(1) : errorM.toFixed(0);
  if (frame.kind === 'local') {
    const [x, y] = [place[0] + frame.x, place[1] + frame.y];
    return `x ${x.toFixed(1)}, y ${y.toFixed(1)}, ${place[2].toFixed(1)} m ± ${bound} m`;
  }
  const {longitudeDeg, latitudeDeg, heightM} = toGeodetic(place, frame);
  const degrees = (deg: number, [more, less]: string) =>
    `${Math.abs(deg).toFixed(5)}° ${deg < 0 ? less : more}`;
  const [x, y] = plan ? toPlan(plan, longitudeDeg, latitudeDeg) : [0, 0];
  return (
    `${degrees(latitudeDeg, 'NS')}, ${degrees(longitudeDeg, 'EW')}, ` +
    `${heightM.toFixed(1)} m ± ${bound} m` +
    (plan ? ` · ${plan.name}: ${planText(x, plan.unit)}, ${planText(y, plan.unit)}` : '')
  );
}

function planText(value: number, unit: string): string {
  if (unit === 'degree') return value.toFixed(5);
  return value.toFixed(1) + (unit === 'metre' ? '' : ` ${unit}`);
}

/** The height of a world place. */
export function heightOf(place: Vec3, frame: Frame): number {
  return frame.kind === 'local' ? place[2] : toGeodetic(place, frame).heightM;
}

const kWidestBarPx = 150;

/** @param metresPerPx in the middle of the picture */
export function showScale(metresPerPx: number): void {
  const metres = roundBelow(kWidestBarPx * metresPerPx);
  const bar = element('scale').firstElementChild as HTMLElement;
  bar.style.width = `${metres / metresPerPx}px`;
  bar.textContent = lengthText(metres);
}

export function showCompass(headingDeg: number): void {
  element('needle').setAttribute('transform', `rotate(${-headingDeg.toFixed(1)} 12 12)`);
}
