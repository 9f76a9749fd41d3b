import { expect, test, vi } from 'vitest';
import { missing } from './support';

test('nothing is missing where this is tested', () => expect(missing()).toBe(null));

test('a browser without vectors is told so, and one without WebAssembly too', () => {
  vi.stubGlobal('WebAssembly', { validate: () => false });
  expect(missing()).toMatch('SIMD');
  vi.stubGlobal('WebAssembly', undefined);
  expect(missing()).toMatch('no WebAssembly');
  vi.unstubAllGlobals();
});
