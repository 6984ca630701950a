// Looks at the page of a volume with headless Chromium: colours at places whose material is known,
// with the section moved, the mesh on and off, and colours by field.
//
//     node volume.mjs --folder OUT --known places.json [--screenshot section.png]
//         [--chromium /usr/bin/chromium]
//
// places.json: {"empty": [number], "sections": [{"section": {kind, directionDeg, offsetM}, "places":
// [{"at": [x, y, z], "material": number}]}], "screenshot_section": {...}}, places in the model's
// metres. One line for each check; exit status 0 if all hold.
import {readFile, writeFile} from 'node:fs/promises';
import {join} from 'node:path';
import {parseArgs} from 'node:util';
import {check, failures, open, withBrowser} from './browser.mjs';
import {serveFolders} from './serve_folder.mjs';

const {values: options} = parseArgs({
  options: {
    folder: {type: 'string'},
    known: {type: 'string'},
    screenshot: {type: 'string'},
    chromium: {type: 'string', default: '/usr/bin/chromium'},
  },
});

// as in src/volume/section_material.ts
const kColors = [[138, 109, 75], [61, 127, 193], [232, 240, 245], [201, 162, 39]];
const kPaper = [243, 245, 246];

/** What a material looks like with nothing behind it: empty ones let a part of the paper through. */
function shownColor(material, known) {
  const opacity = known.empty.includes(material) ? 0.35 : 1;
  return kColors[material].map((x, k) => Math.round(opacity * x + (1 - opacity) * kPaper[k]));
}

/** Colours of the canvas at some pixels, and how many pixels of all are nearly black. */
function look(page, pixels) {
  return page.evaluate((wanted) => {
    const canvas = document.getElementById('volume');
    const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext('2d');
    window.terraneVolume.redraw();
    copy.drawImage(canvas, 0, 0);
    const {data} = copy.getImageData(0, 0, canvas.width, canvas.height);
    let different = 0;
    const colors = new Set();
    for (let i = 0; i < data.length; i += 4) {
      colors.add((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]);
      different += data[i] < 60 && data[i + 1] < 60;
    }
    const at = wanted.map(([x, y]) => [...data.slice(4 * (y * canvas.width + x)).slice(0, 3)]);
    return {at, dark: different / (data.length / 4), colors: colors.size};
  }, pixels);
}

function pixelsOf(page, places) {
  return page.evaluate(
    (list) => list.map((place) => window.terraneVolume.pixelOf(place)),
    places.map(({at}) => at),
  );
}

const isNear = (a, b) => a.every((x, k) => Math.abs(x - b[k]) <= 2);

async function checkSection(page, {section, places}, known) {
  const text = `${section.kind} section at ${section.offsetM} m, ${section.directionDeg} degrees`;
  await page.evaluate((s) => window.terraneVolume.setSection(s), section);
  await page.evaluate(() => window.terraneVolume.setMesh(false));
  const pixels = await pixelsOf(page, places);
  const plain = await look(page, pixels);
  places.forEach(({at, material}, i) => {
    const color = shownColor(material, known);
    const holds = isNear(plain.at[i], color);
    check(holds, `${text}: ${at} shows ${plain.at[i]}, material ${material} is ${color}`);
  });
  await page.evaluate(() => window.terraneVolume.setMesh(true));
  const meshed = await look(page, pixels);
  const {cells} = await page.evaluate(() => window.terraneVolume.stats());
  check(cells > 0 && meshed.dark > plain.dark,
    `${text}: ${cells} cells; ${plain.dark.toFixed(4)} dark without the mesh, ${meshed.dark.toFixed(4)} with it`);
}

async function checkField(page, {section, places}, known) {
  await page.evaluate((s) => window.terraneVolume.setSection(s), section);
  await page.evaluate(() => window.terraneVolume.setMesh(false));
  await page.evaluate(() => window.terraneVolume.setColour(0));
  const {at} = await look(page, await pixelsOf(page, places));
  const changed = places.filter(({material}, i) => !isNear(at[i], shownColor(material, known)));
  const filled = places.filter(({material}) => !known.empty.includes(material));
  check(changed.length === filled.length, `colours by field: ${at.map((c) => c.join(' ')).join(', ')}`);
  await page.evaluate(() => window.terraneVolume.setColour(-1));
}

/** As a user does it: a slider is dragged, a box is ticked. */
async function checkControls(page) {
  const before = await page.textContent('#stats');
  await page.locator('#direction').fill('37');
  await page.locator('#offset').evaluate((input) => {
    input.value = String(0.3 * Number(input.max));
    input.dispatchEvent(new Event('input'));
  });
  const after = await page.textContent('#stats');
  check(before !== after && after.includes('in the section'), `the panel tells: ${after.replace('\n', ', ')}`);
  check((await page.textContent('#direction-text')) === '37°', 'and where the section stands');
}

async function run(context, url, known) {
  const {page, problems} = await open(context, url, 1, {
    started: () => window.terraneVolume,
  });
  await page.evaluate(() => window.terraneVolume.setSurfaces(false));
  for (const each of known.sections) await checkSection(page, each, known);
  await checkField(page, known.sections[0], known);
  await checkControls(page);
  await page.evaluate((s) => window.terraneVolume.setSection(s), known.screenshot_section);
  await page.evaluate(() => {
    window.terraneVolume.setSurfaces(true);
    window.terraneVolume.setMesh(true);
  });
  await page.waitForTimeout(300);
  if (options.screenshot) await writeFile(options.screenshot, await page.screenshot());
  check(await page.isHidden('#error'), 'no error is shown');
  const {console: errors, requests} = problems;
  check(errors.length === 0, `console errors: ${errors.join('; ') || 'none'}`);
  check(requests.length === 0, `failed requests: ${requests.join('; ') || 'none'}`);
}

async function main() {
  if (!options.folder || !options.known) throw new Error('Say --folder and --known');
  const known = JSON.parse(await readFile(options.known, 'utf8'));
  const server = await serveFolders([join(options.folder)]);
  await withBrowser(options.chromium, (context) => run(context, server.url, known));
  server.close();
}

main()
  .catch((error) => check(false, error.message))
  .finally(() => process.exit(failures() > 0 ? 1 : 0));
