/** From the way of a pointer over the drawing to how an object moves, turns or grows. */

import { MathUtils, Plane, type Ray, Vector3 } from 'three';
import type { Vec3 } from '../data';
import { type Change, snapped } from '../editing';

/** What is dragged: the object itself, freely in the plane of the screen, or a handle along or about an axis. */
export type Grip =
  | { do: 'move'; axis: Vec3 | null }
  | { do: 'turn'; axis: Vec3 }
  | { do: 'scale'; axis: Vec3 | null };

const TURN_STEP = 15;
const SCALE_STEP = 0.1;
/** An object must not vanish. */
const SMALLEST = 0.01;

export class Drag {
  private readonly start: Vector3;
  /** Of a turn, which may be more than a whole one. */
  private degrees = 0;
  private last: Vector3;

  /** `start` is the line of sight where it begins, `forward` the direction of view. */
  constructor(
    readonly grip: Grip,
    readonly center: Vector3,
    start: Ray,
    private readonly forward: Vector3,
  ) {
    this.start = this.last = this.place(start) ?? center.clone();
  }

  /** `snap` is the length that moves are multiples of. */
  change(ray: Ray, snap: number | null): Change {
    const { grip } = this;
    // Where the line of sight meets nothing, it stays as it is.
    const place = this.place(ray) ?? this.last;
    const [from, to] = [this.start, place].map((at) => at.clone().sub(this.center)) as [Vector3, Vector3];
    switch (grip.do) {
      case 'move': {
        if (grip.axis === null) return { kind: 'move', by: to.sub(from).toArray().map((value) => snapped(value, snap)) as Vec3 };
        const axis = new Vector3(...grip.axis);
        const by = snapped(to.sub(from).dot(axis), snap);
        return { kind: 'move', by: grip.axis.map((part) => by * part) as Vec3 };
      }
      case 'turn':
        this.degrees += signedAngle(this.last.clone().sub(this.center), to, new Vector3(...grip.axis));
        this.last = place;
        return { kind: 'turn', axis: grip.axis, degrees: snapped(this.degrees, snap === null ? null : TURN_STEP) };
      case 'scale': {
        const axis = grip.axis && new Vector3(...grip.axis);
        const ratio = axis ? to.dot(axis) / from.dot(axis) : to.length() / from.length();
        const by = Math.max(SMALLEST, snapped(Number.isFinite(ratio) ? ratio : 1, snap === null ? null : SCALE_STEP));
        return { kind: 'scale', by: grip.axis === null ? by : (grip.axis.map((part) => (part === 0 ? 1 : by)) as Vec3) };
      }
    }
  }

  /** The point under the pointer that counts: in the plane of the screen, in that of the ring, or in that which shows the axis best. */
  private place(ray: Ray): Vector3 | null {
    const { grip, center } = this;
    const axis = grip.axis && new Vector3(...grip.axis);
    const normal = axis === null ? this.forward : grip.do === 'turn' ? axis : this.forward.clone().projectOnPlane(axis);
    if (normal.lengthSq() < 1e-6) return null;
    return ray.intersectPlane(new Plane().setFromNormalAndCoplanarPoint(normal.clone().normalize(), center), new Vector3());
  }
}

/** Degrees from −180 to 180, counter-clockwise when the axis points at the eye. */
function signedAngle(from: Vector3, to: Vector3, axis: Vector3): number {
  return MathUtils.radToDeg(Math.atan2(new Vector3().crossVectors(from, to).dot(axis), from.dot(to)));
}
