// Flies over a served tileset and looks for cracks and pops.
//
//     node flight.mjs --url http://127.0.0.1:8080/ [--cameras 12] [--flight 24] [--steps 24]
//         [--pieces 5] [--piece 0.001] [--tolerance 2] [--dem FILE]
//
// Cameras: random ones over the terrain, the same for the same seed, for which all is loaded.
// Flight: from afar down to the ground without waiting for tiles. Steps: pieces of it, of this share
// of its length, with all tiles at hand; what is shown is compared with a mesh that does not change on
// the way. --dem: what the tileset was built from, if it has holes: backdrop between terrain must be
// in their direction.
import {parseArgs} from 'node:util';
import {check, failures, open, ready, withBrowser} from './browser.mjs';
import {flightPose} from './flight_path.mjs';
import {passesThroughHole, readDem} from './holes.mjs';
import {differenceOf, keepPicture, lookAgain, readPicture} from './picture.mjs';

const {values: options} = parseArgs({
  options: {
    url: {type: 'string'},
    cameras: {type: 'string', default: '12'},
    flight: {type: 'string', default: '24'},
    steps: {type: 'string', default: '24'},
    pieces: {type: 'string', default: '5'},
    piece: {type: 'string', default: '0.001'},
    tolerance: {type: 'string', default: '2'},
    dem: {type: 'string'},
    chromium: {type: 'string', default: '/usr/bin/chromium'},
  },
});

/** The opening angle of the viewer's camera. */
const kFovDeg = 45;

/** Numbers in [0, 1), the same for the same seed (mulberry32). */
function randomSource(seed) {
  let state = seed;
  return () => {
    state = (state + 0x6d2b79f5) | 0;
    let t = Math.imul(state ^ (state >>> 15), 1 | state);
    t = (t + Math.imul(t ^ (t >>> 7), 61 | t)) ^ t;
    return ((t ^ (t >>> 14)) >>> 0) / 4294967296;
  };
}

/** Eyes over the inner part of the terrain, looking down at least 25 degrees. */
function randomPose({min, max}, random) {
  const within = (k) => min[k] + (0.25 + 0.5 * random()) * (max[k] - min[k]);
  const size = Math.hypot(max[0] - min[0], max[1] - min[1]);
  const [x, y] = [within(0), within(1)];
  const z = max[2] + size * 0.4 * random() ** 2;
  return {eye: [x, y, z], headingDeg: 360 * random(), pitchDeg: -25 - 60 * random()};
}

async function lookForCracks(page) {
  const random = randomSource(1);
  const bounds = await page.evaluate(() => window.terrane.bounds());
  const count = Number(options.cameras);
  const dem = options.dem ? await readDem(options.dem) : undefined;
  let [pairs, vertices, mismatches, cracks, holes, atRim, loading] = [0, 0, 0, 0, 0, 0, 0];
  for (let i = 0; i < count; ++i) {
    const pose = randomPose(bounds, random);
    await page.evaluate((next) => window.terrane.setPose(next), pose);
    loading += (await page.evaluate(() => window.terrane.checkSeams())).mismatches;
    await ready(page);
    const seams = await page.evaluate(() => window.terrane.checkSeams());
    const picture = await readPicture(page);
    pairs += seams.pairs;
    vertices += seams.vertices;
    mismatches += seams.mismatches;
    const seen = await lookAgain(page, picture.cracks);
    atRim += picture.cracks.length - seen.length;
    const notHoles = dem ? await withoutHoles(page, dem, pose, seen) : seen;
    holes += seen.length - notHoles.length;
    cracks += notHoles.length;
  }
  check(
    pairs > 0 && mismatches === 0,
    `${count} cameras: ${pairs} seams, ${vertices} vertices, ${mismatches} apart`,
  );
  check(loading === 0, `${loading} apart while loading`);
  check(
    cracks === 0,
    `${cracks} pixels of backdrop in gaps of the terrain; ${holes} more in holes of the data, ` +
      `${atRim} in slivers over the rim of the picture`,
  );
}

/** Pixels that do not look through a hole of the data. */
async function withoutHoles(page, dem, pose, pixels) {
  const kept = [];
  const frame = pixels.length > 0 ? await frameOf(page) : undefined;
  const {min, max} = await page.evaluate(() => window.terrane.bounds());
  const {width, height} = page.viewportSize();
  const pixelRad = (2 * Math.tan((kFovDeg * Math.PI) / 360)) / height;
  const lengthM = Math.hypot(...max.map((m, k) => Math.max(m - pose.eye[k], pose.eye[k] - min[k])));
  for (const [x, y] of pixels) {
    const [right, up] = [(x + 0.5 - width / 2) * pixelRad, (height / 2 - y - 0.5) * pixelRad];
    const ray = {eye: pose.eye, direction: directionOf(pose, right, up), lengthM};
    // the terrain is within the tolerance of the data, and a pixel is as wide as it is
    const slack = (Number(options.tolerance) + 1) * pixelRad;
    if (!(await passesThroughHole(dem, frame, ray, slack))) kept.push([x, y]);
  }
  return kept;
}

const frameOf = (page) =>
  page.evaluate(async () => (await (await fetch('terrane.json')).json()).frame);

