// maplibre_dem.mjs FOLDER PICTURES: MapLibre shows raster tiles of heights as terrain, and knows how high
// it is. Builds them from the DEM trinidad.tif of FOLDER.
import {execFileSync} from 'node:child_process';
import {mkdtemp, readFile, rm} from 'node:fs/promises';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {check, failures, lookAt, open, takePicture, withBrowser} from './browser.mjs';
import {servePages} from './page_server.mjs';

// half a cell of the DEM (46 m) aside, on a slope of 1 to 2
const kMostRms_m = 23;
const kPage = `<!doctype html><meta charset="utf-8">
<style>html, body, #map { margin: 0; height: 100%; background: black; }</style><body><div id="map"></div>
<script type="module" src="/maplibre_page.mjs"></script></body>`;
const here = (path) => fileURLToPath(new URL(path, import.meta.url));

const [folder, pictures] = process.argv.slice(2);
const points = JSON.parse(await readFile(join(folder, 'trinidad_points.json'), 'utf8'));
const pageModule = await readFile(here('maplibre_page.js'), 'utf8');
const sets = await mkdtemp(join(tmpdir(), 'terrane-raster-'));
const server = await servePages({
  '/page.html': () => kPage, '/maplibre_page.mjs': () => pageModule,
  '/maplibre/': here('node_modules/maplibre-gl/dist/'), '/tiles/': sets,
});
try {
  for (const [name, options] of [['terrarium', ['--raster-px', '256']], ['terrain-rgb', ['--raster-image', 'webp']]]) {
    execFileSync(process.env.TERRANE, ['--quiet', 'build', join(folder, 'trinidad.tif'), '--vertical-unit', 'foot',
      '-o', join(sets, name), '--format', name, '--attribution', 'Terrane test', ...options]);
  }
  await withBrowser(async (context) => {
    for (const name of ['terrarium', 'terrain-rgb']) await look(context, name);
  });
  check(server.missing.length === 0, `nothing asked for that is not there ${server.missing.slice(0, 3)}`);
} finally {
  server.close();
  await rm(sets, {recursive: true, force: true});
}
process.exit(failures() > 0 ? 1 : 0);

async function look(context, name) {
  const {page, problems} = await open(context, `${server.url}/page.html`);
  await page.waitForFunction(() => window.show);
  const heights = await page.evaluate(([url, places]) => window.show(url, places),
    [`${server.url}/tiles/${name}/tiles.json`, points.map(([longitude, latitude]) => [longitude, latitude])]);
  const wrong = [...problems.errors, ...problems.requests];
  check(wrong.length === 0, `${name}: no error, no failed request ${wrong.slice(0, 3)}`);
  const off = points.map(([, , height], n) => Math.abs(heights[n] - height));
  const rms = Math.hypot(...off) / Math.sqrt(off.length);
  check(off.every(Number.isFinite) && rms < kMostRms_m,
    `${name}: ${off.length} heights are those of the DEM: RMS ${rms.toFixed(2)} m, at most ${Math.max(...off).toFixed(2)} m`);
  const seen = await lookAt(page, await takePicture(page, join(pictures, `maplibre_${name}.png`)), [0, 0, 0]);
  check(seen.drawn > 0.3 && seen.colours > 50,
    `${name}: the picture is not blank (${(100 * seen.drawn).toFixed(0)} %, ${seen.colours} colours)`);
  await page.close();
}
