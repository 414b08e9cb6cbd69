import { defineConfig } from 'vite';

// Fixed names: the program serves these files, and the same sources give the same bytes.
export default defineConfig({
  build: {
    target: 'es2022',
    assetsInlineLimit: 0,
    modulePreload: { polyfill: false },
    cssCodeSplit: false,
    rolldownOptions: {
      output: {
        entryFileNames: 'page.js',
        chunkFileNames: 'page-[name].js',
        assetFileNames: 'style.[ext]',
      },
    },
  },
});
