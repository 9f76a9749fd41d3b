import { readFileSync } from 'node:fs';
import { expect, test } from 'vitest';
// @ts-expect-error a script without types
import { FILES, generate } from '../types.mjs';

test.each(FILES as [string, string, string][])('src/generated/%s is made of the schema as it is', async (file, schema, name) => {
  const committed = readFileSync(new URL(`../src/generated/${file}`, import.meta.url), 'utf8');
  expect(committed, 'it is not: run `make schemas` and commit').toBe(await generate(schema, name));
});
