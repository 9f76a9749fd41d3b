import { existsSync, readFileSync } from 'node:fs';
import { expect, test } from 'vitest';

const built = new URL('../dist/snell-viewer.js', import.meta.url);
const committed = new URL('../../crates/snell-formats/assets/snell-viewer.js', import.meta.url);

test('the copy that the command embeds is a fresh build', () => {
  expect(existsSync(committed), 'run `npm run bundle`').toBe(true);
  // Not compared with `toBe`, which would print half a megabyte.
  expect(readFileSync(built).equals(readFileSync(committed)), 'it is not: run `npm run bundle` and commit').toBe(true);
});

test('the build can stand inside of a page', () => {
  const script = readFileSync(built, 'utf8');
  expect(script).not.toMatch(/<\/script/i);
  // A comment that opens like this changes how a page reads the rest of a script.
  expect(script).not.toMatch(/<!--/);
  expect(script).toContain('SPDX-License-Identifier: MIT');
});
