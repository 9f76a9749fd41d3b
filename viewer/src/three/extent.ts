/** What the drawing is about: the camera, the rays and what is near them. */

import { Box3, Sphere, Vector3 } from 'three';
import type { RayNode, Vec3, ViewScene } from '../data';

export interface Extent {
  /** The ends of the rays, and objects; points are spheres without a radius. */
  things: Sphere[];
  /** All that should be seen at first: the camera and the lights too. */
  all: Sphere[];
  center: Vector3;
  radius: number;
}

/** Things larger than this many radii of the rays, or farther away, are not waited for: a floor may be endless. */
const FAR = 3;

export function extentOf(scene: ViewScene, nodes: RayNode[]): Extent {
  const camera = [scene.camera.eye, ...scene.camera.corners].map(point);
  const ends = nodes.flatMap(({ hit }) => (hit === null ? [] : [point(hit.point)]));
  const rays = bounds([...camera, ...ends]);
  const near = (spheres: Sphere[]) => {
    const { center, radius } = bounds(spheres);
    return center.distanceTo(rays.center) + radius <= FAR * rays.radius;
  };
  const objects = [...scene.spheres.map(({ center, radius }) => [ball(center, radius)]), ...scene.meshes.map(corners)];
  const things = [...ends, ...objects.filter(near).flat()];
  const lamps = scene.lights.flatMap(({ position }) => (position === null ? [] : [point(position)])).filter((lamp) => near([lamp]));
  const all = [...camera, ...things, ...lamps];
  const extent = { things: things.length > 0 ? things : camera, all, ...bounds(all) };
  for (const { direction } of scene.lights) if (direction !== null) all.push(new Sphere(arrowStart(direction, extent), 0));
  return extent;
}

/** Where the arrow of a light at infinity begins. */
export function arrowStart(direction: Vec3, extent: Pick<Extent, 'center' | 'radius'>): Vector3 {
  return extent.center.clone().addScaledVector(new Vector3(...direction).normalize(), extent.radius);
}

/** The middle and half the diagonal of the box around spheres. */
export function bounds(spheres: Sphere[]): { center: Vector3; radius: number } {
  const box = new Box3();
  for (const sphere of spheres) box.union(sphere.getBoundingBox(new Box3()));
  const radius = box.getSize(new Vector3()).length() / 2;
  return { center: box.getCenter(new Vector3()), radius: radius > 0 ? radius : 1 };
}

function corners({ vertices }: { vertices: number[] }): Sphere[] {
  if (vertices.length === 0) return [];
  const { min, max } = new Box3().setFromArray(vertices);
  return [0, 1, 2, 3, 4, 5, 6, 7].map((n) => ball([n & 1 ? max.x : min.x, n & 2 ? max.y : min.y, n & 4 ? max.z : min.z], 0));
}

function ball(center: Vec3, radius: number): Sphere {
  return new Sphere(new Vector3(...center), radius);
}

function point(at: Vec3): Sphere {
  return ball(at, 0);
}
