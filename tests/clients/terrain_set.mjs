// A terrain set as it lies on disk, decoded by loaders.gl.
import {existsSync} from 'node:fs';
import {readFile, readdir} from 'node:fs/promises';
import {join} from 'node:path';
import {gunzipSync} from 'node:zlib';
import decode from './node_modules/@loaders.gl/terrain/dist/lib/decode-quantized-mesh.js';

export const kLast = 32767;

/** The folders of terrain sets in a folder that hold a file, as quantized-mesh does a layer.json. */
export async function terrainSets(folder, file = 'layer.json') {
  const entries = await readdir(folder, {withFileTypes: true});
  const names = entries.filter((entry) => entry.isDirectory()).map(({name}) => name).sort();
  return names.filter((name) => existsSync(join(folder, name, file)));
}

/** @returns {layer, summary, tiles: Map from "z/x/y" to a decoded tile with its z, x and y} */
export async function readTerrainSet(folder) {
  const layer = JSON.parse(await readFile(join(folder, 'layer.json'), 'utf8'));
  const summary = JSON.parse(await readFile(join(folder, 'terrane.json'), 'utf8'));
  const tiles = new Map();
  for (const file of await readdir(folder, {recursive: true})) {
    const place = /^(\d+)\/(\d+)\/(\d+)\.terrain$/.exec(file);
    if (!place) continue;
    const bytes = gunzipSync(await readFile(join(folder, file)));
    const [z, x, y] = place.slice(1).map(Number);
    tiles.set(`${z}/${x}/${y}`, tileOf(bytes, z, x, y));
  }
  return {layer, summary, tiles};
}

function tileOf(bytes, z, x, y) {
  // of its own: the decoder undoes the coding of indices in place
  const buffer = new Uint8Array(bytes).buffer;
  const tile = decode(buffer);
  const count = tile.vertexData.length / 3;
  const part = (k) => tile.vertexData.subarray(k * count, (k + 1) * count);
  const {minHeight, maxHeight} = tile.header;
  const [u, v, h] = [part(0), part(1), part(2)];
  // as CesiumJS interpolates
  const heights = Float64Array.from(h, (q) => (1 - q / kLast) * minHeight + (q / kLast) * maxHeight);
  const degrees = 180 / 2 ** z;
  const west = x * degrees - 180, south = y * degrees - 90;
  const longitudes = Float64Array.from(u, (q) => west + (q / kLast) * degrees);
  const latitudes = Float64Array.from(v, (q) => south + (q / kLast) * degrees);
  return {...tile, bytes, z, x, y, count, u, v, heights, longitudes, latitudes, degrees};
}

const kEquator = 6378137, kSquaredEccentricity = 6.69437999014e-3;

/** Earth-centred place of a vertex. */
export function ecef(tile, k) {
  const longitude = (tile.longitudes[k] * Math.PI) / 180, latitude = (tile.latitudes[k] * Math.PI) / 180;
  const n = kEquator / Math.sqrt(1 - kSquaredEccentricity * Math.sin(latitude) ** 2);
  const h = tile.heights[k];
  return [
    (n + h) * Math.cos(latitude) * Math.cos(longitude), (n + h) * Math.cos(latitude) * Math.sin(longitude),
    (n * (1 - kSquaredEccentricity) + h) * Math.sin(latitude),
  ];
}

/** The neighbour of a tile, round the Earth; undefined beyond a pole. */
export function neighbour(tiles, {z, x, y}, east, north) {
  return tiles.get(`${z}/${(x + east + 2 ** (z + 1)) % 2 ** (z + 1)}/${y + north}`);
}

/** Height of the finest mesh at a place; NaN if there is no tile. */
export function heightAt(tiles, zoom, longitude, latitude) {
  const degrees = 180 / 2 ** zoom;
  const tile = tiles.get(`${zoom}/${Math.floor((longitude + 180) / degrees)}/${Math.floor((latitude + 90) / degrees)}`);
  if (!tile) return NaN;
  const {longitudes: x, latitudes: y, heights, triangleIndices: index} = tile;
  for (let k = 0; k < index.length; k += 3) {
    const [a, b, c] = [index[k], index[k + 1], index[k + 2]];
    const area = (x[b] - x[a]) * (y[c] - y[a]) - (x[c] - x[a]) * (y[b] - y[a]);
    const s = ((longitude - x[a]) * (y[c] - y[a]) - (x[c] - x[a]) * (latitude - y[a])) / area;
    const t = ((x[b] - x[a]) * (latitude - y[a]) - (longitude - x[a]) * (y[b] - y[a])) / area;
    if (s >= -1e-9 && t >= -1e-9 && s + t <= 1 + 1e-9) {
      return heights[a] + s * (heights[b] - heights[a]) + t * (heights[c] - heights[a]);
    }
  }
  return NaN;
}
