// The C++ engine (viewer/engine) in WebAssembly: a merge tree as one camera sees it.
import type {Vec3} from '../core/vec3';

export interface TreeSummary {
  readonly fullTriangles: number;
  readonly coarsestTriangles: number;
  readonly levels: number;
  /** Positions are relative to this place of the mesh's frame. */
  readonly origin: Vec3;
  /** Middle of the mesh's box, in its frame, and half the box's diagonal. */
  readonly middle: Vec3;
  readonly reach: number;
  readonly hasColours: boolean;
}

/** What one update did, and what shows after it. */
export interface FrameFigures {
  readonly triangles: number;
  readonly vertices: number;
  readonly splits: number;
  readonly merges: number;
  /** Merges that were judged. */
  readonly lookedAt: number;
  readonly tolerancePx: number;
  /** Further updates would change nothing. */
  readonly isSettled: boolean;
}

/** In the mesh's frame. */
export interface TreeCamera {
  readonly eye: Vec3;
  readonly target: Vec3;
  readonly up: Vec3;
  readonly fovDeg: number;
  readonly widthPx: number;
  readonly heightPx: number;
}

export interface ViewCriteria {
  /** Compared with the tolerance: the error, or the length of collapsed edges (published). */
  readonly measure: 'error' | 'length';
  readonly tolerancePx: number;
  readonly frustum: boolean;
  readonly backFaces: boolean;
  /** null: silhouettes are nothing special. */
  readonly silhouettePx: number | null;
  /** Length of edges where the highlight varies; null: anything. */
  readonly highlightPx: number | null;
  /** Likewise where the colour of the vertices varies. */
  readonly colourPx: number | null;
  readonly shininess: number;
  /** Unit. */
  readonly toLight: Vec3;
}

/** What emscripten makes of viewer/engine/wasm_exports.cpp; addresses may come as negative numbers. */
interface EngineModule {
  readonly HEAPU8: Uint8Array;
  readonly HEAPU32: Uint32Array;
  readonly HEAPF32: Float32Array;
  readonly HEAPF64: Float64Array;
  _malloc(bytes: number): number;
  _free(address: number): void;
  _terrane_open(bytes: number, size: number): number;
  _terrane_look(...numbers: number[]): number;
  _terrane_set_criteria(...numbers: number[]): void;
  _terrane_set_budget(triangles: number): void;
  _terrane_set_morph_frames(frames: number): void;
  _terrane_update(): number;
  _terrane_summary(): number;
  _terrane_figures(): number;
  _terrane_indices(): number;
  _terrane_positions(): number;
  _terrane_normals(): number;
  _terrane_colours(): number;
  _terrane_slot_count(): number;
  _terrane_changed_triangles(): number;
  _terrane_changed_triangles_count(): number;
  _terrane_changed_vertices(): number;
  _terrane_changed_vertices_count(): number;
}

/** @param url of view_engine.js; view_engine.wasm lies beside it */
export async function loadEngine(url: string): Promise<ViewEngine> {
  let made: {default: () => Promise<EngineModule>};
  try {
    made = (await import(/* @vite-ignore */ url)) as typeof made;
  } catch {
    throw new Error(
      'This viewer was built without its engine for merge trees. Install emscripten, and build terrane again',
    );
  }
  return new ViewEngine(await made.default());
}

/** Arrays that it gives are its own: they hold until the next call of anything. */
export class ViewEngine {
  constructor(private readonly module: EngineModule) {}

  /** @throws Error if the bytes are no tree */
  open(bytes: Uint8Array): TreeSummary {
    const {module} = this;
    const address = module._malloc(bytes.length) >>> 0;
    module.HEAPU8.set(bytes, address);
    const message = module._terrane_open(address, bytes.length);
    module._free(address);
    this.check(message);
    const n = this.doubles(module._terrane_summary(), 11);
    return {
      fullTriangles: n[0]!,
      coarsestTriangles: n[1]!,
      levels: n[2]!,
      origin: [n[3]!, n[4]!, n[5]!],
      middle: [n[6]!, n[7]!, n[8]!],
      reach: n[9]!,
      hasColours: n[10]! > 0,
    };
  }

