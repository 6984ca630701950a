// The settings and figures over the picture. The elements are in index.html.
import type {Theme} from '../core/daylight';
import {bytesText} from '../core/round_numbers';
import {kExaggeration, kTolerancePx, type Look, type Settings} from '../core/settings';
import {element} from './page';

/** What the panel does when the user changes something. */
export interface PanelEvents {
  readonly onChange: (change: Partial<Settings>) => void;
  readonly onFreeze: (on: boolean) => void;
}

/** The figures of one frame. */
export interface PanelFigures {
  readonly tiles: number;
  readonly triangles: number;
  readonly levels: Readonly<Record<number, number>>;
  /** Milliseconds between pictures; undefined while nothing moves: then nothing is drawn. */
  readonly frameMs: number | undefined;
  /** Largest error on the screen of what is shown. */
  readonly shownTolerancePx: number;
  /** Share of the wanted tiles that are here, 0 to 1. */
  readonly loadedShare: number;
  readonly requests: number;
  readonly cachedBytes: number;
}

/** The hour that the slider begins with: the light is low and warm. */
const kFirstHour = 18;

export class Panel {
  private readonly loading = element('loading');
  private readonly bar = this.loading.firstElementChild as HTMLElement;

  constructor(settings: Settings, events: PanelEvents) {
    const {onChange} = events;
    element('panel').hidden = false;
    // a phone has no room for both
    if (innerWidth <= 600) element<HTMLDetailsElement>('panel-fold').open = false;
    const look = element<HTMLSelectElement>('look');
    look.addEventListener('change', () => onChange({look: look.value as Look}));
    for (const name of ['contours', 'haze', 'wireframe', 'borders'] as const) {
      onTick(name, (on) => onChange({[name]: on}));
    }
    onTick('freeze', events.onFreeze);
    onTick('sun', (on) => onChange({hour: on ? kFirstHour : null}));
    // equal steps of a slider are equal factors
    onSlide('tolerancePx', kTolerancePx, (px) => onChange({tolerancePx: 2 ** px}));
    onSlide('exaggeration', kExaggeration, (times) => onChange({exaggeration: round(2 ** times)}));
    const hour = element<HTMLInputElement>('hour');
    hour.addEventListener('input', () => onChange({hour: Number(hour.value)}));
    this.showSettings(settings);
  }

  showSettings(settings: Settings): void {
    element<HTMLSelectElement>('look').value = settings.look;
    for (const name of ['contours', 'haze', 'wireframe', 'borders'] as const) {
      element<HTMLInputElement>(name).checked = settings[name];
    }
    const {hour, tolerancePx, exaggeration} = settings;
    element<HTMLInputElement>('sun').checked = hour !== null;
    element('hour-row').hidden = hour === null;
    slideTo('hour', hour ?? kFirstHour, timeText(hour ?? kFirstHour));
    slideTo('tolerancePx', Math.log2(tolerancePx), `${round(tolerancePx)} px`);
    slideTo('exaggeration', Math.log2(exaggeration), `× ${round(exaggeration)}`);
  }

  showFigures(figures: PanelFigures): void {
    const {loadedShare, frameMs} = figures;
    this.bar.style.width = loadedShare < 1 ? `${100 * loadedShare}%` : '0';
    this.loading.setAttribute('aria-valuenow', String(Math.round(100 * loadedShare)));
    if (!element<HTMLDetailsElement>('stats-fold').open) return;
    const levels = Object.entries(figures.levels).map(([level, tiles]) => `${level}: ${tiles}`);
    const px = figures.shownTolerancePx;
    const rows = {
      Triangles: figures.triangles.toLocaleString('en'),
      Tiles: String(figures.tiles),
      'By level': levels.join(', '),
      'Shown error': px < 1000 ? `${px.toFixed(1)} px` : 'loading',
      Memory: bytesText(figures.cachedBytes),
      Requests: String(figures.requests),
      Frame: frameMs === undefined ? 'still' : `${frameMs.toFixed(0)} ms`,
    };
    const cells = Object.entries(rows).flatMap(([name, value]) => [
      cell('dt', name),
      cell('dd', value),
    ]);
    element('stats').replaceChildren(...cells);
  }

  showTheme(theme: Theme): void {
    document.documentElement.dataset.theme = theme;
  }

  /** @param text empty where there are no contours */
  showContourInterval(text: string): void {
    element('contours-row').hidden = text === '';
    element('contours-text').textContent = text;
  }

  /** Takes a look away that this terrain cannot have. */
  offerImagery(on: boolean): void {
    const option = document.querySelector<HTMLOptionElement>('#look option[value=imagery]')!;
    option.hidden = !on;
    option.disabled = !on;
  }
}

function onTick(id: string, onChange: (on: boolean) => void): void {
  const box = element<HTMLInputElement>(id);
  box.addEventListener('change', () => onChange(box.checked));
}

function onSlide(
  id: string,
  {low, high}: {low: number; high: number},
  onChange: (octave: number) => void,
): void {
  const slider = element<HTMLInputElement>(id);
  Object.assign(slider, {min: Math.log2(low), max: Math.log2(high)});
  slider.addEventListener('input', () => onChange(Number(slider.value)));
}

function slideTo(id: string, value: number, text: string): void {
  const slider = element<HTMLInputElement>(id);
  slider.value = String(value);
  slider.setAttribute('aria-valuetext', text);
  element(`${id}-text`).textContent = text;
}

function timeText(hour: number): string {
  const minutes = Math.round(hour * 60);
  return `${Math.floor(minutes / 60)}:${String(minutes % 60).padStart(2, '0')}`;
}

function round(value: number): number {
  return Number(value.toPrecision(2));
}

function cell(tag: 'dt' | 'dd', text: string): HTMLElement {
  const made = document.createElement(tag);
  made.textContent = text;
  return made;
}
