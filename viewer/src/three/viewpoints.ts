/** From where the scene is looked at. */

import { MathUtils, type Sphere, Vector3 } from 'three';
import type { ViewCamera, ViewLight } from '../data';
import { bounds, type Extent } from './extent';

export interface Viewpoint {
  position: Vector3;
  /** What the view turns about. */
  target: Vector3;
  /** Vertical angle of view in degrees. */
  fov: number;
}

const FOV = 30;
/** Room around what is shown, for names. */
const MARGIN = 1.12;
/** Around the picture. */
const PICTURE_MARGIN = 1.03;

/**
 * From the side and a little above, so that the camera, the rays and the objects stand beside each other;
 * more from behind if there is a picture on the image plane to be seen.
 */
export function overview(camera: ViewCamera, extent: Extent, aspect: number, pictured: boolean): Viewpoint {
  const up = new Vector3(...camera.up).normalize();
  const forward = imageCenter(camera).sub(new Vector3(...camera.eye)).normalize();
  const right = new Vector3().crossVectors(forward, up).normalize();
  const [sideways, back] = pictured ? [0.78, 0.56] : [0.92, 0.34];
  const direction = right.clone().multiplyScalar(sideways).addScaledVector(up, 0.42).addScaledVector(forward, -back).normalize();
  return fitted(direction, up, extent.all, aspect);
}

/** The whole picture as the camera sees it. */
export function throughCamera(camera: ViewCamera, extent: Extent, aspect: number): Viewpoint {
  const position = new Vector3(...camera.eye);
  const toPlane = imageCenter(camera).sub(position);
  const distance = toPlane.length();
  const [leftBottom, rightBottom, leftTop] = camera.corners.map((corner) => new Vector3(...corner)) as [Vector3, Vector3, Vector3];
  const height = Math.max(leftTop.distanceTo(leftBottom), rightBottom.distanceTo(leftBottom) / aspect);
  const forward = toPlane.normalize();
  const depth = Math.max(distance, bounds(extent.things).center.sub(position).dot(forward));
  return { position, target: position.clone().addScaledVector(forward, depth), fov: angle((PICTURE_MARGIN * height) / 2 / distance) };
}

/** All objects as the light sees them. */
export function fromLight(light: ViewLight, camera: ViewCamera, extent: Extent, aspect: number): Viewpoint {
  const up = new Vector3(...camera.up).normalize();
  if (light.position === null) return fitted(new Vector3(...light.direction!).normalize(), up, extent.things, aspect);
  const position = new Vector3(...light.position);
  const target = bounds(extent.things).center;
  const { right, top, back } = axes(position.clone().sub(target).normalize(), up);
  const slope = largest(extent.things, ({ center, radius }) => {
    const to = center.clone().sub(position);
    const depth = -to.dot(back);
    const size = Math.max((Math.abs(to.dot(right)) + radius) / aspect, Math.abs(to.dot(top)) + radius);
    return depth > radius ? size / depth : Infinity;
  });
  // Beyond this, spheres at the sides would be stretched to eggs.
  return { position, target, fov: MathUtils.clamp(angle(MARGIN * slope), 5, 70) };
}

/** Looks from the given direction at the middle of all spheres, so far away that all of them are seen. */
function fitted(direction: Vector3, up: Vector3, spheres: Sphere[], aspect: number): Viewpoint {
  const { right, top, back } = axes(direction, up);
  const target = new Vector3();
  for (const axis of [right, top, back]) {
    const low = largest(spheres, ({ center, radius }) => radius - center.dot(axis));
    const high = largest(spheres, ({ center, radius }) => radius + center.dot(axis));
    target.addScaledVector(axis, (high - low) / 2);
  }
  const slope = Math.tan(MathUtils.degToRad(FOV / 2));
  const distance = largest(spheres, ({ center, radius }) => {
    const to = center.clone().sub(target);
    const size = Math.max((Math.abs(to.dot(right)) + radius) / aspect, Math.abs(to.dot(top)) + radius);
    return to.dot(back) + (MARGIN * size) / slope;
  });
  return { position: target.clone().addScaledVector(direction, distance), target, fov: FOV };
}

function largest(spheres: Sphere[], value: (sphere: Sphere) => number): number {
  return spheres.reduce((most, sphere) => Math.max(most, value(sphere)), -Infinity);
}

/** Of a view that looks along `−back`; any right will do where up and back are the same. */
function axes(back: Vector3, up: Vector3): { right: Vector3; top: Vector3; back: Vector3 } {
  const right = new Vector3().crossVectors(up, back);
  if (right.lengthSq() < 1e-8) right.crossVectors(new Vector3(up.y, up.z, up.x), back);
  right.normalize();
  return { right, top: new Vector3().crossVectors(back, right), back };
}

export function imageCenter(camera: ViewCamera): Vector3 {
  return camera.corners.reduce((sum, corner) => sum.add(new Vector3(...corner)), new Vector3()).divideScalar(4);
}

/** Whole angle of view in degrees, from half the height at distance 1. */
function angle(slope: number): number {
  return MathUtils.radToDeg(2 * Math.atan(slope));
}
