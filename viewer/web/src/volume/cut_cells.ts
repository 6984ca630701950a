/** The places p with normal . p = offset; the normal has length 1. */
export interface Plane {
  normal: [number, number, number];
  offset: number;
}

/** Polygons of cells in a plane, as a list of triangles, and their sides. */
export interface Cut {
  /** By corner: the edge of the cell that it lies on, and how far along it. */
  from: Uint32Array;
  to: Uint32Array;
  share: Float32Array;
  /** Corners of triangles, three each; ends of sides, two each. */
  triangles: Uint32Array;
  sides: Uint32Array;
  cells: number;
}

/** Grows as it is written to. */
class Row<T extends Uint32Array | Float32Array> {
  length = 0;
  constructor(private data: T) {}

  push(value: number): void {
    if (this.length === this.data.length) {
      const grown = new (this.data.constructor as new (n: number) => T)(2 * this.data.length);
      grown.set(this.data);
      this.data = grown;
    }
    this.data[this.length++] = value;
  }

  done(): T {
    return this.data.slice(0, this.length) as T;
  }
}

function heightsOver(positions: Float32Array, {normal, offset}: Plane): Float32Array {
  const heights = new Float32Array(positions.length / 3);
  for (let v = 0; v < heights.length; ++v) {
    const at = 3 * v;
    heights[v] =
      normal[0] * positions[at] +
      normal[1] * positions[at + 1] +
      normal[2] * positions[at + 2] -
      offset;
  }
  return heights;
}

/** Heights of a cell's corners over a surface, to cut it at 0. */
class CellCutter {
  readonly from = new Row(new Uint32Array(4096));
  readonly to = new Row(new Uint32Array(4096));
  readonly share = new Row(new Float32Array(4096));
  readonly triangles = new Row(new Uint32Array(4096));
  readonly sides = new Row(new Uint32Array(4096));
  cells = 0;
  private readonly low = [0, 0, 0, 0];
  private readonly high = [0, 0, 0, 0];

  constructor(private readonly heights: ArrayLike<number>) {}

  /** A corner at 0 counts as above: no polygon is made twice. */
  cut(corners: Uint32Array, cell: number): void {
    let lows = 0;
    let highs = 0;
    for (let k = 0; k < 4; ++k) {
      const v = corners[4 * cell + k];
      if (this.heights[v] < 0) this.low[lows++] = v;
      else this.high[highs++] = v;
    }
    if (lows === 0 || highs === 0) return;
    ++this.cells;
    const first = this.from.length;
    if (lows === 2) {
      // round the four sides: each shares an end with the one before
      this.corner(this.low[0], this.high[0]);
      this.corner(this.low[0], this.high[1]);
      this.corner(this.low[1], this.high[1]);
      this.corner(this.low[1], this.high[0]);
    } else {
      const [one, rest] = lows === 1 ? [this.low[0], this.high] : [this.high[0], this.low];
      for (let k = 0; k < 3; ++k) this.corner(one, rest[k]);
    }
    this.polygon(first, this.from.length - first);
  }

  private corner(a: number, b: number): void {
    // from the smaller vertex, so that cells that share an edge get the same place
    const [from, to] = a < b ? [a, b] : [b, a];
    this.from.push(from);
    this.to.push(to);
    this.share.push(this.heights[from] / (this.heights[from] - this.heights[to]));
  }

  private polygon(first: number, count: number): void {
    for (let k = 2; k < count; ++k) {
      this.triangles.push(first);
      this.triangles.push(first + k - 1);
      this.triangles.push(first + k);
    }
    for (let k = 0; k < count; ++k) {
      this.sides.push(first + k);
      this.sides.push(first + ((k + 1) % count));
    }
  }

  done(): Cut {
    return {
      from: this.from.done(),
      to: this.to.done(),
      share: this.share.done(),
      triangles: this.triangles.done(),
      sides: this.sides.done(),
      cells: this.cells,
    };
  }
}

/** Cuts all cells with a plane. */
export function cutCells(positions: Float32Array, corners: Uint32Array, plane: Plane): Cut {
  const cutter = new CellCutter(heightsOver(positions, plane));
  for (let cell = 0; cell < corners.length / 4; ++cell) cutter.cut(corners, cell);
  return cutter.done();
}

/** The zero set of a surface's distances in the cells where it parts two materials. */
export function zeroSet(
  distances: Float32Array,
  surface: number,
  surfaces: number,
  corners: Uint32Array,
  parting: Uint8Array,
): Cut {
  const own = new Float32Array(distances.length / surfaces);
  for (let v = 0; v < own.length; ++v) own[v] = distances[v * surfaces + surface];
  const cutter = new CellCutter(own);
  for (let cell = 0; cell < parting.length; ++cell) {
    if (parting[cell] & (1 << surface)) cutter.cut(corners, cell);
  }
  return cutter.done();
}

/**
 * Values at the corners of a cut, linear along the edges that they lie on.
 *
 * @param values by vertex, `stride` each; `count` of them from `first` on are taken
 * @param width values of a corner in the result; those past `count` are 0
 */
export function valuesAt(
  cut: Cut,
  values: Float32Array,
  {stride, first, count, width}: {stride: number; first: number; count: number; width: number},
): Float32Array {
  const result = new Float32Array(width * cut.from.length);
  for (let i = 0; i < cut.from.length; ++i) {
    const [a, b, t] = [cut.from[i] * stride + first, cut.to[i] * stride + first, cut.share[i]];
    for (let k = 0; k < count; ++k) {
      result[width * i + k] = values[a + k] + t * (values[b + k] - values[a + k]);
    }
  }
  return result;
}
