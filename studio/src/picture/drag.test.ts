import type { ViewCamera } from 'snell-viewer';
import { expect, test } from 'vitest';
import { dragged, project } from './drag';

/** The lecture's: the image plane at z = 95, the eye at z = 100, 4 units wide. */
const camera: ViewCamera = {
  eye: [50, 50, 100],
  up: [0, 1, 0],
  corners: [[48, 48, 95], [52, 48, 95], [48, 52, 95], [52, 52, 95]],
};

test('a point on the axis is in the middle, and what is behind the eye is nowhere', () => {
  expect(project(camera, [512, 256], [50, 50, 20])).toEqual([256, 128]);
  expect(project(camera, [512, 256], [50, 50, 120])).toBe(null);
});

test('what is dragged stays under the pointer', () => {
  // A skewed camera: nothing of it is along an axis.
  const skewed: ViewCamera = { eye: [3, -2, 7], up: [0, 1, 0], corners: [[1, 0, 1], [2, 0, 1.5], [1, 2, 1], [2, 2, 1.5]] };
  const sizes = [[400, 300], [7, 1000]] as const;
  for (const camera of [skewed])
    for (const size of sizes) {
      const center: [number, number, number] = [0.5, 1, -4];
      const from = project(camera, size, center)!;
      const by = dragged(camera, size, center, 31, -12);
      const to = project(camera, size, [center[0] + by[0], center[1] + by[1], center[2] + by[2]])!;
      // Rounding of a few sums and products.
      expect(to[0] - from[0]).toBeCloseTo(31, 9);
      expect(to[1] - from[1]).toBeCloseTo(-12, 9);
    }
});

test('the distance to the image plane stays, also far away from the origin', () => {
  const far = (point: number[]) => point.map((value) => value + 1e8) as [number, number, number];
  const moved: ViewCamera = { ...camera, eye: far(camera.eye), corners: camera.corners.map(far) as ViewCamera['corners'] };
  const by = dragged(moved, [512, 512], far([50, 50, 50]), 10, 10);
  expect(by[2]).toBe(0);
  // 10 of 512 pixels on 4 units, ten times as far away as the plane.
  expect(by[0]).toBeCloseTo((10 * 4 * 10) / 512, 6);
});
