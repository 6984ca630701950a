// The page of a merge tree (`?tree=`): a chunk of its own, loaded where a tree is asked for.
import {PerspectiveCamera, Vector3, WebGLRenderer} from 'three';
import {OrbitControls} from 'three/examples/jsm/controls/OrbitControls.js';
import {add, scale, subtract, type Vec3} from '../core/vec3';
import {element, showError} from '../view/page';
import {TreePanel, type PanelFigures} from './tree_panel';
import {TreeScene} from './tree_scene';
import {criteriaOf, kMorphFrames, kTreeDefaults, toLight, type TreeSettings} from './tree_settings';
import {loadEngine, type TreeCamera, type TreeSummary, type ViewEngine} from './view_engine';

/** What tests and the console can do: `window.terraneTree`. */
export interface TerraneTreeApi {
  /** Resolves when the mesh is what camera and settings ask for. */
  ready(): Promise<void>;
  /** Places of the mesh's frame. */
  setCamera(camera: {eye: Vec3; target: Vec3}): void;
  set(change: Partial<TreeSettings>): void;
  settings(): TreeSettings;
  summary(): TreeSummary;
  stats(): PanelFigures;
  /** Corners of the triangles that show, nine numbers each, in the mesh's frame. */
  corners(): number[];
  /** Draws; the canvas can be read until the current task ends. */
  redraw(): void;
}

declare global {
  interface Window {
    terraneTree?: TerraneTreeApi;
  }
}

const kFovDeg = 45;
/** A budget that swings is given up after so many frames. */
const kMostFrames = 120;

class TreePage {
  private readonly renderer: WebGLRenderer;
  private readonly camera = new PerspectiveCamera(kFovDeg);
  private readonly controls: OrbitControls;
  private readonly view: TreeScene;
  private readonly panel: TreePanel;
  private settings = kTreeDefaults;
  private figures: PanelFigures | undefined;
  private waiting: (() => void)[] = [];
  private framesLeft = kMostFrames;
  private scheduled = false;

