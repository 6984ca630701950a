// Looks at a served tileset with headless Chromium.
//
//     node view.mjs --url http://127.0.0.1:8080/ --screenshot view.png
//         [--tolerance 1] [--steps 20] [--chromium /usr/bin/chromium] [--closeup close.png]
//         [--most-triangles 50000]
//         [--covered x,y]   a place, in world metres, without holes in the data around it
//
// One line for each check; exit status 0 if all hold.
import {writeFile} from 'node:fs/promises';
import {parseArgs} from 'node:util';
import {check, failures, open, ready, withBrowser} from './browser.mjs';
import {readPicture} from './picture.mjs';

const {values: options} = parseArgs({
  options: {
    url: {type: 'string'},
    screenshot: {type: 'string'},
    closeup: {type: 'string'},
    tolerance: {type: 'string', default: '1'},
    steps: {type: 'string', default: '20'},
    covered: {type: 'string'},
    // what software rendering manages in a few seconds
    'most-triangles': {type: 'string', default: '50000'},
    chromium: {type: 'string', default: '/usr/bin/chromium'},
  },
});

/** Cameras from afar down to a few samples over the ground, turning on the way. */
async function cameraPath(page, steps) {
  const {min, max} = await page.evaluate(() => window.terrane.bounds());
  // not the middle itself, where four tiles meet
  const [x, y] = [0, 1].map((k) => 0.6 * min[k] + 0.4 * max[k]);
  const z = await page.evaluate(([px, py]) => window.terrane.groundZ(px, py), [x, y]);
  const target = [x, y, z ?? (min[2] + max[2]) / 2];
  const far = 0.8 * Math.hypot(max[0] - min[0], max[1] - min[1]);
  return [...Array(steps).keys()].map((i) => {
    const share = i / Math.max(1, steps - 1);
    const distance = far * 0.01 ** share;
    const [turn, pitch] = [2.5 * share, 0.6];
    const eye = [
      target[0] + distance * Math.sin(turn) * Math.cos(pitch),
      target[1] - distance * Math.cos(turn) * Math.cos(pitch),
      target[2] + distance * Math.sin(pitch),
    ];
    return {eye, target};
  });
}

function checkStep(text, stats, loading, settled) {
  const levels = Object.entries(stats.levels).map(([level, tiles]) => `${level}:${tiles}`);
  const tight = settled.mismatches === 0 && loading.mismatches === 0;
  // from afar the root alone is enough, and has no seams
  const hasSeams = settled.pairs > 0 || settled.tiles === 1;
  const holds = hasSeams && tight && stats.triangles > 0;
  check(
    holds && stats.triangles < Number(options['most-triangles']),
    `${text}: ${stats.triangles} triangles, tiles ${levels.join(' ')}; ${settled.pairs} seams, ` +
      `${settled.vertices} vertices, ${settled.mismatches} mismatches (${settled.worst_m} m), ` +
      `${loading.mismatches} while loading`,
  );
}

async function walk(page) {
  const steps = Number(options.steps);
  const cameras = await cameraPath(page, steps);
  let withSeams = 0;
  for (const [i, camera] of cameras.entries()) {
    await page.evaluate((c) => window.terrane.setCamera(c), camera);
    // before everything has arrived: a coarser cut, but no cracks either
    const loading = await page.evaluate(() => window.terrane.checkSeams());
    await ready(page);
    const settled = await page.evaluate(() => window.terrane.checkSeams());
    const stats = await page.evaluate(() => window.terrane.stats());
    checkStep(`step ${i + 1} of ${steps}`, stats, loading, settled);
    if (settled.pairs > 0) ++withSeams;
  }
  check(withSeams >= steps / 2, `${withSeams} of ${steps} steps have seams to compare`);
}

/** Looks down on a place from several heights: a pixel that shows the sky is a crack. */
async function lookDown(page, [x, y]) {
  const z = await page.evaluate(([px, py]) => window.terrane.groundZ(px, py), [x, y]);
  for (const distance of [2000, 1400, 1000, 700, 400]) {
    const eye = [x + 0.2 * distance, y - 0.5 * distance, z + distance];
    await page.evaluate((c) => window.terrane.setCamera(c), {eye, target: [x, y, z]});
    await ready(page);
    const {drawn} = await readPicture(page);
    const {levels} = await page.evaluate(() => window.terrane.stats());
    const text = Object.entries(levels).map(([level, tiles]) => `${level}:${tiles}`);
    check(drawn === 1, `from ${distance} m above, tiles ${text.join(' ')}: no sky between them`);
  }
}

async function look(context) {
  const {page, problems} = await open(context, options.url, options.tolerance);
  await ready(page);
  const picture = await readPicture(page);
  check(picture.drawn > 0.1, `terrain covers ${(100 * picture.drawn).toFixed(0)} % of the picture`);
  check(picture.colors > 500, `${picture.colors} different colours`);
  const stats = await page.evaluate(() => window.terrane.stats());
  check(stats.triangles > 0, `${stats.triangles} triangles in ${stats.tiles} tiles`);
  if (options.screenshot) await writeFile(options.screenshot, await page.screenshot());
  await walk(page);
  if (options.covered) await lookDown(page, options.covered.split(',').map(Number));
  if (options.closeup) await writeFile(options.closeup, await page.screenshot());
  const {failed} = await page.evaluate(() => window.terrane.stats());
  check(failed === 0, `${failed} tiles failed`);
  const {console: errors, requests} = problems;
  check(errors.length === 0, `console errors: ${errors.join('; ') || 'none'}`);
  check(requests.length === 0, `failed requests: ${requests.join('; ') || 'none'}`);
}

async function main() {
  if (!options.url) throw new Error('Say --url, the address of the page to look at');
  await withBrowser(options.chromium, look);
}

main()
  .catch((error) => check(false, error.message))
  .finally(() => process.exit(failures() > 0 ? 1 : 0));
