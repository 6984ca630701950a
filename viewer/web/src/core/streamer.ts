// From a camera to the tiles to draw, frame by frame: selection, requests, cache and the share of
// the wanted detail that is loaded.
import {RequestQueue, type Failure, type Fetch} from './request_queue';
import {reducedRanges, wantedRanges, type Ranges} from './ranges';
import {cutOf, nearestBoxes, selectTiles, type Visit} from './selection';
import {glideShare, largestReadyShare} from './shown_cut';
import {TileCache} from './tile_cache';
import type {Tile, Tileset} from './tileset';
import type {Vec3} from './vec3';

/** A tile's content, as far as it matters here. */
export interface Content {
  /** Memory that it takes. */
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
  /** The ranges to morph by. */
  readonly ranges: Ranges;
  /** 0: the root alone; 1: all detail that is wanted. */
  readonly share: number;
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

export class Streamer<C extends Content> {
  private readonly cache: TileCache<C>;
  private readonly queue: RequestQueue<Tile, C>;
  private share = 0;
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

  get requests(): number {
    return this.queue.started;
  }

  get failures(): ReadonlyMap<string, Failure> {
    return this.queue.failures;
  }

  get nextRetryS(): number {
    return this.queue.nextRetryS;
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
    const {root, levels} = this.tileset;
    const nearestM = nearestBoxes(root, view.eye);
    const wanted = wantedRanges(levels, view.pixelScale, view.tolerancePx, nearestM);
    const visits = selectTiles(root, view.eye, reducedRanges(levels, wanted, 1));
    this.request(visits, view, nowS);

    const isReady = (tile: Tile) => this.cache.has(tile.key);
    const ready = largestReadyShare(root, view.eye, levels, wanted, isReady);
    this.share = glideShare(this.share, ready, this.elapsedS(nowS));
    const ranges = reducedRanges(levels, wanted, this.share);
    const cut = isReady(root) ? cutOf(selectTiles(root, view.eye, ranges)) : [];
    const loaded = visits.filter((visit) => isReady(visit.tile)).length;
    const progress = {settled: this.share === 1, gliding: this.share < ready};
    return {cut, ranges, share: this.share, ...progress, wanted: visits.length, loaded};
  }

  private request(visits: readonly Visit[], view: View, nowS: number): void {
    for (const {tile} of visits) this.cache.touch(tile.key);
    this.cache.trim(new Set(visits.map((visit) => visit.tile.key)));
    const missing = visits.filter((visit) => !this.cache.has(visit.tile.key));
    this.queue.want(byNeed(missing, view.isInPicture), nowS);
  }

  private elapsedS(nowS: number): number {
    const elapsedS = Math.min(kLongestFrameS, nowS - this.lastS);
    this.lastS = nowS;
    return elapsedS;
  }
}

/** Coarse levels first: finer ones cannot show without them. Then what is seen; then near ones. */
function byNeed(visits: readonly Visit[], isInPicture: (tile: Tile) => boolean): Tile[] {
  return visits
    .map((visit) => ({...visit, hidden: Number(!isInPicture(visit.tile))}))
    .sort(
      (a, b) =>
        b.tile.level - a.tile.level || a.hidden - b.hidden || a.distanceM - b.distanceM,
    )
    .map((visit) => visit.tile);
}
