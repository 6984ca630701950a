// quantized_mesh.mjs FOLDER: every terrain set of FOLDER as loaders.gl decodes it holds what
// quantized-mesh 1.0 asks for, and what no tool's did when we looked at their output.
import {existsSync} from 'node:fs';
import {readFile} from 'node:fs/promises';
import {join} from 'node:path';
import {parse} from '@loaders.gl/core';
import {QuantizedMeshLoader} from '@loaders.gl/terrain';
import {check, failures} from './check.mjs';
import {ecef, heightAt, kLast, neighbour, readTerrainSet, terrainSets} from './terrain_set.mjs';

const [folder] = process.argv.slice(2);
for (const name of await terrainSets(folder)) await examine(name);
process.exit(failures() > 0 ? 1 : 0);

async function examine(name) {
  const {layer, summary, tiles} = await readTerrainSet(join(folder, name));
  const all = [...tiles.values()];
  const every = (holds, text) => {
    const bad = all.filter((tile) => !holds(tile));
    check(bad.length === 0, `${name}: ${text} (${all.length} tiles)${bad.slice(0, 3).map((t) => ` ${t.z}/${t.x}/${t.y}`)}`);
  };
  checkLayer(name, layer, tiles);
  every(coversItsSquare, 'triangles face up and cover the tile exactly once');
  every(usesItsVertices, 'indices are those of vertices, and every vertex is used');
  every(listsItsBorders, 'the lists of border vertices are complete and on their side');
  every(isInItsSphere, 'the bounding sphere holds every vertex');
  every(holdsItsHeights, 'minimum and maximum hold the heights, and little more');
  every(isSeenWithItsPoint, 'no vertex is seen while the horizon occlusion point is hidden');
  every(hasSoundNormals, 'normals are as many as vertices and point up');
  every(hasSoundExtensions, 'extensions end where the file ends');
  checkBorders(name, tiles);
  await checkPublicLoader(name, all.at(-1));
  if (layer.extensions.includes('watermask')) checkWater(name, all);
  await checkHeights(name, summary, tiles);
}

function checkLayer(name, layer, tiles) {
  const listed = new Set();
  let isInside = true;
  for (const [z, ranges] of layer.available.entries()) {
    for (const {startX, startY, endX, endY} of ranges) {
      isInside &&= startX >= 0 && startY >= 0 && endX < 2 ** (z + 1) && endY < 2 ** z && startX <= endX && startY <= endY;
      for (let x = startX; x <= endX; ++x) for (let y = startY; y <= endY; ++y) listed.add(`${z}/${x}/${y}`);
    }
  }
  check(isInside, `${name}: available ranges are inside the scheme`);
  check(listed.has('0/0/0') && listed.has('0/1/0'), `${name}: both root tiles are there`);
  const missing = [...listed].filter((tile) => !tiles.has(tile)), unlisted = [...tiles.keys()].filter((tile) => !listed.has(tile));
  check(missing.length + unlisted.length === 0, `${name}: what is listed is what is there (${tiles.size} tiles) ${[...missing, ...unlisted].slice(0, 3)}`);
  const orphans = [...tiles.values()].filter(({z, x, y}) => z > 0 && !tiles.has(`${z - 1}/${x >> 1}/${y >> 1}`));
  check(orphans.length === 0, `${name}: every tile has its parent`);
  const [west, south, east, north] = layer.bounds;
  const degrees = 180 / 2 ** layer.maxzoom;
  const finest = [...tiles.values()].filter(({z}) => z === layer.maxzoom);
  const isTight = east - west <= degrees * (1 + Math.max(...finest.map(({x}) => x)) - Math.min(...finest.map(({x}) => x))) + 1e-9;
  check(isTight && south >= -90 && north <= 90 && west >= -180 && east <= 180, `${name}: bounds are those of the finest tiles`);
}

function coversItsSquare({u, v, triangleIndices: index}) {
  let sum = 0;
  for (let k = 0; k < index.length; k += 3) {
    const [a, b, c] = [index[k], index[k + 1], index[k + 2]];
    const area = (u[b] - u[a]) * (v[c] - v[a]) - (u[c] - u[a]) * (v[b] - v[a]);
    if (area <= 0) return false;
    sum += area;
  }
  // with all of them turned the same way, equal areas leave no room for overlap
  return sum === 2 * kLast * kLast;
}

