// Makes the types of what the viewer is given, src/generated/, of the JSON Schemas in ../docs: `npm run types`.

import { mkdir, readFile, writeFile } from 'node:fs/promises';
import { compile } from 'json-schema-to-typescript';

/** Files in src/generated/, with the schema of each and the name of its type. */
export const FILES = [
  ['ray-tree.ts', 'ray-tree', 'RayTreeDocument'],
  ['view.ts', 'view', 'ViewScene'],
];

/** The text of a file. */
export async function generate(schema, name) {
  const file = new URL(`../docs/${schema}.schema.json`, import.meta.url);
  const { title, ...form } = JSON.parse(await readFile(file, 'utf8'));
  return compile(form, name, {
    additionalProperties: false,
    bannerComment: `/** ${title}. Made of docs/${schema}.schema.json by \`npm run types\`: change the types in Rust instead. */`,
    format: true,
    style: { singleQuote: true, printWidth: 120 },
  });
}

if (import.meta.url === `file://${process.argv[1]}`) {
  const folder = new URL('src/generated/', import.meta.url);
  await mkdir(folder, { recursive: true });
  for (const [file, schema, name] of FILES) await writeFile(new URL(file, folder), await generate(schema, name));
}
