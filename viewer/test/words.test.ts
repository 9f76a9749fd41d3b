import { expect, test } from 'vitest';
import { decimal, degrees, percent, rayTitle } from '../src/words';
import { glass, ray } from './fixture';

test('numbers are short', () => {
  expect([0, 1, 0.1, 1 / 3, -2, 12345.678, 0.000123456].map(decimal)).toEqual(['0', '1', '0.1', '0.3333', '−2', '12345.7', '0.0001235']);
  expect([1.5e-7, -2e12].map((value) => decimal(value).replace(/\s/g, ' '))).toEqual(['1.5 × 10⁻⁷', '−2 × 10¹²']);
  expect(degrees(41.8103)).toBe('41.81°');
});

test('percentages never round to nothing', () => {
  expect([0, 0.0001, 0.0123, 0.5, 1].map(percent)).toEqual(['0%', '< 0.1%', '1.2%', '50%', '100%']);
});

test('rays say what they are and where they end', () => {
  const { hit } = glass().tree.samples[0]!.nodes[0]!;
  expect(rayTitle(ray({ kind: 'mirror' }))).toBe('Mirror ray leaves the scene');
  expect(rayTitle(ray({ kind: 'inside', medium: 'BK7', hit, ended: null, band_nm: 550 }))).toBe('Ray inside BK7 of 550 nm hits glass');
  expect(rayTitle(ray({ kind: 'refracted', ended: 'depth' }))).toBe('Refracted ray is not followed');
});
