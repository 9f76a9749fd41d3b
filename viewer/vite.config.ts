import { defineConfig } from 'vitest/config';

export default defineConfig({
  build: {
    lib: {
      entry: 'src/index.ts',
      name: 'SnellViewer',
      formats: ['iife', 'es'],
      fileName: (format) => (format === 'iife' ? 'snell-viewer.js' : 'snell-viewer.mjs'),
    },
    target: 'es2022',
  },
  // The licence of three.js asks that its notice stays in every copy.
  esbuild: { legalComments: 'inline' },
  test: {
    include: ['test/**/*.test.ts'],
    testTimeout: 120_000,
    hookTimeout: 120_000,
  },
});
