/** The colours of the drawing and of the text beside it, for a light and a dark page. */

import type { RayKind } from './data';
import { ON_DARK, ON_LIGHT } from './spectrum';

export interface Theme {
  /** The page, and the middle and the rim of the drawing. */
  paper: string;
  glow: string;
  rim: string;
  ink: string;
  /** Less important text; still 4.5 : 1 on paper. */
  quiet: string;
  line: string;
  accent: string;
  /** Behind a row that the pointer is on. */
  tint: string;
  bulb: string;
  rays: Record<RayKind | 'shadow', string>;
  /** Lightness and chroma of rays of one wavelength. */
  spectrum: [number, number];
  /** Of handles along x, y and z. */
  axes: [string, string, string];
}

export const LIGHT: Theme = {
  paper: '#fbfaf8',
  glow: '#ffffff',
  rim: '#ebe8e2',
  ink: '#22262e',
  quiet: '#5d636e',
  line: '#d9d6cf',
  accent: '#1d5fd1',
  tint: '#f0eee9',
  bulb: '#d79a00',
  rays: { camera: '#4a5568', mirror: '#d4541a', refracted: '#0a7d8c', inside: '#7048d6', shadow: '#a87400' },
  spectrum: ON_LIGHT,
  axes: ['#c8321f', '#2f8a23', '#2a62d9'],
};

export const DARK: Theme = {
  paper: '#15181e',
  glow: '#232934',
  rim: '#12151a',
  ink: '#e8eaee',
  quiet: '#9ea6b3',
  line: '#323945',
  accent: '#7db1ff',
  tint: '#1f242d',
  bulb: '#ffd66b',
  rays: { camera: '#c3ccd9', mirror: '#ff9a62', refracted: '#4fd3e0', inside: '#b59cff', shadow: '#e9bd4b' },
  spectrum: ON_DARK,
  axes: ['#ff7a66', '#7bd66b', '#7fb0ff'],
};

/** Dark or light as the page asks for, or always the same. */
export type Scheme = 'auto' | 'light' | 'dark';

/** Calls back now, and whenever the page turns dark or light. Returns what ends that. */
export function followTheme(scheme: Scheme, apply: (theme: Theme) => void): () => void {
  const dark = window.matchMedia('(prefers-color-scheme: dark)');
  const update = () => apply(scheme === 'dark' || (scheme === 'auto' && dark.matches) ? DARK : LIGHT);
  update();
  dark.addEventListener('change', update);
  return () => dark.removeEventListener('change', update);
}

/** The same colours for the style sheet: `--ink`, `--ray-mirror` and so on. */
export function setProperties(element: HTMLElement, theme: Theme): void {
  const { rays, axes: _, spectrum, ...plain } = theme;
  for (const [name, color] of Object.entries(plain)) element.style.setProperty(`--${name}`, color);
  for (const [kind, color] of Object.entries(rays)) element.style.setProperty(`--ray-${kind}`, color);
  element.style.setProperty('--spectrum', `${spectrum[0]} ${spectrum[1]}`);
  element.style.colorScheme = theme === DARK ? 'dark' : 'light';
}
