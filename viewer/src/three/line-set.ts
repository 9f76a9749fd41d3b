/**
 * Lines of a width in pixels, with soft edges, dashes, open ends that fade, and a small arrow head in the middle.
 * WebGL itself only knows lines of one pixel. Each line is one instance: a rectangle and a triangle.
 */

import {
  type BufferGeometry,
  Color,
  Float32BufferAttribute,
  GreaterDepth,
  Group,
  InstancedBufferAttribute,
  InstancedBufferGeometry,
  LessEqualDepth,
  Mesh,
  ShaderMaterial,
  Vector2,
} from 'three';
import type { Line } from '../lines';

export interface DrawnLine extends Line {
  color: string;
  width: number;
  opacity: number;
  dashed?: boolean;
  arrow?: boolean;
}

/** Shared by all that has a size in pixels. */
export interface ScreenUniforms {
  /** Of the drawing, in pixels of CSS. */
  size: { value: Vector2 };
  /** Pixels of the screen for each pixel of CSS. */
  ratio: { value: number };
  /** Distance of the near plane. */
  near: { value: number };
}

/** What is behind an opaque object is not hidden, only faint, as in a technical drawing. */
const BEHIND = 0.16;

const VERTEX = /* glsl */ `
uniform vec2 size;
uniform float near;
attribute vec3 from;
attribute vec3 to;
attribute vec3 tint;
attribute vec4 look; // width, opacity at the start, opacity at the end, 1: dashed, 2: arrow
varying vec4 vColor;
varying vec3 vAcross; // distance from the middle, half width; both times w, and w
varying float vAlong;

void main() {
  vec4 a = modelViewMatrix * vec4(from, 1.0);
  vec4 b = modelViewMatrix * vec4(to, 1.0);
  // What lies behind the eye has no place on the screen.
  if (a.z > -near && b.z > -near) { gl_Position = vec4(0.0, 0.0, 2.0, 1.0); return; }
  if (a.z > -near) a = mix(b, a, (-near - b.z) / (a.z - b.z));
  if (b.z > -near) b = mix(a, b, (-near - a.z) / (b.z - a.z));
  vec4 start = projectionMatrix * a;
  vec4 end = projectionMatrix * b;
  vec2 way = (end.xy / end.w - start.xy / start.w) * 0.5 * size;
  float reach = length(way);
  vec2 dir = reach > 1e-3 ? way / reach : vec2(1.0, 0.0);
  vec2 side = vec2(-dir.y, dir.x);
  float half_width = 0.5 * look.x;
  vec4 place;
  vec2 offset;
  if (position.z == 0.0) {
    place = position.x == 0.0 ? start : end;
    offset = side * position.y * (half_width + 1.0);
    vAcross = vec3(position.y * (half_width + 1.0), half_width, 1.0) * place.w;
  } else {
    place = projectionMatrix * mix(a, b, 0.5);
    float head = look.w == 2.0 && reach > 40.0 ? 3.6 + 0.7 * look.x : 0.0;
    offset = dir * position.x * 1.3 * head + side * position.y * head;
    vAcross = vec3(0.0, 2.0, 1.0) * place.w;
  }
  vAlong = look.w == 1.0 ? position.x * reach * place.w : -1.0;
  float opacity = position.z == 0.0 ? mix(look.y, look.z, position.x) : 0.5 * (look.y + look.z);
  vColor = vec4(tint, opacity);
  gl_Position = place + vec4(offset / (0.5 * size) * place.w, 0.0, 0.0);
}`;

const FRAGMENT = /* glsl */ `
uniform float strength;
varying vec4 vColor;
varying vec3 vAcross;
varying float vAlong;

void main() {
  vec2 across = vAcross.xy / vAcross.z;
  float alpha = vColor.a * strength * (1.0 - smoothstep(across.y - 0.5, across.y + 0.7, abs(across.x)));
  if (vAlong > -0.5) {
    float dash = mod(vAlong / vAcross.z, 10.0);
    alpha *= smoothstep(0.0, 1.0, dash) * (1.0 - smoothstep(5.0, 6.0, dash));
  }
  gl_FragColor = vec4(vColor.rgb, alpha);
}`;

