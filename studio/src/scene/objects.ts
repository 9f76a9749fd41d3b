/** The things of a scene that one can point at, with the keys of their values in its text. */

import type { ViewScene } from 'snell-viewer';
import type { SceneDocument } from '../generated/scene';

export type Vec3 = [number, number, number];
export type ShapeKind = 'sphere' | 'mesh' | 'plane' | 'box' | 'disc' | 'lathe';

export const SHAPES: ShapeKind[] = ['sphere', 'mesh', 'plane', 'box', 'disc', 'lathe'];

type Elements = { [K in ShapeKind]: NonNullable<SceneDocument[K]>[number] };

export type SceneObject =
  | { [K in ShapeKind]: { kind: K; name: string; key: string; data: Elements[K] } }[ShapeKind]
  | { kind: 'light'; name: string; key: string; data: NonNullable<SceneDocument['light']>[number] }
  /** Its eye, and the point that it looks at. */
  | { kind: 'camera' | 'target'; name: string; key: 'camera'; data: SceneDocument['camera'] };

/** Everything, in the order of the file; names are those that the engine uses. */
export function objectsOf(scene: SceneDocument): SceneObject[] {
  const shapes = SHAPES.flatMap((kind) => elements(kind, scene[kind]));
  const camera = { kind: 'camera', name: 'camera', key: 'camera', data: scene.camera };
  return [...shapes, ...elements('light', scene.light), camera] as SceneObject[];
}

function elements(kind: string, list: { name?: string | null }[] = []) {
  return list.map((data, index) => {
    // A number is looked for among the names first: something may be called 2 and not be the second.
    const isFirst = data.name != null && list.findIndex(({ name }) => name === data.name) === index;
    const key = `${kind}.${isFirst ? quoted(data.name!) : index + 1}`;
    return { kind, name: data.name ?? `${kind} ${index + 1}`, key, data };
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

/** The middle of an object as it is seen, and how far it reaches; nothing for what has no place. */
export function placeOf(object: SceneObject, view: ViewScene): { center: Vec3; radius: number } | null {
  if (object.kind === 'camera') return { center: object.data.eye as Vec3, radius: 0 };
  if (object.kind === 'target') return { center: object.data.look_at as Vec3, radius: 0 };
  if (object.kind === 'light') {
    const light = view.lights.find(({ name }) => name === object.name);
    return light?.position ? { center: light.position, radius: 0 } : null;
  }
  const sphere = view.spheres.find(({ name }) => name === object.name);
  if (sphere) return { center: sphere.center, radius: sphere.radius };
  const mesh = view.meshes.find(({ name }) => name === object.name);
  return mesh && mesh.vertices.length > 0 ? boundsOf(mesh.vertices) : null;
}

function boundsOf(vertices: ArrayLike<number>): { center: Vec3; radius: number } {
  const [low, high]: [Vec3, Vec3] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  for (let at = 0; at < vertices.length; at++) {
    const axis = at % 3;
    low[axis] = Math.min(low[axis]!, vertices[at]!);
    high[axis] = Math.max(high[axis]!, vertices[at]!);
  }
  const center = low.map((value, axis) => (value + high[axis]!) / 2) as Vec3;
  return { center, radius: Math.hypot(...low.map((value, axis) => high[axis]! - value)) / 2 };
}
