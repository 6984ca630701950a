// Whether rays pass through holes of a DEM: GDAL's programs and PROJ are asked, none of our own code.
import {execFile, spawn} from 'node:child_process';
import {mkdtemp, readFile, rm} from 'node:fs/promises';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {promisify} from 'node:util';

const kRad = Math.PI / 180;
const kA = 6378137;
const kE2 = 0.00669437999014132;

/** Reads a DEM: its samples, NaN where there is none, and its place. */
export async function readDem(file) {
  const run = promisify(execFile);
  const {stdout} = await run('gdalinfo', ['-json', file]);
  const {size, geoTransform, bands, coordinateSystem} = JSON.parse(stdout);
  const folder = await mkdtemp(join(tmpdir(), 'terrane-dem-'));
  const raw = join(folder, 'dem.bin');
  await run('gdal_translate', ['-q', '-b', '1', '-ot', 'Float32', '-of', 'ENVI', file, raw]);
  const bytes = await readFile(raw);
  await rm(folder, {recursive: true});
  const samples = new Float32Array(bytes.buffer, bytes.byteOffset, bytes.byteLength / 4);
  const nothing = Math.fround(bands[0].noDataValue ?? NaN);
  const heights = samples.map((value) => (value === nothing ? NaN : value));
  return {size, geoTransform, heights, crs: coordinateSystem.wkt};
}

/** World metres of the tangent plane as a line of Earth-centred numbers. */
function earthCentred([east, north, up], {longitude_deg, latitude_deg}) {
  const [lon, lat] = [longitude_deg * kRad, latitude_deg * kRad];
  const [sinLon, cosLon, sinLat, cosLat] = [lon, lat].flatMap((v) => [Math.sin(v), Math.cos(v)]);
  const n = kA / Math.sqrt(1 - kE2 * sinLat ** 2);
  return [
    (n + up) * cosLat * cosLon - sinLon * east - sinLat * cosLon * north,
    (n + up) * cosLat * sinLon + cosLon * east - sinLat * sinLon * north,
    (n * (1 - kE2) + up) * sinLat + cosLat * north,
  ].join(' ');
}

/** World places as column, row (of samples) and height. */
async function toGrid(dem, frame, places) {
  const args = ['-s_srs', 'EPSG:4978', '-t_srs', dem.crs];
  const program = spawn('gdaltransform', args, {stdio: ['pipe', 'pipe', 'inherit']});
  program.stdin.end(places.map((place) => earthCentred(place, frame)).join('\n'));
  let text = '';
  for await (const part of program.stdout) text += part;
  const [x0, dx, rx, y0, ry, dy] = dem.geoTransform;
  const determinant = dx * dy - rx * ry;
  return text
    .trim()
    .split('\n')
    .map((line) => {
      const [x, y, height] = line.split(' ').map(Number);
      const column = ((x - x0) * dy - (y - y0) * rx) / determinant - 0.5;
      const row = ((y - y0) * dx - (x - x0) * ry) / determinant - 0.5;
      return {column, row, height};
    });
}

/** Lowest and highest of the four samples around a place; undefined where one has no data. */
function groundAt({size: [columns, rows], heights}, {column, row}) {
  const [i, j] = [Math.floor(column), Math.floor(row)];
  if (i < 0 || j < 0 || i + 1 >= columns || j + 1 >= rows) return undefined;
  const around = [0, 1, columns, columns + 1].map((k) => heights[j * columns + i + k]);
  return around.some(Number.isNaN) ? undefined : {low: Math.min(...around), high: Math.max(...around)};
}

/**
 * Whether a ray gets below the ground, or out of the DEM, by way of samples without data.
 *
 * @param slackPerM how far the ground that is shown may be from the DEM's, per metre from the eye
 */
export async function passesThroughHole(dem, frame, {eye, direction, lengthM}, slackPerM) {
  const stepM = 2;
  const at = [...Array(Math.ceil(lengthM / stepM)).keys()].map((i) => i * stepM);
  const places = at.map((m) => eye.map((value, k) => value + m * direction[k]));
  const path = await toGrid(dem, frame, places);
  let gap = true;
  for (const [i, point] of path.entries()) {
    const ground = groundAt(dem, point);
    const slackM = slackPerM * at[i];
    if (!ground) gap = true;
    else if (point.height > ground.high + slackM) gap = false;
    else if (point.height < ground.low - slackM) return gap;
  }
  return true;
}
