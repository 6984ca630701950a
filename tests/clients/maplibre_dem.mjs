// maplibre_dem.mjs FOLDER PICTURES: MapLibre shows raster tiles of heights as terrain, and knows how high
// it is: what gdalwarp makes of the DEM at the middles of pixels, and MapLibre between them. Builds them
// from the DEM trinidad.tif of FOLDER.
import {execFileSync} from 'node:child_process';
import {mkdtemp, readFile, rm} from 'node:fs/promises';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {check, failures, lookAt, open, takePicture, withBrowser} from './browser.mjs';
import {servePages} from './page_server.mjs';

const kSets = [
  {name: 'terrarium', step_m: 1 / 256, options: ['--raster-px', '256']},
  {name: 'terrain-rgb', step_m: 0.1, options: ['--raster-image', 'webp']},
];
// cli.raster: pixels of a real DEM are gdalwarp's to this
const kWarps_m = 1 / 256;
const kCoarser = 4;  // zooms than the finest that MapLibre may draw
const kPage = `<!doctype html><meta charset="utf-8">
<style>html, body, #map { margin: 0; height: 100%; background: black; }</style><body><div id="map"></div>
<script type="module" src="/maplibre_page.mjs"></script></body>`;
const here = (path) => fileURLToPath(new URL(path, import.meta.url));

const [folder, pictures] = process.argv.slice(2);
const dem = join(folder, 'trinidad.tif');
const points = JSON.parse(await readFile(join(folder, 'trinidad_points.json'), 'utf8'));
const pageModule = await readFile(here('maplibre_page.js'), 'utf8');
const sets = await mkdtemp(join(tmpdir(), 'terrane-raster-'));
const server = await servePages({
  '/page.html': () => kPage, '/maplibre_page.mjs': () => pageModule,
  '/maplibre/': here('node_modules/maplibre-gl/dist/'), '/tiles/': sets,
});
try {
  for (const {name, options} of kSets) {
    execFileSync(process.env.TERRANE, ['--quiet', 'build', dem, '--vertical-unit', 'foot',
      '-o', join(sets, name), '--format', name, '--attribution', 'Terrane test', ...options]);
  }
  await withBrowser(async (context) => {
    for (const set of kSets) await look(context, set);
  });
  check(server.missing.length === 0, `nothing asked for that is not there ${server.missing.slice(0, 3)}`);
} finally {
  server.close();
  await rm(sets, {recursive: true, force: true});
}
process.exit(failures() > 0 ? 1 : 0);

async function look(context, {name, step_m}) {
  const {page, problems} = await open(context, `${server.url}/page.html`);
  await page.waitForFunction(() => window.show);
  const heights = await page.evaluate(([url, places]) => window.show(url, places),
    [`${server.url}/tiles/${name}/tiles.json`, points.map(([longitude, latitude]) => [longitude, latitude])]);
  const wrong = [...problems.errors, ...problems.requests];
  check(wrong.length === 0, `${name}: no error, no failed request ${wrong.slice(0, 3)}`);
  await compare(name, heights, step_m);
  const seen = await lookAt(page, await takePicture(page, join(pictures, `maplibre_${name}.png`)), [0, 0, 0]);
  check(seen.drawn > 0.3 && seen.colours > 50,
    `${name}: the picture is not blank (${(100 * seen.drawn).toFixed(0)} %, ${seen.colours} colours)`);
  await page.close();
}

