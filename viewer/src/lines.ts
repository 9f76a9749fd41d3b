/** Where the lines of a ray begin and end. */

import type { RayNode, Vec3 } from './data';

/** A straight line of the drawing. */
export interface Line {
  from: Vec3;
  to: Vec3;
  /** Does it go on, and should fade? */
  open: boolean;
}

export interface ShadowLine extends Line {
  /** Does something stand between the surface and the light? */
  blocked: boolean;
}

/** `reach` is how far a line is drawn that ends nowhere. */
export function rayLine(node: RayNode, reach: number): Line {
  if (node.hit !== null) return { from: node.origin, to: node.hit.point, open: false };
  // A ray that was not followed is a stub: nobody knows where it ends.
  const length = node.ended === 'missed' ? reach : reach / 4;
  return { from: node.origin, to: along(node.origin, node.dir, length), open: true };
}

/**
 * From where a ray met something to where the next one starts, if that is elsewhere: the lecture's model goes through a ball in
 * one step, and a thin pane shifts what goes through.
 */
export function stepLine(parent: RayNode, node: RayNode): Line | null {
  if (parent.hit === null) return null;
  const from = parent.hit.point;
  const step = Math.hypot(...from.map((x, axis) => x - node.origin[axis]!));
  // Further away than rounding, whatever the scale of the scene.
  return step > 1e-6 * Math.max(...from.map(Math.abs), parent.hit.t) ? { from, to: node.origin, open: false } : null;
}

/** From the end of a ray to the lights that its surface faces, or to what blocks them. */
export function shadowLines(node: RayNode, reach: number): ShadowLine[] {
  const { hit, local } = node;
  if (hit === null || local === null) return [];
  return local.lights.filter((light) => light.facing).map((light) => {
    const blocked = light.blocked_by !== null;
    if (light.block_point !== null) return { from: hit.point, to: light.block_point, open: false, blocked };
    if (light.at_infinity) return { from: hit.point, to: along(hit.point, light.point, reach), open: true, blocked };
    return { from: hit.point, to: light.point, open: false, blocked };
  });
}

export function dot(a: Vec3, b: Vec3): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

export function along(origin: Vec3, dir: Vec3, length: number): Vec3 {
  return [origin[0] + length * dir[0], origin[1] + length * dir[1], origin[2] + length * dir[2]];
}

/** Pixels. The square root keeps rays apart that carry a hundredth and a thousandth. */
export function lineWidth(share: number): number {
  return 1.2 + 3 * Math.sqrt(share);
}

export function lineOpacity(share: number): number {
  return 0.4 + 0.6 * Math.sqrt(share);
}
