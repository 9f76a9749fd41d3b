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

// A pixel of 100: 1 brings nearly all; 2 to 4 bring 0.9, 0.8 and 1.3; 5 and 6, below 1, bring 0.5 each.
const many = () => new TreeModel(rays([null, 0, 0, 0, 0, 1, 1, 5], [100, 97, 0.9, 0.8, 1.3, 0.5, 0.5, 0.5]));

test('children that matter little share a row at the end', () => {
  const model = many();
  expect(model.others(0)).toEqual([2, 3]);
  const rows = model.rows(new Set([0]));
  expect(rows.map(({ id }) => id)).toEqual([0, 1, 4, ~0]);
  expect(rows.at(-1)).toEqual({ id: ~0, parent: 0, level: 2, place: 3, siblings: 3, expandable: true, expanded: false });
  // Shares still add up to all.
  expect(rows.slice(1).reduce((sum, { id }) => sum + model.share(id), 0)).toBeCloseTo(1, 12);
  expect(model.share(~0)).toBeCloseTo(0.017, 12);
});

test('their row unfolds to them, one level below', () => {
  const rows = many().rows(new Set([0, ~0]));
  expect(rows.map(({ id, level, parent }) => [id, level, parent])).toEqual([[0, 1, null], [1, 2, 0], [4, 2, 0], [~0, 2, 0], [2, 3, ~0], [3, 3, ~0]]);
  expect(rows.slice(-2).map(({ place, siblings }) => [place, siblings])).toEqual([[1, 2], [2, 2]]);
});

test('a row is not folded alone, not if many together matter, and not in the dark', () => {
  expect(new TreeModel(rays([null, 0, 0], [100, 99.5, 0.5])).others(0)).toEqual([]);
  const eight = Array.from({ length: 8 }, () => 0.7);
  expect(new TreeModel(rays([null, 0, ...eight.map(() => 0)], [100, 94.4, ...eight])).others(0)).toEqual([]);
  expect(new TreeModel(rays([null, 0, ...eight.slice(1).map(() => 0)], [100, 95.1, ...eight.slice(1)])).others(0)).toHaveLength(7);
  expect(new TreeModel(rays([null, 0, 0, 0])).others(0)).toEqual([]);
  // Exactly one in a hundred is enough for a row of its own.
  expect(new TreeModel(rays([null, 0, 0, 0], [100, 98, 1, 1])).others(0)).toEqual([]);
});

test('knows what must be unfolded for a ray to be seen', () => {
  const model = many();
  expect(model.above(7)).toEqual([0, 1, ~1, 5]);
  expect(model.rows(new Set(model.above(7))).map(({ id }) => id)).toContain(7);
  expect(model.above(4)).toEqual([0]);
});

test('generations grow the tree', () => {
  const model = many();
  expect([0, 4, 5, 7].map((id) => model.generation(id))).toEqual([0, 1, 2, 3]);
  expect(model.last).toBe(3);
  expect([0, 1, 2, 3].map((last) => model.countUntil(last))).toEqual([1, 5, 7, 8]);
  const all = new Set([0, 1, ~0, ~1, 5]);
  expect(model.rows(all, 1).map(({ id }) => id)).toEqual([0, 1, 4, ~0, 2, 3]);
  // What has nothing below it as yet cannot be unfolded.
  expect(model.rows(all, 1)[1]).toMatchObject({ expandable: false, expanded: false });
  expect(model.rows(all, 3)).toHaveLength(10);
});

test('colours add up generation by generation, in the order of the document, bit for bit', () => {
  // One to 10¹⁶ is lost, two are not: the order of generations would tell.
  const parts = [0, 1, 1e16, 1];
  const nodes = rays([null, 0, 1, 0]).map((node, id) => ({ ...node, contribution: [parts[id]!, 0, 0.5] as [number, number, number] }));
  const model = new TreeModel(nodes);
  expect([0, 1, 2].map((last) => model.colorUntil(last))).toEqual([[0, 0, 0.5], [2, 0, 1.5], [1e16, 0, 2]]);
});
