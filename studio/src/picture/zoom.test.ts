import { expect, test } from 'vitest';
import { actualSize, fit, keyPlacement, pan, pinch, pixelAt, type Placement, placeOf, type Point, resized, showPixel, type Size, wheelFactor, zoomAt } from './zoom';

const PICTURE: Size = [512, 384];
const FRAME: Size = [800, 500];
const fitted = fit(PICTURE, FRAME);

/** The point of the picture at a point of the frame. */
const under = ({ scale, origin }: Placement, point: Point) => [(point[0] - origin[0]) / scale, (point[1] - origin[1]) / scale];
const close = (some: number[], others: number[]) => some.forEach((value, index) => expect(value).toBeCloseTo(others[index]!, 9));

test('a fitted picture is seen whole, and in the middle', () => {
  for (const picture of [PICTURE, [4000, 100], [100, 4000], [16, 16], [1, 1]] as Size[]) {
    const { scale, origin } = fit(picture, FRAME);
    for (const axis of [0, 1] as const) {
      expect(origin[axis]).toBeGreaterThanOrEqual(-1e-9);
      expect(2 * origin[axis] + scale * picture[axis]).toBeCloseTo(FRAME[axis], 9);
    }
  }
  expect(fitted.scale).toBeCloseTo(500 / 384, 9);
  expect(fit([16, 16], FRAME).scale).toBe(31);
  expect(fit([1, 1], FRAME).scale).toBe(64);
});

test('what is under the pointer stays there', () => {
  const point: Point = [300, 200];
  let placement = fitted;
  for (const factor of [1.5, 2, 3, 1 / 2, 1.1]) {
    const before = under(placement, point);
    placement = zoomAt(placement, point, factor, PICTURE, FRAME);
    close(under(placement, point), before);
  }
});

test('enlarging ends at 64, and making smaller at the whole picture', () => {
  expect(zoomAt(fitted, [0, 0], 1e9, PICTURE, FRAME).scale).toBe(64);
  const far = zoomAt(zoomAt(fitted, [700, 400], 5, PICTURE, FRAME), [10, 10], 1e-9, PICTURE, FRAME);
  expect(far.scale).toBe(0.25);
  const large: Size = [8000, 6000];
  const whole = zoomAt(zoomAt(fit(large, FRAME), [700, 400], 5, large, FRAME), [10, 10], 1e-9, large, FRAME);
  expect(whole.scale).toBeCloseTo(fit(large, FRAME).scale, 9);
  expect(whole.origin[1]).toBeCloseTo(0, 9);
});

test('a picture cannot be lost beside its frame', () => {
  for (const scale of [1, 3, 20]) {
    for (const way of [[1e6, 1e6], [-1e6, -1e6], [1e6, -1e6]] as Point[]) {
      const { origin } = pan({ scale, origin: [0, 0] }, way, PICTURE, FRAME);
      for (const axis of [0, 1] as const) {
        const length = scale * PICTURE[axis];
        const covered = Math.min(FRAME[axis], origin[axis] + length) - Math.max(0, origin[axis]);
        expect(covered).toBeGreaterThanOrEqual(Math.min(length, FRAME[axis] / 2) - 1e-6);
      }
    }
  }
});

test('two fingers keep what is under them', () => {
  const before: [Point, Point] = [[300, 200], [400, 260]];
  const after: [Point, Point] = [[280, 230], [480, 350]];
  const moved = pinch(fitted, before, after, PICTURE, FRAME);
  expect(moved.scale).toBeCloseTo(2 * fitted.scale, 9);
  for (const finger of [0, 1] as const) close(under(moved, after[finger]), under(fitted, before[finger]));
  expect(pinch(fitted, [[1, 1], [1, 1]], after, PICTURE, FRAME).scale).toBe(fitted.scale);
});

test('a turn of the wheel is undone by the turn back, and no turn is wild', () => {
  const wheel = (deltaY: number, deltaMode = 0, ctrlKey = false) => wheelFactor({ deltaY, deltaMode, ctrlKey });
  expect(wheel(-100)).toBeGreaterThan(1);
  expect(wheel(100) * wheel(-100)).toBeCloseTo(1, 12);
  expect(wheel(-3, 1)).toBeCloseTo(wheel(-48), 12);
  expect(wheel(-1e9)).toBe(2);
  expect(wheel(1e9)).toBe(0.5);
  expect(wheel(-10, 0, true)).toBeGreaterThan(wheel(-10));
});

test('pixels and their places', () => {
  const placement = { scale: 8, origin: [10, 20] as Point };
  expect(pixelAt(placement, [10, 20], PICTURE)).toEqual([0, 0]);
  expect(pixelAt(placement, [17.99, 28], PICTURE)).toEqual([0, 1]);
  expect(pixelAt(placement, [9.99, 20], PICTURE)).toBeNull();
  expect(pixelAt(placement, [10 + 8 * 512, 20], PICTURE)).toBeNull();
  expect(pixelAt(placement, [10 + 8 * 512 - 0.01, 20], PICTURE)).toEqual([511, 0]);
  expect(placeOf(placement, [3, 4])).toEqual({ x: 34, y: 52, side: 8 });
});

test('actual size is that of the screen, also on one of high density', () => {
  expect(actualSize(fitted, PICTURE, FRAME).scale).toBe(1);
  expect(actualSize(fitted, PICTURE, FRAME, 2).scale).toBe(0.5);
  const large: Size = [4000, 3000];
  close(under(actualSize(fit(large, FRAME), large, FRAME), [400, 250]), [2000, 1500]);
});

test('keys', () => {
  const near = zoomAt(fitted, [400, 250], 8, PICTURE, FRAME);
  expect(keyPlacement('+', near, PICTURE, FRAME)!.scale).toBeCloseTo(1.25 * near.scale, 9);
  expect(keyPlacement('-', near, PICTURE, FRAME)!.scale).toBeCloseTo(near.scale / 1.25, 9);
  expect(keyPlacement('0', near, PICTURE, FRAME)).toEqual(fitted);
  expect(keyPlacement('1', near, PICTURE, FRAME)!.scale).toBe(1);
  // What is to the right comes into sight.
  expect(under(keyPlacement('ArrowRight', near, PICTURE, FRAME)!, [0, 0])[0]).toBeGreaterThan(under(near, [0, 0])[0]!);
  expect(under(keyPlacement('ArrowUp', near, PICTURE, FRAME)!, [0, 0])[1]).toBeLessThan(under(near, [0, 0])[1]!);
  expect(keyPlacement('x', near, PICTURE, FRAME)).toBeNull();
});

test('a pixel that is asked for comes into sight, one that is seen does not move', () => {
  const near = zoomAt(fitted, [400, 250], 16, PICTURE, FRAME);
  for (const pixel of [[0, 0], [511, 383], [0, 383], [256, 0]] as Point[]) {
    const { x, y, side } = placeOf(showPixel(near, pixel, PICTURE, FRAME), pixel);
    expect(x >= 0 && y >= 0 && x + side <= FRAME[0] && y + side <= FRAME[1]).toBe(true);
  }
  const seen = pixelAt(near, [400, 250], PICTURE)!;
  expect(showPixel(near, seen, PICTURE, FRAME)).toEqual(near);
});

test('another size of the frame keeps the middle, or the whole picture', () => {
  const other: Size = [600, 700];
  expect(resized(fitted, PICTURE, FRAME, other)).toEqual(fit(PICTURE, other));
  const near = zoomAt(fitted, [500, 300], 8, PICTURE, FRAME);
  close(under(resized(near, PICTURE, FRAME, other), [300, 350]), under(near, [400, 250]));
});
