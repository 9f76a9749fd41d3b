import { expect, test } from 'vitest';
import { fit, panBy, pixelAt, zoomAbout } from './zoom';

const picture = [640, 480] as const;
const box = [500, 700] as const;

test('what fits is in the middle, and of a picture of one pixel no wall', () => {
  const zoom = fit(picture, box);
  expect(zoom.x).toBeCloseTo(16);
  expect(zoom.y * 2 + 480 * zoom.scale).toBeCloseTo(700);
  expect(fit([1, 1], [2000, 2000]).scale).toBe(160);
  expect(fit(picture, [0, 0]).scale).toBeGreaterThan(0);
});

test('the pixel under the pointer stays there, in and out', () => {
  let zoom = fit(picture, box);
  const before = pixelAt(zoom, 300, 340, picture);
  for (const factor of [3, 2, 5, 0.4, 1.7]) {
    zoom = zoomAbout(zoom, factor, [300, 340], picture, box);
    expect(pixelAt(zoom, 300, 340, picture)).toEqual(before);
  }
});

test('a picture is never lost beyond the edge', () => {
  let zoom = zoomAbout(fit(picture, box), 4, [10, 10], picture, box);
  for (const by of [1e6, -1e6]) {
    zoom = panBy(zoom, by, by, picture, box);
    expect(pixelAt(zoom, 250 + Math.sign(by), 350 + Math.sign(by), picture)).not.toBe(null);
  }
});

test('beside the picture there is no pixel', () => {
  const zoom = { scale: 2, x: 10, y: 20 };
  expect(pixelAt(zoom, 9.9, 30, picture)).toBe(null);
  expect(pixelAt(zoom, 10, 20, picture)).toEqual([0, 0]);
  expect(pixelAt(zoom, 10 + 1279.9, 20 + 959.9, picture)).toEqual([639, 479]);
  expect(pixelAt(zoom, 10 + 1280, 30, picture)).toBe(null);
});
