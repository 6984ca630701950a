import {describe, expect, it} from 'vitest';
import {distanceToBounds} from '../../src/core/box';
import {kOctaveS} from '../../src/core/holdback';
import {Streamer, type Frame, type View} from '../../src/core/streamer';
import {tilesOf, type Tile} from '../../src/core/tileset';
import {length, subtract, type Vec3} from '../../src/core/vec3';
import {flightOverManyTiles} from './flight_over_many_tiles';
import {kLeafM, quadtree} from './quadtree';

const kTop = 3;
const kTileBytes = 1000;

interface Fake {
  readonly key: string;
  readonly bytes: number;
}

interface World {
  readonly streamer: Streamer<Fake>;
  readonly dropped: string[];
  readonly broken: Set<string>;
  /** Answers the oldest open requests. */
  readonly answer: (count: number) => Promise<void>;
}

/** A streamer whose tiles arrive when the test says so, except the broken ones. */
function makeWorld(cacheBytes?: number): World {
  const dropped: string[] = [];
  const broken = new Set<string>();
  const open: (() => void)[] = [];
  const fetchTile = async (tile: Tile): Promise<Fake> => {
    await new Promise<void>((resolve) => open.push(resolve));
    if (broken.has(tile.key)) throw new Error(`${tile.key}: status 404`);
    return {key: tile.key, bytes: kTileBytes};
  };
  const answer = async (count: number) => {
    for (const resolve of open.splice(0, count)) resolve();
    await new Promise((resolve) => setTimeout(resolve, 0));
  };
  const events = {onDrop: (fake: Fake) => void dropped.push(fake.key), onChange: () => {}};
  const streamer = new Streamer(quadtree(kTop), fetchTile, events, cacheBytes);
  return {streamer, dropped, broken, answer};
}

function viewFrom(x: number, y: number, z: number): View {
  return {eye: [x, y, z], pixelScale: 500, tolerancePx: 2, isInPicture: () => true};
}

/** Frames 50 ms apart; two tiles arrive between them. */
async function* frames(world: World, view: View, count: number, startS = 0): AsyncGenerator<Frame> {
  for (let i = 0; i < count; ++i) {
    yield world.streamer.update(view, startS + 0.05 * i);
    await world.answer(2);
  }
}

/** Whether a cut covers all finest tiles once. */
function isWhole(cut: readonly Tile[]): boolean {
  const leaves = cut.flatMap((tile) => [...tilesOf(tile)].filter(({level}) => level === 0));
  return leaves.length === 4 ** kTop && new Set(leaves.map(({key}) => key)).size === leaves.length;
}

/** The definition of holdback.ts, in doubles. */
function shownDistance(place: Vec3, {eye, holdbacks}: Frame): number {
  const held = holdbacks.map(({bounds, heightM}) => heightM - distanceToBounds(bounds, place));
  return Math.max(length(subtract(place, eye)), ...held);
}

/** Notes the keys of the tiles whose boxes are read from now on. */
function watch(tiles: readonly Tile[]): Set<string> {
  const looked = new Set<string>();
  for (const tile of tiles) {
    const {box, key} = tile;
    Object.defineProperty(tile, 'box', {get: () => looked.add(key) && box});
  }
  return looked;
}

