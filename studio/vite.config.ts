import { fileURLToPath } from 'node:url';
import type { Plugin } from 'vite';
import { defineConfig } from 'vitest/config';

const path = (relative: string) => fileURLToPath(new URL(relative, import.meta.url));

/** The engine is the largest part of the page, and what is shown waits for it: it comes with the first requests. */
const preloadEngine: Plugin = {
  name: 'preload-engine',
  transformIndexHtml: {
    order: 'post',
    handler(_, { bundle }) {
      const module = Object.keys(bundle ?? {}).find((file) => file.endsWith('.wasm'));
      const attrs = { rel: 'preload', as: 'fetch', type: 'application/wasm', crossorigin: '', href: `./${module}` };
      return module === undefined ? [] : [{ tag: 'link', attrs, injectTo: 'head' }];
    },
  },
};

export default defineConfig({
  plugins: [preloadEngine],
  // Relative: the folder may lie below any path of any host.
  base: './',
  publicDir: false,
  resolve: {
    alias: {
      'snell-viewer': path('../viewer/src/index.ts'),
      'snell-wasm': path('../target/studio/snell_wasm.js'),
    },
  },
  esbuild: { jsx: 'automatic', jsxImportSource: 'preact', legalComments: 'eof' },
  worker: { format: 'es' },
  server: { fs: { allow: ['..'] } },
  build: {
    outDir: path('../target/studio-dist'),
    emptyOutDir: true,
    target: 'es2022',
    chunkSizeWarningLimit: 1000, // the 3D view is three.js
    // The module is loaded while the page starts, not as text in it.
    assetsInlineLimit: 0,
  },
  test: { include: ['src/**/*.test.ts', 'test/**/*.test.ts', 'bench/**/*.bench.ts'], testTimeout: 120_000, hookTimeout: 120_000, fileParallelism: false },
});
