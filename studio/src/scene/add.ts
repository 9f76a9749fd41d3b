/** New things, where the camera looks and as large as a part of what it sees. */

import type { SceneDocument } from '../generated/scene';
import { numberText, roundTo, vectorText, type Vec3 } from './objects';

export type Addable = 'sphere' | 'box' | 'plane' | 'disc' | 'light';

/** The element in TOML, for the list of its kind. */
export function elementOf(kind: Addable, name: string, scene: SceneDocument): string {
  const eye = scene.camera.eye as Vec3;
  const middle = scene.camera.look_at as Vec3;
  const away = Math.hypot(...middle.map((value, axis) => value - eye[axis]!));
  const size = roundTo(away / 12, away / 12);
  const at = middle.map((value) => roundTo(value, away)) as Vec3;
  const material = JSON.stringify(Object.keys(scene.material ?? {})[0] ?? '');
  const called = `name = ${JSON.stringify(name)}`;
  const moved = (by: number) => vectorText(at.map((value) => value + by));
  switch (kind) {
    case 'sphere':
      return `{ ${called}, center = ${vectorText(at)}, radius = ${numberText(size)}, material = ${material} }`;
    case 'box':
      return `{ ${called}, min = ${moved(-size)}, max = ${moved(size)}, material = ${material} }`;
    case 'plane':
      return `{ ${called}, center = ${vectorText(at)}, size = ${vectorText([4 * size, 4 * size])}, material = ${material} }`;
    case 'disc':
      return `{ ${called}, center = ${vectorText(at)}, radius = ${numberText(size)}, material = ${material} }`;
    case 'light': {
      const up = scene.camera.up as Vec3;
      const length = Math.hypot(...up) || 1;
      const over = at.map((value, axis) => roundTo(value + (away / 2) * (up[axis]! / length), away)) as Vec3;
      return `{ ${called}, position = ${vectorText(over)}, color = 0.5 }`;
    }
  }
}

/** A name that nothing has: `sphere`, else `sphere 2` and so on. */
export function freeName(kind: Addable, taken: ReadonlySet<string>): string {
  if (!taken.has(kind)) return kind;
  let number = 2;
  while (taken.has(`${kind} ${number}`)) number++;
  return `${kind} ${number}`;
}
