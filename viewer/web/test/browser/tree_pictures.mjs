// Takes the pictures of docs/images/merge/page_*.jpg: the page of a tree as its camera sees it, and the
// same mesh, frozen, from elsewhere.
//
//     node tree_pictures.mjs --url http://127.0.0.1:8080/?tree=x.tree --eye=x,y,z --target=x,y,z
//         --from=x,y,z --out page [--settings '{"frustum": true}'] [--chromium /usr/bin/chromium]
import {writeFile} from 'node:fs/promises';
import {parseArgs} from 'node:util';
import {open, withBrowser} from './browser.mjs';

const {values: options} = parseArgs({
  options: {
    url: {type: 'string'},
    eye: {type: 'string'},
    target: {type: 'string'},
    from: {type: 'string'},
    out: {type: 'string'},
    settings: {type: 'string', default: '{}'},
    chromium: {type: 'string', default: '/usr/bin/chromium'},
  },
});

const place = (text) => text.split(',').map(Number);

async function picture(page, eye, settings, name) {
  await page.evaluate(
    ([camera, change]) => {
      window.terraneTree.set(change);
      window.terraneTree.setCamera(camera);
      return window.terraneTree.ready();
    },
    [{eye, target: place(options.target)}, settings],
  );
  const {triangles, updateMs} = await page.evaluate(() => window.terraneTree.stats());
  console.log(`${name}: ${triangles} triangles, ${updateMs.toFixed(2)} ms`);
  await writeFile(name, await page.screenshot({type: 'jpeg', quality: 85}));
}

await withBrowser(options.chromium, async (context) => {
  const {page} = await open(context, options.url, 1, {
    started: () => window.terraneTree,
    prepare: (opened) => opened.setViewportSize({width: 900, height: 560}),
  });
  const settings = JSON.parse(options.settings);
  await picture(page, place(options.eye), settings, `${options.out}_view.jpg`);
  await picture(page, place(options.from), {...settings, frozen: true}, `${options.out}_frozen.jpg`);
});
