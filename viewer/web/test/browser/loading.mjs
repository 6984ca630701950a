// Tiles that come late, out of order, and one in twenty not at first: never a hole or a crack, and
// in the end the same picture.
//
//     node loading.mjs [--chromium /usr/bin/chromium]
import {mkdtemp, rm} from 'node:fs/promises';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {parseArgs} from 'node:util';
import {writeTileset} from '../synthetic_tiles.mjs';
import {check, failures, open, ready, withBrowser} from './browser.mjs';
import {differenceOf, keepPicture, readPicture} from './picture.mjs';
import {serveFolders} from './serve_folder.mjs';

const {values: options} = parseArgs({
  options: {chromium: {type: 'string', default: '/usr/bin/chromium'}},
});
const kDist = process.env.TERRANE_WEB_DIST ?? fileURLToPath(new URL('../../dist', import.meta.url));
/** Down on a place away from the hole in the data. */
const kPose = {eye: [-2300, -2700, 1500], headingDeg: 20, pitchDeg: -50};
const kLooks = 12;

/** Answers tiles after 50 to 500 ms; every twentieth one fails the first time. */
async function delayTiles(page) {
  const asked = new Map();
  await page.route('**/*.glb', async (route) => {
    const url = route.request().url();
    const tries = (asked.get(url) ?? 0) + 1;
    asked.set(url, tries);
    const fails = tries === 1 && asked.size % 20 === 3;
    // the same delays in every run
    const number = [...url].reduce(
      (sum, letter) => (sum * 31 + letter.charCodeAt(0)) % 9973,
      tries,
    );
    await new Promise((resolve) => setTimeout(resolve, 50 + (number % 450)));
    await (fails ? route.fulfill({status: 503}) : route.continue()).catch(() => {});
  });
}

async function watchLoading(page) {
  let [mismatches, enclosed, held, seams] = [0, 0, 0, 0];
  for (let i = 0; i < kLooks; ++i) {
    const report = await page.evaluate(() => window.terrane.checkSeams());
    const picture = report.tiles > 0 ? await readPicture(page) : {enclosed: 0};
    mismatches += report.mismatches;
    seams += report.pairs;
    enclosed += picture.enclosed;
    held += (await page.evaluate(() => window.terrane.stats())).holdbacks;
    await page.waitForTimeout(80);
  }
  check(
    held > 0 && seams > 0,
    `${kLooks} looks while loading: ${held} times held back, ${seams} seams`,
  );
  check(mismatches === 0, `${mismatches} vertices apart`);
  check(enclosed === 0, `${enclosed} pixels of backdrop inside the terrain`);
}

/** The finished picture: the other page compares with it. */
async function finalPicture(page) {
  await ready(page);
  await keepPicture(page, 'final');
  return page.evaluate(() => [...window.kept.final]);
}

async function run(folder) {
  await writeTileset(folder);
  const server = await serveFolders([folder, kDist]);
  await withBrowser(options.chromium, async (context) => {
    const atOnce = await open(context, server.url, 4);
    await atOnce.page.evaluate((pose) => window.terrane.setPose(pose), kPose);
    const expected = await finalPicture(atOnce.page);
    await atOnce.page.close();

    const {page, problems} = await open(context, server.url, 4, {prepare: delayTiles});
    await page.evaluate((pose) => window.terrane.setPose(pose), kPose);
    await watchLoading(page);
    await finalPicture(page);
    const {tileMs} = await page.evaluate(() => window.terrane.stats());
    check(
      tileMs < 4,
      `${tileMs.toFixed(2)} ms of the page's own time for a tile, decoding left out`,
    );
    await page.evaluate((pixels) => (window.kept.expected = Uint8Array.from(pixels)), expected);
    const {largest} = await differenceOf(page, 'final', 'expected');
    check(largest === 0, `the final picture differs by ${largest} from that without delays`);
    check(problems.requests.length > 0, `${problems.requests.length} requests failed on the way`);
  });
  server.close();
}

const folder = await mkdtemp(join(tmpdir(), 'terrane-tiles-'));
await run(folder).catch((error) => check(false, error.message));
await rm(folder, {recursive: true});
process.exit(failures() > 0 ? 1 : 0);
