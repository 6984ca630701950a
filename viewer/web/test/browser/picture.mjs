// What the canvas shows. A magenta backdrop instead of the sky makes cracks visible.
const kMagenta = 0xff00ff;

/**
 * Share of the canvas that terrain covers, its different colours, and the pixels of backdrop that
 * terrain surrounds: `enclosed`, all of them, those of holes in the data too; `cracks`, the places
 * (x, y from the upper left) of those of patches that are nowhere three pixels wide and high.
 */
export function readPicture(page) {
  return page.evaluate((magenta) => {
    const canvas = document.getElementById('terrain');
    const {width, height} = canvas;
    const copy = new OffscreenCanvas(width, height).getContext('2d');
    window.terrane.setBackdrop(magenta);
    window.terrane.redraw();
    copy.drawImage(canvas, 0, 0);
    window.terrane.setBackdrop(null);
    const pixels = new Uint32Array(copy.getImageData(0, 0, width, height).data.buffer);
    const isBackdrop = (i) => pixels[i] === 0xffff00ff;
    const colors = new Set();
    let backdrop = 0;
    for (let i = 0; i < pixels.length; ++i) {
      if (isBackdrop(i)) ++backdrop;
      else colors.add(pixels[i]);
    }

    // walks through connected backdrop; gives its pixels
    const reached = new Uint8Array(pixels.length);
    const walk = (starts) => {
      const open = [];
      const visit = (i) => {
        if (reached[i] || !isBackdrop(i)) return;
        reached[i] = 1;
        open.push(i);
      };
      starts.forEach(visit);
      for (let next = 0; next < open.length; ++next) {
        const [x, y] = [open[next] % width, Math.floor(open[next] / width)];
        // diagonals too: the sky between two jags of a far ridge is sky
        for (const dy of [-1, 0, 1]) {
          for (const dx of [-1, 0, 1]) {
            const isOutside = x + dx < 0 || x + dx >= width || y + dy < 0 || y + dy >= height;
            if (!isOutside) visit((y + dy) * width + x + dx);
          }
        }
      }
      return open;
    };
    const rim = [];
    for (let x = 0; x < width; ++x) rim.push(x, (height - 1) * width + x);
    for (let y = 0; y < height; ++y) rim.push(y * width, y * width + width - 1);
    walk(rim);

    // what is left is inside: no such pixel lies on the rim of the picture
    const isWide = (i) =>
      [-1, 0, 1].every((dy) => [-1, 0, 1].every((dx) => isBackdrop(i + dy * width + dx)));
    let enclosed = 0;
    const cracks = [];
    for (let i = 0; i < pixels.length; ++i) {
      if (reached[i] || !isBackdrop(i)) continue;
      const patch = walk([i]);
      enclosed += patch.length;
      if (patch.some(isWide)) continue;
      cracks.push(...patch.map((at) => [at % width, Math.floor(at / width)]));
    }
    return {drawn: 1 - backdrop / pixels.length, colors: colors.size, enclosed, cracks};
  }, kMagenta);
}

/** Columns that lookAgain() adds at either side. */
const kMoreColumns = 64;

/**
 * The cracks that stay when more of the world is in the picture at its sides. SwiftShader tells the
 * two sides of a triangle apart by its corners as they are rounded before it is cut off at the rim of the
 * picture, and fills it by those after: a sliver that reaches over the rim can be left out.
 */
export async function lookAgain(page, cracks) {
  if (cracks.length === 0) return cracks;
  const size = page.viewportSize();
  await page.setViewportSize({...size, width: size.width + 2 * kMoreColumns});
  await page.waitForFunction(
    (width) => document.getElementById('terrain').width === width,
    size.width + 2 * kMoreColumns,
  );
  await page.evaluate(() => window.terrane.ready());
  const again = await readPicture(page);
  await page.setViewportSize(size);
  await page.waitForFunction(
    (width) => document.getElementById('terrain').width === width,
    size.width,
  );
  const found = new Set(again.cracks.map(([x, y]) => `${x - kMoreColumns},${y}`));
  return cracks.filter((place) => found.has(String(place)));
}

/** The canvas as it is, for differenceTo(). Kept in the page under a name. */
export function keepPicture(page, name) {
  return page.evaluate((key) => {
    const canvas = document.getElementById('terrain');
    const copy = new OffscreenCanvas(canvas.width, canvas.height).getContext('2d');
    window.terrane.redraw();
    copy.drawImage(canvas, 0, 0);
    window.kept ??= {};
    window.kept[key] = copy.getImageData(0, 0, canvas.width, canvas.height).data;
  }, name);
}

/** All bytes of the canvas, as it is now. */
export async function readPixels(page) {
  await keepPicture(page, 'pixels');
  const base64 = await page.evaluate(async () => {
    const url = await new Promise((resolve) => {
      const reader = new FileReader();
      reader.onload = () => resolve(reader.result);
      reader.readAsDataURL(new Blob([window.kept.pixels]));
    });
    return url.split(',')[1];
  });
  return Buffer.from(base64, 'base64');
}

/** Mean and largest difference of two kept pictures, in steps of 255. */
export function differenceOf(page, a, b) {
  return page.evaluate(
    ([first, second]) => {
      const [p, q] = [window.kept[first], window.kept[second]];
      let [sum, largest] = [0, 0];
      for (let i = 0; i < p.length; ++i) {
        const difference = Math.abs(p[i] - q[i]);
        sum += difference;
        largest = Math.max(largest, difference);
      }
      return {mean: sum / p.length, largest};
    },
    [a, b],
  );
}