/** Direction of a place of the picture, in tangents from its middle. */
function directionOf({headingDeg, pitchDeg}, right, up) {
  const [h, p] = [headingDeg, pitchDeg].map((deg) => (deg * Math.PI) / 180);
  const ahead = [Math.sin(h) * Math.cos(p), Math.cos(h) * Math.cos(p), Math.sin(p)];
  const toRight = [Math.cos(h), -Math.sin(h), 0];
  const upwards = [-Math.sin(h) * Math.sin(p), -Math.cos(h) * Math.sin(p), Math.cos(p)];
  const sum = ahead.map((value, k) => value + right * toRight[k] + up * upwards[k]);
  const size = Math.hypot(...sum);
  return sum.map((value) => value / size);
}

async function flyWithoutWaiting(page) {
  const bounds = await page.evaluate(() => window.terrane.bounds());
  const count = Number(options.flight);
  let [vertices, mismatches, held] = [0, 0, 0];
  for (let i = 0; i <= count; ++i) {
    await page.evaluate((pose) => window.terrane.setPose(pose), flightPose(bounds, i / count));
    const seams = await page.evaluate(() => window.terrane.checkSeams());
    vertices += seams.vertices;
    mismatches += seams.mismatches;
    held += (await page.evaluate(() => window.terrane.stats())).holdbacks;
  }
  check(
    vertices > 0 && mismatches === 0,
    `${count} steps of a flight: ${vertices} vertices of seams, ${mismatches} apart; ${held} times held back`,
  );
}

const kPlaces = 48;

/** Poses along a piece of the flight, of which there are several. */
function piecePoses(bounds, piece, steps) {
  const begin = (piece + 0.5) / Number(options.pieces);
  return [...Array(steps + 1).keys()].map((i) =>
    flightPose(bounds, begin + (Number(options.piece) * i) / steps),
  );
}

/** Flies with all tiles at hand; the largest change of a height per metre flown. */
async function changePerMetre(page, bounds, poses) {
  return page.evaluate(
    ([flight, {min, max}, places]) => {
      const at = (i, k, stride) =>
        min[k] + (0.3 + (0.4 * ((i * stride) % places)) / places) * (max[k] - min[k]);
      const heights = () =>
        [...Array(places).keys()].map((i) => window.terrane.groundZ(at(i, 0, 1), at(i, 1, 19)));
      let [largest, held, last] = [0, 0, undefined];
      for (const pose of flight) {
        window.terrane.setPose(pose);
        window.terrane.redraw();
        held += window.terrane.stats().holdbacks;
        const now = {eye: pose.eye, heights: heights()};
        if (last) {
          const moved = Math.hypot(...now.eye.map((value, k) => value - last.eye[k]));
          now.heights.forEach((height, i) => {
            const change = Math.abs((height ?? 0) - (last.heights[i] ?? 0));
            largest = Math.max(largest, change / moved);
          });
        }
        last = now;
      }
      return {largest, held};
    },
    [poses, bounds, kPlaces],
  );
}

async function lookForPops(page) {
  const bounds = await page.evaluate(() => window.terrane.bounds());
  const steps = Number(options.steps);
  const changes = [0, 0, 0];
  let held = 0;
  for (let piece = 0; piece < Number(options.pieces); ++piece) {
    for (const pose of piecePoses(bounds, piece, 2)) {
      await page.evaluate((next) => window.terrane.setPose(next), pose);
      await ready(page);
    }
    for (const [i, factor] of [1, 2, 4].entries()) {
      const poses = piecePoses(bounds, piece, factor * steps);
      const found = await changePerMetre(page, bounds, poses);
      changes[i] = Math.max(changes[i], found.largest);
      held += found.held;
    }
  }
  check(
    held === 0,
    `${options.pieces} pieces of ${steps}, ${2 * steps} and ${4 * steps} steps, no tile missing`,
  );
  // a jump would double at each halving of the step
  const grows = Math.max(changes[1] / changes[0], changes[2] / changes[1]);
  const text = changes.map((change) => change.toFixed(4)).join(', ');
  check(grows < 1.5, `${text} m of height per metre flown: ${grows.toFixed(2)} times at most`);
}

/** Largest mean difference of consecutive pictures along the flight. */
async function largestPictureStep(page, bounds, steps, isFrozen) {
  await page.evaluate((pose) => window.terrane.setPose(pose), flightPose(bounds, 0.5));
  await ready(page);
  await page.evaluate((on) => window.terrane.setFrozen(on), isFrozen);
  let largest = 0;
  for (let i = 0; i <= steps; ++i) {
    await page.evaluate(
      (pose) => window.terrane.setPose(pose),
      flightPose(bounds, 0.5 + (0.03 * i) / steps),
    );
    await keepPicture(page, String(i % 2));
    if (i > 0) largest = Math.max(largest, (await differenceOf(page, '0', '1')).mean);
  }
  await page.evaluate(() => window.terrane.setFrozen(false));
  return largest;
}

async function comparePictures(page) {
  const bounds = await page.evaluate(() => window.terrane.bounds());
  const steps = Number(options.steps);
  const still = await largestPictureStep(page, bounds, steps, true);
  const blended = await largestPictureStep(page, bounds, steps, false);
  check(
    blended > 0 && blended < 1.25 * still + 0.1,
    `pictures change by ${blended.toFixed(2)} of 255 from frame to frame, ${still.toFixed(2)} with a fixed mesh`,
  );
}

async function run(context) {
  const {page, problems} = await open(context, options.url, options.tolerance);
  await ready(page);
  await flyWithoutWaiting(page);
  await lookForCracks(page);
  await lookForPops(page);
  await comparePictures(page);
  check(problems.console.length === 0, `console errors: ${problems.console.join('; ') || 'none'}`);
}

withBrowser(options.chromium, run)
  .catch((error) => check(false, error.message))
  .finally(() => process.exit(failures() > 0 ? 1 : 0));
