// What people do with the page: mouse, fingers, keys, tools, permalink; and whether all of it can be
// reached and read without a mouse.
//
//     node controls.mjs [--chromium /usr/bin/chromium]
import {mkdtemp, rm, writeFile} from 'node:fs/promises';
import {tmpdir} from 'node:os';
import {join} from 'node:path';
import {fileURLToPath} from 'node:url';
import {parseArgs} from 'node:util';
import {writeTileset} from '../synthetic_tiles.mjs';
import {check, comesTrue, failures, open, ready, withBrowser} from './browser.mjs';
import {serveFolders} from './serve_folder.mjs';

const {values: options} = parseArgs({
  options: {chromium: {type: 'string', default: '/usr/bin/chromium'}},
});
const kDist = process.env.TERRANE_WEB_DIST ?? fileURLToPath(new URL('../../dist', import.meta.url));
const kPose = {eye: [-2300, -3400, 2200], headingDeg: 20, pitchDeg: -45};
const [kX, kY] = [420, 300];
const kProfile = /km|m, [+−]\d+ m; up \d+ m, down \d+ m/;
const kPermalink = [/look=slope/, /contours=1/, /theme=dark/, /camera=/];

const poseOf = (page) => page.evaluate(() => window.terrane.pose());
const far = (a, b) => Math.hypot(...a.eye.map((value, k) => value - b.eye[k]));

/** Waits until the camera has come to rest. */
const rests = (page) =>
  comesTrue(async () => {
    const before = await poseOf(page);
    await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(resolve)));
    return far(before, await poseOf(page)) === 0;
  });

async function settle(page, pose = kPose) {
  await page.evaluate((p) => window.terrane.setPose(p), pose);
  await ready(page);
}

/** What the page says of the place under the cursor, in numbers. */
async function placeAt(page, x, y) {
  await page.mouse.move(x + 1, y);
  await page.mouse.move(x, y);
  const text = await page.textContent('#cursor');
  return (text.match(/-?[\d.]+/g) ?? []).map(Number);
}

const apart = (a, b) => Math.hypot(a[0] - b[0], a[1] - b[1]);

async function useMouse(page) {
  await settle(page);
  const before = await placeAt(page, kX, kY);
  check(before.length === 4, `the place under the cursor: ${await page.textContent('#cursor')}`);
  await page.mouse.down();
  await page.mouse.move(kX + 40, kY - 30, {steps: 4});
  await ready(page);
  const dragged = await placeAt(page, kX + 40, kY - 30);
  await page.mouse.up();
  check(
    apart(before, dragged) < 8,
    `a drag keeps it under the cursor: ${apart(before, dragged).toFixed(1)} m`,
  );

  await settle(page);
  await placeAt(page, kX, kY);
  await page.mouse.wheel(0, -300);
  await comesTrue(async () => far(kPose, await poseOf(page)) > 300);
  await rests(page);
  await ready(page);
  const zoomed = await placeAt(page, kX, kY);
  const came = far(kPose, await poseOf(page));
  check(
    came > 300 && apart(before, zoomed) < 8,
    `the wheel came ${came.toFixed(0)} m closer to it: ${apart(before, zoomed).toFixed(1)} m`,
  );

  await settle(page);
  await page.mouse.dblclick(kX, kY);
  check(
    await comesTrue(async () => far(kPose, await poseOf(page)) > 800),
    'a double click comes closer',
  );

  await settle(page);
  await page.mouse.move(kX, kY);
  await page.mouse.down({button: 'right'});
  await page.mouse.move(kX + 60, kY + 40, {steps: 4});
  await page.mouse.up({button: 'right'});
  await ready(page);
  const turned = await poseOf(page);
  check(
    Math.abs(turned.headingDeg - 35) < 1 && Math.abs(turned.pitchDeg + 55) < 1,
    `a right drag turns to ${turned.headingDeg.toFixed(0)} and tilts to ${turned.pitchDeg.toFixed(0)} degrees`,
  );
  check(apart(before, await placeAt(page, kX, kY)) < 8, 'about the place under the cursor');
}