/** MapLibre goes by the pixels of the zoom that it draws, one for all places: the one that fits must fit all. */
async function compare(name, heights, step_m) {
  const {maxzoom, tileSize} = JSON.parse(await readFile(join(sets, name, 'tiles.json'), 'utf8'));
  let grid = await warped(2 ** maxzoom * tileSize, join(sets, name));
  const fits = [];
  for (let zoom = maxzoom; zoom >= maxzoom - kCoarser; --zoom, grid = halved(grid)) {
    const off = points.map((point, n) => Math.abs(heights[n] - between(grid, point))).filter(Number.isFinite);
    fits.push({zoom, count: off.length, worst: Math.max(...off)});
  }
  const {zoom, count, worst} = fits.reduce((best, fit) => (fit.worst < best.worst ? fit : best));
  check(count > 150 && worst <= step_m / 2 + kWarps_m,
    `${name}: ${count} heights are those of GDAL's pixels of zoom ${zoom} of ${maxzoom}, ${worst.toFixed(4)} m off at most (half a step is ${step_m / 2} m)`);
  const off = points.map(([, , height], n) => heights[n] - height);
  console.log(`     ${(Math.hypot(...off) / Math.sqrt(off.length)).toFixed(2)} m RMS off the DEM's samples, which are not in the middle of pixels`);
}

/** Longitude and latitude in pixels of the whole map. */
function onMap([longitude, latitude], across) {
  const y = Math.asinh(Math.tan((latitude * Math.PI) / 180));
  return [((longitude + 180) / 360) * across, (0.5 - y / (2 * Math.PI)) * across];
}

/** The DEM in metres on the pixels around all points, by gdalwarp; on whole pixels of all coarser zooms, too. */
async function warped(across, folder) {
  const block = 2 ** (kCoarser + 2), places = points.map((point) => onMap(point, across));
  const [left, top] = [0, 1].map((k) => (Math.floor(Math.min(...places.map((p) => p[k])) / block) - 1) * block);
  const [right, bottom] = [0, 1].map((k) => (Math.ceil(Math.max(...places.map((p) => p[k])) / block) + 1) * block);
  const half = Math.PI * 6378137, size = (2 * half) / across;
  const extent = [left * size - half, half - bottom * size, right * size - half, half - top * size];
  execFileSync('gdalwarp', ['-q', '-t_srs', 'EPSG:3857', '-r', 'bilinear', '-et', '0', '-ot', 'Float32', '-of', 'ENVI',
    '-te', ...extent.map(String), '-ts', String(right - left), String(bottom - top), '-dstnodata', '-99999',
    dem, `${folder}.warped`]);
  const bytes = await readFile(`${folder}.warped`);
  const feet = new Float32Array(bytes.buffer, bytes.byteOffset, bytes.length / 4);
  const heights = Float64Array.from(feet, (height) => (height === -99999 ? NaN : height * 0.3048));
  return {left, top, columns: right - left, rows: bottom - top, across, heights};
}

/** Pixels twice as wide: means of those that have data. */
function halved({left, top, columns, rows, across, heights}) {
  const coarser = {left: left / 2, top: top / 2, columns: columns / 2, rows: rows / 2, across: across / 2};
  coarser.heights = Float64Array.from({length: coarser.columns * coarser.rows}, (_, n) => {
    const at = 2 * Math.floor(n / coarser.columns) * columns + 2 * (n % coarser.columns);
    const four = [at, at + 1, at + columns, at + columns + 1].map((k) => heights[k]).filter((h) => !Number.isNaN(h));
    return four.reduce((sum, h) => sum + h, 0) / four.length;
  });
  return coarser;
}

/** Bilinear between the middles of pixels; NaN beside what has no data. */
function between({left, top, columns, across, heights}, point) {
  const [x, y] = onMap(point, across).map((at, k) => at - 0.5 - [left, top][k]);
  const [column, row] = [Math.floor(x), Math.floor(y)];
  const at = (i, j) => heights[(row + j) * columns + column + i];
  // at the DEM's edge pixels are means of fewer samples
  if ([-1, 0, 1, 2].some((j) => [-1, 0, 1, 2].some((i) => !Number.isFinite(at(i, j))))) return NaN;
  const [s, t] = [x - column, y - row];
  return (1 - t) * ((1 - s) * at(0, 0) + s * at(1, 0)) + t * ((1 - s) * at(0, 1) + s * at(1, 1));
}