  look({eye, target, up, fovDeg, widthPx, heightPx}: TreeCamera): void {
    this.check(
      this.module._terrane_look(...eye, ...target, ...up, fovDeg, widthPx, heightPx),
    );
  }

  setCriteria(criteria: ViewCriteria): void {
    const {silhouettePx, highlightPx, colourPx} = criteria;
    const bits =
      (criteria.measure === 'length' ? 1 : 0) |
      (criteria.frustum ? 2 : 0) |
      (criteria.backFaces ? 4 : 0) |
      (silhouettePx !== null ? 8 : 0) |
      (highlightPx !== null ? 16 : 0) |
      (colourPx !== null ? 32 : 0);
    const {tolerancePx, shininess, toLight} = criteria;
    this.module._terrane_set_criteria(
      ...[bits, tolerancePx, silhouettePx ?? 0, highlightPx ?? 0, colourPx ?? 0, shininess, ...toLight],
    );
  }

  /** null: the tolerance of the criteria counts. */
  setBudget(triangles: number | null): void {
    this.module._terrane_set_budget(triangles ?? 0);
  }

  /** Begins with the coarsest mesh again. */
  setMorphFrames(frames: number): void {
    this.module._terrane_set_morph_frames(frames);
  }

  update(): FrameFigures {
    this.check(this.module._terrane_update());
    const n = this.doubles(this.module._terrane_figures(), 7);
    return {
      triangles: n[0]!,
      vertices: n[1]!,
      splits: n[2]!,
      merges: n[3]!,
      lookedAt: n[4]!,
      tolerancePx: n[5]!,
      isSettled: n[6]! > 0,
    };
  }

  /** Three slots a triangle. */
  indices(triangles: number): Uint32Array {
    return this.words(this.module._terrane_indices(), 3 * triangles);
  }
  /** Three numbers a slot. */
  positions(): Float32Array {
    return this.floats(this.module._terrane_positions(), 3 * this.slotCount);
  }
  normals(): Float32Array {
    return this.floats(this.module._terrane_normals(), 3 * this.slotCount);
  }
  /** Four bytes a slot; empty if the tree has no colours. */
  colours(): Uint8Array {
    const address = this.module._terrane_colours() >>> 0;
    return this.module.HEAPU8.subarray(address, address + (address ? 4 * this.slotCount : 0));
  }
  get slotCount(): number {
    return this.module._terrane_slot_count();
  }

  /** Triangles and slots that the last update wrote: begin, end, begin, end, ... */
  changedTriangles(): Uint32Array {
    const count = this.module._terrane_changed_triangles_count();
    return this.words(this.module._terrane_changed_triangles(), 2 * count);
  }
  changedSlots(): Uint32Array {
    const count = this.module._terrane_changed_vertices_count();
    return this.words(this.module._terrane_changed_vertices(), 2 * count);
  }

  private words(address: number, count: number): Uint32Array {
    return this.module.HEAPU32.subarray(address >>> 2, (address >>> 2) + count);
  }
  private floats(address: number, count: number): Float32Array {
    return this.module.HEAPF32.subarray(address >>> 2, (address >>> 2) + count);
  }
  private doubles(address: number, count: number): Float64Array {
    return this.module.HEAPF64.subarray(address >>> 3, (address >>> 3) + count);
  }

  /** @param message address of what went wrong; 0: nothing did */
  private check(message: number): void {
    if (message === 0) return;
    const begin = message >>> 0;
    const bytes = this.module.HEAPU8.subarray(begin, this.module.HEAPU8.indexOf(0, begin));
    throw new Error(new TextDecoder().decode(bytes));
  }
}
