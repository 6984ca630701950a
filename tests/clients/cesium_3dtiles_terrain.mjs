// cesium_3dtiles_terrain.mjs FOLDER: CesiumJS's Cesium3DTilesTerrainProvider, without a browser, reads every tile of
// the 3D Tiles terrain in FOLDER; it makes meshes of them, cuts them into quarters where nothing finer is, and the
// heights that it interpolates are the DEM's within the tolerance.
import {existsSync} from 'node:fs';
import {readFile, readdir} from 'node:fs/promises';
import {createRequire} from 'node:module';
import {join} from 'node:path';
import {check, failures} from './check.mjs';
import {servePages} from './page_server.mjs';
import {terrainSets} from './terrain_set.mjs';

const Cesium = createRequire(import.meta.url)('cesium');

const [folder] = process.argv.slice(2);
const server = await servePages({'/tiles/': folder});
for (const name of await terrainSets(folder, 'tileset.json')) await examine(name);
check(server.missing.length === 0, `nothing asked for that is not there ${server.missing.slice(0, 3)}`);
server.close();
process.exit(failures() > 0 ? 1 : 0);

async function examine(name) {
  const summary = JSON.parse(await readFile(join(folder, name, 'terrane.json'), 'utf8'));
  const provider = await Cesium.Cesium3DTilesTerrainProvider.fromUrl(`${server.url}/tiles/${name}/tileset.json`, {requestVertexNormals: true});
  await readAll(name, provider, summary);
  await compareHeights(name, provider, summary);
}

/** The mesh of a tile; undefined if it cannot be read. */
async function meshOf(provider, x, y, level) {
  const tile = await provider.requestTileGeometry(x, y, level);
  await tile?._createMeshSync({tilingScheme: provider.tilingScheme, x, y, level});
  return tile;
}

async function readAll(name, provider, {zooms}) {
  const bad = [];
  let tiles = 0;
  // coarse tiles first: the client knows finer subtrees by their parents
  for (const {zoom} of zooms) {
    for (const {x, y} of await tilesOf(name, zoom)) {
      ++tiles;
      const tile = await meshOf(provider, x, y, zoom);
      const inSphere = tile && holds(tile._mesh);
      const quarters = tile ? await Promise.all([0, 1, 2, 3].map((k) => tile._upsampleSync(
        provider.tilingScheme, x, y, zoom, 2 * x + (k & 1), 2 * y + (k >> 1), zoom + 1))) : [];
      if (!inSphere || quarters.length !== 4 || !quarters.every(Boolean)) bad.push(`${zoom}/${x}/${y}`);
    }
  }
  const stated = zooms.reduce((sum, zoom) => sum + zoom.tiles, 0);
  check(tiles === stated && bad.length === 0, `${name}: CesiumJS makes meshes of all ${tiles} tiles, and quarters of each ${bad.slice(0, 3)}`);
}

/** Tiles of a zoom as CesiumJS counts them: y from the north. */
async function tilesOf(name, zoom) {
  const side = 2 ** zoom, result = [];
  for (const [half, offset] of [['west', 0], ['east', side]]) {
    const root = join(folder, name, half, String(zoom));
    if (!existsSync(root)) continue;
    for (const x of await readdir(root)) {
      for (const file of await readdir(join(root, x))) {
        result.push({x: Number(x) + offset, y: side - 1 - Number.parseInt(file, 10)});
      }
    }
  }
  return result;
}

/** Does the bounding sphere that the metadata state hold all vertices (of the mesh without its skirts)? */
function holds({vertices, encoding, boundingSphere3D: {center, radius}, vertexCountWithoutSkirts}) {
  for (let k = 0; k < vertexCountWithoutSkirts; ++k) {
    const at = encoding.decodePosition(vertices, k, new Cesium.Cartesian3());
    // positions are floats of the tile's size
    if (Cesium.Cartesian3.distance(at, center) > radius * (1 + 1e-6)) return false;
  }
  return true;
}

async function compareHeights(name, provider, {zooms}) {
  const file = join(folder, `${name}_points.json`);
  if (!existsSync(file)) return;
  const points = JSON.parse(await readFile(file, 'utf8'));
  let worst = 0, coarsest = Infinity;
  for (const [longitude, latitude, height] of points) {
    const place = Cesium.Cartographic.fromDegrees(longitude, latitude);
    const level = provider.availability.computeMaximumLevelAtPosition(place);
    const {x, y} = provider.tilingScheme.positionToTileXY(place, level);
    const tile = await meshOf(provider, x, y, level);
    const rectangle = provider.tilingScheme.tileXYToRectangle(x, y, level);
    worst = Math.max(worst, Math.abs(tile.interpolateHeight(rectangle, place.longitude, place.latitude) - height));
    coarsest = Math.min(coarsest, level);
  }
  const {zoom, tolerance_m: tolerance} = zooms.at(-1);
  check(worst <= tolerance && coarsest === zoom,
    `${name}: ${points.length} heights that CesiumJS interpolates are ${worst.toFixed(2)} m off the DEM's samples at most, the tolerance is ${tolerance} m`);
}
