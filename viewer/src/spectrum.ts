/**
 * Colours for rays of one wavelength: the hue that it is seen in, as light as the page needs it and everywhere the same, since the
 * real colours of the spectrum would be lost on paper (yellow) or in the dark (violet).
 */

import { srgbFromLinear } from './color';

/** Wavelengths in nm and hues in degrees of the OKLCH colour space. */
const HUES: [number, number][] = [
  [400, 308],
  [440, 285],
  [465, 262],
  [490, 210],
  [510, 160],
  [540, 142],
  [570, 115],
  [585, 92],
  [600, 62],
  [625, 38],
  [660, 25],
  [700, 15],
];
/** Lightness and chroma. */
export const ON_LIGHT: [number, number] = [0.56, 0.17];
export const ON_DARK: [number, number] = [0.78, 0.15];

/** Beyond what is seen, that of its end. */
export function hueOf(nm: number): number {
  const next = HUES.findIndex(([length]) => length >= nm);
  if (next <= 0) return next === 0 ? HUES[0]![1] : HUES.at(-1)![1];
  const [[a, from], [b, to]] = [HUES[next - 1]!, HUES[next]!];
  return from + ((nm - a) / (b - a)) * (to - from);
}

/** The colour in sRGB, with as much of its chroma as a screen has: for what does not know `oklch()`. */
export function spectralColor(nm: number, [lightness, chroma]: [number, number]): string {
  const angle = (hueOf(nm) * Math.PI) / 180;
  for (let part = chroma; ; part -= 0.01) {
    const rgb = fromOklab(lightness, part * Math.cos(angle), part * Math.sin(angle));
    if (part <= 0 || rgb.every((value) => value >= 0 && value <= 1)) {
      return `#${rgb.map((value) => hex(srgbFromLinear(Math.min(1, Math.max(0, value))))).join('')}`;
    }
  }
}

function hex(value: number): string {
  return Math.round(255 * value).toString(16).padStart(2, '0');
}

/** Linear sRGB, after Björn Ottosson (2020). */
function fromOklab(lightness: number, a: number, b: number): number[] {
  const l = (lightness + 0.3963377774 * a + 0.2158037573 * b) ** 3;
  const m = (lightness - 0.1055613458 * a - 0.0638541728 * b) ** 3;
  const s = (lightness - 0.0894841775 * a - 1.291485548 * b) ** 3;
  return [
    4.0767416621 * l - 3.3077115913 * m + 0.2309699292 * s,
    -1.2684380046 * l + 2.6097574011 * m - 0.3413193965 * s,
    -0.0041960863 * l - 0.7034186147 * m + 1.707614701 * s,
  ];
}
