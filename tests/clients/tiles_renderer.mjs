// tiles_renderer.mjs FOLDER PICTURES: 3d-tiles-renderer (three.js) shows every tile set of FOLDER; its
// validation plugin has nothing to say.
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
const server = await servePages({...(await bundledPage('tiles_renderer_page.js')), '/tiles/': folder, '/draco/': draco});

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
  // it does not read the boxes of single tiles where the tiling is implicit
  const validated = !name.endsWith('-implicit');
  const shown = await page.evaluate((to) => window.show(to), {
    url, finestError: levels[0].tolerance_m, radius: levels.at(-1).largest_diagonal_m / 2, validated,
  });
  // it says so of every tileset that is not 1.0
  const warnings = problems.warnings.filter((text) => !text.includes('1.1 or higher have limited support'));
  const wrong = [...shown.failed, ...problems.errors, ...warnings, ...problems.requests];
  check(wrong.length === 0, `${name}: no failed tile, no error, no warning ${wrong.slice(0, 3)}`);
  await checkShown(folder, name, shown);
  const seen = await lookAt(page, await takePicture(page, join(pictures, `tiles_renderer_${name}.png`)), [0, 0, 0]);
  check(seen.drawn > 0.1 && seen.colours > 40,
    `${name}: the picture is not blank (${(100 * seen.drawn).toFixed(0)} %, ${seen.colours} colours)`);
  await page.close();
}
