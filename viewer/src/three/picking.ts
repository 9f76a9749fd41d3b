/** Which line is under the pointer: distances on the screen, since lines have no thickness in the scene. */

import { type Matrix4, Vector3, Vector4 } from 'three';
import type { Line } from '../lines';

/** Pixels, of an unsteady hand and of a finger. */
const TOLERANCE = 8;
export const FINGER = 22;

export interface PickedLine extends Line {
  id: number;
}

/** The line nearest to a point, in pixels from the top left corner; among equals the last. */
export function pick(
  lines: PickedLine[],
  x: number,
  y: number,
  projection: Matrix4,
  width: number,
  height: number,
  tolerance = TOLERANCE,
): number | null {
  let found: number | null = null;
  let least = tolerance;
  for (const line of lines) {
    const distance = screenDistance(line, x, y, projection, width, height);
    if (distance <= least) [found, least] = [line.id, distance];
  }
  return found;
}

function screenDistance(line: Line, x: number, y: number, projection: Matrix4, width: number, height: number): number {
  const [a, b] = [line.from, line.to].map((point) => new Vector4(...point, 1).applyMatrix4(projection)) as [Vector4, Vector4];
  if (!beforeEye(a, b)) return Infinity;
  const [start, end] = [a, b].map(({ x, y, w }) => new Vector3(((x / w + 1) * width) / 2, ((1 - y / w) * height) / 2)) as [Vector3, Vector3];
  const way = end.clone().sub(start);
  const to = new Vector3(x, y).sub(start);
  const part = way.lengthSq() > 0 ? Math.min(1, Math.max(0, to.dot(way) / way.lengthSq())) : 0;
  return to.distanceTo(way.multiplyScalar(part));
}

/** Cuts off what lies behind the eye, where z < −w; false if nothing is left. */
function beforeEye(a: Vector4, b: Vector4): boolean {
  const [da, db] = [a.z + a.w, b.z + b.w];
  if (da <= 0 && db <= 0) return false;
  if (da <= 0) a.lerp(b, -da / (db - da));
  if (db <= 0) b.lerp(a, -db / (da - db));
  return true;
}
