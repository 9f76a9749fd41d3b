/** The figure of refraction at the end of a ray: the normal, and the angles to it before and behind the surface. */

import type { RayNode, Vec3 } from './data';
import { along, dot, type Line } from './lines';
import { degrees } from './words';

export interface Arc {
  /** From the normal to the ray; empty where the ray is the normal. */
  points: Vec3[];
  /** Where its text stands. */
  at: Vec3;
  text: string;
}

export interface Figure {
  normal: Line;
  arcs: Arc[];
}

/** Of the normal, in radii of the arcs. */
const NORMAL = 1.7;
const TEXT = 1.4;
const STEPS = 16;
/** Degrees; less cannot be seen. */
const STRAIGHT = 0.5;

/** `reflected` is whether light goes on before the surface. Lies in the plane of the ray and the normal. */
export function figureOf({ dir, hit }: RayNode, reflected: boolean, radius: number): Figure | null {
  if (hit === null) return null;
  const { point, normal, angle_in, angle_out, total_reflection } = hit;
  const sideways = tangent(dir, normal);
  const arc = (angle: number, up: 1 | -1, side: 1 | -1, text: string): Arc => {
    const place = (part: number, size: number): Vec3 => {
      const turn = (part * angle * Math.PI) / 180;
      return along(along(point, normal, up * size * Math.cos(turn)), sideways, side * size * Math.sin(turn));
    };
    const steps = angle < STRAIGHT ? [] : Array.from({ length: STEPS + 1 }, (_, step) => step / STEPS);
    return { points: steps.map((part) => place(part, radius)), at: place(0.5, TEXT * radius), text };
  };
  const text = (angle: number) => degrees(Number(angle.toFixed(1)));
  return {
    normal: {
      from: along(point, normal, angle_out === null ? 0 : -NORMAL * radius),
      to: along(point, normal, NORMAL * radius),
      open: false,
    },
    arcs: [
      arc(angle_in, 1, 1, text(angle_in)),
      ...(total_reflection ? [arc(angle_in, 1, -1, `${text(angle_in)}, total reflection`)] : []),
      ...(reflected && !total_reflection ? [arc(angle_in, 1, -1, text(angle_in))] : []),
      ...(angle_out === null ? [] : [arc(angle_out, -1, -1, text(angle_out))]),
    ],
  };
}

/** Along the surface, to the side that the ray comes from. */
function tangent(dir: Vec3, normal: Vec3): Vec3 {
  const cos = -dot(dir, normal);
  const side = dir.map((value, axis) => -value - cos * normal[axis]!) as Vec3;
  const length = Math.hypot(...side);
  return length > 0 ? (side.map((value) => value / length) as Vec3) : [0, 0, 0];
}
