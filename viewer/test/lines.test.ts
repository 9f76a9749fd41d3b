import { expect, test } from 'vitest';
import { lineOpacity, lineWidth, rayLine, shadowLines, stepLine } from '../src/lines';
import type { LightAtHit } from '../src/data';
import { glass, ray } from './fixture';

const hit = { ...glass().tree.samples[0]!.nodes[0]!.hit!, point: [0, 0, -5] as [number, number, number] };

test('rays end where they hit, in the open, or as a stub', () => {
  expect(rayLine(ray({ hit, ended: null }), 8)).toEqual({ from: [0, 0, 0], to: [0, 0, -5], open: false });
  expect(rayLine(ray({ ended: 'missed' }), 8)).toEqual({ from: [0, 0, 0], to: [0, 0, -8], open: true });
  expect(rayLine(ray({ ended: 'depth' }), 8)).toEqual({ from: [0, 0, 0], to: [0, 0, -2], open: true });
});

test('what a model goes through in one step is a line of its own', () => {
  const parent = ray({ hit });
  expect(stepLine(parent, ray({ origin: [0, 0, -7] }))).toEqual({ from: [0, 0, -5], to: [0, 0, -7], open: false });
  expect(stepLine(parent, ray({ origin: [1e-12, 0, -5] }))).toBeNull();
  expect(stepLine(ray({}), ray({ origin: [0, 0, -7] }))).toBeNull();
});

test('shadow rays go to the light, or to what blocks it', () => {
  const light: LightAtHit = {
    name: 'lamp', facing: true, transmittance: [1, 1, 1], blocked_by: null, block_point: null, through: [],
    diffuse: [0, 0, 0], highlight: [0, 0, 0], point: [1, 2, 3], at_infinity: false,
  };
  const lines = (changes: Partial<LightAtHit>) => {
    const local = { ambient: hit.normal, emission: hit.normal, lights: [{ ...light, ...changes }] };
    return shadowLines(ray({ hit, local }), 10);
  };
  expect(lines({})).toEqual([{ from: [0, 0, -5], to: [1, 2, 3], open: false, blocked: false }]);
  expect(lines({ at_infinity: true, point: [0, 1, 0] })).toEqual([{ from: [0, 0, -5], to: [0, 10, -5], open: true, blocked: false }]);
  expect(lines({ blocked_by: 'red', block_point: [0, 0, 9] })).toEqual([{ from: [0, 0, -5], to: [0, 0, 9], open: false, blocked: true }]);
  expect(lines({ facing: false })).toEqual([]);
  expect(shadowLines(ray({}), 10)).toEqual([]);
});

test('width and opacity grow with the share', () => {
  for (const grows of [lineWidth, lineOpacity]) {
    expect(grows(0)).toBeGreaterThan(0);
    expect(grows(0.1)).toBeGreaterThan(grows(0.01));
    expect(grows(1)).toBeGreaterThan(grows(0.5));
  }
  expect(lineOpacity(1)).toBeLessThanOrEqual(1);
});
