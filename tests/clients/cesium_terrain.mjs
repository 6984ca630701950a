// cesium_terrain.mjs FOLDER PICTURES: CesiumJS draws every terrain set of FOLDER, quantized-mesh or 3D Tiles, down
// to its finest tiles, without an error; the heights that it samples are the DEM's within what terrane states.
import {existsSync} from 'node:fs';
import {readFile} from 'node:fs/promises';
import {join} from 'node:path';
import {check, failures, lookAt, open, takePicture, withBrowser} from './browser.mjs';
import {cesiumMounts, kBackground} from './cesium_page.mjs';
import {servePages} from './page_server.mjs';
import {terrainSets} from './terrain_set.mjs';

const [folder, pictures] = process.argv.slice(2);
const server = await servePages(cesiumMounts(folder));

await withBrowser(async (context) => {
  for (const name of await terrainSets(folder)) await look(context, name, await quantizedMesh(name));
  for (const name of await terrainSets(folder, 'tileset.json')) {
    // the Earth is drawn once, from quantized-mesh: pages take their time
    if (existsSync(join(folder, `${name}_points.json`))) await look(context, name, await tiles3d(name));
  }
});
check(server.missing.length === 0, `nothing asked for that is not there ${server.missing.slice(0, 3)}`);
server.close();
process.exit(failures() > 0 ? 1 : 0);

async function json(...path) {
  return JSON.parse(await readFile(join(folder, ...path), 'utf8'));
}

async function quantizedMesh(name) {
  const {bounds, maxzoom, extensions} = await json(name, 'layer.json');
  return {bounds, maxzoom, hasWater: extensions.includes('watermask')};
}

async function tiles3d(name) {
  const {bounds, zooms} = await json(name, 'terrane.json');
  return {bounds, maxzoom: zooms.at(-1).zoom, is3dTiles: true};
}

async function look(context, name, set) {
  const {page, problems} = await open(context, `${server.url}/cesium.html`);
  const asked = new Set();
  page.on('response', (response) => asked.add(new URL(response.url()).pathname));
  const shown = await page.evaluate(show, {name, ...set});
  const {drawn, colours} = await lookAt(page, await takePicture(page, join(pictures, `cesium_terrain_${name}.png`)), kBackground);

  const errors = [...shown.errors, ...problems.errors, ...problems.requests];
  check(errors.length === 0, `${name}: no error ${errors.slice(0, 3)}`);
  check(shown.isLoaded, `${name}: all tiles are loaded`);
  const finest = [...asked].filter((path) => RegExp(`^/tiles/${name}/(west/|east/)?${set.maxzoom}/`).test(path));
  check(finest.length > 0 && shown.deepest >= set.maxzoom,
    `${name}: the finest tiles are drawn (${shown.tiles} tiles to zoom ${shown.deepest}; ${finest.length} of the finest loaded)`);
  check(shown.hasNormals, `${name}: vertex normals are read`);
  check(drawn > 0.2 && colours > 50, `${name}: the picture is not blank (${(100 * drawn).toFixed(0)} %, ${colours} colours)`);
  await compareHeights(page, name, await json(name, 'terrane.json'));
  await page.close();
}

async function compareHeights(page, name, {zooms}) {
  if (!existsSync(join(folder, `${name}_points.json`))) return;
  const points = await json(`${name}_points.json`);
  const heights = await page.evaluate(sample, points);
  const off = points.map(([, , height], n) => Math.abs(heights[n] - height));
  const {tolerance_m: tolerance} = zooms.at(-1);
  const worst = Math.max(...off);
  check(worst <= tolerance,
    `${name}: ${points.length} heights sampled by CesiumJS are ${worst.toFixed(2)} m off the DEM's samples at most, the tolerance is ${tolerance} m`);
}

// the functions below run in the page

async function show({name, bounds, maxzoom, hasWater, is3dTiles}) {
  const terrainProvider = is3dTiles
    ? await Cesium.Cesium3DTilesTerrainProvider.fromUrl(`/tiles/${name}/tileset.json`, {requestVertexNormals: true})
    : await Cesium.CesiumTerrainProvider.fromUrl(`/tiles/${name}`, {
        requestVertexNormals: true, requestWaterMask: hasWater, requestMetadata: true,
      });
  const errors = [];
  terrainProvider.errorEvent.addEventListener(({message}) => errors.push(message));
  const baseLayer = new Cesium.ImageryLayer(new Cesium.GridImageryProvider({cells: 4, backgroundColor: Cesium.Color.DARKOLIVEGREEN}));
  const viewer = makeViewer({terrainProvider, baseLayer});
  window.viewer = viewer;
  const {scene, camera} = viewer;
  const {globe} = scene;
  // CesiumJS 1.140 waits for ever to cut up 3D Tiles whose ancestors it left out
  globe.preloadAncestors = is3dTiles;
  globe.enableLighting = true;
  const [west, south, east, north] = bounds;
  const isGlobe = east - west > 180;
  if (isGlobe) {
    // the meridian of 180 degrees and the north pole are in sight; the finest tiles are small from there
    camera.setView({destination: Cesium.Cartesian3.fromDegrees(-150, 40, 1.8e7)});
    globe.maximumScreenSpaceError = 0.2;
  } else {
    // so near that the finest tiles are wanted
    const middle = Cesium.Cartographic.fromDegrees((west + east) / 2, (south + north) / 2);
    const [sampled] = await Cesium.sampleTerrainMostDetailed(terrainProvider, [middle]);
    const target = Cesium.Cartographic.toCartesian(sampled);
    const finestError = 77067 / 2 ** maxzoom;
    camera.lookAt(target, new Cesium.HeadingPitchRange(0.4, -0.5, 250 * finestError));
  }
  let calm = 0;
  for (let frames = 0; calm < 20 && frames < 3000; ++frames) {
    await new Promise((resolve) => requestAnimationFrame(resolve));
    calm = globe.tilesLoaded ? calm + 1 : 0;
  }
  const tiles = globe._surface._tilesToRender;
  return {
    errors: [...errors, ...window.renderErrors], isLoaded: calm >= 20, tiles: tiles.length,
    deepest: Math.max(...tiles.map(({level}) => level)), hasNormals: terrainProvider.hasVertexNormals,
  };
}

async function sample(points) {
  const places = points.map(([longitude, latitude]) => Cesium.Cartographic.fromDegrees(longitude, latitude));
  const sampled = await Cesium.sampleTerrainMostDetailed(window.viewer.terrainProvider, places);
  return sampled.map(({height}) => height ?? NaN);
}
