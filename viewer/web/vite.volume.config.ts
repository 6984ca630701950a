import {defineConfig} from 'vite';

// The page that cuts volumes, which `terrane volume` writes into its output folder: fixed names and
// relative URLs, as in vite.config.ts.
export default defineConfig({
  root: 'volume',
  base: './',
  build: {
    target: 'es2022',
    modulePreload: false,
    chunkSizeWarningLimit: 900,
    rollupOptions: {
      output: {
        inlineDynamicImports: true,
        entryFileNames: 'assets/volume.js',
        assetFileNames: 'assets/volume[extname]',
      },
    },
  },
});
