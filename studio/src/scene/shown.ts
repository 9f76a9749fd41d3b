/** Which things in the drawing are which objects of the scene. The engine tells only names, and two things may share one. */

import type { ObjectRef, ViewScene } from 'snell-viewer';
import { boundsOf, type SceneObject, type Vec3 } from './objects';

/** The engine takes lists in this order; but meshes and lathes that stand in several places come last. */
const ORDER: SceneObject['kind'][] = ['sphere', 'mesh', 'lathe', 'plane', 'box', 'disc'];

/** What each object is in the drawing, by its key: several things where it stands in several places, none where it has no size. */
export function shownThings(objects: SceneObject[], view: ViewScene): Map<string, ObjectRef[]> {
  const named = {
    sphere: byName('sphere', view.spheres),
    mesh: byName('mesh', view.meshes),
    light: byName('light', view.lights),
    camera: new Map([['camera', [0, 1].map((index): ObjectRef => ({ kind: 'camera', index, name: 'camera' }))]]),
  };
  const shown = new Map<string, ObjectRef[]>();
  const inOrder = [...objects].sort((a, b) => turnOf(a) - turnOf(b));
  inOrder.forEach((object, at) => {
    const things = named[viewKind(object)].get(object.name) ?? [];
    const isLast = !inOrder.slice(at + 1).some((other) => other.name === object.name && viewKind(other) === viewKind(object));
    // Where there are very many places, the scene does not tell how many.
    shown.set(object.key, things.splice(0, isLast ? things.length : Math.max(1, placesOf(object))));
  });
  return shown;
}

/** Of things that have the same name in the engine, the one on which a point lies. */
export function nearest(things: ObjectRef[], point: Vec3, view: ViewScene): ObjectRef | undefined {
  const off = new Map(things.map((thing) => [thing, distance(thing, point, view)]));
  return [...things].sort((a, b) => off.get(a)! - off.get(b)!)[0];
}

/** How far a point is from the surface of a sphere, or from the ball around a mesh, in radii of it. */
function distance({ kind, index }: ObjectRef, point: Vec3, view: ViewScene): number {
  const mesh = view.meshes[index];
  const ball = kind === 'sphere' ? view.spheres[index]! : boundsOf(mesh!.vertices);
  const radii = Math.hypot(...point.map((value, axis) => value - ball.center[axis]!)) / ball.radius;
  return kind === 'sphere' ? Math.abs(radii - 1) : Math.max(0, radii - 1);
}

function byName(kind: ObjectRef['kind'], list: { name: string }[]): Map<string, ObjectRef[]> {
  const named = new Map<string, ObjectRef[]>();
  list.forEach(({ name }, index) => {
    const things = named.get(name) ?? [];
    things.push({ kind, index, name });
    named.set(name, things);
  });
  return named;
}

function viewKind({ kind }: SceneObject): ObjectRef['kind'] {
  if (kind === 'sphere' || kind === 'light') return kind;
  return kind === 'camera' || kind === 'target' ? 'camera' : 'mesh';
}

function placesOf({ data }: SceneObject): number {
  return 'instances' in data ? (data.instances?.length ?? 0) : 0;
}

function turnOf(object: SceneObject): number {
  // With a medium inside, each place is a mesh of its own.
  const isModel = (object.kind === 'mesh' || object.kind === 'lathe') && placesOf(object) > 0 && !object.data.inside;
  return isModel ? ORDER.length : ORDER.indexOf(object.kind);
}
