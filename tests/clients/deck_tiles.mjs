// deck_tiles.mjs FOLDER PICTURES: deck.gl (loaders.gl) shows the tile sets of FOLDER.
import {readFile} from 'node:fs/promises';
import {join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {check, failures, lookAt, open, takePicture, withBrowser} from './browser.mjs';
import {bundledPage} from './bundled_page.mjs';
import {tileSets} from './glb_files.mjs';
import {servePages} from './page_server.mjs';
import {checkShown} from './shown_tiles.mjs';

// the others say how files are, these how they look
const kShown = /^trinidad/;
const [folder, pictures] = process.argv.slice(2);
const draco = fileURLToPath(new URL('node_modules/three/examples/jsm/libs/draco/gltf/', import.meta.url));
const server = await servePages({...(await bundledPage('deck_page.js')), '/tiles/': folder, '/draco/': draco});

await withBrowser(async (context) => {
  for (const name of await tileSets(folder)) {
    if (kShown.test(name)) await look(context, name);
  }
});
check(server.missing.length === 0, `nothing asked for that is not there ${server.missing.slice(0, 3)}`);
server.close();
process.exit(failures() > 0 ? 1 : 0);

async function look(context, name) {
  const {levels} = JSON.parse(await readFile(join(folder, name, 'terrane.json'), 'utf8'));
  const {page, problems} = await open(context, `${server.url}/page.html`);
  const url = `${server.url}/tiles/${name}/tileset.json`;
  const span = levels.at(-1).largest_diagonal_m;
  // its error is in pixels of the whole view: level 1 in the middle
  const maximumScreenSpaceError = (3 * levels[0].tolerance_m * 480) / span;
  const shown = await page.evaluate((to) => window.show(to), {url, span, maximumScreenSpaceError});
  const wrong = [...shown.failed, ...problems.errors, ...problems.requests];
  check(wrong.length === 0, `${name}: no failed tile, no error ${wrong.slice(0, 3)}`);
  await checkShown(folder, name, shown, 1);
  const seen = await lookAt(page, await takePicture(page, join(pictures, `deck_${name}.png`)), [0, 0, 0]);
  // bare ground has few: it lights the tiles from everywhere
  check(seen.drawn > 0.1 && seen.colours > 4,
    `${name}: the picture is not blank (${(100 * seen.drawn).toFixed(0)} %, ${seen.colours} colours)`);
  await page.close();
}
