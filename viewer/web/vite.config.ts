import {fileURLToPath} from 'node:url';
import {defineConfig, type Plugin} from 'vite';

const source = (name: string) => fileURLToPath(new URL(`src/${name}`, import.meta.url));

/** The page of trees: a script of its own that uses what viewer.js has, and is loaded after it. */
const treePage: Plugin = {
  name: 'tree-page',
  apply: 'build',
  buildStart() {
    this.emitFile({
      type: 'chunk',
      id: source('tree/tree_page.ts'),
      fileName: 'assets/tree_page.js',
      preserveSignature: 'strict',
      implicitlyLoadedAfterOneOf: [source('main.ts')],
    });
  },
};

// Fixed names, two scripts: the files are embedded into the terrane binary, which must know them
// before they are made. Relative URLs: the page works in any folder of any static host.
export default defineConfig({
  base: './',
  plugins: [treePage],
  build: {
    target: 'es2022',
    modulePreload: false,
    chunkSizeWarningLimit: 900,
    rollupOptions: {
      output: {
        entryFileNames: 'assets/viewer.js',
        assetFileNames: 'assets/viewer[extname]',
      },
    },
  },
});
