import { expect, test } from 'vitest';
import { TreeModel } from '../src/model';
import { glass, rays } from './fixture';

const small = () => new TreeModel(rays([null, 0, 0, 1, 1, 4], [8, 6, 2, 1, 4, 0]));

test('shares are parts of the light of the sample', () => {
  const model = small();
  expect([0, 1, 2, 3, 4, 5].map((id) => model.share(id))).toEqual([1, 0.75, 0.25, 0.125, 0.5, 0]);
});

test('a black pixel has no shares', () => {
  expect(new TreeModel(rays([null, 0])).share(1)).toBe(0);
});

test('knows who follows whom', () => {
  const model = small();
  expect(model.roots).toEqual([0]);
  expect(model.children(1)).toEqual([3, 4]);
  expect(model.path(5)).toEqual([0, 1, 4, 5]);
});

test('shows only what is unfolded, children after their parent', () => {
  const model = small();
  const shown = (...expanded: number[]) => model.rows(new Set(expanded)).map(({ id }) => id);
  expect(shown()).toEqual([0]);
  expect(shown(0)).toEqual([0, 1, 2]);
  expect(shown(0, 1, 4)).toEqual([0, 1, 3, 4, 5, 2]);
  // What is unfolded below a folded ray stays unfolded, out of sight.
  expect(shown(0, 4)).toEqual([0, 1, 2]);
});

test('rows say where they stand', () => {
  const [, first, second] = small().rows(new Set([0]));
  expect(first).toEqual({ id: 1, parent: 0, level: 2, place: 1, siblings: 2, expandable: true, expanded: false });
  expect(second).toMatchObject({ id: 2, place: 2, siblings: 2, expandable: false });
});

test('the strongest rays are never without their parents', () => {
  const { nodes } = glass().tree.samples[0]!;
  const model = new TreeModel(nodes);
  for (let limit = 0; limit <= nodes.length; limit++) {
    const kept = model.strongest(limit);
    expect(kept).toHaveLength(limit);
    for (const id of kept) expect(kept).toEqual(expect.arrayContaining(model.path(id)));
  }
  expect(small().strongest(3)).toEqual([0, 1, 4]);
});

test('a path as deep as no stack of calls', () => {
  const deep = rays(Array.from({ length: 30_000 }, (_, id) => (id === 0 ? null : id - 1)));
  const model = new TreeModel(deep);
  expect(model.rows(new Set(deep.map(({ id }) => id)))).toHaveLength(30_000);
});
