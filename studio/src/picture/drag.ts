/** Dragging things in the picture: as far as the pointer goes on the image plane, so much farther as they are behind it. */

import type { ViewCamera } from 'snell-viewer';
import type { Vec3 } from '../scene/objects';

/** How something at `center` moves when it is dragged by so many pixels of a picture. It keeps its distance to the image plane. */
export function dragged(camera: ViewCamera, size: readonly [number, number], center: Vec3, dx: number, dy: number): Vec3 {
  const [leftBottom, , leftTop, rightTop] = camera.corners;
  const right = minus(rightTop, leftTop);
  const down = minus(leftBottom, leftTop);
  const normal = cross(right, down);
  const plane = dot(minus(leftTop, camera.eye), normal);
  // As the eye sees them, both moves are the same: lengths are as the distances.
  const farther = plane === 0 ? 1 : dot(minus(center, camera.eye), normal) / plane;
  return right.map((value, at) => farther * ((value * dx) / size[0] + (down[at]! * dy) / size[1])) as Vec3;
}

/** The pixel at which a point is seen, as a fraction of one, too; nothing for what is not in front of the eye. */
export function project(camera: ViewCamera, size: readonly [number, number], point: Vec3): [number, number] | null {
  const [leftBottom, , leftTop, rightTop] = camera.corners;
  const right = minus(rightTop, leftTop);
  const down = minus(leftBottom, leftTop);
  const normal = cross(right, down);
  const along = dot(minus(point, camera.eye), normal) / dot(minus(leftTop, camera.eye), normal);
  if (!(along > 0)) return null;
  const on = minus(point, camera.eye).map((value, at) => camera.eye[at]! + value / along - leftTop[at]!) as Vec3;
  return [(size[0] * dot(on, right)) / dot(right, right), (size[1] * dot(on, down)) / dot(down, down)];
}

function minus(a: readonly number[], b: readonly number[]): Vec3 {
  return a.map((value, at) => value - b[at]!) as Vec3;
}

function dot(a: Vec3, b: Vec3): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

function cross(a: Vec3, b: Vec3): Vec3 {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}
