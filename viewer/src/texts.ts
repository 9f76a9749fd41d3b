/** What is said of the scene and of the pixel, above the drawing and instead of it. */

import { cssColor } from './color';
import type { RayTreeDocument, ViewScene } from './data';
import { element, stroke, swatch } from './dom';
import type { ObjectRef } from './editing';
import { KIND_NAMES } from './words';

/** Names in the text alternative: nobody listens to a hundred. */
const MAX_SPOKEN = 12;

/** The pixel in a sentence, with its colour. */
export function pixelHeader({ sentence, pixel, size, scene, integrator, spp, color, transfer }: RayTreeDocument): HTMLElement {
  const samples = spp === 1 ? '1 sample' : `${spp} samples`;
  const facts = `Pixel (${pixel.join(', ')}) of ${size.join(' × ')} · ${scene} · ${integrator} · ${samples} per pixel`;
  return header(sentence, facts, swatch(cssColor(color, transfer)));
}

export function sceneHeader(title: string, { spheres, meshes, lights }: ViewScene): HTMLElement {
  const counts: [number, string, string][] = [
    [spheres.length, 'sphere', 'spheres'],
    [meshes.length, 'mesh', 'meshes'],
    [lights.length, 'light', 'lights'],
  ];
  const facts = counts.filter(([count]) => count > 0).map(([count, one, many]) => `${count} ${count === 1 ? one : many}`);
  return header(title, facts.join(' · '));
}

function header(title: string, facts: string, ...before: HTMLElement[]): HTMLElement {
  const texts = element('div', {}, element('p', { class: 'sentence' }, title), element('p', { class: 'quiet' }, facts));
  return element('header', {}, ...before, texts);
}

/** What the drawing shows, for those who do not see it. */
export function alternative({ spheres, meshes, lights }: ViewScene, has: { tree: boolean; pixels: boolean; handles: boolean }): string {
  return [
    `Spheres: ${names(spheres)}. Meshes: ${names(meshes)}. Lights: ${names(lights)}.`,
    ...(has.tree ? ['The tree of rays beside the drawing says where each ray goes and what it adds.'] : []),
    'Arrow keys turn the drawing, plus and minus go nearer and farther.',
    ...(has.handles ? ['Alt with an arrow key moves what is selected; Alt with Page Up and Page Down moves it away and nearer.'] : []),
    ...(has.pixels ? ['Shift with an arrow key explains the next pixel in that direction.'] : []),
  ].join(' ');
}

export function selectedWords(selected: ObjectRef | null): string {
  if (selected === null) return '';
  if (selected.kind === 'camera') return `; the ${selected.index === 0 ? 'camera' : 'target of the camera'} is selected`;
  return `; the ${selected.kind} ${selected.name} is selected`;
}

function names(things: { name: string }[]): string {
  if (things.length === 0) return 'none';
  const first = things.slice(0, MAX_SPOKEN).map(({ name }) => name).join(', ');
  return things.length > MAX_SPOKEN ? `${first} and ${things.length - MAX_SPOKEN} more` : first;
}

export function legend(): HTMLElement {
  const items = Object.entries(KIND_NAMES).map(([kind, name]) => element('li', {}, stroke(kind), name));
  return element('ul', { class: 'legend of-rays', 'aria-label': 'Colours of the rays' }, ...items);
}
