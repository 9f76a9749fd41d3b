/** Moves the eye from one viewpoint to another, around what is looked at instead of through it. */

import { MathUtils, PerspectiveCamera, Quaternion, Spherical, Vector3 } from 'three';
import type { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import type { Viewpoint } from './viewpoints';

const MILLISECONDS = 700;
/** Straight above, left and right would be undefined. */
const POLE = 1e-3;

export class Flight {
  private step: ((part: number) => void) | null = null;
  private started = 0;
  /** To the space in which up is y, where spherical coordinates live. */
  private readonly toY: Quaternion;
  private readonly fromY: Quaternion;

  constructor(
    private readonly camera: PerspectiveCamera,
    private readonly controls: OrbitControls,
  ) {
    this.toY = new Quaternion().setFromUnitVectors(camera.up, new Vector3(0, 1, 0));
    this.fromY = this.toY.clone().invert();
  }

  /** Is there more to come? */
  get flying(): boolean {
    return this.step !== null;
  }

  jump(view: Viewpoint): void {
    this.step = null;
    this.place(view.target, this.spherical(view.position, view.target), view.fov);
  }

  start(view: Viewpoint, now: number): void {
    const target = this.controls.target.clone();
    const from = this.spherical(this.camera.position, target);
    const to = this.spherical(view.position, view.target);
    const turn = MathUtils.euclideanModulo(to.theta - from.theta + Math.PI, 2 * Math.PI) - Math.PI;
    const fov = this.camera.fov;
    this.started = now;
    this.step = (part) => {
      const radius = from.radius * (to.radius / from.radius) ** part;
      const at = new Spherical(radius, MathUtils.lerp(from.phi, to.phi, part), from.theta + part * turn);
      this.place(target.clone().lerp(view.target, part), at, MathUtils.lerp(fov, view.fov, part));
    };
  }

  /** One frame of the flight. */
  advance(now: number): void {
    const part = Math.min(1, (now - this.started) / MILLISECONDS);
    this.step?.(MathUtils.smootherstep(part, 0, 1));
    if (part === 1) this.step = null;
  }

  stop(): void {
    this.step = null;
  }

  /** Turns by angles in radians, and goes `zoom` times as far away. */
  turn(sideways: number, down: number, zoom: number): void {
    const at = this.spherical(this.camera.position, this.controls.target);
    at.set(at.radius * zoom, MathUtils.clamp(at.phi + down, POLE, Math.PI - POLE), at.theta + sideways);
    this.place(this.controls.target.clone(), at, this.camera.fov);
  }

  private spherical(position: Vector3, target: Vector3): Spherical {
    const offset = position.clone().sub(target).applyQuaternion(this.toY);
    const at = new Spherical().setFromVector3(offset);
    at.phi = MathUtils.clamp(at.phi, POLE, Math.PI - POLE);
    return at;
  }

  private place(target: Vector3, at: Spherical, fov: number): void {
    this.controls.target.copy(target);
    this.camera.position.setFromSpherical(at).applyQuaternion(this.fromY).add(target);
    this.camera.fov = fov;
    this.camera.updateProjectionMatrix();
    this.controls.update();
  }
}