async function useKeys(page) {
  await settle(page);
  await page.focus('#terrain');
  for (const [key, what] of [
    ['ArrowUp', 'moves'],
    ['Equal', 'zooms'],
    ['Shift+ArrowLeft', 'turns'],
  ]) {
    await settle(page);
    const [last, shift] = [key.split('+').at(-1), key.startsWith('Shift')];
    if (shift) await page.keyboard.down('Shift');
    await page.keyboard.down(last);
    check(await comesTrue(() => hasMoved(page)), `${key} ${what}`);
    await page.keyboard.up(last);
    if (shift) await page.keyboard.up('Shift');
  }
  await page.keyboard.press('f');
  const flies = () => page.getAttribute('#fly', 'aria-pressed');
  check(await comesTrue(async () => (await flies()) === 'true'), 'F flies');
  await page.keyboard.press('f');
  await page.keyboard.press('h');
  const isHome = ({headingDeg, eye}) => Math.abs(headingDeg) < 0.1 && eye[1] < -4000;
  check(await comesTrue(async () => isHome(await poseOf(page))), 'H shows the whole terrain');
}

async function hasMoved(page) {
  const now = await poseOf(page);
  return far(kPose, now) + Math.abs(now.headingDeg - kPose.headingDeg) > 5;
}

async function stayAboveGround(page) {
  let lowest = Infinity;
  for (const [x, y] of [
    [-2300, -2500],
    [500, -1000],
    [-1000, 2500],
  ]) {
    await settle(page, {eye: [x, y, -3000], headingDeg: 0, pitchDeg: 10});
    lowest = Math.min(
      lowest,
      await page.evaluate(() => {
        const {eye} = window.terrane.pose();
        return eye[2] - window.terrane.groundZ(eye[0], eye[1]);
      }),
    );
  }
  check(lowest > 5, `the eye stays above the ground: ${lowest.toFixed(1)} m`);
}

/** Two fingers through the browser's own input. */
async function useTouch(page) {
  await settle(page);
  const session = await page.context().newCDPSession(page);
  const touch = (type, points) =>
    session.send('Input.dispatchTouchEvent', {
      type,
      touchPoints: points.map(([x, y], id) => ({x, y, id})),
    });
  const gesture = async (from, to) => {
    await touch('touchStart', from);
    for (let i = 1; i <= 6; ++i) {
      await touch(
        'touchMove',
        from.map((p, k) => p.map((v, axis) => v + ((to[k][axis] - v) * i) / 6)),
      );
    }
    await touch('touchEnd', []);
    await ready(page);
  };
  await gesture(
    [
      [300, 240],
      [340, 240],
    ],
    [
      [240, 240],
      [400, 240],
    ],
  );
  check(far(kPose, await poseOf(page)) > 500, 'two fingers apart zoom in');
  await settle(page);
  await gesture(
    [
      [300, 200],
      [340, 200],
    ],
    [
      [300, 280],
      [340, 280],
    ],
  );
  const {pitchDeg} = await poseOf(page);
  check(pitchDeg < -55, `two fingers down tilt: ${pitchDeg.toFixed(0)} degrees`);
}

async function useTools(page) {
  await settle(page);
  await page.click('#measure');
  await page.mouse.click(kX, kY);
  await page.mouse.click(kX - 120, kY + 60);
  const profile = () => page.textContent('#profile-text');
  const holds = await comesTrue(async () => kProfile.test(await profile()));
  check(holds, `a profile: ${await profile()}`);
  check((await page.locator('#profile-plot polygon').count()) === 1, 'and its plot');
  await page.click('#profile-close');

  const download = page.waitForEvent('download');
  await page.click('#picture');
  check((await download).suggestedFilename() === 'terrane.png', 'a picture to save');

  await page.selectOption('#look', 'slope');
  await page.check('#contours');
  await page.click('#theme');
  const hash = () => new URL(page.url()).hash;
  const isWhole = await comesTrue(() => kPermalink.every((part) => part.test(hash())));
  check(isWhole, `permalink ${hash()}`);
  const pose = await poseOf(page);
  await page.reload();
  await page.waitForFunction(() => window.terrane);
  await ready(page);
  check(far(pose, await poseOf(page)) < 0.2, 'which brings the camera back');
  check(
    (await page.inputValue('#look')) === 'slope' && (await page.isChecked('#contours')),
    'and the look',
  );
}

