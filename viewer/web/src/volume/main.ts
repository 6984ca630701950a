import './style.css';
import {PerspectiveCamera, Vector3, WebGLRenderer} from 'three';
import {OrbitControls} from 'three/examples/jsm/controls/OrbitControls.js';
import {parseVolume, type VolumeData} from './volume_data';
import {planeOf, reach, VolumePanel, type SectionSetting} from './volume_panel';
import {VolumeScene, type CutStats} from './volume_scene';

/** What tests and the console can do: `window.terraneVolume`. */
export interface TerraneVolumeApi {
  setSection(section: SectionSetting): void;
  setMesh(shows: boolean): void;
  setSurfaces(shows: boolean): void;
  /** Number of the field that gives the colours; -1: the material does. */
  setColour(field: number): void;
  /** Places are metres from the middle of the box, z up and stretched as it is drawn. */
  setCamera(camera: {eye: number[]; target: number[]}): void;
  stats(): CutStats;
  /** Pixel of the canvas at which a place of the model shows. */
  pixelOf(place: number[]): [number, number];
  /** The place of the model in the middle of its box. */
  middle(): number[];
  /** Draws; the canvas can be read until the current task ends. */
  redraw(): void;
}

declare global {
  interface Window {
    terraneVolume?: TerraneVolumeApi;
  }
}

const kPanelPx = 240;

async function fetched(url: string): Promise<Response> {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: status ${response.status}`);
  return response;
}

/** URL parameter: volume (address of volume.json, from the page; default ./volume.json). */
async function load(): Promise<VolumeData> {
  const wanted = new URLSearchParams(location.search).get('volume') ?? './volume.json';
  const url = new URL(wanted, location.href).href;
  const [json, bin] = await Promise.all([
    fetched(url).then((response) => response.json()),
    fetched(new URL('cells.bin', url).href).then((response) => response.arrayBuffer()),
  ]);
  return parseVolume(json, bin);
}

/** The page: the volume's picture, drawn again when something has changed. */
class VolumePage {
  private readonly renderer: WebGLRenderer;
  private readonly camera = new PerspectiveCamera(35);
  private readonly controls: OrbitControls;
  private readonly volume: VolumeScene;
  private readonly panel: VolumePanel;
  private cutStats: CutStats;
  private isAsked = false;

  constructor(private readonly canvas: HTMLCanvasElement, private readonly data: VolumeData) {
    this.renderer = new WebGLRenderer({canvas, antialias: true});
    this.renderer.setClearColor(0xf3f5f6);
    this.renderer.localClippingEnabled = true;
    this.volume = new VolumeScene(data);
    this.panel = new VolumePanel(data, (what) => this.change(what));
    this.cutStats = this.volume.cut(planeOf(this.panel.section));
    this.camera.up.set(0, 0, 1);
    this.controls = new OrbitControls(this.camera, canvas);
    this.controls.addEventListener('change', () => this.ask());
    this.look();
    new ResizeObserver(() => this.resize()).observe(canvas);
    window.addEventListener('keydown', (event) => this.move(event));
    this.resize();
    this.tell();
  }

  /** From the south-south-west and above, all of the box in view. */
  private look(): void {
    this.change('look');
    const size = this.volume.toScene(this.data.halfSize).length();
    this.camera.near = size / 1000;
    this.camera.far = size * 20;
    this.camera.position.set(-0.5, -1.6, 0.9).normalize().multiplyScalar(2.9 * size);
    this.controls.update();
  }

  private change(what: 'section' | 'colour' | 'look'): void {
    if (what === 'section') this.cutStats = this.volume.cut(planeOf(this.panel.section));
    if (what === 'colour') this.cutStats = this.volume.colour(this.panel.field);
    this.volume.showsMesh = this.panel.showsMesh;
    this.volume.showsSurfaces = this.panel.showsSurfaces;
    this.volume.stretch = this.panel.stretch;
    this.tell();
    this.ask();
  }

  private tell(): void {
    const cells = this.data.corners.length / 4;
    this.panel.stats =
      `${cells.toLocaleString('en')} tetrahedra\n` +
      `${this.cutStats.cells.toLocaleString('en')} of them in the section`;
  }

  private move(event: KeyboardEvent): void {
    const step = {ArrowLeft: -1, ArrowDown: -1, ArrowRight: 1, ArrowUp: 1}[event.key];
    if (!step || (event.target as HTMLElement).tagName === 'INPUT') return;
    const section = this.panel.section;
    const most = reach(planeOf(section), this.data.halfSize);
    const offsetM = Math.min(most, Math.max(-most, section.offsetM + (step * most) / 100));
    this.setSection({...section, offsetM});
    event.preventDefault();
  }

  private resize(): void {
    const {clientWidth, clientHeight} = this.canvas;
    this.renderer.setPixelRatio(window.devicePixelRatio);
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.camera.aspect = clientWidth / Math.max(1, clientHeight);
    // the panel covers the left: the volume stands in the middle of the rest
    const shift = clientWidth > 2 * kPanelPx ? kPanelPx / 2 : 0;
    this.camera.setViewOffset(clientWidth, clientHeight, -shift, 0, clientWidth, clientHeight);
    this.ask();
  }

  private ask(): void {
    if (this.isAsked) return;
    this.isAsked = true;
    requestAnimationFrame(() => {
      this.isAsked = false;
      this.redraw();
    });
  }

  setSection(section: SectionSetting): void {
    this.panel.section = section;
    this.change('section');
  }

  setMesh(shows: boolean): void {
    this.panel.showsMesh = shows;
    this.change('look');
  }

  setSurfaces(shows: boolean): void {
    this.panel.showsSurfaces = shows;
    this.change('look');
  }

  setColour(field: number): void {
    this.panel.field = field;
    this.change('colour');
  }

  setCamera({eye, target}: {eye: number[]; target: number[]}): void {
    this.camera.position.fromArray(eye);
    this.controls.target.fromArray(target);
    this.controls.update();
    this.ask();
  }

  stats(): CutStats {
    return this.cutStats;
  }

  pixelOf(place: number[]): [number, number] {
    const fromMiddle = place.map((x, k) => x - this.data.middle[k]);
    this.camera.updateMatrixWorld();
    const {x, y} = this.volume.toScene(fromMiddle).project(this.camera);
    const {width, height} = this.canvas;
    return [Math.round(((x + 1) / 2) * width), Math.round(((1 - y) / 2) * height)];
  }

  middle(): number[] {
    return this.data.middle;
  }

  redraw(): void {
    this.camera.updateMatrixWorld();
    this.volume.look(this.camera.getWorldPosition(new Vector3()));
    this.renderer.render(this.volume.scene, this.camera);
  }
}

async function start(): Promise<void> {
  const data = await load();
  window.terraneVolume = new VolumePage(
    document.getElementById('volume') as HTMLCanvasElement,
    data,
  ) satisfies TerraneVolumeApi;
}

start().catch((error: unknown) => {
  const element = document.getElementById('error') as HTMLElement;
  element.textContent = error instanceof Error ? error.message : String(error);
  element.hidden = false;
});
