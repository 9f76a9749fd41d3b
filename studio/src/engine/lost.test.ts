import { expect, test } from 'vitest';
import { lostLight } from './lost';

const UNITS = 2 ** 32;
const of = (size: [number, number], spp: number, units: number[]) =>
  lostLight(size, spp, (y, rows) => Float64Array.from(units.slice(y * size[0], (y + rows) * size[0])));

test('pixels are sorted by the share of them that is lost', () => {
  const shares = [0, 2 ** -32, 0.00009, 0.0001, 0.0009, 0.001, 0.01, 0.1, 0.9, 1, 2.5, 0];
  const { pixels, bins } = of([4, 3], 1, shares.map((share) => Math.ceil(share * UNITS)));
  expect([...bins]).toEqual([0, 1, 1, 2, 4, 5, 8, 11, 13, 14, 14, 0]);
  expect(pixels).toEqual([2, 2, 1, 0, 1, 1, 0, 0, 1, 0, 0, 1, 0, 1, 2]);
});

test('samples are averaged, and the worst pixel is the first of the worst', () => {
  const units = new Array<number>(3 * 100).fill(0);
  units[3 * 70 + 1] = units[3 * 80] = UNITS / 2;
  const { pixels, bins, worst } = of([3, 100], 8, units);
  expect(worst).toEqual({ pixel: [1, 70], share: 1 / 16 });
  // 6.25 %, of a mean of eight.
  expect(bins[3 * 80]).toBe(10);
  expect([pixels[0], pixels[10]]).toEqual([298, 2]);
});