/** Names for all controls, all reached by Tab, text that stands out: WCAG 2.1, 1.4.3 and 4.1.2. */
async function readWithoutMouse(page) {
  const nameless = await page.evaluate(() =>
    [...document.querySelectorAll('button, input, select, canvas')]
      .filter((node) => node.checkVisibility())
      .filter((node) => !node.ariaLabel && !node.textContent.trim() && !node.labels?.length)
      .map((node) => node.id),
  );
  check(nameless.length === 0, `controls without a name: ${nameless.join(', ') || 'none'}`);
  await page.focus('#terrain');
  const reached = new Set();
  for (let i = 0; i < 40; ++i) {
    await page.keyboard.press('Tab');
    reached.add(await page.evaluate(() => document.activeElement?.id));
  }
  const wanted = [
    'look',
    'contours',
    'tolerancePx',
    'exaggeration',
    'north',
    'home',
    'measure',
    'theme',
    'help',
  ];
  const missed = wanted.filter((id) => !reached.has(id));
  check(missed.length === 0, `not reached by Tab: ${missed.join(', ') || 'none'}`);
  for (const theme of ['light', 'dark']) {
    await page.evaluate((name) => window.terrane.set({theme: name}), theme);
    const contrast = await page.evaluate(lowestContrast);
    check(contrast > 4.5, `${theme}: text stands out by ${contrast.toFixed(1)} at least`);
  }
}

/** The smallest contrast of text and its panel, over the worst picture below: black or white. */
function lowestContrast() {
  const rgba = (color) => {
    const copy = new OffscreenCanvas(1, 1).getContext('2d', {willReadFrequently: true});
    copy.fillStyle = color;
    copy.fillRect(0, 0, 1, 1);
    const [r, g, b, a] = copy.getImageData(0, 0, 1, 1).data;
    return {rgb: [r, g, b], alpha: a / 255};
  };
  const luminance = (rgb) => {
    const [r, g, b] = rgb.map((v) =>
      v / 255 <= 0.04045 ? v / 255 / 12.92 : ((v / 255 + 0.055) / 1.055) ** 2.4,
    );
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const style = getComputedStyle(document.documentElement);
  const paper = rgba(style.getPropertyValue('--paper'));
  const ratios = ['--ink', '--quiet'].flatMap((name) =>
    [0, 255].map((below) => {
      const back = paper.rgb.map((v) => v * paper.alpha + below * (1 - paper.alpha));
      const [a, b] = [luminance(rgba(style.getPropertyValue(name)).rgb), luminance(back)];
      return (Math.max(a, b) + 0.05) / (Math.min(a, b) + 0.05);
    }),
  );
  return Math.min(...ratios);
}

/** The page flies along a path that a file gives. */
async function playPath(context, url) {
  const {page} = await open(context, `${url}?path=path.json`, 8);
  const isAtEnd = ({eye, headingDeg}) => Math.abs(eye[0] - 100) < 1e-6 && headingDeg === 30;
  check(await comesTrue(async () => isAtEnd(await poseOf(page))), 'a path is flown to its end');
  await page.close();
}

async function run(folder) {
  await writeTileset(folder);
  const path = [
    {s: 0, eye: [-2000, -3000, 2500], heading_deg: 0, pitch_deg: -40},
    {s: 0.5, eye: [100, -3000, 2500], heading_deg: 30, pitch_deg: -40},
  ];
  await writeFile(join(folder, 'path.json'), JSON.stringify(path));
  const server = await serveFolders([folder, kDist]);
  await withBrowser(options.chromium, async (context) => {
    const {page, problems} = await open(context, server.url, 8);
    await useMouse(page);
    await useKeys(page);
    await stayAboveGround(page);
    await useTouch(page);
    await useTools(page);
    await readWithoutMouse(page);
    await playPath(context, server.url);
    check(
      problems.console.length === 0,
      `console errors: ${problems.console.join('; ') || 'none'}`,
    );
  });
  server.close();
}

const folder = await mkdtemp(join(tmpdir(), 'terrane-tiles-'));
await run(folder).catch((error) => check(false, error.message));
await rm(folder, {recursive: true});
process.exit(failures() > 0 ? 1 : 0);
