// Looks at the page of a merge tree with headless Chromium, and compares what it shows with what
// `terrane view-cut` writes for the same cameras: the same engine, native.
//
//     node tree.mjs --url http://127.0.0.1:8080/?tree=x.tree --cuts cuts.json
//         [--screenshot view.png] [--chromium /usr/bin/chromium]
//
// cuts.json: [{"eye": [x, y, z], "target": [...], "settings": {...}, "triangles": [[nine numbers], ...]}],
// places in the mesh's frame. One line for each check; exit status 0 if all hold.
import {readFile, writeFile} from 'node:fs/promises';
import {parseArgs} from 'node:util';
import {check, failures, open, withBrowser} from './browser.mjs';

const {values: options} = parseArgs({
  options: {
    url: {type: 'string'},
    cuts: {type: 'string'},
    screenshot: {type: 'string'},
    chromium: {type: 'string', default: '/usr/bin/chromium'},
  },
});

const kPlain = {
  measure: 'error',
  tolerancePx: 1,
  frustum: false,
  backFaces: false,
  silhouettes: false,
  highlight: false,
  colours: false,
  budget: null,
  blend: false,
  wireframe: false,
  frozen: false,
  lightAzimuthDeg: 40,
  lightHeightDeg: 50,
};

/** A triangle by its corners, whichever comes first. */
function nameOf(places, origin) {
  const corners = [0, 3, 6].map((at) =>
    [0, 1, 2].map((k) => Math.fround(places[at + k] - origin[k])).join(' '));
  const first = corners.indexOf([...corners].sort()[0]);
  return [0, 1, 2].map((k) => corners[(first + k) % 3]).join(', ');
}

async function show(page, {eye, target, settings = {}}) {
  await page.evaluate(
    ([camera, change]) => {
      window.terraneTree.set(change);
      window.terraneTree.setCamera(camera);
      return window.terraneTree.ready();
    },
    [{eye, target}, {...kPlain, ...settings}],
  );
  return page.evaluate(() => window.terraneTree.stats());
}

function shownOf(page) {
  return page.evaluate(() => window.terraneTree.corners());
}

async function checkCut(page, cut, origin) {
  const stats = await show(page, cut);
  const text = `${cut.eye.map((x) => Number(x.toPrecision(4)))} ${JSON.stringify(cut.settings)}`;
  const corners = await shownOf(page);
  const shown = [];
  for (let i = 0; i < corners.length; i += 9) shown.push(nameOf(corners.slice(i, i + 9), origin));
  const wanted = new Set(cut.triangles.map((places) => nameOf(places, origin)));
  const common = shown.filter((name) => wanted.has(name)).length;
  check(
    shown.length === cut.triangles.length && common === wanted.size,
    `${text}: ${shown.length} triangles, ${common} of view-cut's ${cut.triangles.length}; ` +
      `${stats.splits} splits, ${stats.merges} merges, ${(stats.uploadedBytes / 1e3).toFixed(0)} kB sent`,
  );
  return {stats, common};
}

/** Colours of the canvas, and the share of it that the model covers. */
function look(page, name) {
  return page.evaluate((key) => {
    const canvas = document.getElementById('terrain');
    const {width, height} = canvas;
    const copy = new OffscreenCanvas(width, height).getContext('2d');
    window.terraneTree.redraw();
    copy.drawImage(canvas, 0, 0);
    const pixels = new Uint32Array(copy.getImageData(0, 0, width, height).data.buffer);
    const backdrop = pixels[0];
    window.kept ??= {};
    window.kept[key] = pixels;
    let covered = 0;
    for (const pixel of pixels) covered += pixel !== backdrop;
    return {covered: covered / pixels.length, colors: new Set(pixels).size};
  }, name);
}

function differing(page, a, b) {
  return page.evaluate(
    ([first, second]) => {
      const [p, q] = [window.kept[first], window.kept[second]];
      let count = 0;
      for (let i = 0; i < p.length; ++i) count += p[i] !== q[i];
      return count;
    },
    [a, b],
  );
}

/** What the card holds after partial uploads is what a page has that was sent everything at once. */
async function checkUploads(page, context, cut) {
  await show(page, {...cut, settings: {...cut.settings, wireframe: true}});
  await look(page, 'walked');
  const walked = await page.evaluate(() => Array.from(window.kept.walked));
  const {page: fresh} = await open(context, options.url, 1, {started: () => window.terraneTree});
  await show(fresh, {...cut, settings: {...cut.settings, wireframe: true}});
  await look(fresh, 'fresh');
  const count = await fresh.evaluate((other) => {
    let differences = 0;
    for (let i = 0; i < other.length; ++i) differences += other[i] !== window.kept.fresh[i];
    return differences;
  }, walked);
  await fresh.close();
  check(count === 0, `${count} pixels differ from those of a page that walked nowhere`);
}

