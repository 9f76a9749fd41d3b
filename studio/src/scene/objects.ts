/** The things of a scene that one can point at, with the keys of their values in its text. */

import type { ObjectRef, ViewScene } from 'snell-viewer';
import type { SceneDocument } from '../generated/scene';

export type Vec3 = [number, number, number];
export type ShapeKind = 'sphere' | 'mesh' | 'plane' | 'box' | 'disc' | 'lathe';

export const SHAPES: ShapeKind[] = ['sphere', 'mesh', 'plane', 'box', 'disc', 'lathe'];

type Elements = { [K in ShapeKind]: NonNullable<SceneDocument[K]>[number] };

interface Called {
  /** As the engine calls it, which may call others the same. */
  name: string;
  /** As people tell it from the others. */
  title: string;
  /** Of its values in the text, and of no other's. */
  key: string;
}

export type SceneObject = Called &
  (
    | { [K in ShapeKind]: { kind: K; data: Elements[K] } }[ShapeKind]
    | { kind: 'light'; data: NonNullable<SceneDocument['light']>[number] }
    /** Its eye, and the point that it looks at. */
    | { kind: 'camera' | 'target'; key: 'camera'; data: SceneDocument['camera'] }
  );

/** Everything, in the order of the file. */
export function objectsOf(scene: SceneDocument): SceneObject[] {
  const shapes = SHAPES.flatMap((kind) => elements(kind, scene[kind]));
  const camera = { kind: 'camera', name: 'camera', key: 'camera', data: scene.camera };
  const times = new Map<string, number>();
  return [...shapes, ...elements('light', scene.light), camera].map((object) => {
    const time = 1 + (times.get(object.name) ?? 0);
    times.set(object.name, time);
    return { ...object, title: time === 1 ? object.name : `${object.name} (${time})` } as SceneObject;
  });
}

function elements(kind: string, list: { name?: string | null; file?: string | null }[] = []) {
  const names = list.map(({ name }) => name);
  return list.map((data, index) => {
    const isUnique = data.name != null && names.indexOf(data.name) === names.lastIndexOf(data.name);
    let number = String(index + 1);
    // Names go before numbers: something may be called 2 and not be the second, but hardly 02 as well.
    while (names.includes(number)) number = `0${number}`;
    return { kind, name: data.name ?? data.file ?? `${kind} ${index + 1}`, key: `${kind}.${isUnique ? quoted(data.name!) : number}`, data };
  });
}

/** A key of TOML: quoted where it must be. */
export function quoted(key: string): string {
  return /^[A-Za-z0-9_-]+$/.test(key) ? key : JSON.stringify(key);
}

/** Without the noise of sums in the last digits; 0.1 + 0.2 is 0.3. */
export function numberText(value: number): string {
  return String(Number(value.toPrecision(12)));
}

/** To a step that is round and about a thousandth of `extent`: what a hand moves has no more digits than it can aim at. */
export function roundTo(value: number, extent: number): number {
  if (!(extent > 0) || !Number.isFinite(extent)) return value;
  const step = 10 ** Math.floor(Math.log10(extent) - 3);
  return Math.round(value / step) * step;
}

export function vectorText(values: readonly number[]): string {
  return `[${values.map(numberText).join(', ')}]`;
}

/** A round length that is small beside what the camera sees, whatever the unit: what things snap to. */
export function snapOf({ camera }: SceneDocument): number {
  const away = Math.hypot(...camera.look_at.map((value, axis) => value - camera.eye[axis]!));
  return 10 ** Math.floor(Math.log10(away / 20));
}

/** The middle of an object as it is seen, and how far it reaches; nothing for what has no place. `thing` is what it is in the drawing. */
export function placeOf(object: SceneObject, thing: ObjectRef | undefined, view: ViewScene): { center: Vec3; radius: number } | null {
  if (object.kind === 'camera') return { center: object.data.eye as Vec3, radius: 0 };
  if (object.kind === 'target') return { center: object.data.look_at as Vec3, radius: 0 };
  if (thing === undefined) return null;
  if (thing.kind === 'light') {
    const { position } = view.lights[thing.index]!;
    return position && { center: position, radius: 0 };
  }
  if (thing.kind === 'sphere') {
    const { center, radius } = view.spheres[thing.index]!;
    return { center, radius };
  }
  const { vertices } = view.meshes[thing.index]!;
  return vertices.length > 0 ? boundsOf(vertices) : null;
}

export function boundsOf(vertices: ArrayLike<number>): { center: Vec3; radius: number } {
  const [low, high]: [Vec3, Vec3] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  for (let at = 0; at < vertices.length; at++) {
    const axis = at % 3;
    low[axis] = Math.min(low[axis]!, vertices[at]!);
    high[axis] = Math.max(high[axis]!, vertices[at]!);
  }
  const center = low.map((value, axis) => (value + high[axis]!) / 2) as Vec3;
  return { center, radius: Math.hypot(...low.map((value, axis) => high[axis]! - value)) / 2 };
}
