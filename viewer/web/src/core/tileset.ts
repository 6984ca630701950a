// Reads tileset.json and terrane.json (docs/formats.md) into a tree of tiles.
import {diagonal, type Box} from './box';
import type {TangentPlane} from './geodetic';
import {parsePlan, type PlanJson, type PlanMap} from './plan_map';
import {morphShareOf} from './ranges';
import type {Vec3} from './vec3';

/** One node of the quadtree. */
export interface Tile {
  /** "l/x/y", unique in the tileset. */
  readonly key: string;
  readonly level: number;
  readonly x: number;
  readonly y: number;
  /** Holds the content, the content at the end of its morph, and the children's boxes. */
  readonly box: Box;
  /** Address of the glb; unknown before `below` has been read. */
  readonly url: string;
  readonly triangles: number;
  /** Largest vertical distance of its mesh to a sample, those of its descendants included. */
  readonly errorM: number;
  readonly parent: Tile | null;
  /** None for a leaf; fewer than four where the rest has no data. */
  readonly children: readonly Tile[];
  /** Where the tile's content and children are written, if that has still to be read. */
  readonly below?: Below | undefined;
}

/** A tileset of its own, or a subtree of an implicit one. */
export type Below =
  | {readonly kind: 'tileset'; readonly url: string}
  | {readonly kind: 'subtree'; readonly tiling: ImplicitTiling};

/** How an implicit tileset is laid out. Templates hold {level}, {x} and {y}; level 0 is the root's. */
export interface ImplicitTiling {
  readonly rootLevel: number;
  readonly subtreeLevels: number;
  readonly subtreeUrl: string;
  readonly contentUrl: string;
}

/** A tile while its tree is being read. */
export type GrowingTile = {-readonly [Name in keyof Tile]: Tile[Name]} & {children: Tile[]};

/** What the viewer needs to know about one level. */
export interface Level {
  readonly level: number;
  readonly toleranceM: number;
  /** Size of one lattice step along east, north, up; powers of two. */
  readonly stepM: Vec3;
  /** Longest diagonal of a tile's box. */
  readonly diagonalM: number;
  /** Share of its range in which it morphs to the next level. */
  readonly morphShare: number;
}

export interface Tileset {
  readonly root: Tile;
  /** Index = level, 0 is the finest; the last one is the root's. */
  readonly levels: readonly Level[];
  readonly tileCells: number;
  /** Levels between which tiles keep their size: 1, or k for stacks. */
  readonly levelsPerOctave: number;
  readonly minHeightM: number;
  readonly maxHeightM: number;
  /** Plan distance of two samples, from below: the smaller of the two directions. */
  readonly cellM: number;
  /** World z is height less plan distance squared / (2 R); false: world z is height. */
  readonly curved: boolean;
  readonly frame: Frame;
  /** To the DEM's own CRS, if that is another one than longitude and latitude. */
  readonly plan?: PlanMap | undefined;
  /** Whom to thank for the data; empty if the files do not say. */
  readonly attribution: string;
}

/** Where world (0, 0, 0) is: on the Earth, or in the plan of a DEM without a CRS. */
export type Frame =
  | ({readonly kind: 'enu'} & TangentPlane)
  | {readonly kind: 'local'; readonly x: number; readonly y: number};

/** A tileset that cannot be shown. The message names the file and what is wrong. */
export class TilesetError extends Error {}

export interface TileJson {
  boundingVolume?: {box?: number[]};
  geometricError?: number;
  content?: {uri?: string};
  children?: TileJson[];
  transform?: number[];
  implicitTiling?: {subtreeLevels: number; subtrees: {uri: string}};
  extras?: {
    terrane?: {level?: number; x?: number; y?: number; triangles?: number; max_error_m?: number};
  };
}

interface TilesetJson {
  asset?: {extras?: {copyright?: string}};
  root?: TileJson;
}

interface LevelJson {
  level: number;
  tolerance_m: number;
  step_m: [number, number, number];
  largest_diagonal_m: number;
}

interface TerraneJson {
  format?: string;
  tile_cells: number;
  levels_per_octave?: number;
  dem: {
    columns: number;
    rows: number;
    min_height_m: number;
    max_height_m: number;
    crs_wkt?: string;
  };
  plan?: PlanJson;
  frame: {kind: string; longitude_deg?: number; latitude_deg?: number; x?: number; y?: number};
  levels: LevelJson[];
}

/**
 * Builds the tree.
 *
 * @param tileset content of tileset.json
 * @param terrane content of terrane.json
 * @param baseUrl absolute address of tileset.json; tiles are looked for beside it
 * @throws TilesetError where a field is absent or the levels of tree and ladder do not agree
 */
export function parseTileset(tileset: unknown, terrane: unknown, baseUrl: string): Tileset {
  const description = terrane as TerraneJson;
  const rootJson = (tileset as TilesetJson).root;
  if (!rootJson) throw new TilesetError(`${baseUrl}: no "root". Is this a 3D Tiles tileset?`);
  if (!description.format?.startsWith('terrane/1')) {
    throw new TilesetError(`terrane.json beside ${baseUrl}: format is not terrane/1`);
  }
  const root = rootJson.implicitTiling
    ? implicitRoot(rootJson, description.levels.length - 1, baseUrl)
    : parseTile(rootJson, null, baseUrl);
  const levelsPerOctave = description.levels_per_octave ?? 1;
  const levels = parseLevels(description.levels, root, morphShareOf(levelsPerOctave));
  return {
    root,
    levels,
    tileCells: description.tile_cells,
    levelsPerOctave,
    minHeightM: description.dem.min_height_m,
    maxHeightM: description.dem.max_height_m,
    cellM: smallestCell(root.box, description.dem),
    curved: description.frame.kind === 'enu',
    frame: parseFrame(description.frame),
    plan: parsePlan(description.plan, description.dem.crs_wkt ?? ''),
    attribution: (tileset as TilesetJson).asset?.extras?.copyright ?? '',
  };
}

