import { expect, test } from 'vitest';
import { figureOf } from '../src/angles';
import type { Hit, Vec3 } from '../src/data';
import { dot } from '../src/lines';
import { glass, ray } from './fixture';

const degrees = (angle: number) => (angle * Math.PI) / 180;
const dir = (angle: number): Vec3 => [Math.sin(degrees(angle)), -Math.cos(degrees(angle)), 0];
const between = (a: Vec3, b: Vec3) => (Math.acos(Math.min(1, dot(a, b) / (Math.hypot(...a) * Math.hypot(...b)))) * 180) / Math.PI;

/** A ray that falls on the ground at (2, 0, 0). */
function falling(angle: number, changes: Partial<Hit> = {}) {
  const ground = { point: [2, 0, 0] as Vec3, normal: [0, 1, 0] as Vec3, angle_in: angle, angle_out: null, total_reflection: false };
  const hit = { ...glass().tree.samples[0]!.nodes[0]!.hit!, ...ground, ...changes };
  return ray({ dir: dir(angle), hit, ended: null });
}
const from = ([x, y, z]: Vec3): Vec3 => [x - 2, y, z];

test('arcs go from the normal to the rays, before and behind', () => {
  const { arcs, normal } = figureOf(falling(40, { angle_out: 25 }), true, 0.5)!;
  expect(arcs.map(({ text }) => text)).toEqual(['40°', '40°', '25°']);
  const [into, back, out] = arcs.map(({ points }) => points) as [Vec3[], Vec3[], Vec3[]];
  for (const points of [into, back, out]) for (const point of points) expect(Math.hypot(...from(point))).toBeCloseTo(0.5, 12);
  const up: Vec3 = [0, 1, 0];
  expect(between(from(into[0]!), up)).toBeCloseTo(0, 5);
  // Towards where the ray comes from; away from there in the mirror; and on, behind the surface, bent to the normal.
  expect(between(from(into.at(-1)!), dir(40).map((value) => -value) as Vec3)).toBeCloseTo(0, 5);
  expect(between(from(back.at(-1)!), [Math.sin(degrees(40)), Math.cos(degrees(40)), 0])).toBeCloseTo(0, 5);
  expect(between(from(out.at(-1)!), dir(25))).toBeCloseTo(0, 5);
  expect(normal.from[1]).toBeLessThan(0);
  expect(normal.to[1]).toBeGreaterThan(0.5);
});

test('total reflection is said, and nothing is behind', () => {
  const { arcs, normal } = figureOf(falling(50, { total_reflection: true }), false, 1)!;
  expect(arcs.map(({ text }) => text)).toEqual(['50°', '50°, total reflection']);
  expect(normal.from).toEqual([2, 0, 0]);
});

test('along the normal there is no arc but still an angle', () => {
  const { arcs } = figureOf(falling(0, { angle_out: 0 }), false, 1)!;
  expect(arcs).toMatchObject([{ points: [], text: '0°' }, { points: [], text: '0°' }]);
  expect(arcs.flatMap(({ at }) => at).every(Number.isFinite)).toBe(true);
});

test('a ray that meets nothing has no figure', () => {
  expect(figureOf(ray({}), true, 1)).toBeNull();
});

test('the real rays of the fixture end where their arcs do', () => {
  const { nodes } = glass().tree.samples[0]!;
  const bent = nodes.filter(({ hit }) => hit !== null && hit.angle_out !== null && hit.angle_in > 1);
  let followed = 0;
  for (const node of bent) {
    const { normal, point } = node.hit!;
    const { arcs } = figureOf(node, false, 1)!;
    const behind = arcs.at(-1)!.points.at(-1)!.map((value, axis) => value - point[axis]!) as Vec3;
    const next = nodes.find(({ parent, dir }) => parent === node.id && dot(dir, normal) < 0);
    if (next === undefined) continue;
    followed++;
    expect(between(behind, next.dir)).toBeLessThan(0.01);
  }
  expect(followed).toBeGreaterThan(3);
});
