import { describe, expect, test } from 'vitest';
import { validate, ViewerDataError } from '../src/validate';
import { glass } from './fixture';

/** The message for the fixture with one thing changed; `at` is a path such as `tree.samples.0.nodes`. */
function complaint(at: string, value: unknown): string {
  const data = glass();
  const keys = at.split('.');
  const last = keys.pop()!;
  const owner = keys.reduce<unknown>((object, key) => (object as Record<string, unknown>)[key], data);
  (owner as Record<string, unknown>)[last] = value;
  try {
    validate(data);
  } catch (error) {
    expect(error).toBeInstanceOf(ViewerDataError);
    return (error as Error).message;
  }
  throw new Error(`${at} = ${JSON.stringify(value)} was accepted`);
}

describe('validation', () => {
  test('accepts the fixture', () => {
    expect(() => validate(glass())).not.toThrow();
  });

  test('accepts a scene without a tree', () => {
    const { scene } = glass();
    for (const data of [{ scene }, { scene, tree: null, picture: new Uint8Array(4), title: 'glass' }]) expect(() => validate(data)).not.toThrow();
  });

  test('names a wrong version, and what to do', () => {
    expect(complaint('tree.snell_ray_tree', 2)).toBe(
      'tree.snell_ray_tree: expected version 1 (take the viewer that comes with the snell that wrote this), found 2',
    );
    expect(complaint('scene.snell_view', undefined)).toContain('found nothing');
  });

  test.each([
    ['tree.samples.0.nodes.2.id', 7, 'tree.samples[0].nodes[2].id: expected 2, its place in the list, found 7'],
    ['tree.samples.0.nodes.2.parent', 2, 'tree.samples[0].nodes[2].parent: expected a whole number from 0 to 1, found 2'],
    ['tree.samples.0.nodes.1.kind', 'shadow', 'tree.samples[0].nodes[1].kind: expected one of camera, mirror, refracted, inside, found "shadow"'],
    ['tree.samples.0.nodes.0.hit.point', [1, 2], 'tree.samples[0].nodes[0].hit.point: expected three numbers, found [1,2]'],
    ['tree.samples.0.nodes.0.hit.t', null, 'tree.samples[0].nodes[0].hit.t: expected a number, found null'],
    ['tree.samples.0.nodes.0.local.lights.0.facing', 1, 'tree.samples[0].nodes[0].local.lights[0].facing: expected true or false, found 1'],
    ['tree.samples.0.nodes.0.ended', 'tired', 'tree.samples[0].nodes[0].ended: expected one of missed, depth, threshold, absorbed, rays, found "tired"'],
    ['tree.samples', [], 'tree.samples: expected at least one sample, found []'],
    ['tree.transfer', 'gamma', 'tree.transfer: expected one of srgb, linear, found "gamma"'],
    ['tree.pixel', [1], 'tree.pixel: expected two numbers, found [1]'],
    ['scene.meshes.0.faces.4', 8, 'scene.meshes[0].faces[4]: expected a whole number from 0 to 7, found 8'],
    ['scene.camera.corners.3', [0, 0, Infinity], 'scene.camera.corners[3]: expected three numbers, found [0,0,null]'],
    ['scene.lights.1.direction', null, 'scene.lights[1].direction: expected three numbers, found null'],
    ['scene', 'glass', 'scene: expected an object, found "glass"'],
    ['scene.transfer', 'gamma', 'scene.transfer: expected one of srgb, linear, found "gamma"'],
    ['picture', 'x.png', 'picture: expected the bytes of a PNG, found "x.png"'],
    ['title', 7, 'title: expected a text, found 7'],
  ])('%s = %j', (path, value, message) => {
    expect(complaint(path, value)).toBe(message);
  });

  test('cuts long values in messages', () => {
    expect(complaint('scene.spheres', 'x'.repeat(1000)).length).toBeLessThan(120);
  });
});
