// triangles_shown.mjs VIEWER FOLDER NAME...: how many triangles each client draws for the same view at the same
// error on the screen. Not a test: a table for docs/benchmarks.md.
//
// VIEWER is the built viewer; FOLDER holds, for each NAME, NAME (3D Tiles) and NAME_terrain (`--scheme
// geodetic`) of one DEM. Tiles count that reach into the picture, and of terrain those over the DEM.
import {readFile} from 'node:fs/promises';
import {join} from 'node:path';
import {open, withBrowser} from './browser.mjs';
import {cesiumMounts} from './cesium_page.mjs';
import {servePages} from './page_server.mjs';

const [viewer, folder, ...names] = process.argv.slice(2);
const kTolerancePx = 2;
const kFovDeg = 45;

/** Shares of the DEM's extent from its south-west corner; `over` its highest place, in shares of its diagonal. */
const kViews = {
  'the whole DEM': {x: 0.5, y: -0.55, over: 0.45, headingDeg: 0, pitchDeg: -33},
  'from above': {x: 0.5, y: 0.5, over: 0.9, headingDeg: 0, pitchDeg: -89},
  'over the rim': {x: 0.5, y: 0.02, over: 0.06, headingDeg: 0, pitchDeg: -18},
  'across a corner': {x: 0.05, y: 0.05, over: 0.15, headingDeg: 45, pitchDeg: -28},
  'low over the middle': {x: 0.5, y: 0.35, over: 0.01, headingDeg: 20, pitchDeg: -15},
  'steeply down': {x: 0.6, y: 0.5, over: 0.02, headingDeg: 250, pitchDeg: -60},
};

const server = await servePages({'/view/': viewer, ...cesiumMounts(folder)});
await withBrowser(async (context) => {
  for (const name of names) {
    const poses = await inViewer(context, name);
    const tiles = await inCesium(context, name, poses, showTiles, `/tiles/${name}/tileset.json`);
    const terrain = await inCesium(context, name, poses, showTerrain, `/tiles/${name}_terrain`);
    console.log(`| ${name} | viewer | CesiumJS, 3D Tiles | CesiumJS, quantized-mesh |\n|---|---|---|---|`);
    poses.forEach(({view, triangles}, n) => console.log(`| ${view} | ${[triangles, tiles[n], terrain[n]]
      .map((count) => count.toLocaleString('en')).join(' | ')} |`));
  }
});
if (server.missing.length > 0) console.log(`not there: ${server.missing.slice(0, 3)}`);
server.close();

async function inViewer(context, name) {
  const {page} = await open(context, `${server.url}/view/index.html?antialias=off&tolerance=${kTolerancePx}` +
    `&tileset=${encodeURIComponent(`/tiles/${name}/tileset.json`)}`);
  await page.waitForFunction(() => window.terrane);
  const {min, max} = await page.evaluate(() => window.terrane.bounds());
  const diagonal = Math.hypot(max[0] - min[0], max[1] - min[1]);
  const shown = [];
  for (const [view, {x, y, over, headingDeg, pitchDeg}] of Object.entries(kViews)) {
    const eye = [min[0] + x * (max[0] - min[0]), min[1] + y * (max[1] - min[1]), max[2] + over * diagonal];
    const pose = {eye, headingDeg, pitchDeg};
    const triangles = await page.evaluate(async (next) => {
      window.terrane.setPose(next);
      await window.terrane.ready();
      return window.terrane.stats().triangles;
    }, pose);
    shown.push({view, pose, triangles});
  }
  await page.close();
  return shown;
}

/** @returns triangles for each pose */
async function inCesium(context, name, poses, show, address) {
  const {frame} = JSON.parse(await readFile(join(folder, name, 'terrane.json'), 'utf8'));
  const {page, problems} = await open(context, `${server.url}/cesium.html`);
  await page.evaluate(defineAim);
  const cameras = poses.map(({pose}) => pose);
  const counts = await page.evaluate(show, {address, cameras, frame, fovDeg: kFovDeg, tolerancePx: kTolerancePx});
  if (problems.errors.length > 0) throw new Error(`${name}: ${problems.errors[0]}`);
  await page.close();
  return counts;
}

