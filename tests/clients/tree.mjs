// What tileset.json says, read without any library.
import {readFile} from 'node:fs/promises';
import {join, relative, resolve} from 'node:path';

/**
 * @param folder of a tile set
 * @returns {Promise<Map<string, object>>} by path of the glb: {level, x, y, triangles, skirt_triangles?}
 */
export async function contentsOf(folder) {
  const contents = new Map();
  await readTree(folder, 'tileset.json', contents);
  return contents;
}

async function readTree(folder, file, contents) {
  const {root} = JSON.parse(await readFile(join(folder, file), 'utf8'));
  if (root.implicitTiling) {
    await readSubtree(folder, root, {level: 0, x: 0, y: 0}, contents);
    return;
  }
  const visit = async (tile) => {
    const path = relative(folder, resolve(folder, file, '..', tile.content.uri));
    if (path.endsWith('.json')) await readTree(folder, path, contents);
    else contents.set(path, tile.extras.terrane);
    for (const child of tile.children ?? []) await visit(child);
  };
  await visit(root);
}

const filled = (template, {level, x, y}) =>
  template.replace('{level}', level).replace('{x}', x).replace('{y}', y);

/** Numbers level by level, along the curve of Morton: {level, x, y} below a subtree's root. */
function below(at, depth, index) {
  let x = 0, y = 0;
  for (let bit = 0; bit < depth; ++bit) {
    x |= ((index >> (2 * bit)) & 1) << bit;
    y |= ((index >> (2 * bit + 1)) & 1) << bit;
  }
  return {level: at.level + depth, x: (at.x << depth) + x, y: (at.y << depth) + y};
}

async function readSubtree(folder, root, at, contents) {
  const {availableLevels, subtreeLevels, subtrees} = root.implicitTiling;
  const bytes = await readFile(join(folder, filled(subtrees.uri, at)));
  const jsonBytes = Number(bytes.readBigUInt64LE(8));
  const json = JSON.parse(bytes.subarray(24, 24 + jsonBytes).toString());
  const view = (index) => bytes.subarray(24 + jsonBytes + json.bufferViews[index].byteOffset);
  const isThere = ({constant, bitstream}, n) =>
    constant !== undefined ? constant === 1 : ((view(bitstream)[n >> 3] >> (n & 7)) & 1) === 1;
  const {properties} = json.propertyTables[json.tileMetadata];
  let row = 0, first = 0;
  for (let depth = 0; depth < subtreeLevels; ++depth) {
    for (let index = 0; index < 4 ** depth; ++index) {
      if (!isThere(json.tileAvailability, first + index)) continue;
      const {level, x, y} = below(at, depth, index);
      const count = (name) => view(properties[name].values).readUInt32LE(4 * row);
      contents.set(filled(root.content.uri, {level, x, y}), {
        level: availableLevels - 1 - level, x, y,
        triangles: count('triangles'), skirt_triangles: count('skirt_triangles'),
      });
      ++row;
    }
    first += 4 ** depth;
  }
  for (let index = 0; index < 4 ** subtreeLevels; ++index) {
    if (!isThere(json.childSubtreeAvailability, index)) continue;
    await readSubtree(folder, root, below(at, subtreeLevels, index), contents);
  }
}

/** The tiles of level 0. */
export function leavesOf(contents) {
  return [...contents.values()].filter((tile) => tile.level === 0);
}

/**
 * How many leaf tiles lie under some tiles; NaN if one lies under two of them.
 *
 * @param contents all tiles
 */
export function coveredLeaves(tiles, contents) {
  let count = 0;
  for (const leaf of leavesOf(contents)) {
    const above = tiles.filter(({level, x, y}) => leaf.x >> level === x && leaf.y >> level === y);
    if (above.length > 1) return NaN;
    count += above.length;
  }
  return count;
}