async function checkFreeze(page, cut) {
  const before = await show(page, cut);
  const {middle, reach} = await page.evaluate(() => window.terraneTree.summary());
  const elsewhere = {eye: [middle[0] + 2 * reach, middle[1] + 2 * reach, middle[2] + reach], target: middle};
  const frozen = await show(page, {...elsewhere, settings: {...cut.settings, frozen: true, wireframe: true}});
  const {covered, colors} = await look(page, 'frozen');
  check(
    frozen.triangles === before.triangles && covered > 0.05 && colors > 20,
    `frozen: ${frozen.triangles} triangles from elsewhere, ${(100 * covered).toFixed(0)} % covered, ${colors} colours`,
  );
  if (options.screenshot) await writeFile(options.screenshot, await page.screenshot());
  const thawed = await show(page, {...elsewhere, settings: cut.settings});
  check(thawed.triangles !== frozen.triangles, `and ${thawed.triangles} when it is let go`);
}

async function checkLight(page, cut) {
  const settings = {tolerancePx: 4, highlight: true, lightHeightDeg: 30};
  await show(page, {...cut, settings: {...settings, lightAzimuthDeg: 0}});
  await look(page, 'east');
  const east = await page.evaluate(() => window.terraneTree.stats().triangles);
  await show(page, {...cut, settings: {...settings, lightAzimuthDeg: 180}});
  await look(page, 'west');
  const west = await page.evaluate(() => window.terraneTree.stats().triangles);
  const pixels = await differing(page, 'east', 'west');
  check(pixels > 1000 && east !== west,
    `the light moves: ${pixels} pixels change, and ${east} triangles become ${west}`);
}

async function checkBudget(page, cut) {
  const {fullTriangles} = await page.evaluate(() => window.terraneTree.summary());
  const budget = Math.round(fullTriangles / 4);
  const stats = await show(page, {...cut, settings: {budget}});
  check(Math.abs(stats.triangles / budget - 1) < 0.05,
    `${stats.triangles} triangles for a budget of ${budget}, at ${stats.tolerancePx.toFixed(2)} px`);
}

async function checkBlend(page, cut) {
  const still = await show(page, cut);
  const blended = await show(page, {...cut, settings: {...cut.settings, blend: true}});
  check(still.triangles === blended.triangles, `blending ends at the same ${blended.triangles} triangles`);
  await show(page, cut);
}

/** As a user does it. */
async function checkControls(page) {
  const before = await page.textContent('#stats');
  await page.locator('#tolerancePx').fill('4');
  await page.evaluate(() => window.terraneTree.ready());
  const after = await page.textContent('#stats');
  check(before !== after && after.includes('16 px'), `the panel tells: ${after}`);
  await page.mouse.move(400, 240);
  await page.mouse.down();
  await page.mouse.move(480, 260, {steps: 4});
  await page.mouse.up();
  await page.evaluate(() => window.terraneTree.ready());
  check((await page.textContent('#stats')) !== after, 'a drag turns the model');
}

async function run(context, cuts) {
  const {page, problems} = await open(context, options.url, 1, {started: () => window.terraneTree});
  const {origin, fullTriangles} = await page.evaluate(() => window.terraneTree.summary());
  for (const cut of cuts) {
    await checkCut(page, cut, origin);
    const {covered, colors} = await look(page, 'cut');
    check(covered > 0.02 && colors > 20, `  ${(100 * covered).toFixed(0)} % covered in ${colors} colours`);
  }
  const last = cuts.at(-1);
  await checkUploads(page, context, last);
  await checkFreeze(page, last);
  await checkLight(page, last);
  await checkBudget(page, last);
  await checkBlend(page, last);
  await checkControls(page);
  check(fullTriangles > 0 && (await page.isHidden('#error')), 'no error is shown');
  const {console: errors, requests} = problems;
  check(errors.length === 0, `console errors: ${errors.join('; ') || 'none'}`);
  check(requests.length === 0, `failed requests: ${requests.join('; ') || 'none'}`);
}

async function main() {
  if (!options.url || !options.cuts) throw new Error('Say --url and --cuts');
  const cuts = JSON.parse(await readFile(options.cuts, 'utf8'));
  await withBrowser(options.chromium, (context) => run(context, cuts));
}

main()
  .catch((error) => check(false, error.message))
  .finally(() => process.exit(failures() > 0 ? 1 : 0));
