/** The names of objects, lights and the camera, as text over the drawing. */

import { type PerspectiveCamera, Vector3 } from 'three';
import type { ViewScene } from '../data';
import { element } from '../dom';
import { arrowStart, type Extent } from './extent';

/** Pixels between a name and the edge of the drawing. */
const EDGE = 4;

interface Name {
  at: Vector3;
  /** Pixels to the right and down, to stand beside a mark. */
  offset: [number, number];
  label: HTMLElement;
  /** Where it is, in pixels. */
  place: [number, number];
}

export class Names {
  /** The text alternative of the drawing names them too. */
  readonly root = element('div', { class: 'names', 'aria-hidden': true });
  private names: Name[] = [];

  constructor(private readonly extent: Extent) {}

  set(scene: ViewScene): void {
    this.names = [];
    this.root.replaceChildren();
    for (const { name, center } of scene.spheres) this.add(name, new Vector3(...center), 'object', [0, 0]);
    for (const { name, vertices } of scene.meshes) this.add(name, middle(vertices), 'object', [0, 0]);
    for (const { name, position, direction } of scene.lights) {
      this.add(name, position ? new Vector3(...position) : arrowStart(direction!, this.extent), 'light', [0, -22]);
    }
    this.add('camera', new Vector3(...scene.camera.eye), 'light', [0, 14]);
  }

  update(camera: PerspectiveCamera, width: number, height: number): void {
    for (const name of this.names) {
      const { at, offset, label } = name;
      const place = at.clone().project(camera);
      label.hidden = Math.abs(place.z) > 1;
      const center = ((place.x + 1) / 2) * width;
      // What is itself in the drawing has its whole name there.
      const half = center >= 0 && center <= width ? label.offsetWidth / 2 + EDGE : -Infinity;
      const x = Math.min(width - half, Math.max(half, center + offset[0]));
      const y = ((1 - place.y) / 2) * height + offset[1];
      name.place = [x, y];
      label.style.transform = `translate(${x.toFixed(1)}px, ${y.toFixed(1)}px) translate(-50%, -50%)`;
    }
  }

  /** The same for a picture of the drawing. */
  paint(context: CanvasRenderingContext2D, scale: number): void {
    if (this.root.hidden) return;
    context.setTransform(scale, 0, 0, scale, 0, 0);
    context.textAlign = 'center';
    context.textBaseline = 'middle';
    for (const { label, place } of this.names) {
      if (label.hidden) continue;
      const { font, color, textShadow } = getComputedStyle(label);
      context.font = font;
      context.fillStyle = color;
      // Shadows of a canvas are not scaled with it.
      context.shadowColor = textShadow.match(/^rgba?\([^)]*\)/)?.[0] ?? 'transparent';
      context.shadowBlur = 3 * scale;
      // The style sheet has three shadows too.
      for (let shadow = 0; shadow < 3; shadow++) context.fillText(label.textContent, ...place);
    }
    context.shadowColor = 'transparent';
  }

  private add(name: string, at: Vector3, kind: 'object' | 'light', offset: [number, number]): void {
    const label = element('span', { class: kind }, name);
    this.root.append(label);
    this.names.push({ at, offset, label, place: [0, 0] });
  }
}

function middle(vertices: number[]): Vector3 {
  const sum = new Vector3();
  const point = new Vector3();
  const count = Math.max(1, vertices.length / 3);
  for (let index = 0; index < vertices.length; index += 3) sum.add(point.fromArray(vertices, index));
  return sum.divideScalar(count);
}
