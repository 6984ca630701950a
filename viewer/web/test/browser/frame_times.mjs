// Times the frames of the flight over a served tileset: selection, panels, and its picture drawn and waited for.
//
//     node frame_times.mjs --url http://127.0.0.1:8080/ --gpu [--steps 600] [--tolerance 1]
//         [--width 1920] [--height 1080] [--antialias] [--screenshot end.png] [--stops 40]
//         [--json times.json]   milliseconds and triangles of each frame
//
// --gpu lets Chromium use the machine's graphics card, and fails where p99 is above 8 ms; without it
// software renders, and nothing is judged. --antialias smooths edges, as the page does by default.
import {writeFile} from 'node:fs/promises';
import {parseArgs} from 'node:util';
import {check, failures, open, ready, withBrowser} from './browser.mjs';
import {flightPose} from './flight_path.mjs';

const {values: options} = parseArgs({
  options: {
    url: {type: 'string'},
    gpu: {type: 'boolean', default: false},
    steps: {type: 'string', default: '600'},
    tolerance: {type: 'string', default: '1'},
    width: {type: 'string', default: '1920'},
    height: {type: 'string', default: '1080'},
    antialias: {type: 'boolean', default: false},
    screenshot: {type: 'string'},
    json: {type: 'string'},
    // where the flight stops to load what it needs
    stops: {type: 'string', default: '40'},
    chromium: {type: 'string', default: '/usr/bin/chromium'},
  },
});
const kLargestP99Ms = 8;

/** What draws, as the browser says it. */
const rendererOf = (page) =>
  page.evaluate(() => {
    const gl = document.getElementById('terrain').getContext('webgl2');
    const info = gl.getExtension('WEBGL_debug_renderer_info');
    return gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
  });

/**
 * Flies, a pose for each frame that the browser asks for. In milliseconds: what the page's own thread works on a frame,
 * panels included; until its picture is there; and from one frame's begin to the next.
 */
const timeFrames = (page, poses) =>
  page.evaluate(async (flight) => {
    const gl = document.getElementById('terrain').getContext('webgl2');
    const pixel = new Uint8Array(4);
    const waitForPicture = () => gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
    const times = {pageMs: [], wholeMs: [], betweenMs: [], triangles: [], tiles: []};
    let [isTiming, lastMs, onDrawn] = [false, undefined, () => {}];
    const nextFrame = window.requestAnimationFrame;
    window.requestAnimationFrame = (draw) =>
      nextFrame((nowMs) => {
        // what is left of the picture before is not this one's
        waitForPicture();
        const beginMs = performance.now();
        draw(nowMs);
        const pageMs = performance.now() - beginMs;
        waitForPicture();
        if (isTiming) {
          times.pageMs.push(pageMs);
          times.wholeMs.push(performance.now() - beginMs);
          times.betweenMs.push(beginMs - lastMs);
          const {triangles, tiles} = window.terrane.stats();
          times.triangles.push(triangles);
          times.tiles.push(tiles);
        }
        lastMs = beginMs;
        onDrawn();
      });
    for (const [i, pose] of flight.entries()) {
      isTiming = i > 0;
      await new Promise((resolve) => {
        onDrawn = resolve;
        window.terrane.setPose(pose);
      });
    }
    window.requestAnimationFrame = nextFrame;
    return times;
  }, poses);

/** The value that a share of all does not exceed. */
function quantile(values, share) {
  const sorted = [...values].sort((a, b) => a - b);
  return sorted[Math.max(0, Math.ceil(share * sorted.length) - 1)];
}

function describe(times) {
  const [median, p99, most] = [0.5, 0.99, 1].map((share) => quantile(times, share).toFixed(2));
  return `p50 ${median}, p99 ${p99}, most ${most} ms`;
}

async function run(context) {
  const {antialias} = options;
  const {page} = await open(context, options.url, options.tolerance, {antialias});
  await ready(page);
  const bounds = await page.evaluate(() => window.terrane.bounds());
  const stops = Number(options.stops);
  for (let i = 0; i <= stops; ++i) {
    await page.evaluate((pose) => window.terrane.setPose(pose), flightPose(bounds, i / stops));
    await ready(page);
  }
  const steps = Number(options.steps);
  const poses = [...Array(steps + 1).keys()].map((i) => flightPose(bounds, i / steps));
  const frames = await timeFrames(page, poses);
  const {pageMs, wholeMs, betweenMs, triangles, tiles} = frames;
  if (options.json) await writeFile(options.json, JSON.stringify(frames));
  if (options.screenshot) await page.screenshot({path: options.screenshot});

  const size = `${options.width} x ${options.height}${antialias ? ', antialiased' : ''}`;
  console.log(`     ${await rendererOf(page)}`);
  console.log(
    `     ${quantile(triangles, 0.5)} triangles of ${quantile(tiles, 0.5)} tiles (medians), ` +
      `${quantile(triangles, 1)} of ${quantile(tiles, 1)} at most`,
  );
  console.log(`     the page's own thread: ${describe(pageMs)}`);
  console.log(`     from one frame to the next: ${describe(betweenMs)}`);
  check(
    !options.gpu || quantile(wholeMs, 0.99) <= kLargestP99Ms,
    `${steps} steps at ${size}, ${options.tolerance} px: ${describe(wholeMs)}`,
  );
}

const viewport = {width: Number(options.width), height: Number(options.height)};
withBrowser(options.chromium, run, {viewport, gpu: options.gpu})
  .catch((error) => check(false, error.message))
  .finally(() => process.exit(failures() > 0 ? 1 : 0));
