import {join} from 'node:path';
import {check} from './check.mjs';
import {contentsOf, coveredLeaves, leavesOf} from './tree.mjs';

/**
 * Checks what a client draws: tiles of several levels that cover the DEM once, all their triangles.
 *
 * @param fewestLevels that must be mixed
 * @param shown urls of the tiles, and how many triangles were drawn, if it tells
 */
export async function checkShown(folder, name, shown, fewestLevels = 2) {
  const contents = await contentsOf(join(folder, name));
  const pathOf = (url) => decodeURI(new URL(url).pathname).split(`/tiles/${name}/`)[1];
  const tiles = shown.tiles.map((url) => contents.get(pathOf(url)));
  const unknown = shown.tiles.filter((_, n) => !tiles[n]);
  check(unknown.length === 0, `${name}: only tiles that are listed ${unknown.slice(0, 3)}`);
  if (unknown.length > 0) return;
  const levels = [...new Set(tiles.map((tile) => tile.level))].sort();
  check(levels.length >= fewestLevels, `${name}: ${tiles.length} tiles of levels ${levels} are drawn`);
  check(coveredLeaves(tiles, contents) === leavesOf(contents).length, `${name}: they cover the DEM once`);
  if (shown.triangles === undefined) return;
  const triangles = tiles.reduce((sum, tile) => sum + tile.triangles + (tile.skirt_triangles ?? 0), 0);
  check(shown.triangles === triangles, `${name}: ${shown.triangles} triangles are drawn, the tiles hold ${triangles}`);
}
