import { expect, test } from 'vitest';
import type { SceneDocument } from '../generated/scene';
import { editsFor } from './movement';
import { numberText, objectsOf, quoted, roundTo, snapOf } from './objects';

const scene = {
  snell: 1,
  render: { integrator: 'whitted', size: [10, 10] },
  camera: { eye: [0, 0, 5], look_at: [0, 0, 0], up: [0, 1, 0], fov: 40 },
  light: [{ position: [1, 2, 3], color: 1 }, { name: 'sun', direction: [0, 1, 0], color: 1 }],
  sphere: [{ center: [0.1, 0.2, 0.3], radius: 2, material: 'm' }, { name: 'a "b"', center: [0, 0, 0], radius: 1, material: 'm', transform: [{ move: [1, 0, 0] }] }],
  box: [{ min: [0, 0, 0], max: [2, 2, 2], material: 'm' }],
  mesh: [{ file: 'm.obj', material: 'm' }],
} as unknown as SceneDocument;
const objects = objectsOf(scene);
const named = (name: string) => objects.find((object) => object.name === name)!;

test('things without a name go by their file, or by their kind and number, as the engine calls them', () => {
  expect(objects.map(({ name, key }) => `${name} ${key}`)).toEqual([
    'sphere 1 sphere.1', 'a "b" sphere."a \\"b\\""', 'm.obj mesh.1', 'box 1 box.1', 'light 1 light.1', 'sun light.sun', 'camera camera',
  ]);
});

test('something that is called like the number of another is not mistaken for it', () => {
  expect(keysAndTitles('2', 'x', undefined)).toEqual(['sphere.2 2', 'sphere.x x', 'sphere.3 sphere 3']);
  expect(keysAndTitles('2', undefined, '02')).toEqual(['sphere.2 2', 'sphere.002 sphere 2', 'sphere.02 02']);
});

test('things of the same name have keys and titles of their own', () => {
  expect(keysAndTitles('x', 'y', 'x')).toEqual(['sphere.1 x', 'sphere.y y', 'sphere.3 x (2)']);
  expect(keysAndTitles('sphere 2', undefined)).toEqual(['sphere."sphere 2" sphere 2', 'sphere.2 sphere 2 (2)']);
});

function keysAndTitles(...names: (string | undefined)[]): string[] {
  const spheres = names.map((name) => ({ ...scene.sphere![0]!, name }));
  const objects = objectsOf({ ...scene, sphere: spheres } as unknown as SceneDocument);
  return objects.slice(0, names.length).map(({ key, title }) => `${key} ${title}`);
}

test('a move has no noise in its digits', () => {
  expect(editsFor(named('sphere 1'), { kind: 'move', by: [0.2, 0, 0] }, [0.1, 0.2, 0.3])).toEqual([['sphere.1.center', '[0.3, 0.2, 0.3]']]);
});

// The edits of a drag replace each other: were there none at its start, the last but one would stay.
test('a drag that ends where it began leaves everything as it was', () => {
  const before = [['sphere."a \\"b\\"".transform', '[{ move = [1, 0, 0] }]']];
  expect(editsFor(named('sphere 1'), { kind: 'move', by: [0, 0, 0] }, [0.1, 0.2, 0.3])).toEqual([['sphere.1.center', '[0.1, 0.2, 0.3]']]);
  expect(editsFor(named('sphere 1'), { kind: 'scale', by: 1 }, [0.1, 0.2, 0.3])).toEqual([['sphere.1.radius', '2']]);
  expect(editsFor(named('a "b"'), { kind: 'move', by: [0, 0, 0] }, [1, 0, 0])).toEqual(before);
  expect(editsFor(named('a "b"'), { kind: 'turn', axis: [1, 0, 0], degrees: 0 }, [0, 0, 0])).toEqual(before);
  expect(editsFor(named('a "b"'), { kind: 'scale', by: [1, 1, 1] }, [0, 0, 0])).toEqual(before);
});

test('what has been placed by steps is moved by its last one', () => {
  expect(editsFor(named('a "b"'), { kind: 'move', by: [0, 2, 0] }, [1, 0, 0])).toEqual([['sphere."a \\"b\\"".transform', '[{ move = [1, 2, 0] }]']]);
  expect(editsFor(named('a "b"'), { kind: 'move', by: [-1, 0, 0] }, [1, 0, 0])).toEqual([['sphere."a \\"b\\"".transform', '[]']]);
});

test('turning about the middle, twice, stays three steps', () => {
  const turned = editsFor(named('m.obj'), { kind: 'turn', axis: [0, 1, 0], degrees: 15 }, [1, 2, 3]);
  expect(turned).toEqual([['mesh.1.transform', '[{ move = [-1, -2, -3] }, { rotate = { axis = [0, 1, 0], degrees = 15 } }, { move = [1, 2, 3] }]']]);
  const mesh = {
    ...named('m.obj'),
    data: { file: 'm.obj', transform: [{ move: [-1, -2, -3] }, { rotate: { axis: [0, 1, 0], degrees: 15 } }, { move: [1, 2, 3] }] },
  } as ReturnType<typeof named>;
  expect(editsFor(mesh, { kind: 'turn', axis: [0, 1, 0], degrees: 10 }, [1, 2, 3])[0]![1]).toMatch('degrees = 25');
});

test('a box grows about its middle, a sphere by its radius', () => {
  expect(editsFor(named('box 1'), { kind: 'scale', by: 2 }, [1, 1, 1])).toEqual([['box.1.min', '[-1, -1, -1]'], ['box.1.max', '[3, 3, 3]']]);
  expect(editsFor(named('sphere 1'), { kind: 'scale', by: 1.5 }, [0, 0, 0])).toEqual([['sphere.1.radius', '3']]);
});

test('a light at infinity and the camera cannot be scaled, and the light cannot be moved', () => {
  expect(editsFor(named('sun'), { kind: 'move', by: [1, 0, 0] }, [0, 0, 0])).toEqual([]);
  expect(editsFor(named('camera'), { kind: 'scale', by: 2 }, [0, 0, 0])).toEqual([]);
});

test('numbers are those of the scene, in any unit', () => {
  expect([numberText(0.1 + 0.2), numberText(1e8 + 0.5), numberText(-3e-9), numberText(1e21)]).toEqual(['0.3', '100000000.5', '-3e-9', '1e+21']);
  expect([roundTo(1.23456789, 9), roundTo(1.23456789e-9, 9e-9), roundTo(5, 0)]).toEqual([1.235, 1.235e-9, 5]);
});

test('the step that things snap to is as large as the scene asks for', () => {
  const of = (unit: number) => snapOf({ ...scene, camera: { ...scene.camera, eye: [0, 0, 90 * unit] } });
  expect([of(1), of(1e9)]).toEqual([1, 1e9]);
  // A power of ten below one has no exact form.
  expect(of(1e-9)).toBeCloseTo(1e-9, 20);
});

test('names are quoted where TOML wants it', () => {
  expect([quoted('glass'), quoted('N-BK7'), quoted('a.b'), quoted('x"]')]).toEqual(['glass', 'N-BK7', '"a.b"', '"x\\"]"']);
});
