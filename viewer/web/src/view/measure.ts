// Distance, climb and height profile between two clicks.
import {lengthText} from '../core/round_numbers';
import {profileAlong, type Profile} from '../core/profile';
import type {Surface} from '../core/surface';
import type {Vec3} from '../core/vec3';
import {element} from './page';

const kSvg = 'http://www.w3.org/2000/svg';
const kPlot = {width: 536, height: 110, left: 46, bottom: 18, top: 8};
const kMarks = 64;

/** What measuring needs of the viewer. */
export interface Measured {
  readonly surface: () => Surface;
  /** Metres over the ellipsoid, or of the DEM, at a world place. */
  readonly heightOf: (place: Vec3) => number;
  /** Pixels from the upper left; undefined behind the eye. */
  readonly screenOf: (place: Vec3) => {x: number; y: number} | undefined;
}

export class Measure {
  private ends: Vec3[] = [];
  private isOn = false;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly terrain: Measured,
  ) {
    element('measure').addEventListener('click', () => this.toggle());
    element('profile-close').addEventListener('click', () => this.toggle(false));
  }

  get active(): boolean {
    return this.isOn;
  }

  toggle(on = !this.isOn): void {
    this.isOn = on;
    this.ends = [];
    element('measure').setAttribute('aria-pressed', String(on));
    this.canvas.classList.toggle('measuring', on);
    element('profile').hidden = !on;
    element('profile-text').textContent = 'Click two places on the terrain.';
    this.hidePlot(true);
    this.follow();
  }

  /** Takes a click on the terrain. */
  add(place: Vec3): void {
    if (this.ends.length === 2) this.ends = [];
    this.ends.push(place);
    // a first click needs to see the terrain, not the plot before
    this.hidePlot(this.ends.length < 2);
    if (this.ends.length === 2) this.showProfile();
    else element('profile-text').textContent = 'Click the other end.';
    this.follow();
  }

  /** Keeps the line on the terrain as the camera moves. */
  follow(): void {
    const marks = element<SVGElement>('marks');
    if (this.ends.length === 0) return marks.replaceChildren();
    const along = this.ends.length === 2 ? this.line() : this.ends;
    const points = along.flatMap((place) => this.terrain.screenOf(place) ?? []);
    const line = svg('polyline', {points: points.map(({x, y}) => `${x},${y}`).join(' ')});
    const ends = this.ends
      .flatMap((place) => this.terrain.screenOf(place) ?? [])
      .map(({x, y}) => svg('circle', {cx: x, cy: y, r: 5}));
    marks.replaceChildren(line, ...ends);
  }

  private hidePlot(on: boolean): void {
    element<SVGElement>('profile-plot').toggleAttribute('hidden', on);
  }

  private line(): Vec3[] {
    const [a, b] = this.ends as [Vec3, Vec3];
    const surface = this.terrain.surface();
    return Array.from({length: kMarks + 1}, (_, i) => {
      const t = i / kMarks;
      const [x, y] = [a[0] + t * (b[0] - a[0]), a[1] + t * (b[1] - a[1])];
      return [x, y, surface.heightAt(x, y) ?? a[2] + t * (b[2] - a[2])] as const;
    });
  }

  private showProfile(): void {
    const [a, b] = this.ends as [Vec3, Vec3];
    const surface = this.terrain.surface();
    const profile = profileAlong(a, b, (x, y) => {
      const point = surface.pointAt(x, y);
      return point && this.terrain.heightOf(point.place);
    });
    const metres = (value: number) => `${value.toFixed(0)} m`;
    const rise = this.terrain.heightOf(b) - this.terrain.heightOf(a);
    element('profile-text').textContent =
      `${lengthText(profile.lengthM)}, ${rise < 0 ? '−' : '+'}${metres(Math.abs(rise))}; ` +
      `up ${metres(profile.climbM)}, down ${metres(profile.descentM)}`;
    element('profile-plot').replaceChildren(...plotOf(profile));
    element('profile-plot').setAttribute('viewBox', `0 0 ${kPlot.width} ${kPlot.height}`);
  }
}

function plotOf({heights, lowM, highM, lengthM}: Profile): SVGElement[] {
  const {width, height, left, bottom, top} = kPlot;
  const base = height - bottom;
  const span = Math.max(1, highM - lowM);
  const x = (i: number) => left + ((width - left - 6) * i) / (heights.length - 1);
  const y = (metres: number) => base - ((base - top) * (metres - lowM)) / span;
  const points = heights.flatMap((metres, i) =>
    metres === undefined ? [] : [`${x(i).toFixed(1)},${y(metres).toFixed(1)}`],
  );
  const [first, last] = [points[0]?.split(',')[0], points.at(-1)?.split(',')[0]];
  const ground = svg('polygon', {
    class: 'ground',
    points: `${first},${base} ${points.join(' ')} ${last},${base}`,
  });
  const text = (value: string, at: {x: number; y: number}, anchor: string) => {
    const made = svg('text', {...at, 'text-anchor': anchor});
    made.textContent = value;
    return made;
  };
  return [
    svg('line', {x1: left, x2: width - 6, y1: top, y2: top}),
    ground,
    text(`${highM.toFixed(0)} m`, {x: left - 6, y: top + 8}, 'end'),
    text(`${lowM.toFixed(0)} m`, {x: left - 6, y: base}, 'end'),
    text('0', {x: left, y: height - 4}, 'start'),
    text(lengthText(lengthM), {x: width - 6, y: height - 4}, 'end'),
  ];
}

function svg(name: string, attributes: Record<string, string | number>): SVGElement {
  const made = document.createElementNS(kSvg, name) as SVGElement;
  for (const [key, value] of Object.entries(attributes)) made.setAttribute(key, String(value));
  return made;
}
