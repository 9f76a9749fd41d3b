import { expect, test } from 'vitest';
import { hueOf, ON_DARK, ON_LIGHT, spectralColor } from '../src/spectrum';
import { DARK, LIGHT } from '../src/theme';

/** After WCAG 2. */
function contrast(a: string, b: string): number {
  const luminance = (color: string) => {
    const [r, g, b] = color.match(/\w\w/g)!.map((hex) => {
      const value = parseInt(hex, 16) / 255;
      return value <= 0.04045 ? value / 12.92 : ((value + 0.055) / 1.055) ** 2.4;
    }) as [number, number, number];
    return 0.2126 * r + 0.7152 * g + 0.0722 * b;
  };
  const [dark, light] = [luminance(a), luminance(b)].sort((x, y) => x - y) as [number, number];
  return (light + 0.05) / (dark + 0.05);
}

test('all of the spectrum can be seen on both pages', () => {
  for (let nm = 380; nm <= 780; nm += 5) {
    expect(contrast(spectralColor(nm, ON_LIGHT), LIGHT.paper), `${nm} nm`).toBeGreaterThan(3);
    expect(contrast(spectralColor(nm, ON_DARK), DARK.paper), `${nm} nm`).toBeGreaterThan(3);
  }
});

test('hues run from violet to red and never back', () => {
  for (let nm = 400; nm < 700; nm++) expect(hueOf(nm + 1)).toBeLessThan(hueOf(nm));
  expect(hueOf(300)).toBe(hueOf(400));
  expect(hueOf(900)).toBe(hueOf(700));
});

test('blue is blue, green is green, red is red', () => {
  const channels = (nm: number) => spectralColor(nm, ON_LIGHT).match(/\w\w/g)!.map((hex) => parseInt(hex, 16));
  for (const [nm, channel] of [[650, 0], [540, 1], [465, 2]] as const) {
    expect(channels(nm)[channel]).toBe(Math.max(...channels(nm)));
  }
});
