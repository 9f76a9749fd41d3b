import type { ViewScene } from 'snell-viewer';
import { expect, test } from 'vitest';
import type { SceneDocument } from '../generated/scene';
import { objectsOf } from './objects';
import { nearest, shownThings } from './shown';

const camera = { eye: [0, 0, 5], look_at: [0, 0, 0], up: [0, 1, 0] };
const called = (...names: string[]) => names.map((name) => ({ name }));

/** The numbers of what each object is in the drawing. */
function numbers(shapes: object, view: object): Record<string, number[]> {
  const objects = objectsOf({ camera, ...shapes } as unknown as SceneDocument);
  const shown = shownThings(objects, { spheres: [], meshes: [], lights: [], ...view } as unknown as ViewScene);
  return Object.fromEntries([...shown].filter(([key]) => key !== 'camera').map(([key, things]) => [key, things.map(({ index }) => index)]));
}

test('things of the same name are told apart by their order', () => {
  const shapes = { sphere: called('a', 'b', 'a'), light: called('a', 'a') };
  const expected = { 'sphere.1': [0], 'sphere.b': [1], 'sphere.3': [2], 'light.1': [0], 'light.2': [1] };
  expect(numbers(shapes, { spheres: called('a', 'b', 'a'), lights: called('a', 'a') })).toEqual(expected);
});

test('what stands in several places is several things, and meshes of that kind come last', () => {
  const shapes = { mesh: [{ name: 'a', instances: [[], []] }, { name: 'a' }], disc: called('a'), box: [{ name: 'b', instances: [[], [], []] }] };
  const view = { meshes: called('a', 'b', 'b', 'b', 'a', 'a', 'a') };
  expect(numbers(shapes, view)).toEqual({ 'mesh.1': [5, 6], 'mesh.2': [0], 'disc.a': [4], 'box.b': [1, 2, 3] });
});

test('of very many places all are found, though the scene does not tell them', () => {
  expect(numbers({ sphere: called('a') }, { spheres: called('a', 'a', 'a') })).toEqual({ 'sphere.a': [0, 1, 2] });
});

test('the thing is found on which a point lies', () => {
  const spheres = [[0, 5], [0, 2], [9, 1]].map(([x, radius]) => ({ name: 'a', center: [x, 0, 0], radius }));
  const meshes = [0, 7].map((x) => ({ name: 'a', vertices: [x, 0, 0, x + 1, 0, 0, x, 1, 0] }));
  const view = { spheres, meshes } as unknown as ViewScene;
  const at = (kind: 'sphere' | 'mesh', ...point: [number, number, number]) => {
    const things = [0, 1, 2].slice(0, kind === 'sphere' ? 3 : 2).map((index) => ({ kind, index, name: 'a' }));
    return nearest(things, point, view)!.index;
  };
  expect([at('sphere', 0, 5, 0), at('sphere', 0, 0, 2), at('sphere', 10, 0, 0)]).toEqual([0, 1, 2]);
  expect([at('mesh', 0.2, 0.2, 0), at('mesh', 7.2, 0.2, 0)]).toEqual([0, 1]);
});
