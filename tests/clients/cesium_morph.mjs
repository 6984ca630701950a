// cesium_morph.mjs FOLDER PICTURES: docs/samples/cesium_morph.html blends levels with a CustomShader. Level 0
// at t = 1 is level 1 at t = 0, pixel for pixel, and neither is level 0 at t = 0.
import {readFile} from 'node:fs/promises';
import {join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {check, failures, lookAt, open, takePicture, withBrowser} from './browser.mjs';
import {cesiumMounts, kBackground} from './cesium_page.mjs';
import {servePages} from './page_server.mjs';

const [folder, pictures] = process.argv.slice(2);
const samples = fileURLToPath(new URL('../../docs/samples/', import.meta.url));
const server = await servePages({...cesiumMounts(folder), '/samples/': samples});
const {levels} = JSON.parse(await readFile(join(folder, 'trinidad/terrane.json'), 'utf8'));

await withBrowser(async (context) => {
  const fine = await show(context, 0, 0);
  const morphed = await show(context, 0, 1);
  const coarse = await show(context, 1, 0);
  const {page} = await open(context, `${server.url}/cesium.html`);
  const different = async (a, b) => (await compare(page, a.png, b.png)).toFixed(4);
  // where an edge passes through the middle of a pixel, either side may win
  const equal = await different(morphed, coarse);
  check(equal < 0.002, `level 0 at t = 1 looks like level 1 (${equal} of the pixels differ)`);
  const moved = await different(fine, coarse);
  check(moved > 0.01, `level 0 at t = 0 does not (${moved})`);
  const {drawn, colours} = await lookAt(page, morphed.png, kBackground);
  check(drawn > 0.1 && colours > 40, `the picture is not blank (${(100 * drawn).toFixed(0)} %, ${colours} colours)`);
});
server.close();
process.exit(failures() > 0 ? 1 : 0);

async function show(context, level, t) {
  const radius = levels.at(-1).largest_diagonal_m / 2;
  // a tile of the next level is refined, one of this level is not, wherever it is
  const pixelsPerMetre = 480 / (2 * Math.tan(Math.PI / 6)) / (2 * radius);
  const sse = level === 0 ? 1e-6 : levels[1].tolerance_m * pixelsPerMetre * 2.2;
  const url = new URL(`${server.url}/samples/cesium_morph.html`);
  Object.entries({tileset: '/tiles/trinidad/tileset.json', cesium: '/cesium/', t, sse}).forEach(
    ([key, value]) => url.searchParams.set(key, value));
  const {page, problems} = await open(context, url.href);
  const shown = await page.evaluate(settle);
  check(problems.errors.length === 0 && problems.requests.length === 0,
    `t = ${t}: no error ${[...problems.errors, ...problems.requests].slice(0, 2)}`);
  check(shown.length === 1 && shown[0] === `${level}`, `t = ${t}: only tiles of level ${level} are drawn (${shown})`);
  await page.addStyleTag({content: '#blend, .cesium-viewer-bottom { display: none; }'});
  const png = await takePicture(page, join(pictures, `cesium_morph_${level}_${t}.png`));
  await page.close();
  return {png};
}

/** Share of pixels that differ visibly. */
async function compare(page, a, b) {
  return page.evaluate(async (pictures) => {
    const [left, right] = await Promise.all(pictures.map(async (base64) => {
      const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
      const bitmap = await createImageBitmap(new Blob([bytes], {type: 'image/png'}));
      const pen = new OffscreenCanvas(bitmap.width, bitmap.height).getContext('2d');
      pen.drawImage(bitmap, 0, 0);
      return pen.getImageData(0, 0, bitmap.width, bitmap.height).data;
    }));
    let different = 0;
    for (let i = 0; i < left.length; i += 4) different += Math.abs(left[i] - right[i]) > 4;
    return (4 * different) / left.length;
  }, [a.toString('base64'), b.toString('base64')]);
}

// runs in the page

async function settle() {
  while (!window.tileset) await new Promise((resolve) => setTimeout(resolve, 50));
  const levels = new Set();
  window.tileset.tileVisible.addEventListener((tile) => levels.add(tile.extras.terrane.level));
  for (let calm = 0, frames = 0; calm < 20 && frames < 3000; ++frames) {
    levels.clear();
    await new Promise((resolve) => requestAnimationFrame(resolve));
    calm = window.tileset.tilesLoaded && levels.size > 0 ? calm + 1 : 0;
  }
  return [...levels].map(String);
}
