// Serves pages, packages and tiles to a browser on this machine; for tests only.
import {readFile, stat} from 'node:fs/promises';
import {createServer} from 'node:http';
import {extname, join, normalize} from 'node:path';

const kTypes = {
  '.html': 'text/html',
  '.js': 'text/javascript',
  '.mjs': 'text/javascript',
  '.css': 'text/css',
  '.json': 'application/json',
  '.wasm': 'application/wasm',
  '.glb': 'model/gltf-binary',
  '.png': 'image/png',
};

/**
 * Serves on 127.0.0.1, at any free port.
 *
 * @param mounts what lies where: {'/tiles/': folder, '/page.html': () => text}; the first that fits
 * @returns {Promise<{url: string, missing: string[], close: () => void}>} missing: asked, not found
 */
export async function servePages(mounts) {
  const missing = [];
  const server = createServer((request, response) => {
    void answer(mounts, normalize(new URL(request.url, 'http://localhost').pathname), response, missing);
  });
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  const close = () => {
    server.close();
    server.closeAllConnections();
  };
  return {url: `http://127.0.0.1:${server.address().port}`, missing, close};
}

async function answer(mounts, path, response, missing) {
  for (const [place, source] of Object.entries(mounts)) {
    if (typeof source === 'function') {
      if (path !== place) continue;
      send(response, path, Buffer.from(source()));
      return;
    }
    if (!path.startsWith(place)) continue;
    const file = join(source, path.slice(place.length));
    if (!(await stat(file).catch(() => undefined))?.isFile()) continue;
    send(response, path, await readFile(file));
    return;
  }
  if (path !== '/favicon.ico') missing.push(path);
  response.writeHead(404).end();
}

function send(response, path, bytes) {
  const headers = {'content-type': kTypes[extname(path)] ?? 'application/octet-stream'};
  // files that lie compressed on disk
  if (bytes[0] === 0x1f && bytes[1] === 0x8b) headers['content-encoding'] = 'gzip';
  response.writeHead(200, headers).end(bytes);
}
