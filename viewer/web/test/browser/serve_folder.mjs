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
 * Serves folders on 127.0.0.1, at any free port; for tests only.
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
    response.writeHead(200, {'content-type': kTypes[extname(file)] ?? 'application/octet-stream'});
    createReadStream(file).pipe(response);
    return;
  }
  response.writeHead(404).end();
}