/** x along the line, y across it, z: of the arrow head. */
const CORNERS = [0, -1, 0, 1, -1, 0, 1, 1, 0, 0, 1, 0, 1, 0, 1, -1, 1, 1, -1, -1, 1];
const TRIANGLES = [0, 1, 2, 0, 2, 3, 4, 5, 6];

/** Columns of numbers, one row for each line: their names and widths. */
const COLUMNS = [['from', 3], ['to', 3], ['tint', 3], ['look', 4]] as const;

export class LineSet {
  readonly group = new Group();
  private geometry = new InstancedBufferGeometry();
  /** Lines that there is room for: sets change with each frame, and rooms do not. */
  private room = 0;

  /**
   * `order` is the place among translucent things: by default over all surfaces. `behind` is how much is seen of what is behind
   * an opaque object.
   */
  constructor(uniforms: ScreenUniforms, order = 10, behind = BEHIND) {
    for (const hidden of [true, false]) {
      const material = new ShaderMaterial({
        vertexShader: VERTEX,
        fragmentShader: FRAGMENT,
        uniforms: { ...uniforms, strength: { value: hidden ? behind : 1 } },
        transparent: true,
        depthWrite: false,
        depthFunc: hidden ? GreaterDepth : LessEqualDepth,
      });
      const mesh = new Mesh(this.geometry, material);
      mesh.frustumCulled = false;
      mesh.renderOrder = order;
      mesh.visible = false;
      this.group.add(mesh);
    }
  }

  /** Later lines are drawn over earlier ones. */
  set(lines: DrawnLine[]): void {
    if (lines.length > this.room) this.makeRoom(Math.max(64, 2 * lines.length));
    this.geometry.instanceCount = lines.length;
    for (const mesh of this.meshes()) mesh.visible = lines.length > 0;
    if (lines.length === 0) return;
    const [from, to, tint, look] = COLUMNS.map(([name]) => this.geometry.getAttribute(name)) as [Column, Column, Column, Column];
    lines.forEach((line, row) => {
      const { width, opacity, open, dashed, arrow } = line;
      from.array.set(line.from, 3 * row);
      to.array.set(line.to, 3 * row);
      tint.array.set(screenColor(line.color), 3 * row);
      look.array.set([width, opacity, open ? 0 : opacity, dashed ? 1 : arrow ? 2 : 0], 4 * row);
    });
    for (const column of [from, to, tint, look]) {
      column.clearUpdateRanges();
      column.addUpdateRange(0, lines.length * column.itemSize);
      column.needsUpdate = true;
    }
  }

  dispose(): void {
    this.geometry.dispose();
    for (const mesh of this.meshes()) mesh.material.dispose();
  }

  private makeRoom(room: number): void {
    const geometry = new InstancedBufferGeometry();
    geometry.setAttribute('position', new Float32BufferAttribute(CORNERS, 3));
    geometry.setIndex(TRIANGLES);
    for (const [name, width] of COLUMNS) geometry.setAttribute(name, new InstancedBufferAttribute(new Float32Array(width * room), width));
    this.geometry.dispose();
    this.geometry = geometry;
    this.room = room;
    for (const mesh of this.meshes()) mesh.geometry = geometry;
  }

  private meshes(): Mesh<BufferGeometry, ShaderMaterial>[] {
    return this.group.children as Mesh<BufferGeometry, ShaderMaterial>[];
  }
}

type Column = InstancedBufferAttribute & { array: Float32Array };

const parsed = new Map<string, [number, number, number]>();

/** The shaders here write the colours of the screen themselves, without the linear detour of three.js. */
export function screenColor(css: string): [number, number, number] {
  let color = parsed.get(css);
  if (color === undefined) {
    const { r, g, b } = new Color().setStyle(css).convertLinearToSRGB();
    parsed.set(css, (color = [r, g, b]));
  }
  return color;
}