/** Every tile of a subtree, parents before children. */
export function* tilesOf(tile: Tile): Generator<Tile> {
  yield tile;
  for (const child of tile.children) yield* tilesOf(child);
}

/** @throws TilesetError where a field is absent */
export function parseTile(json: TileJson, parent: Tile | null, baseUrl: string): GrowingTile {
  const id = json.extras?.terrane;
  if (id?.level === undefined || id.x === undefined || id.y === undefined) {
    throw new TilesetError(`${baseUrl}: a tile has no extras.terrane with level, x and y`);
  }
  const key = `${id.level}/${id.x}/${id.y}`;
  if (!json.content?.uri) throw new TilesetError(`${baseUrl}: tile ${key} has no content.uri`);
  if (parent && id.level !== parent.level - 1) {
    throw new TilesetError(`${baseUrl}: tile ${key} is not one level below ${parent.key}`);
  }
  if (parent && json.transform) {
    throw new TilesetError(`${baseUrl}: tile ${key} has a transform; only the root may have one`);
  }
  const url = new URL(json.content.uri, baseUrl).href;
  const isTileset = /\.json$/i.test(new URL(url).pathname);
  const tile: GrowingTile = {
    key,
    level: id.level,
    x: id.x,
    y: id.y,
    box: parseBox(json.boundingVolume?.box, key, baseUrl),
    url: isTileset ? '' : url,
    triangles: id.triangles ?? 0,
    errorM: id.max_error_m ?? json.geometricError ?? 0,
    parent,
    children: [],
    below: isTileset ? {kind: 'tileset', url} : undefined,
  };
  tile.children.push(...(json.children ?? []).map((child) => parseTile(child, tile, baseUrl)));
  return tile;
}

function implicitRoot(json: TileJson, level: number, baseUrl: string): GrowingTile {
  const resolve = (uri: string | undefined) => {
    if (!uri) throw new TilesetError(`${baseUrl}: the implicit root lacks content or subtrees`);
    // an address would escape the braces of the template
    return decodeURI(new URL(uri, baseUrl).href);
  };
  const {subtreeLevels, subtrees} = json.implicitTiling!;
  return {
    ...{key: `${level}/0/0`, level, x: 0, y: 0, url: '', triangles: 0},
    box: parseBox(json.boundingVolume?.box, `${level}/0/0`, baseUrl),
    errorM: json.geometricError ?? 0,
    parent: null,
    children: [],
    below: {
      kind: 'subtree',
      tiling: {
        rootLevel: level,
        subtreeLevels,
        subtreeUrl: resolve(subtrees.uri),
        contentUrl: resolve(json.content?.uri),
      },
    },
  };
}

function parseFrame({kind, longitude_deg, latitude_deg, x, y}: TerraneJson['frame']): Frame {
  if (kind !== 'enu') return {kind: 'local', x: x ?? 0, y: y ?? 0};
  return {kind, longitudeDeg: longitude_deg ?? 0, latitudeDeg: latitude_deg ?? 0};
}

/** @throws TilesetError unless there are 12 numbers */
export function parseBox(numbers: number[] | undefined, key: string, baseUrl: string): Box {
  if (numbers?.length !== 12 || !numbers.every(Number.isFinite)) {
    throw new TilesetError(`${baseUrl}: tile ${key} has no boundingVolume.box of 12 numbers`);
  }
  const at = (i: number): Vec3 => [numbers[i]!, numbers[i + 1]!, numbers[i + 2]!];
  return {center: at(0), halfAxes: [at(3), at(6), at(9)]};
}

function parseLevels(json: LevelJson[], root: Tile, morphShare: number): Level[] {
  const boxes = new Map<number, number>();
  for (const tile of tilesOf(root)) {
    boxes.set(tile.level, Math.max(boxes.get(tile.level) ?? 0, diagonal(tile.box)));
  }
  const levels = [...json]
    .sort((a, b) => a.level - b.level)
    .map((level) => ({
      level: level.level,
      toleranceM: level.tolerance_m,
      stepM: level.step_m,
      // the boxes decide which tiles are shown, so theirs counts where it is larger
      diagonalM: Math.max(level.largest_diagonal_m, boxes.get(level.level) ?? 0),
      morphShare,
    }));
  if (levels.length !== root.level + 1 || levels.some((level, i) => level.level !== i)) {
    throw new TilesetError(`terrane.json: levels are not 0 to ${root.level}, the root's level`);
  }
  return levels;
}

function smallestCell(box: Box, dem: {columns: number; rows: number}): number {
  const extent = (axis: 0 | 1) => 2 * box.halfAxes.reduce((sum, a) => sum + Math.abs(a[axis]), 0);
  return Math.min(extent(0) / (dem.columns - 1), extent(1) / (dem.rows - 1));
}
