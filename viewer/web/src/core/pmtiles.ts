// Reads a .pmtiles archive as `terrane pack` writes it (docs/formats.md): tiles by range requests,
// the other files from its metadata.
//
// Source: PMTiles specification, version 3.
export type ReadRange = (
  offset: number,
  length: number,
  signal?: AbortSignal,
) => Promise<ArrayBuffer>;

interface Section {
  readonly offset: number;
  readonly length: number;
}

interface Header {
  readonly root: Section;
  readonly metadata: Section;
  readonly leaves: Section;
  readonly tiles: Section;
  /** 1: none, 2: gzip. */
  readonly ownCompression: number;
  readonly tileCompression: number;
}

/** A run of equal tiles, or (run 0) a leaf directory. */
interface Entry {
  readonly id: number;
  readonly run: number;
  readonly offset: number;
  readonly length: number;
}

interface Contents {
  readonly tiles: {path: string; first_zoom: number; zoom_step: number};
  readonly files: Record<string, unknown>;
  readonly stored: Record<string, Section & {compression: string}>;
}

const kHeaderBytes = 127;
/** The header and the root directory lie within. */
const kFirstBytes = 16384;

export class PmtilesArchive {
  private readonly directories = new Map<number, Promise<Entry[]>>();
  private readonly tilePath: RegExp;

  private constructor(
    private readonly readRange: ReadRange,
    private readonly header: Header,
    private readonly root: Entry[],
    private readonly contents: Contents,
  ) {
    const escaped = contents.tiles.path.replace(/[.*+?^$()|[\]\\]/g, '\\$&');
    const named = escaped.replace(/\{([lxy])\}/g, '(?<$1>\\d+)');
    this.tilePath = new RegExp(`^${named}$`);
  }

  /** @throws Error that says what is wrong with the archive */
  static async open(readRange: ReadRange): Promise<PmtilesArchive> {
    const first = await readRange(0, kFirstBytes);
    const header = parseHeader(first);
    const {root, metadata, ownCompression} = header;
    const rootBytes = first.slice(root.offset, root.offset + root.length);
    const directory = parseDirectory(await unpacked(rootBytes, ownCompression));
    const text = await unpacked(await readRange(metadata.offset, metadata.length), ownCompression);
    const json = JSON.parse(new TextDecoder().decode(text)) as {terrane_archive?: Contents};
    if (!json.terrane_archive) throw new Error('the archive holds no terrane data set');
    return new PmtilesArchive(readRange, header, directory, json.terrane_archive);
  }

  /** The bytes of a file of the packed folder; undefined if there is none of that name. */
  async read(path: string, signal?: AbortSignal): Promise<ArrayBuffer | undefined> {
    const {files, stored} = this.contents;
    const file = files[path];
    if (file !== undefined) {
      const text = typeof file === 'string' ? file : JSON.stringify(file);
      return new TextEncoder().encode(text).buffer as ArrayBuffer;
    }
    const place = stored?.[path];
    if (place) return this.readData(place, place.compression === 'gzip' ? 2 : 1, signal);
    return this.readTile(path, signal);
  }

  private async readTile(path: string, signal?: AbortSignal): Promise<ArrayBuffer | undefined> {
    const numbers = this.tilePath.exec(path)?.groups;
    if (!numbers) return undefined;
    const {first_zoom, zoom_step} = this.contents.tiles;
    const zoom = first_zoom + zoom_step * Number(numbers.l);
    const entry = await this.find(tileId(zoom, Number(numbers.x), Number(numbers.y)));
    return entry && this.readData(entry, this.header.tileCompression, signal);
  }

  private async find(id: number): Promise<Entry | undefined> {
    let entries = this.root;
    // the specification allows a root, leaves, and one more for good measure
    for (let depth = 0; depth < 4; ++depth) {
      const entry = lastNotAfter(entries, id);
      if (!entry) return undefined;
      if (entry.run > 0) return id < entry.id + entry.run ? entry : undefined;
      entries = await this.leaf(entry);
    }
    return undefined;
  }

