// A flight over the synthetic tileset, without a browser: whole cuts, closed seams, no pops.
import {beforeAll, describe, expect, it} from 'vitest';
import {holdbackUniform, morphUniforms, renderOrigin} from '../../src/core/render_origin';
import {checkSeams} from '../../src/core/seams';
import {Streamer, type Frame} from '../../src/core/streamer';
import {Surface, type ShownTile} from '../../src/core/surface';
import {parseTileset, tilesOf, type Tile, type Tileset} from '../../src/core/tileset';
import type {Vec3} from '../../src/core/vec3';
import {makeTile, makeTileset} from '../synthetic_tiles.mjs';
import {randomSource} from './random';

const kView = {pixelScale: 400, tolerancePx: 3, isInPicture: () => true};

interface Stored {
  readonly bytes: number;
  readonly origin: Vec3;
  readonly positions: number[];
  readonly toTargets: number[];
  readonly indices: number[];
}

let tileset: Tileset;
const stored = new Map<string, Stored>();

beforeAll(() => {
  const made = makeTileset();
  tileset = parseTileset(made.tileset, made.terrane, 'http://host/tileset.json');
  for (const {key, level, x, y} of tilesOf(tileset.root)) {
    stored.set(key, {...(makeTile(level, x, y) as unknown as Stored), bytes: 1000});
  }
});

/** From afar down to the ground and along it; t from 0 to 1. */
function eyeAt(t: number): Vec3 {
  return [-3500 + 6000 * t, -3000 + 4500 * t ** 2, 900 + 5000 * (1 - t) ** 3];
}

function shownTiles({cut, ranges, holdbacks, eye}: Frame): {originM: Vec3; tiles: ShownTile[]} {
  const originM = renderOrigin(eye, tileset.levels.at(-1)!.stepM);
  const eyeM = eye.map((value, k) => value - originM[k]!) as unknown as Vec3;
  const held = holdbacks.map((hold) => holdbackUniform(hold, originM));
  const tiles = cut.map((tile) => {
    const {origin, positions, toTargets, indices} = stored.get(tile.key)!;
    const {stepM, morphShare} = tileset.levels[tile.level]!;
    const place = {level: tile.level, origin, stepM, morphShare};
    const uniforms = morphUniforms(place, ranges, eyeM, originM, held);
    return {tile, positions, toTargets, indices, uniforms};
  });
  return {originM, tiles};
}

function openSeams(frame: Frame): number {
  const {tiles} = shownTiles(frame);
  const drawn = tiles.map((shown) => {
    const {level, x, y} = shown.tile;
    return {...shown, octave: level, x, y};
  });
  return checkSeams(drawn, tileset.cellM).mismatches;
}

/** Heights of the shown surface at places below the flight. */
function heights(frame: Frame): (number | undefined)[] {
  const {originM, tiles} = shownTiles(frame);
  const byTile = new Map(tiles.map((shown) => [shown.tile, shown]));
  const surface = new Surface(frame.cut, originM, (tile) => byTile.get(tile)!);
  const places = [...Array(60).keys()].map((i) => [-3400 + 110 * i, -2900 + 97 * ((i * 37) % 60)]);
  return places.map(([x, y]) => surface.heightAt(x!, y!));
}

/** Loads all that the flight needs, then flies it; the largest change of height per metre flown. */
async function largestPop(steps: number): Promise<number> {
  const streamer = new Streamer(tileset, (tile: Tile) => Promise.resolve(stored.get(tile.key)!), {
    onDrop: () => {},
    onChange: () => {},
  });
  let nowS = 0;
  for (let i = 0; i <= 40; ++i) {
    const view = {...kView, eye: eyeAt(i / 40)};
    while (!streamer.update(view, (nowS += 0.2)).settled) await Promise.resolve();
  }
  let largest = 0;
  let last: {eye: Vec3; heights: (number | undefined)[]} | undefined;
  for (let i = 0; i <= steps; ++i) {
    const frame = streamer.update({...kView, eye: eyeAt(0.35 + (0.2 * i) / steps)}, (nowS += 0.02));
    expect(frame.settled).toBe(true);
    const now = {eye: frame.eye, heights: heights(frame)};
    if (last) {
      const movedM = Math.hypot(...now.eye.map((value, k) => value - last!.eye[k]!));
      now.heights.forEach((height, k) => {
        const change = Math.abs((height ?? 0) - (last!.heights[k] ?? 0));
        largest = Math.max(largest, change / movedM);
      });
    }
    last = now;
  }
  return largest;
}

describe('a flight', () => {
  it('changes no height by a jump: the change per metre flown stays as steps are halved', async () => {
    const perM = [await largestPop(30), await largestPop(60), await largestPop(120)];
    expect(perM[0]).toBeGreaterThan(0);
    // a jump would be twice as much per metre at each halving
    expect(perM[1]! / perM[0]!).toBeLessThan(1.5);
    expect(perM[2]! / perM[1]!).toBeLessThan(1.5);
  }, 60000);

  it('has no open seam while tiles come late, out of order or not at all', async () => {
    const random = randomSource(7);
    const due: {atFrame: number; act: () => void}[] = [];
    let frameNumber = 0;
    const fetchTile = ({key}: Tile) =>
      new Promise<Stored>((resolve, reject) => {
        const fails = random() < 0.05;
        const act = () => (fails ? reject(new Error('status 503')) : resolve(stored.get(key)!));
        due.push({atFrame: frameNumber + 1 + 9 * random(), act});
      });
    const streamer = new Streamer(tileset, fetchTile, {onDrop: () => {}, onChange: () => {}});
    let [held, frame] = [0, undefined as Frame | undefined];
    for (; frameNumber < 60 || (!frame!.settled && frameNumber < 400); ++frameNumber) {
      const eye = eyeAt(Math.min(1, frameNumber / 60));
      frame = streamer.update({...kView, eye}, frameNumber / 20);
      for (const {act} of due.filter(({atFrame}) => atFrame <= frameNumber)) act();
      due.splice(0, due.length, ...due.filter(({atFrame}) => atFrame > frameNumber));
      await new Promise((resolve) => setTimeout(resolve, 0));
      if (frame.cut.length === 0) continue;
      expect(openSeams(frame)).toBe(0);
      held += frame.holdbacks.length;
    }
    expect(held).toBeGreaterThan(100);
    expect(frame!.settled).toBe(true);
  }, 60000);
});
