// From a camera to the tiles to draw, frame by frame: selection, requests, cache, and what is held
// back until it is loaded.
import {distanceToBox} from './box';
import {Holdbacks, tilesWithoutChildren, type Holdback} from './holdback';
import {RequestQueue, type Failure, type Fetch} from './request_queue';
import {reducedRanges, wantedRanges, type Ranges} from './ranges';
import {cutOf, nearestBoxes, selectTiles, type Visit} from './selection';
import {TileCache} from './tile_cache';
import type {Tile, Tileset} from './tileset';
import type {Vec3} from './vec3';

/** A tile's content, as far as it matters here. */
export interface Content {
  /** Memory that it takes, on the graphics card too. */
  readonly bytes: number;
}

/** The camera of one frame. */
export interface View {
  /** World metres. */
  readonly eye: Vec3;
  /** K of pixelsPerRadian(). */
  readonly pixelScale: number;
  /** Wanted error on the screen. */
  readonly tolerancePx: number;
  /** True for a tile that may be in the picture: those are fetched first. */
  readonly isInPicture: (tile: Tile) => boolean;
}

/** What to draw. */
export interface Frame {
  /** Covers the root exactly once; empty until the root is loaded. Every tile of it is loaded. */
  readonly cut: readonly Tile[];
  /** The ranges and holdbacks to morph by. */
  readonly ranges: Ranges;
  readonly holdbacks: readonly Holdback[];
  /** Where distances are measured from. */
  readonly eye: Vec3;
  /** True when all detail that is wanted is in the cut. */
  readonly settled: boolean;
  /** True when the next frame will show more even if nothing arrives. */
  readonly gliding: boolean;
  /** Tiles that the wanted cut needs, and how many of them are here. */
  readonly wanted: number;
  readonly loaded: number;
}

/** What happens on the way. */
export interface StreamerEvents<C> {
  readonly onDrop: (content: C) => void;
  /** Something arrived or failed: draw again. */
  readonly onChange: () => void;
}

/** Seconds that one frame may glide by, however long ago the last one was. */
const kLongestFrameS = 0.25;

/** Octaves a second by which the shown tolerance follows the wanted one. */
const kToleranceRate = 8;

/** How much less a tile counts that is not in the picture. */
const kUnseen = 1 / 8;

export class Streamer<C extends Content> {
  private readonly cache: TileCache<C>;
  private readonly queue: RequestQueue<Tile, C>;
  private readonly holdbacks = new Holdbacks();
  private tolerancePx: number | undefined;
  private lastS = -Infinity;

  constructor(
    private readonly tileset: Tileset,
    fetchTile: Fetch<Tile, C>,
    events: StreamerEvents<C>,
    cacheBytes = 512 * 1024 * 1024,
  ) {
    this.cache = new TileCache(cacheBytes, events.onDrop);
    const keep = (tile: Tile, content: C) => this.cache.put(tile.key, content, content.bytes);
    this.queue = new RequestQueue(fetchTile, keep, events.onChange);
  }

  /** Requests made so far, retries included. */
  get requests(): number {
    return this.queue.started;
  }

  get inFlight(): number {
    return this.queue.running;
  }

  get failures(): ReadonlyMap<string, Failure> {
    return this.queue.failures;
  }

  get nextRetryS(): number {
    return this.queue.nextRetryS;
  }

  get cachedBytes(): number {
    return this.cache.bytes;
  }

  content(tile: Tile): C | undefined {
    return this.cache.get(tile.key);
  }

  /**
   * Asks for what is missing and says what to draw.
   *
   * @param nowS seconds of any clock that never runs back
   */
  update(view: View, nowS: number): Frame {
    const {root} = this.tileset;
    const {eye} = view;
    const elapsedS = this.elapsedS(nowS);
    const visits = selectTiles(root, eye, this.ranges(view, view.tolerancePx));
    this.request(visits, view, nowS);

    const isReady = (tile: Tile) => this.cache.has(tile.key);
    if (!isReady(root)) return nothing(eye, visits.length);
    this.tolerancePx = glide(this.tolerancePx ?? view.tolerancePx, view.tolerancePx, elapsedS);
    const ranges = this.ranges(view, this.tolerancePx);
    const missing = tilesWithoutChildren(root, eye, ranges, isReady);
    const holdbacks = this.holdbacks.step(missing, eye, ranges, elapsedS);
    const cut = cutOf(selectTiles(root, eye, ranges, holdbacks));
    const isGlidingTolerance = this.tolerancePx !== view.tolerancePx;
    const gliding = isGlidingTolerance || this.holdbacks.gliding;
    const settled = holdbacks.length === 0 && !isGlidingTolerance;
    const loaded = visits.filter((visit) => isReady(visit.tile)).length;
    return {cut, ranges, holdbacks, eye, settled, gliding, wanted: visits.length, loaded};
  }

  private ranges(view: View, tolerancePx: number): Ranges {
    const {root, levels} = this.tileset;
    const nearestM = nearestBoxes(root, view.eye);
    return reducedRanges(levels, wantedRanges(levels, view.pixelScale, tolerancePx, nearestM), 1);
  }

  private request(visits: readonly Visit[], view: View, nowS: number): void {
    for (const {tile} of visits) this.cache.touch(tile.key);
    this.cache.trim(new Set(visits.map((visit) => visit.tile.key)));
    const missing = visits.filter((visit) => !this.cache.has(visit.tile.key));
    this.queue.want(byNeed(missing, this.tileset, view), nowS);
  }

  private elapsedS(nowS: number): number {
    const elapsedS = Math.min(kLongestFrameS, nowS - this.lastS);
    this.lastS = nowS;
    return elapsedS;
  }
}

function nothing(eye: Vec3, wanted: number): Frame {
  const empty = {cut: [], ranges: [], holdbacks: []};
  return {...empty, eye, settled: false, gliding: false, wanted, loaded: 0};
}

/** Follows a wanted tolerance, by equal factors in equal times. */
function glide(shownPx: number, wantedPx: number, elapsedS: number): number {
  const largest = 2 ** (kToleranceRate * elapsedS);
  return Math.min(shownPx * largest, Math.max(shownPx / largest, wantedPx));
}

/**
 * The largest error on the screen first that a tile takes away: its parent's, which shows without
 * it. That puts parents before their children, and siblings, which show together, side by side.
 */
function byNeed(missing: readonly Visit[], {levels}: Tileset, view: View): Tile[] {
  const need = ({parent, level}: Tile): number => {
    if (!parent) return Infinity;
    const distanceM = Math.max(1, distanceToBox(parent.box, view.eye));
    const share = view.isInPicture(parent) ? 1 : kUnseen;
    return (share * levels[level + 1]!.toleranceM) / distanceM;
  };
  return missing
    .map(({tile}) => ({tile, need: need(tile)}))
    .sort((a, b) => b.need - a.need)
    .map(({tile}) => tile);
}
