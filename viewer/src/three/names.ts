/** The names of objects, lights and the camera, and other short texts, over the drawing. */

import { type PerspectiveCamera, Vector3 } from 'three';
import type { ViewScene } from '../data';
import { element } from '../dom';
import { arrowStart, boxOf, type Extent } from './extent';

/** Pixels between a name and the edge of the drawing. */
const EDGE = 4;

export interface Label {
  text: string;
  at: Vector3;
  kind: 'object' | 'light' | 'angle';
  /** Pixels down, to stand beside a mark. */
  offset: number;
  /** Those with a smaller one stay where they are when names would lie over each other. */
  rank: number;
}

interface Shown {
  label: Label;
  element: HTMLElement;
  size: [number, number];
  /** Where its middle is, in pixels. */
  place: [number, number];
}

interface Box {
  left: number;
  right: number;
  top: number;
  bottom: number;
}

export class Names {
  /** The text alternative of the drawing names them too. */
  readonly root = element('div', { class: 'names', 'aria-hidden': true });
  /** Are the names of things shown? */
  shown = true;
  /** By what they belong to. */
  private readonly groups = new Map<string, Shown[]>();
  /** They come before all others. */
  private important = new Set<string>();

  /** Replaces the labels of a group; elements are used again. */
  set(group: string, labels: Label[]): void {
    const shown = this.groups.get(group) ?? [];
    for (const { element } of shown.splice(labels.length)) element.remove();
    labels.forEach((label, index) => {
      const old = shown[index];
      if (old?.label.text === label.text && old.label.kind === label.kind) old.label = label;
      else {
        old?.element.remove();
        const made = element('span', { class: label.kind }, label.text);
        this.root.append(made);
        shown[index] = { label, element: made, size: [0, 0], place: [0, 0] };
      }
    });
    this.groups.set(group, shown);
  }

  setImportant(texts: Set<string>): void {
    this.important = texts;
  }

  update(camera: PerspectiveCamera, width: number, height: number): void {
    const taken: Box[] = [];
    const rank = ({ text, rank }: Label) => (this.important.has(text) ? -1 : rank);
    const depths = new Map(this.all().map((name) => [name, name.label.at.clone().project(camera)]));
    const order = this.all().sort((a, b) => rank(a.label) - rank(b.label) || depths.get(a)!.z - depths.get(b)!.z);
    for (const name of order) {
      const { label, element } = name;
      const place = depths.get(name)!;
      element.hidden = Math.abs(place.z) > 1 || (!this.shown && label.kind !== 'angle');
      if (element.hidden) continue;
      if (name.size[0] === 0) name.size = [element.offsetWidth, element.offsetHeight];
      const [w, h] = name.size;
      const center = ((place.x + 1) / 2) * width;
      // What is itself in the drawing has its whole name there.
      const half = center >= 0 && center <= width ? w / 2 + EDGE : -Infinity;
      const x = Math.min(width - half, Math.max(half, center));
      const y = ((1 - place.y) / 2) * height + label.offset;
      const boxAt = (middle: number): Box => ({ left: x - w / 2, right: x + w / 2, top: middle - h / 2, bottom: middle + h / 2 });
      const boxes = [y, y - h, y + h].map(boxAt);
      const free = boxes.find((box) => !taken.some((other) => overlap(box, other))) ?? (rank(label) < 0 ? boxes[0]! : null);
      element.hidden = free === null;
      if (free === null) continue;
      taken.push(free);
      name.place = [x, (free.top + free.bottom) / 2];
      element.style.transform = `translate(${name.place[0].toFixed(1)}px, ${name.place[1].toFixed(1)}px) translate(-50%, -50%)`;
    }
  }

  /** The same for a picture of the drawing. */
  paint(context: CanvasRenderingContext2D, scale: number): void {
    context.setTransform(scale, 0, 0, scale, 0, 0);
    context.textAlign = 'center';
    context.textBaseline = 'middle';
    for (const { element, place } of this.all()) {
      if (element.hidden) continue;
      const { font, color, textShadow } = getComputedStyle(element);
      context.font = font;
      context.fillStyle = color;
      // Shadows of a canvas are not scaled with it.
      context.shadowColor = textShadow.match(/^rgba?\([^)]*\)/)?.[0] ?? 'transparent';
      context.shadowBlur = 3 * scale;
      // The style sheet has three shadows too.
      for (let shadow = 0; shadow < 3; shadow++) context.fillText(element.textContent, ...place);
    }
    context.shadowColor = 'transparent';
  }

  private all(): Shown[] {
    return [...this.groups.values()].flat();
  }
}

export function sceneLabels({ spheres, meshes, lights, camera }: ViewScene, extent: Extent): Label[] {
  return [
    ...spheres.map(({ name, center }): Label => ({ text: name, at: new Vector3(...center), kind: 'object', offset: 0, rank: 2 })),
    ...meshes.map((mesh): Label => ({ text: mesh.name, at: boxOf(mesh).getCenter(new Vector3()), kind: 'object', offset: 0, rank: 3 })),
    ...lights.map(({ name, position, direction }): Label => {
      const at = position ? new Vector3(...position) : arrowStart(direction!, extent);
      return { text: name, at, kind: 'light', offset: -22, rank: 1 };
    }),
    { text: 'camera', at: new Vector3(...camera.eye), kind: 'light', offset: 14, rank: 1 },
  ];
}

function overlap(a: Box, b: Box): boolean {
  return a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;
}
