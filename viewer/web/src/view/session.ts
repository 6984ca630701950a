// One open data set: the viewer, and all the page's controls around it.
import type {Theme} from '../core/daylight';
import {poseAt, type Waypoint} from '../core/camera_path';
import {lengthText} from '../core/round_numbers';
import {kDefaults, readPermalink, writePermalink, type Settings} from '../core/settings';
import type {Source} from '../core/source';
import type {Tileset} from '../core/tileset';
import {showLegend} from './legend';
import {Measure} from './measure';
import {element, showError} from './page';
import {Panel} from './panel';
import {heightOf, placeText, showCompass, showScale} from './reads';
import {Viewer} from './viewer';

const kLinkDelayMs = 300;
/** Pixels that a click may move. */
const kClickPx = 4;

export class Session {
  readonly viewer: Viewer;
  settings: Settings;
  private readonly panel: Panel;
  private readonly measure: Measure;
  private readonly prefersDark = matchMedia('(prefers-color-scheme: dark)');
  private cursor: {right: number; up: number} | undefined;
  private linkTimer = 0;
  private linkAtMs = 0;
  private offersImagery: boolean | undefined;
  private namesWater = false;
  /** Whether the look is the user's, or that of a permalink. */
  private hasChosen = location.hash.includes('look=');

  constructor(
    private readonly canvas: HTMLCanvasElement,
    source: Source,
    private readonly tileset: Tileset,
    first: {readonly settings: Settings; readonly antialias: boolean},
  ) {
    const {settings, pose} = readPermalink(location.hash.slice(1), first.settings);
    this.settings = settings;
    this.viewer = new Viewer(canvas, source, tileset, {
      ...{settings, theme: this.theme, antialias: first.antialias},
      onFrame: () => this.onFrame(),
    });
    if (pose) this.viewer.setPose(pose);
    this.panel = new Panel(settings, {
      onChange: (change) => {
        this.hasChosen ||= 'look' in change;
        this.set({...this.settings, ...change});
      },
      onFreeze: (on) => this.viewer.setFrozen(on),
    });
    this.measure = new Measure(canvas, {
      surface: () => this.viewer.surface(),
      heightOf: (place) => heightOf(place, tileset.frame),
      screenOf: (place) => this.viewer.screenOf(place),
    });
    this.bindTools();
    this.bindCanvas();
    this.prefersDark.addEventListener('change', () => this.set(this.settings));
    addEventListener('hashchange', () => this.onHashChange());
    element('tools').hidden = false;
    element('reads').hidden = false;
    element('attribution').textContent = tileset.attribution;
    this.set(settings);
  }

  /** What the user chose, else what the system prefers. */
  get theme(): Theme {
    return this.settings.theme ?? (this.prefersDark.matches ? 'dark' : 'light');
  }

  set(settings: Settings): void {
    this.settings = settings;
    this.panel.showTheme(this.theme);
    this.panel.showSettings(settings);
    this.showLegend();
    this.viewer.setTheme(this.theme);
    this.viewer.apply(settings);
    this.linkSoon();
  }

  /** Flies along a path; resolves at its end. */
  async play(path: readonly Waypoint[]): Promise<void> {
    const beginMs = performance.now();
    const endS = path[path.length - 1]!.s;
    for (let s = 0; s < endS; s = (performance.now() - beginMs) / 1000) {
      this.viewer.setPose(poseAt(path, s));
      await new Promise((resolve) => requestAnimationFrame(resolve));
    }
    this.viewer.setPose(poseAt(path, endS));
  }

  private onFrame(): void {
    const stats = this.viewer.stats();
    this.panel.showFigures(stats);
    if (this.viewer.hasImagery !== this.offersImagery) this.offerImagery();
    if (this.viewer.hasWater !== this.namesWater) this.showLegend();
    const {contours} = this.settings;
    this.panel.showContourInterval(contours ? lengthText(this.viewer.contourM) : '');
    showError(this.viewer.failureText());
    showScale(this.viewer.metresPerPx());
    showCompass(this.viewer.navigation.pose.headingDeg);
    element('fly').setAttribute('aria-pressed', String(this.viewer.navigation.isFlying));
    this.showCursor();
    this.measure.follow();
    this.linkSoon();
  }

  private showLegend(): void {
    const {look, tolerancePx} = this.settings;
    this.namesWater = this.viewer.hasWater;
    showLegend(look, this.tileset, {tolerancePx, hasWater: this.namesWater});
  }

