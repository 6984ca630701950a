// The viewer by itself: makes a small tileset, serves it with the built viewer and looks at it.
//
//     npm run build && npm run test:browser [-- options of view.mjs]
import {spawn} from 'node:child_process';
import {mkdtemp, rm} from 'node:fs/promises';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {writeTileset} from '../synthetic_tiles.mjs';
import {serveFolders} from './serve_folder.mjs';

const here = (path) => fileURLToPath(new URL(path, import.meta.url));

const folder = await mkdtemp(join(tmpdir(), 'terrane-tiles-'));
await writeTileset(folder);
const server = await serveFolders([folder, process.env.TERRANE_WEB_DIST ?? here('../../dist')]);
const view = spawn(
  process.execPath,
  [here('view.mjs'), '--url', server.url, '--covered=-1500,-1200', ...process.argv.slice(2)],
  {stdio: 'inherit'},
);
const status = await new Promise((resolve) => view.on('exit', resolve));
server.close();
await rm(folder, {recursive: true});
process.exit(status ?? 1);
