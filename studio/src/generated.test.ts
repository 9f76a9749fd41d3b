import { readFileSync } from 'node:fs';
import { expect, test } from 'vitest';
// @ts-expect-error a script without types
import { sceneTypes } from '../scripts/types.mjs';

test('the types of scenes are made of the schema as it is', async () => {
  const committed = readFileSync(new URL('./generated/scene.ts', import.meta.url), 'utf8');
  expect(committed, 'they are not: run `make schemas` and commit').toBe(await sceneTypes());
});
