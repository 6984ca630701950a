import {readdir, readFile} from 'node:fs/promises';
import {join} from 'node:path';

/** The tile sets below a folder: those with a finished terrane.json. */
export async function tileSets(folder) {
  const entries = await readdir(folder, {withFileTypes: true});
  return entries.filter((entry) => entry.isDirectory()).map((entry) => entry.name).sort();
}

/** Every glb below a folder. */
export async function* glbFiles(folder) {
  const entries = await readdir(folder, {withFileTypes: true, recursive: true});
  const files = entries.filter((entry) => entry.name.endsWith('.glb'));
  for (const file of files.map((entry) => join(entry.parentPath ?? entry.path, entry.name)).sort()) {
    yield [file, new Uint8Array(await readFile(file))];
  }
}
