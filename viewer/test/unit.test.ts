/** A drawing is the same whatever its scene is measured in. */

import { expect, test } from 'vitest';
import { creases } from '../src/three/creases';
import { extentOf } from '../src/three/extent';
import { scaledNodes, scaledScene, unitFor } from '../src/three/unit';
import { glass } from './fixture';

const { scene, tree } = glass();
const nodes = tree.samples[0]!.nodes;

test('what is drawn has a size of about 1 and is the same at any scale', () => {
  const drawn = (factor: number) => {
    const [given, rays] = [scaledScene(scene, factor), scaledNodes(nodes, factor)];
    const unit = unitFor(extentOf(given, rays).radius);
    return { scene: scaledScene(given, unit), nodes: scaledNodes(rays, unit) };
  };
  const usual = drawn(1);
  const { radius } = extentOf(usual.scene, usual.nodes);
  expect(radius).toBeGreaterThan(0.7);
  expect(radius).toBeLessThan(1.5);
  // Powers of two, so that no digit is lost on the way.
  for (const factor of [2 ** -50, 2 ** -20, 2 ** 30]) expect(drawn(factor)).toEqual(usual);
});

test('what is near enough to be seen at first does not depend on the unit', () => {
  for (const rays of [nodes, []]) {
    const { radius } = extentOf(scene, rays);
    for (const factor of [2 ** -50, 2 ** 30]) {
      const [small, way] = [scaledScene(scene, factor), scaledNodes(rays, factor)];
      expect(extentOf(small, way).radius).toBe(radius * factor);
    }
  }
});

test('directions are no lengths', () => {
  const sun = { name: 'sun', position: null, direction: [0, 1, 0] as [number, number, number], color: [1, 1, 1] as [number, number, number] };
  const scaled = scaledScene({ ...scene, lights: [sun] }, 8);
  expect(scaled.lights).toEqual([sun]);
  expect(scaled.camera.up).toEqual(scene.camera.up);
  expect(scaledNodes(nodes, 8).map(({ dir }) => dir)).toEqual(nodes.map(({ dir }) => dir));
});

test('a cube has twelve edges, however small, and however fine beside the scene', () => {
  const corner = (n: number) => [n & 1, (n >> 1) & 1, n >> 2];
  const faces = [0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6, 0, 1, 5, 0, 5, 4, 2, 6, 7, 2, 7, 3, 0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5];
  for (const size of [1e-9, 1, 1e9]) {
    const vertices = [0, 1, 2, 3, 4, 5, 6, 7].flatMap((n) => corner(n).map((value) => value * size));
    const found = creases({ name: 'cube', vertices, faces, color: [1, 1, 1], opacity: 1 });
    expect(found.length).toBe(12);
    for (const [from, to] of found) expect(Math.hypot(...from.map((x, axis) => x - to[axis]!)) / size).toBeCloseTo(1, 5);
  }
});