  constructor(
    private readonly canvas: HTMLCanvasElement,
    private readonly engine: ViewEngine,
    private readonly summary: TreeSummary,
    name: string,
    {antialias, up}: {antialias: boolean; up: Vec3},
  ) {
    this.view = new TreeScene(summary.hasColours);
    this.renderer = new WebGLRenderer({canvas, antialias});
    this.renderer.setClearColor(0xeef1f3);
    this.panel = new TreePanel(name, summary, (change) => this.set(change));
    document.title = this.panel.title;
    this.camera.up.fromArray(up);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => this.onCamera());
    const {middle, reach} = summary;
    // as view-cut does: south and above
    this.setCamera({eye: add(middle, scale([0, -2, 1], reach)), target: middle});
    new ResizeObserver(() => this.resize()).observe(canvas);
    this.set({});
  }

  api(): TerraneTreeApi {
    return {
      ready: () => this.ready(),
      setCamera: (camera) => this.setCamera(camera),
      set: (change) => this.set(change),
      settings: () => this.settings,
      summary: () => this.summary,
      stats: () => this.figures!,
      corners: () => {
        const {origin} = this.summary;
        return this.view.cornersShown().map((x, i) => x + origin[i % 3]!);
      },
      redraw: () => this.redraw(),
    };
  }

  set(change: Partial<TreeSettings>): void {
    const before = this.settings;
    this.settings = {...before, ...change};
    const {settings} = this;
    this.engine.setCriteria(criteriaOf(settings));
    if (settings.budget !== before.budget) this.engine.setBudget(settings.budget);
    if (settings.blend !== before.blend) {
      this.engine.setMorphFrames(settings.blend ? kMorphFrames : 0);
    }
    if (settings.frozen !== before.frozen) this.freeze(settings.frozen);
    this.view.toLight = toLight(settings);
    this.view.wireframe = settings.wireframe;
    this.panel.showSettings(settings);
    this.invalidate();
  }

  private freeze(on: boolean): void {
    if (on) this.view.showEye(this.camera, 2 * this.summary.reach);
    else this.view.showEye(undefined, 0);
  }

  private setCamera({eye, target}: {eye: Vec3; target: Vec3}): void {
    const {origin} = this.summary;
    this.controls.target.fromArray(subtract(target, origin));
    this.camera.position.fromArray(subtract(eye, origin));
    this.exact = {eye, target};
    this.controls.update();
    this.exact = {eye, target};
    this.invalidate();
  }

  /** Of the last setCamera(), while nothing else has moved the camera: orbiting rounds. */
  private exact: {eye: Vec3; target: Vec3} | undefined;

  private onCamera(): void {
    this.exact = undefined;
    this.invalidate();
  }

  private engineCamera(): TreeCamera {
    const {origin} = this.summary;
    const placed = (v: Vector3) => add(v.toArray() as unknown as Vec3, origin);
    const {eye, target} = this.exact ?? {
      eye: placed(this.camera.position),
      target: placed(this.controls.target),
    };
    const {clientWidth, clientHeight} = this.canvas;
    const up = this.camera.up.toArray() as unknown as Vec3;
    return {eye, target, up, fovDeg: kFovDeg, widthPx: clientWidth, heightPx: clientHeight};
  }

  private async ready(): Promise<void> {
    this.invalidate();
    return new Promise((resolve) => this.waiting.push(resolve));
  }

  private update(): void {
    const {engine, view} = this;
    const before = performance.now();
    engine.look(this.engineCamera());
    const figures = engine.update();
    const updateMs = performance.now() - before;
    view.follow(engine, figures.triangles);
    this.figures = {...figures, updateMs, uploadedBytes: view.uploadedBytes};
    this.panel.showFigures(this.figures);
  }

  private onAnimationFrame(): void {
    this.scheduled = false;
    if (this.canvas.clientWidth === 0) return;
    if (!this.settings.frozen) this.update();
    this.redraw();
    const isSettled = this.settings.frozen || this.figures!.isSettled;
    if (!isSettled && --this.framesLeft > 0) this.schedule();
    else for (const resolve of this.waiting.splice(0)) resolve();
  }

  private redraw(): void {
    const {camera, summary} = this;
    const away = camera.position.distanceTo(new Vector3(...subtract(summary.middle, summary.origin)));
    // as near as the model may be, but not so near that depths run together
    camera.near = Math.max(away - summary.reach, 0.002 * summary.reach);
    camera.far = away + 5 * summary.reach;
    camera.updateProjectionMatrix();
    this.renderer.render(this.view.scene, camera);
  }

  private resize(): void {
    const {clientWidth, clientHeight} = this.canvas;
    if (clientWidth === 0 || clientHeight === 0) return;
    this.renderer.setPixelRatio(window.devicePixelRatio);
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / clientHeight;
    this.invalidate();
  }

  private invalidate(): void {
    this.framesLeft = kMostFrames;
    this.schedule();
  }

  private schedule(): void {
    if (this.scheduled) return;
    this.scheduled = true;
    requestAnimationFrame(() => {
      try {
        this.onAnimationFrame();
      } catch (error) {
        showError(error instanceof Error ? error.message : String(error));
      }
    });
  }
}

async function fetchBytes(url: string): Promise<Uint8Array> {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: status ${response.status}`);
  return new Uint8Array(await response.arrayBuffer());
}

/**
 * Shows a tree. URL parameters: tree (its address, from the page), up (`y` for models that stand on
 * the x-z plane), antialias (`off`).
 */
export async function showTree(parameters: URLSearchParams): Promise<void> {
  const url = new URL(parameters.get('tree')!, location.href).href;
  const [engine, bytes] = await Promise.all([
    loadEngine(new URL('assets/view_engine.js', document.baseURI).href),
    fetchBytes(url),
  ]);
  const name = decodeURIComponent(url.split('/').pop()!);
  let summary: TreeSummary;
  try {
    summary = engine.open(bytes);
  } catch (error) {
    throw new Error((error as Error).message.replace(/^tree:/, `${name}:`));
  }
  const canvas = element<HTMLCanvasElement>('terrain');
  canvas.setAttribute('aria-label', 'Model. Drag to turn, right drag to move, wheel to zoom.');
  const page = new TreePage(canvas, engine, summary, name.replace(/\.tree$/, ''), {
    antialias: parameters.get('antialias') !== 'off',
    up: parameters.get('up') === 'y' ? [0, 1, 0] : [0, 0, 1],
  });
  window.terraneTree = page.api();
}
