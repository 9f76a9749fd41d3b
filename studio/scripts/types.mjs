// Makes src/generated/scene.ts of the JSON Schema of scenes, as the viewer makes its types: `npm run types`.

import { mkdir, writeFile } from 'node:fs/promises';
import { generate } from '../../viewer/types.mjs';

/** The text of the file. */
export const sceneTypes = () => generate('scene', 'SceneDocument');

if (import.meta.url === `file://${process.argv[1]}`) {
  const folder = new URL('../src/generated/', import.meta.url);
  await mkdir(folder, { recursive: true });
  await writeFile(new URL('scene.ts', folder), await sceneTypes());
}
