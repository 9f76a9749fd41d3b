/** Short ways to make elements. */

import type { RayNode } from './data';
import { hueOf } from './spectrum';

type Attributes = Record<string, string | number | boolean>;

/** Text becomes text, never markup: names in scenes may hold anything. */
export function element<K extends keyof HTMLElementTagNameMap>(
  tag: K,
  attributes: Attributes = {},
  ...children: (Node | string)[]
): HTMLElementTagNameMap[K] {
  const made = document.createElement(tag);
  for (const [name, value] of Object.entries(attributes)) made.setAttribute(name, String(value));
  made.append(...children);
  return made;
}

/** The same, with what only a reader of the screen is told in other words. */
export function namedButton(name: string, label: string, act: () => void): HTMLButtonElement {
  const made = button(label, act);
  made.setAttribute('aria-label', name);
  made.title = name;
  return made;
}

export function button(label: string, act: () => void): HTMLButtonElement {
  const made = element('button', { type: 'button' }, label);
  made.addEventListener('click', act);
  return made;
}

export function checkbox(label: string, checked: boolean, act: (checked: boolean) => void): HTMLLabelElement {
  const box = element('input', { type: 'checkbox' });
  box.checked = checked;
  box.addEventListener('change', () => act(box.checked));
  return element('label', {}, box, label);
}

/** A little square of a colour; the numbers stand beside it, so readers of screens skip it. */
export function swatch(color: string): HTMLElement {
  const made = element('span', { class: 'swatch', 'aria-hidden': true });
  made.style.background = color;
  return made;
}

/** A piece of line in the colour of a kind of ray. */
export function stroke(kind: string): HTMLElement {
  return element('span', { class: `stroke ${kind}`, 'aria-hidden': true });
}

/** In the colour of a ray: that of its light, if dispersion has split it. */
export function rayStroke({ kind, band_nm }: RayNode): HTMLElement {
  const made = stroke(kind);
  if (band_nm === null) return made;
  made.classList.add('band');
  made.style.setProperty('--hue', String(hueOf(band_nm)));
  return made;
}
