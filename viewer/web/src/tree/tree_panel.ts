// The settings and figures of the page of trees, in the viewer's panel.
import {bytesText} from '../core/round_numbers';
import {element} from '../view/page';
import type {TreeSettings} from './tree_settings';
import type {FrameFigures, TreeSummary} from './view_engine';

const kHtml = /* html */ `
  <details id="panel-fold" open>
    <summary><h1 id="title"></h1></summary>
    <div class="row">
      <label for="measure">At most</label>
      <select id="measure">
        <option value="error">pixels of error</option>
        <option value="length">pixels of edge (published)</option>
      </select>
    </div>
    <label for="tolerancePx">Tolerance <output id="tolerancePx-text"></output></label>
    <input id="tolerancePx" type="range" min="-2" max="7" step="0.25" />
    <div class="checks">
      <label><input id="frustum" type="checkbox" /> Picture only</label>
      <label><input id="backFaces" type="checkbox" /> Coarse back</label>
      <label><input id="silhouettes" type="checkbox" /> Silhouettes</label>
      <label><input id="highlight" type="checkbox" /> Highlight</label>
      <label id="colours-label"><input id="colours" type="checkbox" /> Colours</label>
      <label><input id="wireframe" type="checkbox" /> Triangles</label>
      <label><input id="blend" type="checkbox" /> Blend</label>
      <label><input id="frozen" type="checkbox" /> Freeze detail</label>
      <label><input id="hasBudget" type="checkbox" /> Budget</label>
    </div>
    <div id="budget-row">
      <label for="budget">Triangles at most <output id="budget-text"></output></label>
      <input id="budget" type="range" step="0.05" />
    </div>
    <label for="lightAzimuthDeg">Light from <output id="lightAzimuthDeg-text"></output></label>
    <input id="lightAzimuthDeg" type="range" min="0" max="360" step="1" />
    <label for="lightHeightDeg">Its height <output id="lightHeightDeg-text"></output></label>
    <input id="lightHeightDeg" type="range" min="-90" max="90" step="1" />
    <dl id="stats"></dl>
  </details>`;

const kTicks = [
  ...['frustum', 'backFaces', 'silhouettes', 'highlight'],
  ...['colours', 'wireframe', 'blend', 'frozen'],
] as (keyof TreeSettings & string)[];

/** Figures of a frame, and what it cost the page. */
export interface PanelFigures extends FrameFigures {
  readonly updateMs: number;
  readonly uploadedBytes: number;
}

export class TreePanel {
  private readonly smallest: number;
  private readonly largest: number;

  constructor(
    private readonly name: string,
    private readonly summary: TreeSummary,
    private readonly onChange: (change: Partial<TreeSettings>) => void,
  ) {
    const panel = element('panel');
    panel.innerHTML = kHtml;
    panel.hidden = false;
    element('title').textContent = name;
    element('colours-label').hidden = !summary.hasColours;
    this.smallest = Math.log2(Math.max(2, summary.coarsestTriangles));
    this.largest = Math.log2(Math.max(3, summary.fullTriangles));
    Object.assign(element('budget'), {min: this.smallest, max: this.largest});
    for (const id of kTicks) this.on(id, (input) => ({[id]: input.checked}));
    this.on('measure', ({value}) => ({measure: value as TreeSettings['measure']}));
    this.on('tolerancePx', ({value}) => ({tolerancePx: 2 ** Number(value)}));
    this.on('lightAzimuthDeg', ({value}) => ({lightAzimuthDeg: Number(value)}));
    this.on('lightHeightDeg', ({value}) => ({lightHeightDeg: Number(value)}));
    for (const id of ['budget', 'hasBudget']) this.on(id, () => ({budget: this.budget()}));
  }

  private on(id: string, change: (input: HTMLInputElement) => Partial<TreeSettings>): void {
    const input = element<HTMLInputElement>(id);
    input.addEventListener('input', () => this.onChange(change(input)));
  }

  private budget(): number | null {
    const octaves = Number(element<HTMLInputElement>('budget').value);
    return element<HTMLInputElement>('hasBudget').checked ? Math.round(2 ** octaves) : null;
  }

  showSettings(settings: TreeSettings): void {
    for (const id of kTicks) element<HTMLInputElement>(id).checked = settings[id] === true;
    element<HTMLSelectElement>('measure').value = settings.measure;
    const {budget, tolerancePx} = settings;
    element<HTMLInputElement>('hasBudget').checked = budget !== null;
    element('budget-row').hidden = budget === null;
    if (budget !== null) slideTo('budget', Math.log2(budget), budget.toLocaleString('en'));
    slideTo('tolerancePx', Math.log2(tolerancePx), `${Number(tolerancePx.toPrecision(2))} px`);
    element<HTMLInputElement>('tolerancePx').disabled = budget !== null;
    for (const id of ['lightAzimuthDeg', 'lightHeightDeg'] as const) {
      slideTo(id, settings[id], `${settings[id]}°`);
    }
  }

  showFigures(figures: PanelFigures): void {
    const rows = {
      Triangles: figures.triangles.toLocaleString('en'),
      'of the model': this.summary.fullTriangles.toLocaleString('en'),
      Vertices: figures.vertices.toLocaleString('en'),
      Tolerance: `${Number(figures.tolerancePx.toPrecision(3))} px`,
      'Splits, merges': `${figures.splits}, ${figures.merges}`,
      'Looked at': figures.lookedAt.toLocaleString('en'),
      Update: `${figures.updateMs.toFixed(2)} ms`,
      Upload: bytesText(figures.uploadedBytes),
    };
    const cells = Object.entries(rows).flatMap(([term, value]) => [cell('dt', term), cell('dd', value)]);
    element('stats').replaceChildren(...cells);
  }

  /** For the page's title. */
  get title(): string {
    return `${this.name}: ${this.summary.levels} levels`;
  }
}

function slideTo(id: string, value: number, text: string): void {
  const slider = element<HTMLInputElement>(id);
  slider.value = String(value);
  slider.setAttribute('aria-valuetext', text);
  element(`${id}-text`).textContent = text;
}

function cell(tag: 'dt' | 'dd', text: string): HTMLElement {
  const made = document.createElement(tag);
  made.textContent = text;
  return made;
}
