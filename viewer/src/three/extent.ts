/** What the drawing is about: the camera, the rays and what is near them; or without rays, the objects before the camera. */

import { Box3, Sphere, Vector3 } from 'three';
import type { Numbers, RayNode, Vec3, ViewMesh, ViewScene } from '../data';

export interface Extent {
  /** The ends of the rays, and objects; points are spheres without a radius. */
  things: Sphere[];
  /** All that should be seen at first: the camera and the lights too. */
  all: Sphere[];
  center: Vector3;
  radius: number;
}

/** Things this many times as large as the others, or as far away, are not waited for: a floor may be endless. */
const FAR = 3;
/** Radius in distances from the eye: larger things are floors, walls and rooms. */
const WIDE = 0.5;

export function extentOf(scene: ViewScene, nodes: RayNode[]): Extent {
  const camera = [scene.camera.eye, ...scene.camera.corners].map(point);
  const ends = nodes.flatMap(({ hit }) => (hit === null ? [] : [point(hit.point)]));
  const objects = [...scene.spheres.map(({ center, radius }) => [ball(center, radius)]), ...scene.meshes.map(corners)].filter(
    (spheres) => spheres.length > 0,
  );
  // Without rays, the objects decide themselves.
  const seen = ends.length > 0 ? ends : subjects(objects, new Vector3(...scene.camera.eye));
  const core = bounds([...camera, ...seen]);
  const far = ends.length > 0 ? FAR : FAR / 2;
  const near = (spheres: Sphere[]) => {
    const { center, radius } = bounds(spheres);
    return center.distanceTo(core.center) + radius <= far * core.radius;
  };
  const things = [...seen, ...objects.filter(near).flat()];
  const lamps = scene.lights.flatMap(({ position }) => (position === null ? [] : [point(position)])).filter((lamp) => near([lamp]));
  const all = [...camera, ...things, ...lamps];
  const { center, radius } = bounds(all);
  // Where all is one point, any size will do.
  const extent = { things: things.length > 0 ? things : camera, all, center, radius: radius > 0 ? radius : 1 };
  for (const { direction } of scene.lights) if (direction !== null) all.push(new Sphere(arrowStart(direction, extent), 0));
  return extent;
}

/** The objects that stand before the eye instead of around it, from near to far, until one is much farther than those before. */
function subjects(objects: Sphere[][], eye: Vector3): Sphere[] {
  const seen = objects.map((spheres) => {
    const { center, radius } = bounds(spheres);
    const distance = center.distanceTo(eye);
    return { spheres, reach: distance + radius, wide: radius > WIDE * distance };
  });
  const before = seen.some(({ wide }) => !wide) ? seen.filter(({ wide }) => !wide) : seen;
  before.sort((a, b) => a.reach - b.reach);
  const end = before.findIndex(({ reach }, index) => index > 0 && reach > FAR * before[index - 1]!.reach);
  return before.slice(0, end < 0 ? before.length : end).flatMap(({ spheres }) => spheres);
}

/** Where the arrow of a light at infinity begins. */
export function arrowStart(direction: Vec3, extent: Pick<Extent, 'center' | 'radius'>): Vector3 {
  return extent.center.clone().addScaledVector(new Vector3(...direction).normalize(), extent.radius);
}

/** The middle and half the diagonal of the box around spheres; 0 for a point. */
export function bounds(spheres: Sphere[]): { center: Vector3; radius: number } {
  const box = new Box3();
  for (const sphere of spheres) box.union(sphere.getBoundingBox(new Box3()));
  return { center: box.getCenter(new Vector3()), radius: box.getSize(new Vector3()).length() / 2 };
}

const boxes = new WeakMap<Numbers, Box3>();

/** Looked for once in each list: there may be many vertices, and scenes that change keep most of them. */
export function boxOf({ vertices }: ViewMesh): Box3 {
  let box = boxes.get(vertices);
  if (box === undefined) boxes.set(vertices, (box = new Box3().setFromArray(vertices as ArrayLike<number> as number[])));
  return box;
}

function corners(mesh: ViewMesh): Sphere[] {
  if (mesh.vertices.length === 0) return [];
  const { min, max } = boxOf(mesh);
  return [0, 1, 2, 3, 4, 5, 6, 7].map((n) => ball([n & 1 ? max.x : min.x, n & 2 ? max.y : min.y, n & 4 ? max.z : min.z], 0));
}

function ball(center: Vec3, radius: number): Sphere {
  return new Sphere(new Vector3(...center), radius);
}

function point(at: Vec3): Sphere {
  return ball(at, 0);
}
