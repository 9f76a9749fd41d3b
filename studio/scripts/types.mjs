// Makes src/generated/scene.ts of the JSON Schema of scenes: `npm run types`.

import { mkdir, readFile, writeFile } from 'node:fs/promises';
import { compile } from 'json-schema-to-typescript';

const { title, ...form } = JSON.parse(await readFile(new URL('../../docs/scene.schema.json', import.meta.url), 'utf8'));
const folder = new URL('../src/generated/', import.meta.url);
await mkdir(folder, { recursive: true });
const text = await compile(form, 'SceneDocument', {
  additionalProperties: false,
  bannerComment: `/** ${title}. Made of docs/scene.schema.json by \`npm run types\`: change the types in Rust instead. */`,
  format: true,
  style: { singleQuote: true, printWidth: 120 },
});
await writeFile(new URL('scene.ts', folder), text);