  private leaf({offset, length}: Entry): Promise<Entry[]> {
    let directory = this.directories.get(offset);
    if (!directory) {
      const {leaves, ownCompression} = this.header;
      directory = this.readRange(leaves.offset + offset, length)
        .then((bytes) => unpacked(bytes, ownCompression))
        .then(parseDirectory);
      this.directories.set(offset, directory);
      // one that failed is asked for again
      directory.catch(() => this.directories.delete(offset));
    }
    return directory;
  }

  private async readData(
    {offset, length}: Section,
    compression: number,
    signal?: AbortSignal,
  ): Promise<ArrayBuffer> {
    const bytes = await this.readRange(this.header.tiles.offset + offset, length, signal);
    return unpacked(bytes, compression);
  }
}

/** Number of a tile: all of the zooms before, then its place on the Hilbert curve of its zoom. */
export function tileId(zoom: number, x: number, y: number): number {
  let id = (4 ** zoom - 1) / 3;
  for (let side = 2 ** zoom / 2; side >= 1; side /= 2) {
    const [right, low] = [Math.floor(x / side) % 2, Math.floor(y / side) % 2];
    id += side * side * ((3 * right) ^ low);
    if (low === 0) {
      if (right === 1) [x, y] = [side - 1 - (x % side), side - 1 - (y % side)];
      [x, y] = [y, x];
    }
    [x, y] = [x % side, y % side];
  }
  return id;
}

function parseHeader(bytes: ArrayBuffer): Header {
  const magic = new TextDecoder('latin1').decode(new Uint8Array(bytes, 0, 7));
  if (bytes.byteLength < kHeaderBytes || magic !== 'PMTiles') throw new Error('not a PMTiles file');
  const view = new DataView(bytes);
  const version = view.getUint8(7);
  if (version !== 3) throw new Error(`PMTiles version ${version}; only 3 can be read`);
  const section = (at: number): Section => ({
    offset: Number(view.getBigUint64(at, true)),
    length: Number(view.getBigUint64(at + 8, true)),
  });
  return {
    root: section(8),
    metadata: section(24),
    leaves: section(40),
    tiles: section(56),
    ownCompression: view.getUint8(97),
    tileCompression: view.getUint8(98),
  };
}

/** Columns of varints: ids as differences, runs, lengths, offsets (0: behind the one before). */
function parseDirectory(bytes: ArrayBuffer): Entry[] {
  const next = varints(new Uint8Array(bytes));
  const count = next();
  const column = () => Array.from({length: count}, next);
  const [gaps, runs, lengths, offsets] = [column(), column(), column(), column()];
  let id = 0;
  let end = 0;
  return gaps.map((gap, i) => {
    id += gap;
    const offset = offsets[i] === 0 ? end : offsets[i]! - 1;
    end = offset + lengths[i]!;
    return {id, run: runs[i]!, offset, length: lengths[i]!};
  });
}

function varints(bytes: Uint8Array): () => number {
  let at = 0;
  return () => {
    let [value, factor] = [0, 1];
    for (;;) {
      const byte = bytes[at++];
      if (byte === undefined) throw new Error('a directory of the archive ends too early');
      value += (byte & 127) * factor;
      if (byte < 128) return value;
      factor *= 128;
    }
  };
}

function lastNotAfter(entries: readonly Entry[], id: number): Entry | undefined {
  let [low, high] = [0, entries.length];
  while (low < high) {
    const middle = (low + high) >> 1;
    if (entries[middle]!.id <= id) low = middle + 1;
    else high = middle;
  }
  return entries[low - 1];
}

async function unpacked(bytes: ArrayBuffer, compression: number): Promise<ArrayBuffer> {
  if (compression <= 1) return bytes;
  if (compression !== 2) throw new Error(`compression ${compression} cannot be read, only gzip`);
  const stream = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Response(stream).arrayBuffer();
}