describe('Streamer', () => {
  it('shows a whole cut of loaded tiles in every frame once the root is there', async () => {
    const world = makeWorld();
    const levels: number[] = [];
    for await (const frame of frames(world, viewFrom(1500, 1500, 300), 100)) {
      if (frame.cut.length === 0) continue;
      expect(isWhole(frame.cut)).toBe(true);
      expect(frame.cut.every((tile) => world.streamer.content(tile))).toBe(true);
      levels.push(Math.min(...frame.cut.map(({level}) => level)));
    }
    expect(levels[0]).toBe(kTop);
    expect(levels.at(-1)).toBe(0);
  });

  it('settles with all wanted detail', async () => {
    const world = makeWorld();
    let last: Frame | undefined;
    for await (const frame of frames(world, viewFrom(1500, 1500, 300), 100)) last = frame;
    expect(last!.settled).toBe(true);
    expect(last!.loaded).toBe(last!.wanted);
  });

  it('lets detail fade in: what is shown changes little from one frame to the next', async () => {
    const world = makeWorld();
    let last: Frame | undefined;
    for await (const frame of frames(world, viewFrom(1500, 1500, 300), 60)) {
      if (last && last.cut.length > 0) {
        const highest = Math.max(0, ...last.holdbacks.map(({heightM}) => heightM));
        const sinks = highest * (1 - 2 ** (-0.05 / kOctaveS));
        for (let x = 100; x < kLeafM * 2 ** kTop; x += 700) {
          const nearer = shownDistance([x, x, 0], last) - shownDistance([x, x, 0], frame);
          expect(nearer).toBeLessThan(1.001 * sinks + 1e-6);
        }
      }
      last = frame;
    }
  });

  it('holds back the surroundings of a missing tile, not what is far from it', async () => {
    const world = makeWorld();
    world.broken.add('0/1/1');
    // fine enough to want all of level 0
    const view = {...viewFrom(4000, 4000, 3000), tolerancePx: 0.1};
    let last: Frame | undefined;
    for await (const frame of frames(world, view, 200)) last = frame;
    const levels = new Map(last!.cut.map(({level, x, y}) => [`${level}/${x}/${y}`, level]));
    expect(levels.get('1/0/0')).toBe(1);
    expect([...levels.keys()].filter((key) => key.startsWith('0/'))).toHaveLength(60);
    expect(last!.settled).toBe(false);
    expect(last!.gliding).toBe(false);
  });

  it('follows the tolerance without a jump', async () => {
    const world = makeWorld();
    const view = viewFrom(1500, 1500, 300);
    for await (const _ of frames(world, view, 100));
    const before = world.streamer.update({...view, tolerancePx: 2}, 6).ranges;
    const after = world.streamer.update({...view, tolerancePx: 16}, 6.05);
    expect(after.settled).toBe(false);
    after.ranges.forEach((range, l) => expect(range).toBeGreaterThan(before[l]! * 0.7));
    for (let i = 0; i < 20; ++i) world.streamer.update({...view, tolerancePx: 16}, 6.1 + i / 20);
    expect(world.streamer.update({...view, tolerancePx: 16}, 8).settled).toBe(true);
  });

  it('keeps the parent of a failed tile, says so, and recovers', async () => {
    const world = makeWorld();
    world.broken.add('0/1/1');
    const view = viewFrom(1.5 * kLeafM, 1.5 * kLeafM, 300);
    for await (const frame of frames(world, view, 100)) {
      if (frame.cut.length > 0) expect(isWhole(frame.cut)).toBe(true);
      expect(frame.cut.some(({key}) => key === '0/1/1')).toBe(false);
    }
    // it rests: nothing to draw until the next try
    expect(world.streamer.update(view, 5).gliding).toBe(false);
    expect([...world.streamer.failures.values()][0]!.message).toBe('0/1/1: status 404');

    world.broken.clear();
    let last: Frame | undefined;
    for await (const frame of frames(world, view, 100, 100)) last = frame;
    expect(world.streamer.failures.size).toBe(0);
    expect(last!.cut.some(({key}) => key === '0/1/1')).toBe(true);
  });

  it('drops tiles that are out of use, never those of the cut', async () => {
    const world = makeWorld(5 * kTileBytes);
    for await (const _ of frames(world, viewFrom(500, 500, 100), 100));
    expect(world.dropped).toEqual([]);
    for await (const frame of frames(world, viewFrom(7500, 7500, 60000), 100, 10)) {
      expect(frame.cut.every((tile) => world.streamer.content(tile))).toBe(true);
    }
    expect(world.dropped.length).toBeGreaterThan(0);
  });

  it('looks at no tile but those that it wants, though there are 100,000', async () => {
    const {tiles, fly} = await flightOverManyTiles();
    expect(tiles.length).toBeGreaterThan(100000);
    const looked = watch(tiles);
    const {wanted, settled} = fly(60);
    expect(settled).toBe(true);
    expect(looked.size).toBe(wanted);
  }, 60000);
});
