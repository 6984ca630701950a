import {contoursFor} from '../core/contours';
import {daylight, type Theme} from '../core/daylight';
import type {Camera} from '../core/first_camera';
import type {Pose} from '../core/pose';
import {pixelsPerRadian} from '../core/ranges';
import {checkSeams, type SeamReport} from '../core/seams';
import {kDefaults, kLooks, type Settings} from '../core/settings';
import type {Source} from '../core/source';
import {readBelow} from '../core/subtree';
import {Streamer, type Frame} from '../core/streamer';
import {Surface, type SurfacePoint} from '../core/surface';
import {diagonal, distanceToBox} from '../core/box';
import type {Tile, Tileset} from '../core/tileset';
import {length, subtract, type Vec3} from '../core/vec3';
import {Navigation} from './navigation';
import {setDaylight} from './terrain_material';
import {kFovDeg, TerrainView, type Drawn} from './terrain_view';
import {completeTargets, disposeContent, makeContent, type TileContent} from './tile_content';
import {TileDecoder} from './tile_decoder';

/** The figures of the last frame. */
export interface ViewerStats extends Drawn {
  /** Tiles that could not be loaded and wait for another try. */
  readonly failed: number;
  /** Requests for tiles so far. */
  readonly requests: number;
  readonly cachedBytes: number;
  /** Largest error on the screen of the tiles in the picture that have finer ones below. */
  readonly shownTolerancePx: number;
  readonly loadedShare: number;
  /** Places where detail is held back. */
  readonly holdbacks: number;
  /** What the page's own thread worked on a tile that came in: milliseconds, the mean. */
  readonly tileMs: number;
  /** Milliseconds between the last pictures; undefined while nothing moves. */
  readonly frameMs: number | undefined;
}

export interface ViewerOptions {
  readonly settings: Settings;
  readonly theme: Theme;
  readonly antialias: boolean;
  /** Called after each picture. */
  readonly onFrame: () => void;
}

/** Eye over ground, in distances of two samples. */
const kClearanceCells = 0.2;

/** Far terrain fades to about a fifth at this many diagonals of the data set. */
const kHazeDiagonals = 1.9;

