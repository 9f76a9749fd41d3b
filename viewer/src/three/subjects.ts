/** Where the things are that can be chosen, and which of them is under the pointer. */

import { Box3, type Ray, Raycaster, Sphere, Vector3 } from 'three';
import type { ViewScene } from '../data';
import type { ObjectRef } from '../editing';
import { arrowStart, bounds, boxOf, type Extent } from './extent';
import type { Objects } from './objects';
import type { Stage } from './stage';
import { imageCenter } from './viewpoints';

/** Pixels around the mark of a lamp, and of the camera's eye. */
const [LAMP, EYE] = [16, 11];
/** Faces that can be looked through with each move of the pointer. */
const MANY_FACES = 5000;

export interface Places {
  scene: ViewScene;
  extent: Extent;
  /** What the camera looks at; `null` where that does not matter. */
  target: Vector3 | null;
}

/** The middle of a thing; `null` if there is none such. */
export function placeOf({ kind, index }: ObjectRef, { scene, extent, target }: Places): Vector3 | null {
  switch (kind) {
    case 'sphere': {
      const sphere = scene.spheres[index];
      return sphere ? new Vector3(...sphere.center) : null;
    }
    case 'mesh': {
      const mesh = scene.meshes[index];
      return mesh ? boxOf(mesh).getCenter(new Vector3()) : null;
    }
    case 'light': {
      const light = scene.lights[index];
      if (light === undefined) return null;
      return light.position ? new Vector3(...light.position) : arrowStart(light.direction!, extent);
    }
    case 'camera':
      return index === 0 ? new Vector3(...scene.camera.eye) : target;
  }
}

/** The place on the camera's axis beside the middle of the objects. */
export function axisPoint({ camera }: ViewScene, { things }: Extent): Vector3 {
  const eye = new Vector3(...camera.eye);
  const axis = imageCenter(camera).sub(eye);
  const forward = axis.clone().normalize();
  return eye.addScaledVector(forward, Math.max(axis.length(), bounds(things).center.sub(eye).dot(forward)));
}

/** A thing under the pointer, and how far away it is on the line of sight: marks are before all others. */
export interface Met {
  object: ObjectRef;
  distance: number;
}

interface Drawn extends Places {
  objects: Objects;
  stage: Stage;
}

/** `x` and `y` in pixels. Large meshes are looked at only if this is not `hasty`. */
export function objectAt(drawn: Drawn, x: number, y: number, hasty: boolean): Met | null {
  const { scene, objects, stage } = drawn;
  const marks: [ObjectRef, number][] = [
    ...scene.lights.map(({ name }, index): [ObjectRef, number] => [{ kind: 'light', index, name }, LAMP]),
    ...[0, 1].map((index): [ObjectRef, number] => [{ kind: 'camera', index, name: 'camera' }, EYE]),
  ];
  const mark = marks.find(([object, pixels]) => {
    const place = placeOf(object, drawn);
    const at = place && stage.onScreen(place);
    return at !== null && Math.hypot(at[0] - x, at[1] - y) <= pixels;
  });
  if (mark) return { object: mark[0], distance: 0 };

  const ray = stage.lineOfSight(x, y);
  let met: Met | null = null;
  const meet = (object: ObjectRef, distance: number) => {
    if (distance < (met?.distance ?? Infinity)) met = { object, distance };
  };
  scene.spheres.forEach(({ name, center, radius }, index) => {
    const at = ray.intersectSphere(new Sphere(new Vector3(...center), radius), new Vector3());
    if (at) meet({ kind: 'sphere', index, name }, at.distanceTo(ray.origin));
  });
  scene.meshes.forEach((mesh, index) => {
    if (hasty && mesh.faces.length > 3 * MANY_FACES) return;
    meet({ kind: 'mesh', index, name: mesh.name }, distanceTo(objects.meshes[index]!, boxOf(mesh), ray));
  });
  return met;
}

function distanceTo(mesh: Objects['meshes'][number], box: Box3, ray: Ray): number {
  if (!ray.intersectsBox(box)) return Infinity;
  const caster = new Raycaster(ray.origin, ray.direction);
  return caster.intersectObject(mesh, false)[0]?.distance ?? Infinity;
}
