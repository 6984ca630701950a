// read_pmtiles.mjs ARCHIVE FOLDER: reads the archive with the npm package `pmtiles`, by HTTP range
// requests as a browser would, and compares every tile with the folder that was packed.
import assert from 'node:assert/strict';
import {readdirSync, readFileSync, statSync} from 'node:fs';
import {PMTiles} from 'pmtiles';

const [archiveUrl, folder] = process.argv.slice(2);

const archive = new PMTiles(archiveUrl);
const header = await archive.getHeader();
const metadata = await archive.getMetadata();
const {tiles, files, stored} = metadata.terrane_archive;

assert.equal(header.specVersion, 3);
assert.equal(header.clustered, true);
assert.ok(header.rootDirectoryOffset + header.rootDirectoryLength <= 16384);
for (const bound of ['minLon', 'maxLon', 'minLat', 'maxLat']) assert.ok(Number.isFinite(header[bound]));

const [before, after] = tiles.path.split('{l}/{x}/{y}');
const zooms = new Set();
let compared = 0;
for (const name of readdirSync(folder, {recursive: true})) {
  if (!statSync(`${folder}/${name}`).isFile()) continue;
  const numbers = /^(\d+)\/(\d+)\/(\d+)$/.exec(name.slice(before.length, -after.length));
  if (!name.startsWith(before) || !name.endsWith(after) || !numbers) continue;
  const [level, x, y] = numbers.slice(1).map(Number);
  const z = tiles.first_zoom + tiles.zoom_step * level;
  const tile = await archive.getZxy(z, x, y);
  assert.ok(tile, `${name} is missing at ${z}/${x}/${y}`);
  assert.ok(Buffer.from(tile.data).equals(readFileSync(`${folder}/${name}`)), `${name} differs`);
  zooms.add(z);
  compared += 1;
}
assert.ok(compared > 4);
assert.equal(header.numAddressedTiles, compared);
assert.equal(header.minZoom, Math.min(...zooms));
assert.equal(header.maxZoom, Math.max(...zooms));
assert.equal(await archive.getZxy(header.maxZoom + 1, 0, 0), undefined);
for (const name of ['tileset.json', 'terrane.json']) {
  assert.deepEqual(files[name], JSON.parse(readFileSync(`${folder}/${name}`, 'utf8')));
}
assert.deepEqual(Object.keys(stored), []);
console.log(`${compared} tiles are the same`);
