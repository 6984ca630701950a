// A headless Chromium that reaches this machine alone, and a count of checks that do not hold.
import {mkdir, mkdtemp, rm, writeFile} from 'node:fs/promises';
import {tmpdir} from 'node:os';
import {dirname, join} from 'node:path';
import {chromium} from 'playwright-core';

export {check, failures} from './check.mjs';

const kPicture = {width: 640, height: 480};
const kLongestMs = 180000;

// software rendering, and no traffic of the browser's own
const kFlags = [
  '--no-sandbox',
  '--disable-quic',
  '--no-first-run',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
  '--use-gl=angle',
  '--use-angle=swiftshader',
  '--enable-unsafe-swiftshader',
];

/** Runs use(context) in a fresh browser. */
export async function withBrowser(use) {
  const profile = await mkdtemp(join(tmpdir(), 'terrane-client-'));
  const settings = {executablePath: '/usr/bin/chromium', headless: true, args: kFlags, viewport: kPicture};
  const context = await chromium.launchPersistentContext(profile, settings);
  context.setDefaultTimeout(kLongestMs);
  try {
    await use(context);
  } finally {
    await context.close();
    await rm(profile, {recursive: true, force: true});
  }
}

/**
 * Opens a page.
 *
 * @returns the page, and what goes wrong in it: errors and warnings of its console, failed requests
 */
export async function open(context, url) {
  const problems = {errors: [], warnings: [], requests: []};
  const page = await context.newPage();
  await page.route('**', (route) => {
    const {hostname, protocol} = new URL(route.request().url());
    const isLocal = hostname === '127.0.0.1' || protocol === 'data:' || protocol === 'blob:';
    if (!isLocal) problems.requests.push(`away: ${route.request().url()}`);
    return isLocal ? route.continue() : route.abort();
  });
  page.on('console', (message) => {
    // software rendering has its own complaints
    if (/GPU stall|WebGL|swiftshader|GroupMarker/i.test(message.text())) return;
    if (message.type() === 'error') problems.errors.push(message.text());
    if (message.type() === 'warning') problems.warnings.push(message.text());
  });
  page.on('pageerror', (error) => problems.errors.push(error.message));
  page.on('response', (response) => {
    if (response.status() >= 400) problems.requests.push(`${response.status()} ${response.url()}`);
  });
  await page.goto(url);
  return {page, problems};
}

/** Takes a picture of the page, keeps it in a file, and gives its bytes. */
export async function takePicture(page, file) {
  const png = await page.screenshot();
  await mkdir(dirname(file), {recursive: true});
  await writeFile(file, png);
  return png;
}

/**
 * Looks at a picture.
 *
 * @returns share of pixels that are not `background` (r, g, b), and number of different colours
 */
export async function lookAt(page, png, background) {
  return page.evaluate(async ([base64, ground]) => {
    const bytes = Uint8Array.from(atob(base64), (c) => c.charCodeAt(0));
    const bitmap = await createImageBitmap(new Blob([bytes], {type: 'image/png'}));
    const canvas = new OffscreenCanvas(bitmap.width, bitmap.height);
    const pen = canvas.getContext('2d');
    pen.drawImage(bitmap, 0, 0);
    const {data} = pen.getImageData(0, 0, bitmap.width, bitmap.height);
    const colours = new Set();
    let drawn = 0;
    for (let i = 0; i < data.length; i += 4) {
      colours.add((data[i] << 16) | (data[i + 1] << 8) | data[i + 2]);
      drawn += ground.some((value, k) => Math.abs(value - data[i + k]) > 3);
    }
    return {drawn: (4 * drawn) / data.length, colours: colours.size};
  }, [png.toString('base64'), background]);
}