/** Everything between a canvas and a tileset. Draws only when something has changed. */
export class Viewer {
  readonly navigation: Navigation;
  hasImagery = false;
  hasWater = false;
  private readonly view: TerrainView;
  private readonly streamer: Streamer<TileContent>;
  private readonly decoder = new TileDecoder();
  private settings: Settings = kDefaults;
  private theme: Theme;
  private frame: Frame | undefined;
  private surfaceOfFrame: Surface | undefined;
  private drawn: Drawn = {tiles: 0, triangles: 0, levels: {}};
  private frozenEye: Vec3 | undefined;
  private scheduled = 0;
  private retryTimer = 0;
  private isMoving = true;
  private lastMs = 0;
  private frameMs: number | undefined;
  private tilesMs = 0;
  private tilesMade = 0;
  private waiting: (() => void)[] = [];

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly source: Source,
    private readonly tileset: Tileset,
    private readonly options: ViewerOptions,
  ) {
    const invalidate = () => this.invalidate();
    this.theme = options.theme;
    this.view = new TerrainView(canvas, tileset, options.antialias);
    const clearanceM = kClearanceCells * tileset.cellM;
    const ground = {
      pick: (right: number, up: number) => this.seen(this.pick(right, up)?.place),
      direction: (right: number, up: number) => this.view.directionTo(right, up),
      heightAt: (x: number, y: number) => this.seenHeightAt(x, y),
    };
    this.navigation = new Navigation(canvas, tileset.root.box, clearanceM, ground, invalidate);
    this.streamer = new Streamer(tileset, (tile, signal) => this.load(tile, signal), {
      onDrop: disposeContent,
      onChange: invalidate,
    });
    this.apply(options.settings);
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.resize();
  }

  /** Resolves when all wanted detail is on the screen. */
  ready(): Promise<void> {
    return new Promise((resolve) => {
      this.waiting.push(resolve);
      this.invalidate();
    });
  }

  setPose(pose: Pose): void {
    this.change(() => this.navigation.set(pose));
  }

  setCamera(camera: Camera): void {
    this.change(() => this.navigation.setCamera(camera));
  }

  apply(settings: Settings): void {
    this.change(() => {
      if (settings.exaggeration !== this.settings.exaggeration) {
        this.navigation.setExaggeration(settings.exaggeration);
      }
      this.settings = settings;
      this.view.overlays = {triangles: settings.wireframe, borders: settings.borders};
      const {shared} = this.view;
      shared.look.value = kLooks.indexOf(settings.look);
      shared.contourStrength.value = settings.contours ? 1 : 0;
      shared.hazePerM.value = settings.haze
        ? 1 / (kHazeDiagonals * diagonal(this.tileset.root.box))
        : 0;
      this.applyLight();
    });
  }

  setTheme(theme: Theme): void {
    this.change(() => {
      this.theme = theme;
      this.applyLight();
    });
  }

  /** Keeps what is shown as it is while the camera moves on. */
  setFrozen(on: boolean): void {
    this.change(() => (this.frozenEye = on ? this.trueEye() : undefined));
  }

  setBackdrop(color: number | null): void {
    this.change(() => this.view.setBackdrop(color));
  }

  stats(): ViewerStats {
    const {failures, requests, cachedBytes} = this.streamer;
    const {frame} = this;
    const shownTolerancePx = () => this.shownTolerancePx();
    return {
      ...this.drawn,
      failed: failures.size,
      requests,
      cachedBytes,
      // worked out for those who read it only: all boxes are looked at for it
      get shownTolerancePx() {
        return shownTolerancePx();
      },
      loadedShare: frame ? frame.loaded / frame.wanted : 0,
      holdbacks: frame?.holdbacks.length ?? 0,
      tileMs: this.tilesMs / Math.max(1, this.tilesMade),
      frameMs: this.isMoving ? this.frameMs : undefined,
    };
  }

  /** What could not be loaded, in words; empty if all went well. */
  failureText(): string {
    const [failure, ...others] = this.streamer.failures.values();
    const more = others.length > 0 ? ` and ${others.length} more` : '';
    return failure ? `Shown coarser, will be tried again: ${failure.message}${more}` : '';
  }

  /** Draws now and compares the seams of the whole cut, also outside the picture. */
  checkSeams(): SeamReport {
    const frame = this.redraw();
    const tiles = frame.cut.map((tile) => {
      const {x, y} = tile;
      const octave = Math.floor(tile.level / this.tileset.levelsPerOctave);
      return {octave, x, y, ...this.view.shownTile(tile, this.contentOf(tile), frame)};
    });
    return checkSeams(tiles, this.tileset.cellM);
  }

  /** Draws now; the canvas can be read until the current task ends. */
  redraw(elapsedS = 0): Frame {
    const isTurning = this.navigation.step(elapsedS);
    const {exaggeration} = this.settings;
    this.view.aim(this.navigation.pose, exaggeration, this.navigation.heightOverGround());
    this.surfaceOfFrame = undefined; // it counts from the render origin
    this.view.shared.errorPerM.value = this.pixelScale() / this.settings.tolerancePx;
    this.showContours();
    const frame = this.update();
    this.frame = frame;
    this.surfaceOfFrame = undefined;
    this.drawn = this.view.draw(frame, (tile) => this.contentOf(tile));
    this.isMoving = isTurning || frame.gliding;
    return frame;
  }

  /** The terrain as it is shown now. */
  surface(): Surface {
    this.surfaceOfFrame ??= new Surface(this.frame?.cut ?? [], this.view.renderOrigin, (tile) =>
      this.view.shownTile(tile, this.contentOf(tile), this.frame!),
    );
    return this.surfaceOfFrame;
  }

  /** The terrain at a place of the picture, -1 to 1 to the right and up. */
  pick(right: number, up: number): SurfacePoint | undefined {
    const {exaggeration} = this.settings;
    const [x, y, z] = this.view.directionTo(right, up);
    // the seen world is the true one, stretched: so are its rays
    const direction: Vec3 = [x, y, z / exaggeration];
    return this.surface().hit(this.trueEye(), direction);
  }

  screenOf(place: Vec3): {x: number; y: number} | undefined {
    const found = this.view.screenOf(place);
    const {clientWidth, clientHeight} = this.canvas;
    return (
      found && {
        x: ((1 + found.right) * clientWidth) / 2,
        y: ((1 - found.up) * clientHeight) / 2,
      }
    );
  }

  /** What a pixel covers where the middle of the picture meets the terrain. */
  metresPerPx(): number {
    const {pose} = this.navigation;
    const awayM = length(subtract(this.navigation.pivotAt(0, 0), pose.eye));
    return awayM / pixelsPerRadian(this.canvas.clientHeight, kFovDeg);
  }

  private async load(tile: Tile, signal: AbortSignal): Promise<TileContent> {
    if (tile.below) await readBelow(tile, (url) => this.source.read(url, signal));
    const file = await this.source.read(tile.url, signal);
    try {
      const decoded = await this.decoder.decode(file, this.tileset.levels[tile.level]!.stepM);
      const beginMs = performance.now();
      const content = makeContent(decoded, tile, this.tileset.levels, this.view.shared);
      this.hasImagery ||= content.hasDrape;
      this.hasWater ||= content.hasWater;
      const parent = tile.parent && this.streamer.content(tile.parent);
      if (parent || !tile.parent) completeTargets(content, parent ?? undefined);
      this.tilesMs += performance.now() - beginMs;
      ++this.tilesMade;
      return content;
    } catch (error) {
      throw new Error(`${tile.url}: ${error instanceof Error ? error.message : String(error)}`);
    }
  }

  private update(): Frame {
    const isInPicture = this.view.pictureTest();
    const view = {
      eye: this.frozenEye ?? this.trueEye(),
      pixelScale: this.pixelScale(),
      tolerancePx: this.settings.tolerancePx,
      isInPicture: (tile: Tile) => isInPicture(tile.box),
    };
    return this.streamer.update(view, performance.now() / 1000);
  }

  /** Pixels of a metre of height error at a metre's distance; drawn higher, it shows more. */
  private pixelScale(): number {
    const scale = pixelsPerRadian(this.canvas.clientHeight, kFovDeg);
    return scale * Math.max(1, this.settings.exaggeration);
  }

  private shownTolerancePx(): number {
    if (!this.frame || this.frame.cut.length === 0) return Infinity;
    const isInPicture = this.view.pictureTest();
    const clearanceM = this.navigation.heightOverGround();
    const errors = this.frame.cut
      .filter((tile) => tile.children.length > 0 && isInPicture(tile.box))
      .map((tile) => {
        const awayM = distanceToBox(tile.box, this.frame!.eye);
        const errorM = this.tileset.levels[tile.level]!.toleranceM;
        return (errorM * this.pixelScale()) / Math.max(awayM, clearanceM);
      });
    return Math.max(0, ...errors);
  }

  private showContours(): void {
    if (!this.settings.contours) return;
    const {intervalM, nextIntervalM, blend} = contoursFor(this.metresPerPx());
    this.view.shared.contours.value.set(intervalM, nextIntervalM, blend);
  }

  /** The interval of the contours in the last picture, in metres. */
  get contourM(): number {
    return this.view.shared.contours.value.x;
  }

  private applyLight(): void {
    const {frame} = this.tileset;
    const latitudeDeg = frame.kind === 'enu' ? frame.latitudeDeg : 45;
    const light = daylight(this.settings.hour, latitudeDeg, this.theme);
    setDaylight(this.view.shared, light, this.settings.hour === null ? 0 : 1);
  }

  private onAnimationFrame(): void {
    this.scheduled = 0;
    const nowMs = performance.now();
    const elapsedMs = nowMs - this.lastMs;
    this.lastMs = nowMs;
    // a long pause may be that of a page in the background, not of slow drawing
    const isTimed = this.isMoving && elapsedMs < 1000;
    this.frameMs = isTimed ? 0.9 * (this.frameMs ?? elapsedMs) + 0.1 * elapsedMs : undefined;
    const frame = this.redraw(this.isMoving ? Math.min(0.1, elapsedMs / 1000) : 1 / 60);
    this.options.onFrame();
    this.retryLater();
    if (this.isMoving) this.invalidate();
    if (frame.settled) for (const resolve of this.waiting.splice(0)) resolve();
  }

  private retryLater(): void {
    if (this.retryTimer !== 0) clearTimeout(this.retryTimer);
    this.retryTimer = 0;
    const waitS = this.streamer.nextRetryS - performance.now() / 1000;
    if (Number.isFinite(waitS)) {
      this.retryTimer = window.setTimeout(() => this.invalidate(), 1000 * Math.max(0, waitS) + 10);
    }
  }

  private contentOf(tile: Tile): TileContent {
    const content = this.streamer.content(tile);
    if (!content) throw new Error(`tile ${tile.key} is shown but not loaded`);
    return content;
  }

  /** The eye in the true world; the camera moves in the seen one. */
  private trueEye(): Vec3 {
    const [x, y, z] = this.navigation.pose.eye;
    return [x, y, z / this.settings.exaggeration];
  }

  private seen(place: Vec3 | undefined): Vec3 | undefined {
    return place && [place[0], place[1], place[2] * this.settings.exaggeration];
  }

  private seenHeightAt(x: number, y: number): number | undefined {
    const z = this.surface().heightAt(x, y);
    return z === undefined ? undefined : z * this.settings.exaggeration;
  }

  private resize(): void {
    const {clientWidth, clientHeight} = this.canvas;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.change(() => {
      this.view.resize(clientWidth, clientHeight, window.devicePixelRatio);
      this.navigation.resize(clientWidth / clientHeight);
    });
  }

  private change(apply: () => void): void {
    apply();
    this.invalidate();
  }

  private invalidate(): void {
    if (this.scheduled === 0) {
      this.scheduled = requestAnimationFrame(() => this.onAnimationFrame());
    }
  }
}
