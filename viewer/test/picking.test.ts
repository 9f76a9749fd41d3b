import { PerspectiveCamera } from 'three';
import { expect, test } from 'vitest';
import { pick } from '../src/three/picking';

// Looks along −z from the origin; 100 × 100 pixels, 90°.
const { projectionMatrix } = new PerspectiveCamera(90, 1, 0.1, 100);
const at = (x: number, y: number, ...lines: [number, number, number][][]) =>
  pick(lines.map(([from, to], id) => ({ id, from: from!, to: to!, open: false })), x, y, projectionMatrix, 100, 100);

test('finds the nearest line, none when all are far', () => {
  const left: [number, number, number][] = [[-0.5, -1, -1], [-0.5, 1, -1]];
  const right: [number, number, number][] = [[0.5, -1, -1], [0.5, 1, -1]];
  expect(at(27, 50, left, right)).toBe(0);
  expect(at(70, 10, left, right)).toBe(1);
  expect(at(50, 50, left, right)).toBeNull();
});

test('lines end', () => {
  expect(at(75, 50, [[-0.5, 0, -1], [0, 0, -1]])).toBeNull();
});

test('lines that come from behind the eye are cut', () => {
  expect(at(50, 60, [[0, -1, 5], [0, -1, -50]])).toBe(0);
  expect(at(50, 50, [[0, 0, 5], [0, 1, 3]])).toBeNull();
});
