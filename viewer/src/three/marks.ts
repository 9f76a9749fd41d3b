/** Dots where rays end, lamps, and the frame of a pixel: marks of a size in pixels. */

import { BufferAttribute, BufferGeometry, Points, ShaderMaterial } from 'three';
import type { Vec3 } from '../data';
import { screenColor, type ScreenUniforms } from './line-set';

export interface Mark {
  at: Vec3;
  color: string;
  /** Diameter in pixels. */
  size: number;
  opacity: number;
  /** A dot unless it is said. */
  shape?: 'lamp' | 'frame' | 'ring';
}

const SHAPES = ['dot', 'lamp', 'frame', 'ring'];

const VERTEX = /* glsl */ `
uniform float ratio;
attribute vec3 tint;
attribute vec3 look; // size, opacity, place among the shapes
varying vec4 vColor;
varying vec2 vShape;

void main() {
  gl_Position = projectionMatrix * modelViewMatrix * vec4(position, 1.0);
  gl_PointSize = (look.x + 2.0) * ratio;
  vColor = vec4(tint, look.y);
  vShape = vec2(look.x, look.z);
}`;

const FRAGMENT = /* glsl */ `
varying vec4 vColor;
varying vec2 vShape;

void main() {
  vec2 place = (gl_PointCoord - 0.5) * (vShape.x + 2.0);
  float far = length(place);
  float radius = 0.5 * vShape.x;
  float alpha = 1.0 - smoothstep(radius - 0.5, radius + 0.5, far);
  vec3 tint = vColor.rgb;
  if (vShape.y > 2.5) {
    alpha *= smoothstep(radius - 2.5, radius - 1.5, far);
  } else if (vShape.y > 1.5) {
    // A square in the colour between two dark ones: seen on every picture.
    float inwards = radius - max(abs(place.x), abs(place.y));
    tint *= smoothstep(0.6, 1.4, inwards) * (1.0 - smoothstep(2.6, 3.4, inwards));
    alpha = smoothstep(-0.5, 0.5, inwards) * (1.0 - smoothstep(3.5, 4.5, inwards));
  } else if (vShape.y > 0.5) {
    // A disc, eight short strokes around it, and a glow.
    float turn = 0.7853981634;
    float angle = mod(atan(place.y, place.x) + 0.5 * turn, turn) - 0.5 * turn;
    float across = abs(far * sin(angle));
    float between = smoothstep(0.52 * radius, 0.58 * radius, far) * (1.0 - smoothstep(0.84 * radius, 0.9 * radius, far));
    float strokes = between * (1.0 - smoothstep(0.6, 1.4, across));
    float disc = 1.0 - smoothstep(0.36 * radius - 0.5, 0.36 * radius + 0.5, far);
    float glow = 0.4 * pow(max(0.0, 1.0 - far / radius), 1.5);
    alpha = max(max(disc, strokes), glow);
  }
  gl_FragColor = vec4(tint, vColor.a * alpha);
}`;

const COLUMNS = ['position', 'tint', 'look'];

export class MarkSet {
  readonly points: Points<BufferGeometry, ShaderMaterial>;
  /** Marks that there is room for. */
  private room = 0;

  constructor(uniforms: ScreenUniforms) {
    const material = new ShaderMaterial({
      vertexShader: VERTEX,
      fragmentShader: FRAGMENT,
      uniforms: { ...uniforms },
      transparent: true,
      depthWrite: false,
      // A dot on a surface would be cut in half by it.
      depthTest: false,
    });
    this.points = new Points(new BufferGeometry(), material);
    this.points.frustumCulled = false;
    this.points.renderOrder = 11;
    this.points.visible = false;
  }

  set(marks: Mark[]): void {
    if (marks.length > this.room) this.makeRoom(Math.max(16, 2 * marks.length));
    const { geometry } = this.points;
    geometry.setDrawRange(0, marks.length);
    this.points.visible = marks.length > 0;
    if (marks.length === 0) return;
    const columns = COLUMNS.map((name) => geometry.getAttribute(name)) as [BufferAttribute, BufferAttribute, BufferAttribute];
    const [position, tint, look] = columns;
    marks.forEach(({ at, color, size, opacity, shape }, row) => {
      position.array.set(at, 3 * row);
      tint.array.set(screenColor(color), 3 * row);
      look.array.set([size, opacity, SHAPES.indexOf(shape ?? 'dot')], 3 * row);
    });
    for (const column of columns) column.needsUpdate = true;
  }

  dispose(): void {
    this.points.geometry.dispose();
    this.points.material.dispose();
  }

  private makeRoom(room: number): void {
    const geometry = new BufferGeometry();
    for (const name of COLUMNS) geometry.setAttribute(name, new BufferAttribute(new Float32Array(3 * room), 3));
    this.points.geometry.dispose();
    this.points.geometry = geometry;
    this.room = room;
  }
}
