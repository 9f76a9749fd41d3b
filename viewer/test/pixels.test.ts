import { expect, test } from 'vitest';
import { middleOf, nextPixel } from '../src/pixels';

test('arrows go to the next pixel, and stop at the edges', () => {
  expect(nextPixel('ArrowRight', [3, 2], [8, 6])).toEqual([4, 2]);
  expect(nextPixel('ArrowUp', [3, 2], [8, 6])).toEqual([3, 1]);
  expect(nextPixel('ArrowLeft', [0, 2], [8, 6])).toEqual([0, 2]);
  expect(nextPixel('ArrowDown', [7, 5], [8, 6])).toEqual([7, 5]);
});

test('the first one is in the middle', () => {
  expect(nextPixel('ArrowDown', null, [8, 5])).toEqual([4, 2]);
  expect(nextPixel('ArrowDown', null, [1, 1])).toEqual([0, 0]);
});

test('other keys do nothing', () => {
  expect(nextPixel('Enter', [3, 2], [8, 6])).toBeNull();
});

test('the middle of a pixel is half a pixel from its corner', () => {
  expect(middleOf([0, 5], [8, 6])).toEqual([1 / 16, 11 / 12]);
});
