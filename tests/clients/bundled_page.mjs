// A page from one module of this folder and the packages that it imports.
import {fileURLToPath} from 'node:url';
import {build} from 'esbuild';

/** @returns what servePages() needs: the page is at /page.html. */
export async function bundledPage(module) {
  const {outputFiles} = await build({
    entryPoints: [fileURLToPath(new URL(module, import.meta.url))],
    bundle: true, write: false, format: 'esm', logLevel: 'error', define: {'process.env.NODE_ENV': '"production"'},
  });
  return {'/page.html': () => kPage, '/page.js': () => outputFiles[0].text};
}

const kPage = `<!doctype html><meta charset="utf-8">
<style>html, body { margin: 0; height: 100%; background: black; overflow: hidden; }</style>
<body><script type="module" src="/page.js"></script></body>`;
