import {materialColor, rampColor} from './section_material';
import type {Plane} from './cut_cells';
import type {VolumeData} from './volume_data';

/** Where the section stands. */
export interface SectionSetting {
  kind: 'upright' | 'level';
  /** Upright: the compass bearing of its normal, 0 to 180. */
  directionDeg: number;
  /** Along the normal, in metres from the middle of the box. */
  offsetM: number;
}

export function planeOf({kind, directionDeg, offsetM}: SectionSetting): Plane {
  if (kind === 'level') return {normal: [0, 0, 1], offset: offsetM};
  const angle = (directionDeg * Math.PI) / 180;
  return {normal: [Math.sin(angle), Math.cos(angle), 0], offset: offsetM};
}

/** How far a section may be moved from the middle before it leaves the box. */
export function reach({normal}: Plane, halfSize: readonly number[]): number {
  return normal.reduce((sum, n, k) => sum + Math.abs(n) * halfSize[k], 0);
}

function element<T extends HTMLElement>(id: string): T {
  return document.getElementById(id) as T;
}

const kInputs = {
  kind: 'kind',
  direction: 'direction',
  offset: 'offset',
  mesh: 'mesh',
  surfaces: 'surfaces',
  colour: 'colour',
  stretch: 'stretch',
};

/** The page's controls. */
export class VolumePanel {
  private readonly input = Object.fromEntries(
    Object.entries(kInputs).map(([name, id]) => [name, element<HTMLInputElement>(id)]),
  ) as Record<keyof typeof kInputs, HTMLInputElement>;

  constructor(
    private readonly data: VolumeData,
    private readonly onChange: (what: 'section' | 'colour' | 'look') => void,
  ) {
    const colour = this.input.colour as unknown as HTMLSelectElement;
    colour.add(new Option('by material', '-1'));
    data.fields.forEach(({name}, f) => colour.add(new Option(`by ${name}`, String(f))));
    const [x, y, z] = data.halfSize;
    this.input.stretch.value = String(Math.max(1, (0.25 * Math.hypot(x, y)) / z));
    for (const name of ['kind', 'direction', 'offset'] as const) this.on(name, 'section');
    this.on('colour', 'colour');
    for (const name of ['mesh', 'surfaces', 'stretch'] as const) this.on(name, 'look');
    this.refresh();
  }

  private on(name: keyof typeof kInputs, what: 'section' | 'colour' | 'look'): void {
    this.input[name].addEventListener('input', () => {
      this.refresh();
      this.onChange(what);
    });
  }

  get section(): SectionSetting {
    return {
      kind: this.input.kind.value as SectionSetting['kind'],
      directionDeg: Number(this.input.direction.value),
      offsetM: Number(this.input.offset.value),
    };
  }

  set section({kind, directionDeg, offsetM}: SectionSetting) {
    this.input.kind.value = kind;
    this.input.direction.value = String(directionDeg);
    this.refresh();
    this.input.offset.value = String(offsetM);
    this.refresh();
  }

  get showsMesh(): boolean {
    return this.input.mesh.checked;
  }
  set showsMesh(shows: boolean) {
    this.input.mesh.checked = shows;
  }
  get showsSurfaces(): boolean {
    return this.input.surfaces.checked;
  }
  set showsSurfaces(shows: boolean) {
    this.input.surfaces.checked = shows;
  }
  get field(): number {
    return Number(this.input.colour.value);
  }
  set field(field: number) {
    this.input.colour.value = String(field);
    this.refresh();
  }
  get stretch(): number {
    return Number(this.input.stretch.value);
  }

  set stats(text: string) {
    element('stats').textContent = text;
  }

  /** Ranges and texts follow the values. */
  private refresh(): void {
    const {data, input} = this;
    const isLevel = input.kind.value === 'level';
    input.direction.disabled = isLevel;
    const most = reach(planeOf(this.section), data.halfSize);
    input.offset.min = String(-most);
    input.offset.max = String(most);
    element('direction-text').textContent = isLevel ? '' : `${input.direction.value}°`;
    const at = Number(input.offset.value) + (isLevel ? data.middle[2] : 0);
    element('offset-text').textContent = `${at.toFixed(0)} m${isLevel ? '' : ' from the middle'}`;
    element('stretch-text').textContent = `× ${this.stretch.toFixed(1)}`;
    this.legend();
  }

  private legend(): void {
    const {materials, fields} = this.data;
    const field = fields[this.field];
    const rows = materials
      .map((material, m) => ({...material, color: materialColor(m)}))
      .filter(({isEmpty}) => !field || isEmpty)
      .map(({name, color}) => {
        const swatch = Object.assign(document.createElement('span'), {className: 'swatch'});
        swatch.style.background = color;
        const row = document.createElement('li');
        row.append(swatch, name);
        return row;
      });
    if (field) rows.push(this.ramp(field));
    element('legend').replaceChildren(...rows);
  }

  private ramp({unit, range}: VolumeData['fields'][number]): HTMLLIElement {
    const row = document.createElement('li');
    const bar = Object.assign(document.createElement('div'), {className: 'ramp'});
    const stops = [0, 0.25, 0.5, 0.75, 1].map(rampColor);
    bar.style.background = `linear-gradient(to right, ${stops.join(', ')})`;
    const ends = Object.assign(document.createElement('div'), {className: 'ends'});
    for (const value of range) {
      ends.append(
        Object.assign(document.createElement('span'), {
          textContent: `${Number(value.toPrecision(5))} ${unit}`,
        }),
      );
    }
    row.append(bar, ends);
    return row;
  }
}
