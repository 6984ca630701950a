// Times the frames of the flight over a served tileset: its picture drawn and waited for.
//
//     node frame_times.mjs --url http://127.0.0.1:8080/ --gpu [--steps 600] [--tolerance 1]
//         [--width 1920] [--height 1080]
//
// --gpu lets Chromium use the machine's graphics card, and fails where p99 is above 8 ms; without it
// software renders, and nothing is judged.
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
    chromium: {type: 'string', default: '/usr/bin/chromium'},
  },
});
const kLargestP99Ms = 8;
/** Where the flight stops to load what it needs. */
const kStops = 40;

/** What draws, as the browser says it. */
const rendererOf = (page) =>
  page.evaluate(() => {
    const gl = document.getElementById('terrain').getContext('webgl2');
    const info = gl.getExtension('WEBGL_debug_renderer_info');
    return gl.getParameter(info ? info.UNMASKED_RENDERER_WEBGL : gl.RENDERER);
  });

/** Milliseconds of each frame: selection, drawing, and the card's own work. */
const timeFrames = (page, poses) =>
  page.evaluate(async (flight) => {
    const gl = document.getElementById('terrain').getContext('webgl2');
    const pixel = new Uint8Array(4);
    const times = [];
    let triangles = 0;
    for (const pose of flight) {
      window.terrane.setPose(pose);
      const beginMs = performance.now();
      window.terrane.redraw();
      // waits until the picture is there
      gl.readPixels(0, 0, 1, 1, gl.RGBA, gl.UNSIGNED_BYTE, pixel);
      times.push(performance.now() - beginMs);
      triangles = Math.max(triangles, window.terrane.stats().triangles);
      // tiles come in between, as they do in a browser that draws at its own pace
      await new Promise((resolve) => setTimeout(resolve, 0));
    }
    return {times, triangles};
  }, poses);

async function run(context) {
  const {page} = await open(context, options.url, options.tolerance);
  await ready(page);
  const bounds = await page.evaluate(() => window.terrane.bounds());
  for (let i = 0; i <= kStops; ++i) {
    await page.evaluate((pose) => window.terrane.setPose(pose), flightPose(bounds, i / kStops));
    await ready(page);
  }
  const steps = Number(options.steps);
  const poses = [...Array(steps + 1).keys()].map((i) => flightPose(bounds, i / steps));
  const {times, triangles} = await timeFrames(page, poses);
  const sorted = times.sort((a, b) => a - b);
  const at = (share) => sorted[Math.ceil(share * sorted.length) - 1];
  const [median, p99] = [at(0.5), at(0.99)];
  const text =
    `${steps} steps at ${options.width} x ${options.height}, ${options.tolerance} px: p50 ${median.toFixed(2)}, ` +
    `p99 ${p99.toFixed(2)}, most ${at(1).toFixed(2)} ms; ${triangles} triangles at most; ${await rendererOf(page)}`;
  check(!options.gpu || p99 <= kLargestP99Ms, text);
}

const viewport = {width: Number(options.width), height: Number(options.height)};
withBrowser(options.chromium, run, {viewport, gpu: options.gpu})
  .catch((error) => check(false, error.message))
  .finally(() => process.exit(failures() > 0 ? 1 : 0));