function usesItsVertices({count, triangleIndices}) {
  const used = new Set(triangleIndices);
  return used.size === count && Math.max(...used) === count - 1;
}

function listsItsBorders({count, u, v, westIndices, southIndices, eastIndices, northIndices}) {
  const on = (values, at) => Array.from({length: count}, (_, k) => k).filter((k) => values[k] === at);
  const isSame = (list, wanted) => list.length === wanted.length && wanted.every((k) => list.includes(k));
  return isSame(westIndices, on(u, 0)) && isSame(southIndices, on(v, 0)) &&
    isSame(eastIndices, on(u, kLast)) && isSame(northIndices, on(v, kLast));
}

function isInItsSphere(tile) {
  const {boundingSphereCenterX: x, boundingSphereCenterY: y, boundingSphereCenterZ: z, boundingSphereRadius: r} = tile.header;
  for (let k = 0; k < tile.count; ++k) {
    const at = ecef(tile, k);
    if (Math.hypot(at[0] - x, at[1] - y, at[2] - z) > r) return false;
  }
  return true;
}

function holdsItsHeights({heights, header: {minHeight, maxHeight}}) {
  const low = Math.min(...heights), high = Math.max(...heights);
  // of a nearly flat tile high up, floats do not hold a finer division
  const room = Math.max(2.01 * (high - low), 0.01 * Math.max(Math.abs(low), Math.abs(high)));
  return low === minHeight && high <= maxHeight + 1e-9 && maxHeight - minHeight <= room;
}

/** From cameras all around: is the segment from the camera to a point free of the ellipsoid? */
function isSeenWithItsPoint(tile) {
  const scale = ([x, y, z]) => [x / 6378137, y / 6378137, z / 6356752.314245179];
  const point = [tile.header.horizonOcclusionPointX, tile.header.horizonOcclusionPointY, tile.header.horizonOcclusionPointZ];
  if (!(Math.hypot(...point) >= 1 - 1e-9)) return false;
  const step = Math.max(1, Math.floor(tile.count / 60));
  const vertices = [];
  for (let k = 0; k < tile.count; k += step) {
    const vertex = scale(ecef(tile, k));
    // what lies below the ellipsoid counts as on it
    const lift = Math.max(1, 1 / Math.hypot(...vertex));
    vertices.push(vertex.map((c) => c * lift));
  }
  for (let n = 0; n < 300; ++n) {
    const camera = sphere(n, 300).map((c) => c * [1.0005, 1.01, 1.3, 4][n % 4]);
    if (isSeen(camera, point)) continue;
    if (vertices.some((vertex) => isSeen(camera, vertex))) return false;
  }
  return true;
}

/** The n-th of some places spread evenly over the unit sphere. */
function sphere(n, count) {
  const z = 1 - (2 * n + 1) / count, turn = n * 2.399963;
  const r = Math.sqrt(1 - z * z);
  return [r * Math.cos(turn), r * Math.sin(turn), z];
}

function isSeen(camera, point) {
  const along = point.map((c, k) => c - camera[k]);
  const a = dot(along, along), b = dot(camera, along);
  const t = Math.min(Math.max(-b / a, 0), 1);
  // what stands on or under the ellipsoid is not hidden by its own ground
  if (t > 1 - 1e-9) return true;
  return Math.hypot(...camera.map((c, k) => c + t * along[k])) >= 1 - 1e-9;
}

