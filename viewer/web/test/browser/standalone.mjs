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
// regular grids have many triangles: a tolerance that software rendering can follow
const settings = ['--url', server.url, '--tolerance', '4', '--covered=-1500,-1200'];
const view = spawn(process.execPath, [here('view.mjs'), ...settings, ...process.argv.slice(2)], {
  stdio: 'inherit',
});
const status = await new Promise((resolve) => view.on('exit', resolve));
server.close();
await rm(folder, {recursive: true});
process.exit(status ?? 1);
