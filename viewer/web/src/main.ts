import './view/style.css';
import {corners} from './core/box';
import type {Camera} from './core/first_camera';
import type {SeamReport} from './core/seams';
import {parseTileset, type Tileset} from './core/tileset';
import {showFatal} from './view/panel';
import {Viewer, type ViewerStats} from './view/viewer';

/** What tests and the console can do: `window.terrane`. */
export interface TerraneApi {
  /** Resolves when all detail that is wanted is on the screen. */
  ready(): Promise<void>;
  setCamera(camera: Camera): void;
  setTolerance(tolerancePx: number): void;
  stats(): ViewerStats;
  checkSeams(): SeamReport;
  /** Draws; the canvas can be read until the current task ends. */
  redraw(): void;
  /** World z of the terrain at a place, as far as it is loaded. */
  groundZ(x: number, y: number): number | undefined;
  /** The world box of the terrain. */
  bounds(): {min: number[]; max: number[]};
}

declare global {
  interface Window {
    terrane?: TerraneApi;
  }
}

async function fetchJson(url: string): Promise<unknown> {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`${url}: status ${response.status}`);
  return response.json();
}

async function fetchTileset(url: string): Promise<Tileset> {
  const beside = new URL('terrane.json', url).href;
  const [tileset, terrane] = await Promise.all([fetchJson(url), fetchJson(beside)]);
  return parseTileset(tileset, terrane, url);
}

function bounds({root}: Tileset) {
  const extreme = (pick: (...values: number[]) => number) =>
    ([0, 1, 2] as const).map((axis) => pick(...corners(root.box).map((corner) => corner[axis])));
  return {min: extreme(Math.min), max: extreme(Math.max)};
}

function apiOf(viewer: Viewer, tileset: Tileset): TerraneApi {
  return {
    ready: () => viewer.ready(),
    setCamera: (camera) => viewer.setCamera(camera),
    setTolerance: (tolerancePx) => viewer.setTolerance(tolerancePx),
    stats: () => viewer.stats(),
    checkSeams: () => viewer.checkSeams(),
    redraw: () => void viewer.redraw(),
    groundZ: (x, y) => viewer.groundZ(x, y),
    bounds: () => bounds(tileset),
  };
}

/**
 * Starts the viewer. URL parameters: tileset (address, from the page; default ./tileset.json),
 * tolerance (pixels; default 1), antialias (off for slow machines).
 */
async function start(): Promise<void> {
  const parameters = new URLSearchParams(location.search);
  const url = new URL(parameters.get('tileset') ?? './tileset.json', location.href).href;
  const tileset = await fetchTileset(url);
  const canvas = document.getElementById('terrain') as HTMLCanvasElement;
  const viewer = new Viewer(canvas, tileset, {
    tolerancePx: Math.min(16, Math.max(0.5, Number(parameters.get('tolerance')) || 1)),
    antialias: parameters.get('antialias') !== 'off',
  });
  window.terrane = apiOf(viewer, tileset);
}

start().catch((error: unknown) =>
  showFatal(error instanceof Error ? error.message : String(error)),
);
