/** The studio for notebooks, in target/studio-notebook: the page as one script, one style and the module, and the widget around it. */

import { defineConfig, mergeConfig } from 'vite';
import studio from './vite.config';

export default defineConfig(({ mode }) => {
  const isWidget = mode === 'widget';
  return mergeConfig(
    { ...studio, plugins: [] },
    {
      build: {
        outDir: '../target/studio-notebook',
        emptyOutDir: !isWidget,
        // Nothing can be loaded beside the page.
        assetsInlineLimit: () => true,
        cssCodeSplit: false,
        modulePreload: false,
        chunkSizeWarningLimit: 4000,
        rollupOptions: {
          input: isWidget ? 'src/notebook/widget.ts' : 'src/notebook/page.tsx',
          preserveEntrySignatures: 'strict' as const,
          output: {
            format: 'es' as const,
            inlineDynamicImports: true,
            entryFileNames: isWidget ? 'widget.js' : 'studio.js',
            assetFileNames: 'studio[extname]',
          },
        },
      },
    },
  );
});
