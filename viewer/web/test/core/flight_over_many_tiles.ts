import {Streamer, type Frame} from '../../src/core/streamer';
import {tilesOf, type Tile} from '../../src/core/tileset';
import {kLeafM, quadtree} from './quadtree';

export interface Flight {
  /** More than 100,000. */
  readonly tiles: readonly Tile[];
  /** One frame; a step is 100 m long, and takes a second. */
  readonly fly: (step: number) => Frame;
}

/** A low flight over a strip, 60 steps on, with all loaded that it needs. */
export async function flightOverManyTiles(): Promise<Flight> {
  const tileset = quadtree(9, ({level, y}) => y * 2 ** level < 150);
  const streamer = new Streamer(tileset, () => Promise.resolve({bytes: 1}), {
    onDrop: () => {},
    onChange: () => {},
  });
  const view = {pixelScale: 500, tolerancePx: 1, isInPicture: () => true};
  const fly = (step: number) => {
    const eye = [kLeafM * (200 + step / 10), kLeafM * 70, 800] as const;
    return streamer.update({...view, eye}, step / 10);
  };
  let frame: Frame | undefined;
  for (let i = 0; i < 400 && !frame?.settled; ++i) {
    frame = fly(0.001 * i);
    await Promise.resolve();
  }
  for (let i = 10; i < 60; ++i) {
    fly(i);
    await Promise.resolve();
  }
  return {tiles: [...tilesOf(tileset.root)], fly};
}
