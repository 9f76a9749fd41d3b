import { expect, test } from 'vitest';
import { cssColor, displayed, srgbFromLinear } from '../src/color';

test('the curve of sRGB, at values of the standard', () => {
  expect(srgbFromLinear(0)).toBe(0);
  expect(srgbFromLinear(1)).toBeCloseTo(1, 12);
  expect(srgbFromLinear(0.0031308)).toBeCloseTo(0.04045, 5);
  // Half of the light is 188 of 255.
  expect(Math.round(255 * srgbFromLinear(0.5))).toBe(188);
});

test('rises everywhere', () => {
  for (let step = 0; step < 1000; step++) expect(srgbFromLinear((step + 1) / 1000)).toBeGreaterThan(srgbFromLinear(step / 1000));
});

test('pictures without a curve have none here', () => {
  expect(displayed([0.25, 0.5, 1], 'linear')).toEqual([0.25, 0.5, 1]);
  expect(cssColor([0.5, 0.5, 0.5], 'linear')).toBe('rgb(128 128 128)');
  expect(cssColor([0.5, 0.5, 0.5], 'srgb')).toBe('rgb(188 188 188)');
});

test('what is too bright or below black is clipped', () => {
  expect(cssColor([-1, 7, 0], 'srgb')).toBe('rgb(0 255 0)');
});
