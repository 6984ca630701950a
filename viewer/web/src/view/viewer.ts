import type {Camera} from '../core/first_camera';
import {hitDistance} from '../core/ground_hit';
import {pixelsPerRadian} from '../core/ranges';
import {checkSeams, type SeamReport} from '../core/seams';
import {Streamer, type Frame} from '../core/streamer';
import type {Tile, Tileset} from '../core/tileset';
import type {Vec3} from '../core/vec3';
import {FrameRate} from './frame_rate';
import {groundZ} from './ground';
import {Navigation} from './navigation';
import {Panel} from './panel';
import {TerrainView, type Drawn} from './terrain_view';
import {disposeContent, TileLoader, type TileContent} from './tile_content';

/** The figures of the last frame. */
export interface ViewerStats extends Drawn {
  /** Tiles that could not be loaded and wait for another try. */
  readonly failed: number;
  /** Requests for tiles so far. */
  readonly requests: number;
  /** Error on the screen that the shown cut keeps; Infinity while only the root is shown. */
  readonly shownTolerancePx: number;
}

export interface ViewerOptions {
  readonly tolerancePx: number;
  readonly antialias: boolean;
}

/** Eye over ground, in distances of two samples. */
const kClearanceCells = 0.2;

/** Everything between a canvas and a tileset. Draws only when something has changed. */
export class Viewer {
  private readonly view: TerrainView;
  private readonly navigation: Navigation;
  private readonly streamer: Streamer<TileContent>;
  private readonly panel: Panel;
  private readonly rate = new FrameRate();
  private tolerancePx: number;
  private frame: Frame | undefined;
  private drawn: Drawn = {tiles: 0, triangles: 0, levels: {}};
  private scheduled = 0;
  private retryTimer = 0;
  private isMoving = true;
  private waiting: (() => void)[] = [];

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly tileset: Tileset,
    options: ViewerOptions,
  ) {
    const invalidate = () => this.invalidate();
    this.tolerancePx = options.tolerancePx;
    this.view = new TerrainView(canvas, tileset, options.antialias);
    const hit = (direction: Vec3) => this.hitDistance(direction);
    this.navigation = new Navigation(canvas, tileset.root.box, hit, invalidate);
    const loader = new TileLoader(tileset.levels, this.view.shared);
    this.streamer = new Streamer(tileset, (tile, signal) => loader.load(tile, signal), {
      onDrop: disposeContent,
      onChange: invalidate,
    });
    this.panel = new Panel(this.tolerancePx, {
      onTolerance: (px) => this.setTolerance(px),
      onWireframe: (on) => this.change(() => this.view.setWireframe(on)),
      onLevelColors: (on) => this.change(() => this.view.setLevelColors(on)),
    });
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

  setCamera(camera: Camera): void {
    this.change(() => this.navigation.set(camera));
  }

  /** @param tolerancePx wanted error on the screen, above 0 */
  setTolerance(tolerancePx: number): void {
    this.change(() => (this.tolerancePx = tolerancePx));
  }

  stats(): ViewerStats {
    const {failures, requests} = this.streamer;
    const shownTolerancePx = this.tolerancePx / (this.frame?.share ?? 0);
    return {...this.drawn, failed: failures.size, requests, shownTolerancePx};
  }

  /** Draws now and compares the seams of the whole cut, also outside the picture. */
  checkSeams(): SeamReport {
    const frame = this.redraw();
    const tiles = frame.cut.map((tile) => this.view.drawnTile(tile, this.contentOf(tile), frame));
    return checkSeams(tiles, this.tileset.cellM);
  }

  /** Draws now; the canvas can be read until the current task ends. */
  redraw(): Frame {
    const isTurning = this.navigation.step(this.lowestEyeZ());
    const ground = this.groundBelow() ?? this.tileset.root.box.center[2];
    this.view.aim(this.navigation.camera, Math.abs(this.navigation.eye[2] - ground));
    const frame = this.update();
    this.frame = frame;
    this.drawn = this.view.draw(frame, (tile) => this.contentOf(tile));
    this.isMoving = isTurning || frame.gliding;
    return frame;
  }

  /** World z of the terrain at a place; undefined beside it or before it is loaded. */
  groundZ(x: number, y: number): number | undefined {
    return groundZ(x, y, this.frame?.cut ?? [], (tile) => this.contentOf(tile));
  }

  private groundBelow(): number | undefined {
    const [x, y] = this.navigation.eye;
    return this.groundZ(x, y);
  }

  private hitDistance(direction: Vec3): number | undefined {
    const {eye} = this.navigation;
    return hitDistance(eye, direction, this.tileset.root.box, (x, y) => this.groundZ(x, y));
  }

  private update(): Frame {
    const isInPicture = this.view.pictureTest();
    const heightPx = this.canvas.clientHeight;
    const view = {
      eye: this.navigation.eye,
      pixelScale: pixelsPerRadian(heightPx, this.navigation.camera.fov),
      tolerancePx: this.tolerancePx,
      isInPicture: (tile: Tile) => isInPicture(tile.box),
    };
    return this.streamer.update(view, performance.now() / 1000);
  }

  private onAnimationFrame(): void {
    this.scheduled = 0;
    const frame = this.redraw();
    this.rate.tick(performance.now());
    this.showFigures(frame);
    this.showFailures();
    this.retryLater();
    if (this.isMoving) this.invalidate();
    if (frame.settled) for (const resolve of this.waiting.splice(0)) resolve();
  }

  private showFigures(frame: Frame): void {
    const framesPerS = this.isMoving ? this.rate.framesPerS : undefined;
    const loadedShare = frame.loaded / frame.wanted;
    this.panel.show({...this.stats(), framesPerS, loadedShare});
  }

  private showFailures(): void {
    const [failure, ...others] = this.streamer.failures.values();
    const more = others.length > 0 ? ` and ${others.length} more` : '';
    const text = failure ? `Shown coarser, will be tried again: ${failure.message}${more}` : '';
    this.panel.showError(text);
  }

  private retryLater(): void {
    clearTimeout(this.retryTimer);
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

  private lowestEyeZ(): number {
    const ground = this.groundBelow();
    return ground === undefined ? -Infinity : ground + kClearanceCells * this.tileset.cellM;
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
