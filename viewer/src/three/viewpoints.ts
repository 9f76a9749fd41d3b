/** From where the scene is looked at. */

import { MathUtils, Vector3 } from 'three';
import type { ViewCamera, ViewLight } from '../data';
import type { Extent } from './extent';

export interface Viewpoint {
  position: Vector3;
  /** What the view turns about. */
  target: Vector3;
  /** Vertical angle of view in degrees. */
  fov: number;
}

const FOV = 30;

/** From the side and a little above, so that the camera, the rays and the objects stand beside each other. */
export function overview(camera: ViewCamera, extent: Extent, aspect: number): Viewpoint {
  const up = new Vector3(...camera.up).normalize();
  const forward = imageCenter(camera).sub(new Vector3(...camera.eye)).normalize();
  const right = new Vector3().crossVectors(forward, up).normalize();
  const direction = right.clone().multiplyScalar(0.92).addScaledVector(up, 0.42).addScaledVector(forward, -0.34).normalize();
  return fitted(direction, up, extent, aspect);
}

/** The whole picture as the camera sees it. */
export function throughCamera(camera: ViewCamera, extent: Extent, aspect: number): Viewpoint {
  const position = new Vector3(...camera.eye);
  const toPlane = imageCenter(camera).sub(position);
  const distance = toPlane.length();
  const [leftBottom, rightBottom, leftTop] = camera.corners.map((corner) => new Vector3(...corner)) as [Vector3, Vector3, Vector3];
  const height = Math.max(leftTop.distanceTo(leftBottom), rightBottom.distanceTo(leftBottom) / aspect);
  const forward = toPlane.normalize();
  const depth = Math.max(distance, extent.center.clone().sub(position).dot(forward));
  const target = position.clone().addScaledVector(forward, depth);
  // A little more than the picture, so that its frame is seen.
  return { position, target, fov: angle(1.08 * height, distance) };
}

/** Everything, as the light sees it. */
export function fromLight(light: ViewLight, camera: ViewCamera, extent: Extent, aspect: number): Viewpoint {
  if (light.position === null) {
    return fitted(new Vector3(...light.direction!).normalize(), new Vector3(...camera.up).normalize(), extent, aspect);
  }
  const position = new Vector3(...light.position);
  const distance = position.distanceTo(extent.center);
  const fov = MathUtils.clamp(angle(1.4 * extent.radius, distance), 15, 75);
  return { position, target: extent.center.clone(), fov };
}

/** So far away in the given direction that the whole box is seen. */
function fitted(direction: Vector3, up: Vector3, extent: Extent, aspect: number): Viewpoint {
  const right = new Vector3().crossVectors(up, direction).normalize();
  const top = new Vector3().crossVectors(direction, right);
  const slope = Math.tan(MathUtils.degToRad(FOV / 2));
  const { min, max } = extent.box;
  let distance = 0;
  for (let corner = 0; corner < 8; corner++) {
    const point = new Vector3(corner & 1 ? max.x : min.x, corner & 2 ? max.y : min.y, corner & 4 ? max.z : min.z).sub(extent.center);
    const sideways = Math.max(Math.abs(point.dot(right)) / aspect, Math.abs(point.dot(top)));
    distance = Math.max(distance, point.dot(direction) + (1.08 * sideways) / slope);
  }
  return { position: extent.center.clone().addScaledVector(direction, distance), target: extent.center.clone(), fov: FOV };
}

function imageCenter(camera: ViewCamera): Vector3 {
  return camera.corners.reduce((sum, corner) => sum.add(new Vector3(...corner)), new Vector3()).divideScalar(4);
}

function angle(height: number, distance: number): number {
  return MathUtils.radToDeg(2 * Math.atan2(height / 2, distance));
}
