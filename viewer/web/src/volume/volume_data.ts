/** What fills a part of space: there where all sides hold, and no material before it fits. */
export interface Material {
  name: string;
  isEmpty: boolean;
  /** Bit i: it lies below, or above, surface i. */
  below: number;
  above: number;
}

export interface FieldInfo {
  name: string;
  unit: string;
  /** Smallest and largest value that vertices have in the materials that are not empty. */
  range: [number, number];
}

/** A volume that `terrane volume` wrote: docs/formats.md, volume.json and cells.bin. */
export interface VolumeData {
  /** Half the box's extent in metres; places are seen from its middle. */
  halfSize: [number, number, number];
  /** Of the model, at the middle of the box. */
  middle: [number, number, number];
  surfaces: string[];
  materials: Material[];
  fields: FieldInfo[];
  /** By vertex: x, y, z; a signed distance for each surface; values by field, material. */
  positions: Float32Array;
  distances: Float32Array;
  values: Float32Array;
  /** By cell: four vertices; the surfaces that part two materials in it, a bit each. */
  corners: Uint32Array;
  parting: Uint8Array;
}

interface PlacedArray {
  type: string;
  components: number;
  count: number;
  offset: number;
}

interface VolumeJson {
  format: string;
  box_m: {low: number[]; high: number[]};
  surfaces: {name: string}[];
  fields: {name: string; unit: string}[];
  materials: {name: string; is_empty: boolean; where: {surface: string; side: string}[]}[];
  cells_bin: Record<string, PlacedArray>;
}

const kViews = {float32: Float32Array, uint32: Uint32Array, uint8: Uint8Array};

function arrayOf<T>(name: string, type: keyof typeof kViews, json: VolumeJson, bin: ArrayBuffer): T {
  const placed = json.cells_bin[name];
  const View = kViews[type];
  // no surfaces or no fields: the array is left out
  if (!placed) return new View(0) as T;
  const length = placed.components * placed.count;
  if (placed.type !== type || placed.offset + length * View.BYTES_PER_ELEMENT > bin.byteLength) {
    throw new Error(`cells.bin does not hold the ${name} that volume.json tells of`);
  }
  return new View(bin, placed.offset, length) as T;
}

function sidesOf(material: VolumeJson['materials'][number], side: string, surfaces: string[]): number {
  return material.where
    .filter((where) => where.side === side)
    .reduce((mask, where) => mask | (1 << surfaces.indexOf(where.surface)), 0);
}

/** The first material whose sides all hold; `below` has a bit for each surface. */
export function materialAt(materials: Material[], below: number): number {
  const fits = materials.findIndex(
    (material) => (below & material.below) === material.below && (below & material.above) === 0,
  );
  return fits < 0 ? materials.length - 1 : fits;
}

/** The surfaces that a vertex is below, a bit each. */
export function belowAt(data: VolumeData, vertex: number): number {
  const count = data.surfaces.length;
  let below = 0;
  for (let i = 0; i < count; ++i) {
    if (data.distances[vertex * count + i] < 0) below |= 1 << i;
  }
  return below;
}

function rangeOf(data: VolumeData, field: number): [number, number] {
  const materials = data.materials.length;
  const stride = data.fields.length * materials;
  let [low, high] = [Infinity, -Infinity];
  for (let v = 0; v < data.positions.length / 3; ++v) {
    const material = materialAt(data.materials, belowAt(data, v));
    if (data.materials[material].isEmpty) continue;
    const value = data.values[v * stride + field * materials + material];
    low = Math.min(low, value);
    high = Math.max(high, value);
  }
  return low <= high ? [low, high] : [0, 1];
}

/** @throws Error if the two do not fit together, or are of another format. */
export function parseVolume(json: VolumeJson, bin: ArrayBuffer): VolumeData {
  if (json.format !== 'terrane-volume/1' || !json.cells_bin) {
    throw new Error('volume.json is not what terrane volume writes');
  }
  const {low, high} = json.box_m;
  const each = (f: (k: number) => number) => [f(0), f(1), f(2)] as [number, number, number];
  const surfaces = json.surfaces.map(({name}) => name);
  const data: VolumeData = {
    halfSize: each((k) => (high[k] - low[k]) / 2),
    middle: each((k) => (high[k] + low[k]) / 2),
    surfaces,
    materials: json.materials.map((material) => ({
      name: material.name,
      isEmpty: material.is_empty,
      below: sidesOf(material, 'below', surfaces),
      above: sidesOf(material, 'above', surfaces),
    })),
    fields: json.fields.map(({name, unit}) => ({name, unit, range: [0, 1]})),
    positions: arrayOf('positions', 'float32', json, bin),
    distances: arrayOf('distances', 'float32', json, bin),
    values: arrayOf('values', 'float32', json, bin),
    corners: arrayOf('corners', 'uint32', json, bin),
    parting: arrayOf('parting', 'uint8', json, bin),
  };
  data.fields.forEach((field, f) => (field.range = rangeOf(data, f)));
  return data;
}
