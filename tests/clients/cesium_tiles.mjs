// cesium_tiles.mjs FOLDER PICTURES: CesiumJS shows every tile set of FOLDER that is on the Earth, without a
// failed tile; where it samples heights they are the DEM's within the tolerance.
import {readFile} from 'node:fs/promises';
import {existsSync} from 'node:fs';
import {join} from 'node:path';
import {check, failures, lookAt, open, takePicture, withBrowser} from './browser.mjs';
import {cesiumMounts, kBackground} from './cesium_page.mjs';
import {tileSets} from './glb_files.mjs';
import {servePages} from './page_server.mjs';
import {checkShown} from './shown_tiles.mjs';

// the others say how files are, these how they look
const kShown = /^trinidad/;
const [folder, pictures] = process.argv.slice(2);
const server = await servePages(cesiumMounts(folder));

await withBrowser(async (context) => {
  for (const name of await tileSets(folder)) {
    if (kShown.test(name)) await look(context, name);
  }
});
check(server.missing.length === 0, `nothing asked for that is not there ${server.missing.slice(0, 3)}`);
server.close();
process.exit(failures() > 0 ? 1 : 0);

async function look(context, name) {
  const {levels} = JSON.parse(await readFile(join(folder, name, 'terrane.json'), 'utf8'));
  const {page, problems} = await open(context, `${server.url}/cesium.html`);
  // from above, so near that levels are mixed
  const shown = await page.evaluate(show, {name, finestError: levels[0].tolerance_m, radius: levels.at(-1).largest_diagonal_m / 2});
  const {drawn, colours} = await lookAt(page, await takePicture(page, join(pictures, `cesium_${name}.png`)), kBackground);

  check(shown.failed.length + shown.renderErrors.length + problems.errors.length === 0,
    `${name}: no tile failed, no render error ${[...shown.failed, ...shown.renderErrors, ...problems.errors].slice(0, 3)}`);
  check(problems.requests.length === 0, `${name}: no request failed ${problems.requests.slice(0, 3)}`);
  await checkShown(folder, name, shown);
  check(drawn > 0.1 && colours > 40, `${name}: the picture is not blank (${(100 * drawn).toFixed(0)} %, ${colours} colours)`);
  if (name.startsWith('trinidad')) check(shown.credits.includes('Terrane_test'), `${name}: the attribution is shown`);

  const points = join(folder, `${name.split('-')[0]}_points.json`);
  if (existsSync(points)) await compareHeights(page, name, JSON.parse(await readFile(points, 'utf8')), levels[0].tolerance_m);
  await page.close();
}

async function compareHeights(page, name, points, tolerance) {
  const heights = await page.evaluate(sample, points);
  const off = points.map(([, , height], n) => Math.abs(heights[n] - height));
  const worst = Math.max(...off);
  check(worst <= tolerance + 0.02, `${name}: ${points.length} sampled heights are within ${tolerance} m of the DEM (${worst.toFixed(2)} m)`);
}

// the functions below run in the page

async function show({name, finestError, radius}) {
  const viewer = makeViewer({});
  window.viewer = viewer;
  const {scene, camera} = viewer;
  scene.globe.show = false;
  const tileset = await Cesium.Cesium3DTileset.fromUrl(`/tiles/${name}/tileset.json`, {cullRequestsWhileMoving: false, showCreditsOnScreen: true});
  const failed = [];
  tileset.tileFailed.addEventListener(({url, message}) => failed.push(`${url}: ${message}`));
  scene.primitives.add(tileset);
  camera.viewBoundingSphere(tileset.boundingSphere, new Cesium.HeadingPitchRange(0.4, -0.6, 2.3 * radius));
  // the nearest part at level 1 or 0, the farthest at higher ones
  const pixelsPerRadian = scene.drawingBufferHeight / camera.frustum.sseDenominator;
  tileset.maximumScreenSpaceError = (4 * finestError * pixelsPerRadian) / (1.9 * radius);
  const tiles = new Set();
  tileset.tileVisible.addEventListener((tile) => tiles.add(tile.content.url));
  for (let calm = 0, frames = 0; calm < 20 && frames < 3000; ++frames) {
    tiles.clear();
    await new Promise((resolve) => requestAnimationFrame(resolve));
    calm = tileset.tilesLoaded && tiles.size > 0 ? calm + 1 : 0;
  }
  return {
    failed, renderErrors: window.renderErrors, tiles: [...tiles],
    triangles: tileset.statistics.numberOfTrianglesSelected,
    credits: document.querySelector('.cesium-viewer-bottom').textContent,
  };
}

async function sample(points) {
  const places = points.map(([longitude, latitude]) => Cesium.Cartographic.fromDegrees(longitude, latitude));
  const sampled = await window.viewer.scene.sampleHeightMostDetailed(places);
  return sampled.map(({height}) => height ?? NaN);
}
