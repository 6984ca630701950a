// The controls and figures over the picture. The elements are in index.html.

/** What the user can set. */
export interface PanelEvents {
  readonly onTolerance: (tolerancePx: number) => void;
  readonly onWireframe: (on: boolean) => void;
  readonly onLevelColors: (on: boolean) => void;
}

/** The figures of one frame. */
export interface PanelFigures {
  readonly tiles: number;
  readonly triangles: number;
  readonly levels: Readonly<Record<number, number>>;
  /** Undefined while nothing moves: then nothing is drawn. */
  readonly framesPerS: number | undefined;
  /** Infinity while only the root is shown. */
  readonly shownTolerancePx: number;
  /** Share of the wanted tiles that are here, 0 to 1. */
  readonly loadedShare: number;
}

const kFinestPx = 0.5;
const kCoarsestPx = 16;

export class Panel {
  private readonly stats = element('stats');
  private readonly error = element('error');
  private readonly loading = element('loading').firstElementChild as HTMLElement;

  constructor(tolerancePx: number, events: PanelEvents) {
    this.bindTolerance(tolerancePx, events.onTolerance);
    bindCheckbox('wireframe', events.onWireframe);
    bindCheckbox('levels', events.onLevelColors);
  }

  show(figures: PanelFigures): void {
    const levels = Object.entries(figures.levels).map(([level, tiles]) => `${level}: ${tiles}`);
    const shown = Number.isFinite(figures.shownTolerancePx)
      ? `${figures.shownTolerancePx.toFixed(1)} px`
      : 'coarsest level';
    const {framesPerS} = figures;
    const rate = framesPerS === undefined ? 'still' : `${framesPerS.toFixed(0)} fps`;
    this.stats.textContent =
      `${figures.triangles.toLocaleString('en')} triangles, ${figures.tiles} tiles\n` +
      `tiles by level: ${levels.join(', ') || 'none'}\n` +
      `shown: ${shown}, ${rate}`;
    this.loading.style.width = figures.loadedShare < 1 ? `${100 * figures.loadedShare}%` : '0';
  }

  /** Says what went wrong; an empty message takes the line away. */
  showError(message: string): void {
    showError(this.error, message);
  }

  private bindTolerance(tolerancePx: number, onTolerance: (px: number) => void): void {
    const slider = element('tolerance') as HTMLInputElement;
    const text = element('tolerance-text');
    // equal steps of the slider are equal factors
    Object.assign(slider, {min: Math.log2(kFinestPx), max: Math.log2(kCoarsestPx), step: 0.25});
    slider.value = String(Math.log2(tolerancePx));
    const label = () => (text.textContent = `${(2 ** Number(slider.value)).toFixed(1)} px`);
    label();
    slider.addEventListener('input', () => {
      label();
      onTolerance(2 ** Number(slider.value));
    });
  }
}

/** Shows a message when there is no panel yet. */
export function showFatal(message: string): void {
  showError(element('error'), message);
}

function showError(line: HTMLElement, message: string): void {
  line.textContent = message;
  line.hidden = message === '';
}

function bindCheckbox(id: string, onChange: (on: boolean) => void): void {
  const box = element(id) as HTMLInputElement;
  box.addEventListener('change', () => onChange(box.checked));
}

function element(id: string): HTMLElement {
  const found = document.getElementById(id);
  if (!found) throw new Error(`index.html has no element #${id}`);
  return found;
}
