// A .pmtiles file opened by its address, dropped on the start page and chosen there shows what its
// folder shows.
//
//     node archive.mjs --url http://127.0.0.1:8080/ --archive FILE.pmtiles --dist DIST [--tolerance 2]
//
// --url serves the folder that FILE was packed from, --dist is the built viewer.
import {readFile} from 'node:fs/promises';
import {basename, dirname} from 'node:path';
import {parseArgs} from 'node:util';
import {check, failures, open, ready, withBrowser} from './browser.mjs';
import {readPixels} from './picture.mjs';
import {serveFolders} from './serve_folder.mjs';

const {values: options} = parseArgs({
  options: {
    url: {type: 'string'},
    archive: {type: 'string'},
    dist: {type: 'string'},
    tolerance: {type: 'string', default: '2'},
    chromium: {type: 'string', default: '/usr/bin/chromium'},
  },
});
const kName = basename(options.archive);

/** Looks from the south over all of it. */
async function look(page) {
  await page.evaluate(() => {
    const {min, max} = window.terrane.bounds();
    const wide = max[0] - min[0];
    const eye = [min[0] + 0.4 * wide, min[1] + 0.07 * (max[1] - min[1]), max[2] + 0.09 * wide];
    window.terrane.setPose({eye, headingDeg: 12, pitchDeg: -24});
  });
  await ready(page);
  const {tiles, failed} = await page.evaluate(() => window.terrane.stats());
  return {pixels: await readPixels(page), tiles, failed};
}

function compare(what, found, expected) {
  const differ = found.pixels.filter((value, i) => value !== expected.pixels[i]).length;
  check(
    differ === 0 && found.tiles > 4 && found.failed === 0,
    `${what}: ${found.tiles} tiles in the picture, ${differ} bytes of it differ from the folder's`,
  );
}

async function openByAddress(context, url, expected) {
  const answers = [];
  const prepare = (page) =>
    page.on('response', (response) => answers.push([response.status(), response.url()]));
  const {page, problems} = await open(context, `${url}?tileset=${kName}`, options.tolerance, {
    prepare,
  });
  compare('by address', await look(page), expected);
  const ranges = answers.filter(([status, from]) => status === 206 && from.endsWith(kName));
  const files = answers.filter(([, from]) => /\.(glb|json)$/.test(new URL(from).pathname));
  check(
    ranges.length > 3 && files.length === 0,
    `${ranges.length} ranges of it were read, ${files.length} other files`,
  );
  check(problems.requests.length === 0, `failed requests: ${problems.requests.join('; ') || 'none'}`);
  await page.close();
}

/** Opens the page without a data set, gives it the file in some way, and looks. */
async function openOnStartPage(context, url, what, give, expected) {
  const started = () => !document.getElementById('start').hidden;
  const {page} = await open(context, url, options.tolerance, {started});
  await give(page);
  await page.waitForFunction(() => window.terrane);
  compare(what, await look(page), expected);
  check(await page.locator('#start').isHidden(), 'the start page has gone');
  await page.close();
}

async function drop(page) {
  const bytes = (await readFile(options.archive)).toString('base64');
  const dataTransfer = await page.evaluateHandle(
    ([base64, name]) => {
      const content = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
      const transfer = new DataTransfer();
      transfer.items.add(new File([content], name));
      return transfer;
    },
    [bytes, kName],
  );
  await page.dispatchEvent('body', 'dragover', {dataTransfer});
  check(await page.evaluate(() => document.body.classList.contains('dropping')), 'shows where to drop');
  await page.dispatchEvent('body', 'drop', {dataTransfer});
}

async function run(context) {
  const {page} = await open(context, options.url, options.tolerance);
  const expected = await look(page);
  await page.close();
  const server = await serveFolders([options.dist, dirname(options.archive)]);
  await openByAddress(context, server.url, expected);
  await openOnStartPage(context, server.url, 'dropped', drop, expected);
  const choose = (start) => start.setInputFiles('#start-file', options.archive);
  await openOnStartPage(context, server.url, 'chosen', choose, expected);
  server.close();
}

withBrowser(options.chromium, run)
  .catch((error) => check(false, error.message))
  .finally(() => process.exit(failures() > 0 ? 1 : 0));
