import {distanceToBox} from '../core/box';
import type {Tile} from '../core/tileset';
import type {TileContent} from './tile_content';

/**
 * World z of the terrain below or above a place, taken from the nearest vertex in plan of the shown
 * tiles; undefined beside the terrain. Good enough to keep a camera out of the ground.
 */
export function groundZ(
  x: number,
  y: number,
  cut: readonly Tile[],
  contentOf: (tile: Tile) => TileContent,
): number | undefined {
  let best: {z: number; squared: number} | undefined;
  for (const tile of cut) {
    if (distanceToBox(tile.box, [x, y, tile.box.center[2]]) > 0) continue;
    const nearest = nearestVertex(x, y, contentOf(tile));
    if (!best || nearest.squared < best.squared) best = nearest;
  }
  return best?.z;
}

function nearestVertex(x: number, y: number, content: TileContent) {
  const {positions, origin, stepM} = content;
  const [column, row]: [number, number] = [x / stepM[0] - origin[0], y / stepM[1] - origin[1]];
  let nearest = {vertex: 0, squared: Infinity};
  for (let i = 0; 3 * i < positions.length; ++i) {
    const dx = (positions[3 * i]! - column) * stepM[0];
    const dy = (-positions[3 * i + 2]! - row) * stepM[1];
    const squared = dx * dx + dy * dy;
    if (squared < nearest.squared) nearest = {vertex: i, squared};
  }
  const z = (origin[2] + positions[3 * nearest.vertex + 1]!) * stepM[2];
  return {z, squared: nearest.squared};
}
