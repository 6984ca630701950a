// A tile that cannot be loaded: its parent stays, the page says so, and it comes when it can.
//
//     node failed_tile.mjs [--chromium /usr/bin/chromium]
import {mkdtemp, rename, rm} from 'node:fs/promises';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {parseArgs} from 'node:util';
import {writeTileset} from '../synthetic_tiles.mjs';
import {check, comesTrue, failures, open, ready, withBrowser} from './browser.mjs';
import {serveFolders} from './serve_folder.mjs';

const {values: options} = parseArgs({
  options: {chromium: {type: 'string', default: '/usr/bin/chromium'}},
});
const kDist = process.env.TERRANE_WEB_DIST ?? fileURLToPath(new URL('../../dist', import.meta.url));
/** Below the camera. */
const kAddress = 'tiles/0/1/6.glb';
const kCamera = {eye: [-2400, -2600, 1200], target: [-2400, -2400, 500]};

async function expectParent(page) {
  await page.waitForFunction(() => window.terrane.stats().failed > 0);
  // the more of the rest has arrived, the more there is to see; what is checked holds before, too
  await page.waitForTimeout(1500);
  const message = () => page.textContent('#error');
  const isSaid = await comesTrue(async () => (await message()).includes(`${kAddress}: status 404`));
  check(isSaid, `the page says: ${await message()}`);
  const stats = () => page.evaluate(() => window.terrane.stats());
  const isParentShown = await comesTrue(async () => (await stats()).levels[1] > 0);
  const {levels, shownTolerancePx} = await stats();
  check(isParentShown, `its parent is shown: ${JSON.stringify(levels)}`);
  check(shownTolerancePx > 1, `and what error they have: ${shownTolerancePx.toFixed(1)} px`);
  const seams = await page.evaluate(() => window.terrane.checkSeams());
  check(seams.pairs > 0 && seams.mismatches === 0, `${seams.pairs} seams, none open`);
}

async function expectRecovery(page) {
  await ready(page);
  const {failed, levels} = await page.evaluate(() => window.terrane.stats());
  check(failed === 0 && levels[0] > 0, `it came at last: ${JSON.stringify(levels)}`);
  check(await page.isHidden('#error'), 'the message is gone');
}

async function run(folder) {
  await writeTileset(folder);
  await rename(join(folder, kAddress), join(folder, 'away.glb'));
  const server = await serveFolders([folder, kDist]);
  await withBrowser(options.chromium, async (context) => {
    const {page} = await open(context, server.url, 1);
    await page.evaluate((camera) => window.terrane.setCamera(camera), kCamera);
    await expectParent(page);
    await rename(join(folder, 'away.glb'), join(folder, kAddress));
    await expectRecovery(page);
  });
  server.close();
}

const folder = await mkdtemp(join(tmpdir(), 'terrane-tiles-'));
await run(folder).catch((error) => check(false, error.message));
await rm(folder, {recursive: true});
process.exit(failures() > 0 ? 1 : 0);