  /** The first tile with an image or colours has come: that is what people want to see. */
  private offerImagery(): void {
    this.offersImagery = this.viewer.hasImagery;
    this.panel.offerImagery(this.offersImagery);
    const {look} = this.settings;
    if (!this.offersImagery || this.hasChosen || look !== kDefaults.look) return;
    this.set({...this.settings, look: 'imagery'});
  }

  private showCursor(): void {
    const point = this.cursor && this.viewer.pick(this.cursor.right, this.cursor.up);
    element('cursor').textContent = point ? placeText(point, this.tileset) : '';
  }

  private bindTools(): void {
    const {navigation} = this.viewer;
    const zoom = (factor: number) => navigation.zoomSoon(navigation.pivotAt(0, 0), factor);
    const actions: Record<string, () => void> = {
      north: () => navigation.faceNorth(),
      'zoom-in': () => zoom(0.6),
      'zoom-out': () => zoom(1 / 0.6),
      home: () => navigation.home(),
      fly: () => navigation.toggleFlying(),
      picture: () => void this.savePicture(),
      full: () => void toggleFullScreen(),
      theme: () => this.set({...this.settings, theme: this.theme === 'dark' ? 'light' : 'dark'}),
      help: () => element<HTMLDialogElement>('keys').showModal(),
    };
    for (const [id, act] of Object.entries(actions)) element(id).addEventListener('click', act);
    addEventListener('keydown', (event) => this.onKey(event));
  }

  private onKey(event: KeyboardEvent): void {
    const isTyping = event.target instanceof HTMLInputElement && event.target.type === 'text';
    if (event.ctrlKey || event.metaKey || event.altKey || isTyping) return;
    const actions: Record<string, () => void> = {
      '?': () => element<HTMLDialogElement>('keys').showModal(),
      m: () => this.measure.toggle(),
      p: () => void this.savePicture(),
      c: () => this.set({...this.settings, contours: !this.settings.contours}),
      Escape: () => this.measure.toggle(false),
    };
    actions[event.key]?.();
  }

  private bindCanvas(): void {
    let down = {x: 0, y: 0};
    this.canvas.addEventListener('pointerdown', ({offsetX: x, offsetY: y}) => (down = {x, y}));
    this.canvas.addEventListener('pointermove', (event) => {
      this.cursor = this.placeOf(event);
      // a camera that moves draws anyway
      if (event.buttons === 0) this.showCursor();
    });
    this.canvas.addEventListener('pointerleave', () => {
      this.cursor = undefined;
      this.showCursor();
    });
    this.canvas.addEventListener('click', (event) => {
      const movedPx = Math.hypot(event.offsetX - down.x, event.offsetY - down.y);
      if (!this.measure.active || movedPx > kClickPx) return;
      const {right, up} = this.placeOf(event);
      const point = this.viewer.pick(right, up);
      if (point) this.measure.add(point.place);
    });
  }

  private placeOf({offsetX, offsetY}: MouseEvent): {right: number; up: number} {
    const {clientWidth, clientHeight} = this.canvas;
    return {right: (2 * offsetX) / clientWidth - 1, up: 1 - (2 * offsetY) / clientHeight};
  }

  private async savePicture(): Promise<void> {
    this.viewer.redraw();
    const blob = await new Promise<Blob | null>((resolve) => this.canvas.toBlob(resolve));
    if (!blob) return;
    const link = document.createElement('a');
    link.href = URL.createObjectURL(blob);
    link.download = 'terrane.png';
    link.click();
    URL.revokeObjectURL(link.href);
  }

  /** Keeps the address up to date, but not at every frame: browsers refuse that. */
  private linkSoon(): void {
    this.linkAtMs = performance.now() + kLinkDelayMs;
    if (this.linkTimer === 0) this.linkLater();
  }

  private linkLater(): void {
    const waitMs = this.linkAtMs - performance.now();
    if (waitMs > 0) {
      this.linkTimer = window.setTimeout(() => this.linkLater(), waitMs);
      return;
    }
    this.linkTimer = 0;
    const {navigation} = this.viewer;
    const pose = navigation.hasMoved ? {pose: navigation.pose} : {};
    const text = writePermalink({settings: this.settings, ...pose});
    if (text !== location.hash.slice(1)) history.replaceState(null, '', `#${text}`);
  }

  private onHashChange(): void {
    const {settings, pose} = readPermalink(location.hash.slice(1));
    this.set(settings);
    if (pose) this.viewer.setPose(pose);
  }
}

function toggleFullScreen(): Promise<void> {
  const isFull = document.fullscreenElement !== null;
  return isFull ? document.exitFullscreen() : document.documentElement.requestFullscreen();
}
