// Pictures of the looks, the themes and a phone, compared with those in docs/images/viewer.
//
//     node looks.mjs --url http://127.0.0.1:8080/ --images docs/images/viewer
//         [--imagery | --water] [--write]
//
// --imagery takes the look of a tileset with images alone, --water those of Crater Lake; without them,
// all others.
// --write makes the pictures anew: look at each before you keep it. Fonts differ from machine to
// machine: pictures are compared at a quarter of their size.
import {mkdir, readFile, writeFile} from 'node:fs/promises';
import {join} from 'node:path';
import {parseArgs} from 'node:util';
import {check, failures, open, ready, withBrowser} from './browser.mjs';

const {values: options} = parseArgs({
  options: {
    url: {type: 'string'},
    images: {type: 'string'},
    imagery: {type: 'boolean', default: false},
    water: {type: 'boolean', default: false},
    write: {type: 'boolean', default: false},
    chromium: {type: 'string', default: '/usr/bin/chromium'},
  },
});

const kWide = {width: 760, height: 480};
const kPhone = {width: 390, height: 720};
/** Largest mean difference, of 255. */
const kLargestMean = 3;
/** Largest share of pixels that differ by more than 40 of 255. */
const kLargestShare = 0.02;

const kDay = {theme: 'light', hour: null, contours: false, wireframe: false, borders: false};
const kImagery = {imagery: {set: {...kDay, look: 'imagery'}}};
const kPictures = {
  relief: {set: {...kDay, look: 'relief'}},
  contours: {set: {...kDay, look: 'hillshade', contours: true}},
  slope: {set: {...kDay, look: 'slope'}},
  levels: {set: {...kDay, look: 'levels', wireframe: true, borders: true}},
  error: {set: {...kDay, look: 'error'}},
  evening: {set: {...kDay, look: 'relief', hour: 17.7}},
  dark: {set: {...kDay, look: 'relief', theme: 'dark', contours: true}},
  night: {set: {...kDay, look: 'relief', theme: 'dark', hour: 21}},
  phone: {set: {...kDay, look: 'relief'}, size: kPhone},
};

/** From the rim in the south, and from the east, where the sun goes down behind the lake. */
const kOverLake = {eye: [3800, -1500, 3700], target: [-1300, 3300, 1900]};
const kToTheWest = {eye: [7300, 6800, 2700], target: [-1500, 4400, 1800]};
const kWater = {
  water: {set: {...kDay, look: 'relief'}, camera: kOverLake},
  water_slope: {set: {...kDay, look: 'slope', contours: true}, camera: kOverLake},
  water_evening: {set: {...kDay, look: 'relief', hour: 17.8}, camera: kToTheWest},
  water_dark: {set: {...kDay, look: 'relief', theme: 'dark'}, camera: kOverLake},
  water_night: {set: {...kDay, look: 'relief', theme: 'dark', hour: 19.2}, camera: kToTheWest},
};

/** From the south, so that the nearest tiles are of the finest level. */
async function poseOver(page) {
  const {min, max} = await page.evaluate(() => window.terrane.bounds());
  const [wide, deep] = [max[0] - min[0], max[1] - min[1]];
  const eye = [min[0] + 0.4 * wide, min[1] + 0.07 * deep, max[2] + 0.09 * wide];
  return {eye, headingDeg: 12, pitchDeg: -24};
}

/** Mean difference of two JPEGs and the share of pixels that differ much; at a quarter of the size. */
function compare(page, a, b) {
  return page.evaluate(
    async ([first, second]) => {
      const pixels = async (base64) => {
        const bytes = Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0));
        const image = await createImageBitmap(new Blob([bytes], {type: 'image/jpeg'}));
        const [width, height] = [Math.round(image.width / 4), Math.round(image.height / 4)];
        const copy = new OffscreenCanvas(width, height).getContext('2d');
        copy.imageSmoothingQuality = 'high';
        copy.drawImage(image, 0, 0, width, height);
        return copy.getImageData(0, 0, width, height).data;
      };
      const [p, q] = [await pixels(first), await pixels(second)];
      if (p.length !== q.length) return {mean: 255, share: 1};
      let [sum, many] = [0, 0];
      for (let i = 0; i < p.length; i += 4) {
        const difference = [0, 1, 2].map((k) => Math.abs(p[i + k] - q[i + k]));
        sum += (difference[0] + difference[1] + difference[2]) / 3;
        if (Math.max(...difference) > 40) ++many;
      }
      return {mean: sum / (p.length / 4), share: many / (p.length / 4)};
    },
    [a.toString('base64'), b.toString('base64')],
  );
}

async function look(page, name, {set, size = kWide, camera}) {
  await page.setViewportSize(size);
  await page.evaluate((change) => window.terrane.set(change), set);
  if (camera) await page.evaluate((place) => window.terrane.setCamera(place), camera);
  else await page.evaluate((pose) => window.terrane.setPose(pose), await poseOver(page));
  await ready(page);
  await page.waitForTimeout(200);
  const shot = await page.screenshot({type: 'jpeg', quality: 70});
  const file = join(options.images, `${name}.jpg`);
  if (options.write) return writeFile(file, shot);
  const {mean, share} = await compare(page, shot, await readFile(file));
  check(
    mean < kLargestMean && share < kLargestShare,
    `${name}: differs by ${mean.toFixed(2)} of 255, ${(100 * share).toFixed(2)} % of it by much`,
  );
}

async function run(context) {
  const {page} = await open(context, options.url, 1);
  if (options.write) await mkdir(options.images, {recursive: true});
  const pictures = options.imagery ? kImagery : options.water ? kWater : kPictures;
  for (const [name, picture] of Object.entries(pictures)) {
    // the panel folds itself on a small window, when it opens
    if (picture.size)
      await page.evaluate(() => (document.getElementById('panel-fold').open = false));
    await look(page, name, picture);
  }
}

withBrowser(options.chromium, run)
  .catch((error) => check(false, error.message))
  .finally(() => process.exit(failures() > 0 ? 1 : 0));
