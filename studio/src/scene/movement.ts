/** Moving, turning and scaling an object, as edits of the scene's text. */

import type { Change } from 'snell-viewer';
import type { Edit } from '../engine/protocol';
import { numberText, type SceneObject, type Vec3, vectorText } from './objects';

/**
 * `center` is the middle of the object before the movement. Nothing for what cannot be done to it; but a movement by nothing is one:
 * a drag may end where it began.
 */
export function editsFor(object: SceneObject, movement: Change, center: Vec3): Edit[] {
  switch (movement.kind) {
    case 'move':
      return move(object, movement.by);
    case 'turn':
      return turn(object, movement.axis, movement.degrees, center);
    case 'scale':
      return scale(object, movement.by, center);
  }
}

type Step = { move: Vec3 } | { rotate: { axis: Vec3; degrees: number } } | { scale: Vec3 };

function move(object: SceneObject, by: Vec3): Edit[] {
  const { key } = object;
  if (object.kind === 'camera') return [[`${key}.eye`, vectorText(sum(object.data.eye as Vec3, by))]];
  if (object.kind === 'target') return [[`${key}.look_at`, vectorText(sum(object.data.look_at as Vec3, by))]];
  if (object.kind === 'light') {
    return object.data.position ? [[`${key}.position`, vectorText(sum(object.data.position as Vec3, by))]] : [];
  }
  const steps = stepsOf(object);
  if (steps.length === 0) {
    switch (object.kind) {
      case 'sphere':
        return [[`${key}.center`, vectorText(sum(object.data.center as Vec3, by))]];
      case 'plane':
      case 'disc':
        return [[`${key}.center`, vectorText(sum((object.data.center ?? [0, 0, 0]) as Vec3, by))]];
      case 'box': {
        const { min, max } = object.data;
        return [[`${key}.min`, vectorText(sum(min as Vec3, by))], [`${key}.max`, vectorText(sum(max as Vec3, by))]];
      }
    }
  }
  return [placed(object, joined(steps, [{ move: by }]))];
}

function turn(object: SceneObject, axis: Vec3, degrees: number, center: Vec3): Edit[] {
  if (!isShape(object)) return [];
  // A sphere looks the same from all sides, unless it carries a picture.
  return [placed(object, joined(stepsOf(object), about(center, { rotate: { axis, degrees } })))];
}

function scale(object: SceneObject, by: number | Vec3, center: Vec3): Edit[] {
  const all = typeof by === 'number' ? by : null;
  if (!isShape(object)) return [];
  const { key } = object;
  if (all !== null && stepsOf(object).length === 0) {
    switch (object.kind) {
      case 'sphere':
      case 'disc':
        return [[`${key}.radius`, numberText(object.data.radius * all)]];
      case 'plane':
        return [[`${key}.size`, vectorText((object.data.size as number[]).map((side) => side * all))]];
      case 'box': {
        const around = (corner: Vec3) => vectorText(corner.map((value, axis) => center[axis]! + (value - center[axis]!) * all));
        return [[`${key}.min`, around(object.data.min as Vec3)], [`${key}.max`, around(object.data.max as Vec3)]];
      }
    }
  }
  const factors: Vec3 = typeof by === 'number' ? [by, by, by] : by;
  return [placed(object, joined(stepsOf(object), about(center, { scale: factors })))];
}

function isShape(object: SceneObject): object is Exclude<SceneObject, { kind: 'camera' | 'target' | 'light' }> {
  return object.kind !== 'camera' && object.kind !== 'target' && object.kind !== 'light';
}

function stepsOf(object: SceneObject): Step[] {
  return 'transform' in object.data ? ((object.data.transform ?? []) as Step[]) : [];
}

function about(center: Vec3, step: Step): Step[] {
  return [{ move: center.map((value) => -value) as Vec3 }, step, { move: center }];
}

/** Two moves in a row are one, and so are two turns about one axis: a text that was dragged a hundred times stays short. */
function joined(before: Step[], more: Step[]): Step[] {
  const steps = [...before];
  for (const step of more) {
    if (isNothing(step)) continue;
    const last = steps.at(-1);
    const one = last === undefined ? null : join(last, step);
    if (one === null) {
      steps.push(step);
      continue;
    }
    steps.pop();
    if (!isNothing(one)) steps.push(one);
  }
  return steps;
}

function join(first: Step, second: Step): Step | null {
  if ('move' in first && 'move' in second) return { move: sum(first.move, second.move) };
  if ('rotate' in first && 'rotate' in second) {
    const same = first.rotate.axis.every((value, at) => value === second.rotate.axis[at]);
    return same ? { rotate: { axis: first.rotate.axis, degrees: first.rotate.degrees + second.rotate.degrees } } : null;
  }
  if ('scale' in first && 'scale' in second) return { scale: first.scale.map((value, at) => value * second.scale[at]!) as Vec3 };
  return null;
}

function isNothing(step: Step): boolean {
  if ('move' in step) return step.move.every((value) => value === 0);
  return 'rotate' in step ? step.rotate.degrees === 0 : step.scale.every((value) => value === 1);
}

function placed({ key }: SceneObject, steps: Step[]): Edit {
  return [`${key}.transform`, `[${steps.map(stepText).join(', ')}]`];
}

function stepText(step: Step): string {
  if ('move' in step) return `{ move = ${vectorText(step.move)} }`;
  if ('scale' in step) return `{ scale = ${vectorText(step.scale)} }`;
  return `{ rotate = { axis = ${vectorText(step.rotate.axis)}, degrees = ${numberText(step.rotate.degrees)} } }`;
}

function sum(first: Vec3, second: Vec3): Vec3 {
  return first.map((value, at) => {
    const sum = value + second[at]!;
    // The noise of numbers that cancel is nothing, in any unit.
    return Math.abs(sum) < 1e-12 * Math.abs(value) ? 0 : sum;
  }) as Vec3;
}
