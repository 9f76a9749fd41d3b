/** What a selected object is drawn with: its outline, and the handles it is dragged by, of a size in pixels. */

import { type PerspectiveCamera, Vector3 } from 'three';
import type { Vec3, ViewScene } from '../data';
import type { Handles, ObjectRef } from '../editing';
import type { Line } from '../lines';
import type { Theme } from '../theme';
import type { Grip } from './drag';
import { boxOf } from './extent';
import type { DrawnLine } from './line-set';
import type { Mark } from './marks';

export interface Handle {
  grip: Grip;
  lines: Line[];
  color: string;
}

const AXES: Vec3[] = [[1, 0, 0], [0, 1, 0], [0, 0, 1]];
/** Pixels, of an arrow and of the radius of a ring. */
const LENGTH = 84;
/** Of the length: between the handles, the object itself can be taken hold of. */
const START = 0.25;
/** Cosine from which on an axis is seen too much from its end, or a ring from its side. */
const END_ON = 0.97;
const EDGE_ON = 0.12;
const SEGMENTS = 64;

/** An object where it is, and from where it is looked at. */
export interface Seen {
  object: ObjectRef;
  at: Vector3;
  scene: ViewScene;
  camera: PerspectiveCamera;
  theme: Theme;
}

interface Marked {
  lines: DrawnLine[];
  marks: Mark[];
}

/** Handles that can be seen and taken hold of. `pixel` is the length of one where the object is. */
export function handlesFor({ object, at, scene, camera, theme }: Seen, mode: Handles, pixel: number): Handle[] {
  const sight = at.clone().sub(camera.position).normalize();
  const length = LENGTH * pixel;
  const axes = AXES.map((axis, index) => ({ axis, color: theme.axes[index]!, slant: Math.abs(sight.dot(new Vector3(...axis))) }));
  const distant = object.kind === 'light' && scene.lights[object.index]?.position === null;
  const along = axes.filter(({ slant }) => slant < END_ON);
  if (mode === 'move') {
    // What is infinitely far away has no place.
    return distant ? [] : along.map(({ axis, color }) => ({ grip: { do: 'move', axis }, color, lines: arrow(at, axis, length, sight) }));
  }
  if (mode === 'turn') {
    // A sphere looks the same from all sides.
    if (object.kind !== 'mesh' && !distant) return [];
    const open = axes.filter(({ slant }) => slant > EDGE_ON);
    return open.map(({ axis, color }) => ({ grip: { do: 'turn', axis }, color, lines: ring(at, new Vector3(...axis), length) }));
  }
  if (object.kind === 'light' || object.kind === 'camera') return [];
  const whole: Handle = { grip: { do: 'scale', axis: null }, color: theme.accent, lines: ring(at, sight, 1.2 * length) };
  if (object.kind === 'sphere') return [whole];
  return [whole, ...along.map(({ axis, color }): Handle => ({ grip: { do: 'scale', axis }, color, lines: [rod(at, axis, length)] }))];
}

export function drawnHandle({ grip, lines, color }: Handle, hovered: boolean): Marked {
  const width = hovered ? 4.5 : 2.6;
  const knob = grip.do === 'scale' && grip.axis !== null;
  return {
    lines: lines.map((line) => ({ ...line, color, width, opacity: 1 })),
    marks: knob ? [{ at: lines[0]!.to, color, size: hovered ? 14 : 11, opacity: 1 }] : [],
  };
}

/** The outline of a sphere as it is seen, the box around a mesh, or a ring around a mark. */
export function outline({ object, at, scene, camera, theme }: Seen): Marked {
  const look = { color: theme.accent, width: 2.4, opacity: 0.95 };
  const drawn = (lines: Line[]) => ({ lines: lines.map((line): DrawnLine => ({ ...line, ...look })), marks: [] });
  if (object.kind === 'sphere') {
    const { radius } = scene.spheres[object.index]!;
    const sight = at.clone().sub(camera.position);
    const distance = sight.length();
    // Seen from within, it has none.
    if (distance <= radius) return drawn([]);
    const part = radius / distance;
    return drawn(ring(at.clone().addScaledVector(sight, -part * part), sight.normalize(), radius * Math.sqrt(1 - part * part)));
  }
  if (object.kind === 'mesh') return drawn(boxEdges(scene, object.index));
  const size = object.kind === 'light' ? 38 : 18;
  return { lines: [], marks: [{ at: at.toArray(), color: theme.accent, size, opacity: 1, shape: 'ring' }] };
}

/** From the camera's eye to what it looks at. */
export function axis(eye: Vec3, target: Vec3, theme: Theme): Marked {
  return {
    lines: [{ from: eye, to: target, open: false, color: theme.accent, width: 1.4, opacity: 0.8, dashed: true }],
    marks: [{ at: target, color: theme.accent, size: 8, opacity: 1 }],
  };
}

function boxEdges(scene: ViewScene, index: number): Line[] {
  const { min, max } = boxOf(scene.meshes[index]!);
  const corner = (n: number): Vec3 => [n & 1 ? max.x : min.x, n & 2 ? max.y : min.y, n & 4 ? max.z : min.z];
  const all = [0, 1, 2, 3, 4, 5, 6, 7];
  const edge = (n: number, bit: number): Line => ({ from: corner(n), to: corner(n | bit), open: false });
  return [1, 2, 4].flatMap((bit) => all.filter((n) => (n & bit) === 0).map((n) => edge(n, bit)));
}

function rod(at: Vector3, axis: Vec3, length: number): Line {
  const point = (part: number) => at.clone().addScaledVector(new Vector3(...axis), part * length).toArray();
  return { from: point(START), to: point(1), open: false };
}

function arrow(at: Vector3, axis: Vec3, length: number, sight: Vector3): Line[] {
  const shaft = rod(at, axis, length);
  const direction = new Vector3(...axis);
  const side = new Vector3().crossVectors(direction, sight).normalize();
  const barb = (turn: number): Line => {
    const to = new Vector3(...shaft.to).addScaledVector(direction, -0.16 * length).addScaledVector(side, 0.09 * turn * length);
    return { from: shaft.to, to: to.toArray(), open: false };
  };
  return [shaft, barb(1), barb(-1)];
}

function ring(at: Vector3, axis: Vector3, radius: number): Line[] {
  const first = new Vector3(axis.y, axis.z, axis.x).cross(axis);
  if (first.lengthSq() < 1e-6) first.set(1, -1, 0).cross(axis);
  first.setLength(radius);
  const second = new Vector3().crossVectors(axis, first).setLength(radius);
  const point = (step: number): Vec3 => {
    const angle = (2 * Math.PI * step) / SEGMENTS;
    return at.clone().addScaledVector(first, Math.cos(angle)).addScaledVector(second, Math.sin(angle)).toArray();
  };
  return Array.from({ length: SEGMENTS }, (_, step) => ({ from: point(step), to: point(step + 1), open: false }));
}
