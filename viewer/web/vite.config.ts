import {defineConfig} from 'vite';

// Fixed names, one script: the files are embedded into the terrane binary, which must know them
// before they are made. Relative URLs: the page works in any folder of any static host.
export default defineConfig({
  base: './',
  build: {
    target: 'es2022',
    modulePreload: false,
    chunkSizeWarningLimit: 900,
    rollupOptions: {
      output: {
        inlineDynamicImports: true,
        entryFileNames: 'assets/viewer.js',
        assetFileNames: 'assets/viewer[extname]',
      },
    },
  },
});