// the functions below run in the page

function defineAim() {
  /** Puts the camera where the viewer has it: a place and angles in the tangent plane of a data set. */
  window.aim = ({camera, canvas}, {eye, headingDeg, pitchDeg}, {longitude_deg, latitude_deg}, fovDeg) => {
    const toEarth = Cesium.Transforms.eastNorthUpToFixedFrame(Cesium.Cartesian3.fromDegrees(longitude_deg, latitude_deg));
    const [h, p] = [headingDeg, pitchDeg].map(Cesium.Math.toRadians);
    const direction = new Cesium.Cartesian3(Math.sin(h) * Math.cos(p), Math.cos(h) * Math.cos(p), Math.sin(p));
    const up = new Cesium.Cartesian3(-Math.sin(h) * Math.sin(p), -Math.cos(h) * Math.sin(p), Math.cos(p));
    const turned = (v) => Cesium.Matrix4.multiplyByPointAsVector(toEarth, v, new Cesium.Cartesian3());
    // Cesium's angle is that of the longer side
    const aspect = canvas.clientWidth / canvas.clientHeight;
    camera.frustum.fov = 2 * Math.atan(Math.max(1, aspect) * Math.tan(Cesium.Math.toRadians(fovDeg) / 2));
    camera.setView({
      destination: Cesium.Matrix4.multiplyByPoint(toEarth, new Cesium.Cartesian3(...eye), new Cesium.Cartesian3()),
      orientation: {direction: turned(direction), up: turned(up)},
    });
  };
  /** Draws until nothing is left to load. */
  window.settle = async (isLoaded) => {
    for (let calm = 0, frames = 0; calm < 20; ++frames) {
      if (frames > 3000) throw new Error('not loaded after 3000 frames');
      await new Promise((resolve) => requestAnimationFrame(resolve));
      calm = isLoaded() ? calm + 1 : 0;
    }
  };
}

async function showTiles({address, cameras, frame, fovDeg, tolerancePx}) {
  const viewer = makeViewer({});
  viewer.scene.globe.show = false;
  const tileset = await Cesium.Cesium3DTileset.fromUrl(address, {
    maximumScreenSpaceError: tolerancePx, dynamicScreenSpaceError: false, cullRequestsWhileMoving: false,
  });
  viewer.scene.primitives.add(tileset);
  const counts = [];
  for (const camera of cameras) {
    aim(viewer, camera, frame, fovDeg);
    await settle(() => tileset.tilesLoaded);
    counts.push(tileset.statistics.numberOfTrianglesSelected);
  }
  return counts;
}

async function showTerrain({address, cameras, frame, fovDeg, tolerancePx}) {
  const terrainProvider = await Cesium.CesiumTerrainProvider.fromUrl(address);
  const bounds = (await (await fetch(`${address}/layer.json`)).json()).bounds;
  const overDem = Cesium.Rectangle.fromDegrees(...bounds);
  const viewer = makeViewer({terrainProvider, baseLayer: new Cesium.ImageryLayer(new Cesium.GridImageryProvider({cells: 4}))});
  const {globe} = viewer.scene;
  globe.preloadAncestors = false;
  globe.maximumScreenSpaceError = tolerancePx;
  const counts = [];
  for (const camera of cameras) {
    aim(viewer, camera, frame, fovDeg);
    await settle(() => globe.tilesLoaded);
    // skirts are Cesium's own, and do not count
    counts.push(globe._surface._tilesToRender
      .filter(({rectangle}) => Cesium.Rectangle.simpleIntersection(rectangle, overDem))
      .reduce((sum, {data}) => sum + data.renderedMesh.indexCountWithoutSkirts / 3, 0));
  }
  return counts;
}
