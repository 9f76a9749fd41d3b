/** From the linear colours of the data to colours on a screen. */

import type { Color, Transfer } from './data';

/** The curve of sRGB (IEC 61966-2-1), for one channel from 0 to 1. */
export function srgbFromLinear(value: number): number {
  return value <= 0.0031308 ? 12.92 * value : 1.055 * value ** (1 / 2.4) - 0.055;
}

/** Three channels from 0 to 1, as the picture itself would show them. */
export function displayed(color: Color, transfer: Transfer): Color {
  return color.map((value) => {
    const clipped = Math.min(1, Math.max(0, value));
    return transfer === 'srgb' ? srgbFromLinear(clipped) : clipped;
  }) as Color;
}

export function cssColor(color: Color, transfer: Transfer): string {
  return `rgb(${displayed(color, transfer).map((value) => Math.round(255 * value)).join(' ')})`;
}