function dot(a, b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

function hasSoundNormals(tile) {
  const coded = tile.extensions.vertexNormals;
  if (coded?.length !== 2 * tile.count) return false;
  for (let k = 0; k < tile.count; ++k) {
    let x = (coded[2 * k] / 255) * 2 - 1, y = (coded[2 * k + 1] / 255) * 2 - 1;
    const z = 1 - Math.abs(x) - Math.abs(y);
    if (z < 0) [x, y] = [(1 - Math.abs(y)) * (x < 0 ? -1 : 1), (1 - Math.abs(x)) * (y < 0 ? -1 : 1)];
    const normal = [x, y, z].map((c) => c / Math.hypot(x, y, z));
    const longitude = (tile.longitudes[k] * Math.PI) / 180, latitude = (tile.latitudes[k] * Math.PI) / 180;
    const up = [Math.cos(latitude) * Math.cos(longitude), Math.cos(latitude) * Math.sin(longitude), Math.sin(latitude)];
    if (dot(normal, up) < 0.1) return false;
  }
  return true;
}

/** Walks over the extensions from the end of the border lists. */
function hasSoundExtensions({z, bytes, count, triangleIndices, westIndices, southIndices, eastIndices, northIndices}) {
  const size = count > 65536 ? 4 : 2;
  let at = 88 + 4 + 6 * count;
  at += (size - (at % size)) % size;
  at += 4 + size * triangleIndices.length;
  for (const list of [westIndices, southIndices, eastIndices, northIndices]) at += 4 + size * list.length;
  const lengths = {};
  while (at < bytes.length) {
    lengths[bytes[at]] = bytes.readUInt32LE(at + 1);
    if (bytes[at] === 4) JSON.parse(bytes.subarray(at + 9, at + 9 + bytes.readUInt32LE(at + 5)).toString());
    at += 5 + bytes.readUInt32LE(at + 1);
  }
  return at === bytes.length && lengths[1] === 2 * count && [undefined, 1, 65536].includes(lengths[2]) &&
    (lengths[4] > 4) === (z % 10 === 0);
}

function checkBorders(name, tiles) {
  let pairs = 0, vertices = 0;
  const bad = [];
  const compare = (tile, other, ownList, otherList, along) => {
    if (!other) return;
    ++pairs;
    // whole micrometres: (1 - t) min + t max is off by rounding, which shows where the height is 0
    const line = (of, list) => Array.from(list, (k) => `${of[along][k]} ${Math.round(1e6 * of.heights[k])}`).sort();
    const [own, others] = [line(tile, ownList), line(other, otherList)];
    vertices += own.length;
    if (own.join() !== others.join()) bad.push(`${tile.z}/${tile.x}/${tile.y}`);
  };
  for (const tile of tiles.values()) {
    const east = neighbour(tiles, tile, 1, 0), north = neighbour(tiles, tile, 0, 1);
    compare(tile, east, tile.eastIndices, east?.westIndices, 'v');
    compare(tile, north, tile.northIndices, north?.southIndices, 'u');
  }
  check(bad.length === 0, `${name}: neighbours hold the same border vertices and equal heights (${pairs} borders, ${vertices} vertices) ${bad.slice(0, 5)}`);
}

async function checkPublicLoader(name, tile) {
  const bounds = [0, 0, 1, 1];
  const mesh = await parse(new Uint8Array(tile.bytes).buffer, QuantizedMeshLoader, {'quantized-mesh': {bounds}, worker: false});
  const positions = mesh.attributes.POSITION.value;
  let worst = 0;
  for (let k = 0; k < tile.count; ++k) worst = Math.max(worst, Math.abs(positions[3 * k + 2] - tile.heights[k]));
  check(positions.length === 3 * tile.count && worst < 1e-3, `${name}: QuantizedMeshLoader has the same heights`);
}

function checkWater(name, all) {
  const masks = all.map(({extensions}) => new Uint8Array(extensions.waterMask));
  const wet = masks.flatMap((mask) => [...mask]).filter((value) => value === 255).length;
  const isSound = masks.every((mask) => [1, 65536].includes(mask.length) && mask.every((value) => value === 0 || value === 255));
  check(isSound && wet > 0, `${name}: water masks are of one byte or 256 x 256, and there is water`);
}

async function checkHeights(name, {zooms}, tiles) {
  const file = join(folder, `${name}_points.json`);
  if (!existsSync(file)) return;
  const points = JSON.parse(await readFile(file, 'utf8'));
  const {zoom, tolerance_m: tolerance} = zooms.at(-1);
  const off = points.map(([longitude, latitude, height]) => Math.abs(heightAt(tiles, zoom, longitude, latitude) - height));
  const worst = Math.max(...off);
  check(worst <= tolerance, `${name}: ${points.length} samples of the DEM are ${worst.toFixed(2)} m off at most, the tolerance is ${tolerance} m`);
}
