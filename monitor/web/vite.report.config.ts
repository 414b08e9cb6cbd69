import { defineConfig } from 'vite';

// The map alone, as one script without modules: the report of a session has it inside.
export default defineConfig({
  build: {
    target: 'es2022',
    emptyOutDir: false,
    lib: { entry: 'src/plane.ts', name: 'palpPlane', formats: ['iife'], fileName: () => 'plane.js' },
  },
});
