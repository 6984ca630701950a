// Headless Chromium with a viewer in it, and a count of checks that do not hold.
import {mkdtemp, rm} from 'node:fs/promises';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {chromium} from 'playwright-core';

const kPicture = {width: 640, height: 480};
const kReadyMs = 120000;
const kComesTrueMs = 60000;

// no traffic of the browser's own
const kFlags = [
  '--no-sandbox',
  '--disable-quic',
  '--no-first-run',
  '--disable-background-networking',
  '--disable-component-update',
  '--disable-sync',
];
const kSoftwareFlags = ['--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'];
// without a display, too (tried with NVIDIA's driver 580): through EGL, WebGL and the page are both put together on the
// card. --use-angle=vulkan draws there as well, but the page is then composed in software and waits for each picture.
const kGpuFlags = ['--use-gl=angle', '--use-angle=gl-egl', '--ignore-gpu-blocklist'];

let failureCount = 0;

/** Prints one line for a check. */
export function check(holds, text) {
  console.log(`${holds ? 'ok  ' : 'FAIL'} ${text}`);
  if (!holds) ++failureCount;
}

/** Checks so far that do not hold. */
export function failures() {
  return failureCount;
}

/**
 * Opens a viewer and waits for its tileset.
 *
 * @param prepare what to do with the page before it opens
 * @param started what is true in the page once its data is there
 * @param antialias true: smooth edges, as the page has them by default
 * @returns the page, and what goes wrong in it: console errors, and requests that fail
 */
export async function open(
  context,
  address,
  tolerance,
  {prepare = () => {}, started = () => window.terrane, antialias = false} = {},
) {
  const problems = {console: [], requests: []};
  const page = await context.newPage();
  await page.route('**', keepLocal);
  listen(page, problems);
  await prepare(page);
  const url = new URL(address);
  if (!antialias) url.searchParams.set('antialias', 'off');
  url.searchParams.set('tolerance', tolerance);
  await page.goto(url.href);
  await page.waitForFunction(started, undefined, {timeout: kReadyMs});
  return {page, problems};
}

function keepLocal(route) {
  const {hostname, protocol} = new URL(route.request().url());
  const isLocal = hostname === '127.0.0.1' || hostname === 'localhost' || protocol === 'data:';
  return isLocal ? route.continue() : route.abort();
}

function listen(page, problems) {
  page.on('console', (message) => {
    if (message.type() === 'error') problems.console.push(message.text());
  });
  page.on('pageerror', (error) => problems.console.push(error.message));
  page.on('response', (response) => {
    if (response.status() >= 400) problems.requests.push(`${response.status()} ${response.url()}`);
  });
  page.on('requestfailed', (request) => {
    // the viewer lets go of tiles that it no longer wants
    const reason = request.failure()?.errorText ?? '';
    if (reason !== 'net::ERR_ABORTED') problems.requests.push(`${reason} ${request.url()}`);
  });
}

/** Resolves when all wanted detail is shown; rejects after two minutes. */
export async function ready(page) {
  let timer;
  const late = new Promise((_, reject) => {
    timer = setTimeout(() => reject(new Error('not ready after two minutes')), kReadyMs);
  });
  await Promise.race([page.evaluate(() => window.terrane.ready()), late]);
  clearTimeout(timer);
}

/**
 * True as soon as something holds, which it is asked again and again; false if it does not within a minute. No fixed wait
 * will do: a frame moves a camera by a tenth of a second at most, however long it took to draw.
 */
export async function comesTrue(holds) {
  const endMs = Date.now() + kComesTrueMs;
  while (!(await holds())) {
    if (Date.now() > endMs) return false;
    await new Promise((resolve) => setTimeout(resolve, 50));
  }
  return true;
}

/** Runs something in a fresh browser, which renders in software unless `gpu` is true. */
export async function withBrowser(executablePath, use, {viewport = kPicture, gpu = false} = {}) {
  const profile = await mkdtemp(join(tmpdir(), 'terrane-view-'));
  const args = [...kFlags, ...(gpu ? kGpuFlags : kSoftwareFlags)];
  const settings = {executablePath, headless: true, args, viewport};
  const context = await chromium.launchPersistentContext(profile, settings);
  try {
    await use(context);
  } finally {
    await context.close();
    await rm(profile, {recursive: true, force: true});
  }
}
