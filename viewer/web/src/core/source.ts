// Where the files of a data set come from: a folder on a web server, or one .pmtiles file.
import {PmtilesArchive, type ReadRange} from './pmtiles';

/** Files by their address; relative ones are found beside the tileset. */
export interface Source {
  /** Address of the tileset. */
  readonly url: string;
  /** Rejects with a message that names the file where it cannot be read. */
  read(url: string, signal?: AbortSignal): Promise<ArrayBuffer>;
}

/** @param url address of a tileset.json, or of a .pmtiles file */
export async function openSource(url: string): Promise<Source> {
  if (/\.pmtiles$/i.test(new URL(url).pathname)) {
    return archiveSource(url, await PmtilesArchive.open(rangesOfUrl(url)));
  }
  return {url, read: readUrl};
}

/** Opens a file from the user's disk. */
export async function openFile(file: File): Promise<Source> {
  const readRange: ReadRange = (offset, length) =>
    file.slice(offset, offset + length).arrayBuffer();
  return archiveSource(
    `file:///${encodeURIComponent(file.name)}`,
    await PmtilesArchive.open(readRange),
  );
}

export async function readJson(source: Source, url: string): Promise<unknown> {
  const text = new TextDecoder().decode(await source.read(url));
  try {
    return JSON.parse(text);
  } catch {
    throw new Error(`${url}: not JSON`);
  }
}

/** Paths in the archive are those below its own address. */
function archiveSource(url: string, archive: PmtilesArchive): Source {
  const top = `${url}/`;
  const read = async (address: string, signal?: AbortSignal) => {
    const path = address.startsWith(top) ? address.slice(top.length) : address;
    const found = await archive.read(decodeURIComponent(path), signal);
    if (!found) throw new Error(`${path}: not in ${url}`);
    return found;
  };
  return {url: `${top}tileset.json`, read};
}

async function readUrl(url: string, signal?: AbortSignal): Promise<ArrayBuffer> {
  const response = await fetch(url, {signal: signal ?? null});
  if (!response.ok) throw new Error(`${url}: status ${response.status}`);
  return response.arrayBuffer();
}

function rangesOfUrl(url: string): ReadRange {
  return async (offset, length, signal) => {
    const headers = {range: `bytes=${offset}-${offset + length - 1}`};
    const response = await fetch(url, {headers, signal: signal ?? null});
    if (response.status === 206) return response.arrayBuffer();
    if (!response.ok) throw new Error(`${url}: status ${response.status}`);
    throw new Error(`${url}: its server does not answer range requests`);
  };
}
