// What a browser fetches before the first tile, as a server that compresses sends it.
//
//     node first_load.mjs
import {readFile} from 'node:fs/promises';
import {join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {gzipSync} from 'node:zlib';

const kDist = process.env.TERRANE_WEB_DIST ?? fileURLToPath(new URL('../dist', import.meta.url));
const kLargestBytes = 250000;

const files = ['index.html', 'assets/viewer.js', 'assets/viewer.css'];
const sizes = await Promise.all(
  files.map(async (name) => gzipSync(await readFile(join(kDist, name)), {level: 9}).length),
);
const total = sizes.reduce((sum, size) => sum + size, 0);
const holds = total < kLargestBytes;
console.log(`${holds ? 'ok  ' : 'FAIL'} first load: ${total} bytes gzipped (${sizes.join(' + ')})`);
process.exit(holds ? 0 : 1);
