import {createReadStream} from 'node:fs';
import {stat} from 'node:fs/promises';
import {createServer} from 'node:http';
import {extname, join, normalize} from 'node:path';

const kTypes = {
  '.html': 'text/html',
  '.js': 'text/javascript',
  '.css': 'text/css',
  '.json': 'application/json',
  '.glb': 'model/gltf-binary',
};

/**
 * Serves folders and ranges of files on 127.0.0.1, at any free port; for tests only.
 *
 * @param folders the first one that has a file answers
 * @returns {Promise<{url: string, close: () => void}>}
 */
export async function serveFolders(folders) {
  const server = createServer((request, response) => void answer(folders, request, response));
  await new Promise((resolve) => server.listen(0, '127.0.0.1', resolve));
  const close = () => {
    server.close();
    server.closeAllConnections();
  };
  return {url: `http://127.0.0.1:${server.address().port}/`, close};
}

async function answer(folders, request, response) {
  const path = normalize(new URL(request.url, 'http://localhost').pathname);
  const name = path.endsWith('/') ? `${path}index.html` : path;
  for (const folder of folders) {
    const file = join(folder, name);
    const found = await stat(file).catch(() => undefined);
    if (!found?.isFile()) continue;
    const headers = {'content-type': kTypes[extname(file)] ?? 'application/octet-stream'};
    const asked = /^bytes=(\d+)-(\d+)$/.exec(request.headers.range ?? '');
    if (!asked) {
      response.writeHead(200, headers);
      createReadStream(file).pipe(response);
      return;
    }
    const [start, end] = [Number(asked[1]), Math.min(Number(asked[2]), found.size - 1)];
    const range = `bytes ${start}-${end}/${found.size}`;
    response.writeHead(206, {...headers, 'content-range': range});
    createReadStream(file, {start, end}).pipe(response);
    return;
  }
  response.writeHead(404).end();
}
