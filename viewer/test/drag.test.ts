import { Ray, Vector3 } from 'three';
import { expect, test } from 'vitest';
import type { Vec3 } from '../src/data';
import { snapped, undone } from '../src/editing';
import { Drag, type Grip } from '../src/three/drag';

/** From an eye at (0, 0, 10), through a point. */
const through = (...at: Vec3) => new Ray(new Vector3(0, 0, 10), new Vector3(...at).sub(new Vector3(0, 0, 10)).normalize());
const FORWARD = new Vector3(0, 0, -1);
const drag = (grip: Grip, from: Vec3, center: Vec3 = [0, 0, 0]) => new Drag(grip, new Vector3(...center), through(...from), FORWARD);
const rounded = (change: unknown) => JSON.parse(JSON.stringify(change, (_, value) => (typeof value === 'number' ? Number(value.toFixed(6)) + 0 : value)));

test('freely, it follows the pointer in the plane of the screen through its middle', () => {
  const free = drag({ do: 'move', axis: null }, [0.5, 0, 0], [0, 0, -10]);
  // Twice as far away as where the pointer is: twice as far.
  expect(rounded(free.change(through(0.5, 1, 0), null))).toEqual({ kind: 'move', by: [0, 2, 0] });
  expect(rounded(free.change(through(0.5, 0, 0), null))).toEqual({ kind: 'move', by: [0, 0, 0] });
});

test('along an axis, it follows the nearest point of the axis', () => {
  const along = drag({ do: 'move', axis: [1, 0, 0] }, [1, 0, 0]);
  expect(rounded(along.change(through(1.5, 0.7, 0), null))).toEqual({ kind: 'move', by: [0.5, 0, 0] });
  expect(rounded(along.change(through(1.9, 0, 0), 0.25))).toEqual({ kind: 'move', by: [1, 0, 0] });
});

test('an axis that points at the eye says nothing, and nothing jumps', () => {
  const end = new Drag({ do: 'move', axis: [0, 0, 1] }, new Vector3(), through(0, 0, 0), FORWARD);
  expect(rounded(end.change(through(0, 0, 0), null))).toEqual({ kind: 'move', by: [0, 0, 0] });
});

test('turns add up beyond a whole one', () => {
  const turn = drag({ do: 'turn', axis: [0, 0, 1] }, [1, 0, 0]);
  const at = (degrees: number) => through(Math.cos((degrees * Math.PI) / 180), Math.sin((degrees * Math.PI) / 180), 0);
  for (let degrees = 30; degrees <= 390; degrees += 30) {
    expect(rounded(turn.change(at(degrees), null))).toEqual({ kind: 'turn', axis: [0, 0, 1], degrees });
  }
  expect(turn.change(at(398), 1)).toMatchObject({ degrees: 405 });
});

test('scales by how much farther from the middle the pointer is, and never to nothing', () => {
  const whole = drag({ do: 'scale', axis: null }, [1, 0, 0]);
  expect(rounded(whole.change(through(0, 2, 0), null))).toEqual({ kind: 'scale', by: 2 });
  expect(rounded(whole.change(through(0, 0, 0), null))).toEqual({ kind: 'scale', by: 0.01 });
  const one = drag({ do: 'scale', axis: [0, 1, 0] }, [0, 1, 0]);
  expect(rounded(one.change(through(3, 1.5, 0), null))).toEqual({ kind: 'scale', by: [1, 1.5, 1] });
  expect(rounded(one.change(through(0, -5, 0), 1))).toEqual({ kind: 'scale', by: [1, 0.01, 1] });
});

test('snaps to short numbers', () => {
  expect(snapped(0.31, 0.1)).toBe(0.3);
  expect(snapped(0.31, null)).toBe(0.31);
});

test('what is taken back changes nothing', () => {
  expect(undone({ kind: 'move', by: [1, 2, 3] })).toEqual({ kind: 'move', by: [0, 0, 0] });
  expect(undone({ kind: 'turn', axis: [0, 1, 0], degrees: 30 })).toEqual({ kind: 'turn', axis: [0, 1, 0], degrees: 0 });
  expect(undone({ kind: 'scale', by: 3 })).toEqual({ kind: 'scale', by: 1 });
  expect(undone({ kind: 'scale', by: [1, 2, 1] })).toEqual({ kind: 'scale', by: [1, 1, 1] });
});
