/** What the drawing is about: the box around the camera, the rays and what is near them. */

import { Box3, Vector3 } from 'three';
import type { RayNode, Vec3, ViewScene } from '../data';

export interface Extent {
  /** All that should be seen, the arrows of lights at infinity too. */
  box: Box3;
  center: Vector3;
  radius: number;
}

/** Things larger than this many radii of the rays, or farther away, are not waited for: a floor may be endless. */
const FAR = 3;

export function extentOf(scene: ViewScene, nodes: RayNode[]): Extent {
  const { eye, corners } = scene.camera;
  const rays = new Box3().setFromPoints([eye, ...corners].map((point) => new Vector3(...point)));
  for (const node of nodes) {
    rays.expandByPoint(new Vector3(...node.origin));
    if (node.hit !== null) rays.expandByPoint(new Vector3(...node.hit.point));
  }
  const { center, radius } = measured(rays);
  const near = new Box3(center.clone().subScalar(FAR * radius), center.clone().addScalar(FAR * radius));
  const box = rays.clone();
  for (const thing of boxes(scene)) if (near.containsBox(thing)) box.union(thing);
  const extent = measured(box);
  for (const { direction } of scene.lights) if (direction !== null) box.expandByPoint(arrowStart(direction, extent));
  return extent;
}

/** Where the arrow of a light at infinity begins. */
export function arrowStart(direction: Vec3, extent: Extent): Vector3 {
  return extent.center.clone().addScaledVector(new Vector3(...direction).normalize(), extent.radius);
}

function boxes(scene: ViewScene): Box3[] {
  const spheres = scene.spheres.map(({ center, radius }) => {
    const middle = new Vector3(...center);
    return new Box3(middle.clone().subScalar(radius), middle.clone().addScalar(radius));
  });
  const meshes = scene.meshes.map(({ vertices }) => new Box3().setFromArray(vertices));
  const lights = scene.lights.flatMap(({ position }) => (position ? [new Box3().setFromPoints([new Vector3(...position)])] : []));
  return [...spheres, ...meshes, ...lights].filter((box) => !box.isEmpty());
}

function measured(box: Box3): Extent {
  const radius = box.getSize(new Vector3()).length() / 2;
  return { box, center: box.getCenter(new Vector3()), radius: radius > 0 ? radius : 1 };
}
