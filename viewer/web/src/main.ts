import './view/style.css';
import {corners} from './core/box';
import {parsePath} from './core/camera_path';
import type {Camera} from './core/first_camera';
import type {Pose} from './core/pose';
import type {SeamReport} from './core/seams';
import {kDefaults, type Settings} from './core/settings';
import {readJson, type Source} from './core/source';
import {readBelow} from './core/subtree';
import {parseTileset, type Tileset} from './core/tileset';
import {showError} from './view/page';
import {Session} from './view/session';
import {chooseSource, sourceOfPage} from './view/start_page';
import type {ViewerStats} from './view/viewer';

/** What tests and the console can do: `window.terrane`. */
export interface TerraneApi {
  /** Resolves when all detail that is wanted is on the screen. */
  ready(): Promise<void>;
  setCamera(camera: Camera): void;
  setPose(pose: Pose): void;
  pose(): Pose;
  set(change: Partial<Settings>): void;
  stats(): ViewerStats;
  checkSeams(): SeamReport;
  /** Draws; the canvas can be read until the current task ends. */
  redraw(): void;
  /** Draws a colour (0xrrggbb) instead of the sky; null: the sky. */
  setBackdrop(color: number | null): void;
  /** Keeps what is shown as it is while the camera moves on. */
  setFrozen(on: boolean): void;
  /** World z of the shown terrain at a place. */
  groundZ(x: number, y: number): number | undefined;
  /** The world box of the terrain. */
  bounds(): {min: number[]; max: number[]};
}

declare global {
  interface Window {
    terrane?: TerraneApi;
  }
}

async function readTileset(source: Source): Promise<Tileset> {
  const beside = new URL('terrane.json', source.url).href;
  const [tileset, terrane] = await Promise.all([
    readJson(source, source.url),
    readJson(source, beside),
  ]);
  const parsed = parseTileset(tileset, terrane, source.url);
  // the first view needs the root's own box
  await readBelow(parsed.root, (url) => source.read(url));
  return parsed;
}

function bounds({root}: Tileset) {
  const extreme = (pick: (...values: number[]) => number) =>
    ([0, 1, 2] as const).map((axis) => pick(...corners(root.box).map((corner) => corner[axis])));
  return {min: extreme(Math.min), max: extreme(Math.max)};
}

function apiOf(session: Session, tileset: Tileset): TerraneApi {
  const {viewer} = session;
  return {
    ready: () => viewer.ready(),
    setCamera: (camera) => viewer.setCamera(camera),
    setPose: (pose) => viewer.setPose(pose),
    pose: () => viewer.navigation.pose,
    set: (change) => session.set({...session.settings, ...change}),
    stats: () => viewer.stats(),
    checkSeams: () => viewer.checkSeams(),
    redraw: () => void viewer.redraw(),
    setBackdrop: (color) => viewer.setBackdrop(color),
    setFrozen: (on) => viewer.setFrozen(on),
    groundZ: (x, y) => viewer.surface().heightAt(x, y),
    bounds: () => bounds(tileset),
  };
}

/**
 * Starts the viewer. URL parameters: tileset (address of a tileset.json or .pmtiles, from the page;
 * default ./tileset.json), tolerance (pixels; default 1), antialias (off for slow machines), path
 * (address of a camera path to fly along). The hash is the permalink.
 */
/** By its address: what Vite makes of an import by name would cost every page half a kilobyte. */
async function showTree(parameters: URLSearchParams): Promise<void> {
  const address = import.meta.env.DEV
    ? '/src/tree/tree_page.ts'
    : new URL(/* @vite-ignore */ 'tree_page.js', import.meta.url).href;
  const page = (await import(/* @vite-ignore */ address)) as typeof import('./tree/tree_page');
  return page.showTree(parameters);
}

async function start(): Promise<void> {
  const parameters = new URLSearchParams(location.search);
  if (parameters.has('tree')) return showTree(parameters);
  const source =
    (await sourceOfPage(parameters)) ?? (await chooseSource('Choose a terrain to look at.'));
  const tileset = await readTileset(source);
  const canvas = document.getElementById('terrain') as HTMLCanvasElement;
  const tolerancePx = Math.min(16, Math.max(0.5, Number(parameters.get('tolerance')) || 1));
  const session = new Session(canvas, source, tileset, {
    settings: {...kDefaults, tolerancePx},
    antialias: parameters.get('antialias') !== 'off',
  });
  window.terrane = apiOf(session, tileset);
  const path = parameters.get('path');
  if (path) await session.play(parsePath(await (await fetch(path)).json()));
}

start().catch((error: unknown) =>
  showError(error instanceof Error ? error.message : String(error)),
);
