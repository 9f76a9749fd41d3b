/** Compares pictures, and writes what differs where a person can look at it. */

import { existsSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import pixelmatch from 'pixelmatch';
import { PNG } from 'pngjs';
import { OUT } from './browser';

/** Of the colour difference that pixelmatch sees as one, from 0 to 1: releases of SwiftShader round differently. */
const THRESHOLD = 0.05;
/** Part of the pixels that may differ; one thin ray more or less is over it. */
export const TOLERANCE = 0.0005;

/** The part of the pixels that differ from the reference. Without a reference, or with another size, all do. */
export function difference(name: string, png: Buffer): number {
  const reference = fileURLToPath(new URL(`reference/${name}.png`, import.meta.url));
  const files = { actual: `${OUT}${name}.actual.png`, difference: `${OUT}${name}.difference.png` };
  for (const file of Object.values(files)) rmSync(file, { force: true });
  const actual = PNG.sync.read(png);
  const expected = existsSync(reference) ? PNG.sync.read(readFileSync(reference)) : null;
  if (expected === null || expected.width !== actual.width || expected.height !== actual.height) {
    writeFileSync(files.actual, png);
    return 1;
  }
  const { width, height } = actual;
  const picture = new PNG({ width, height });
  // Thin lines look like soft edges, which pixelmatch would forgive.
  const options = { threshold: THRESHOLD, includeAA: true };
  const different = pixelmatch(actual.data, expected.data, picture.data, width, height, options);
  const part = different / (width * height);
  if (part > TOLERANCE) {
    writeFileSync(files.actual, png);
    writeFileSync(files.difference, PNG.sync.write(picture));
  }
  return part;
}

/** The middle one of all places where 3 × 3 pixels nearly have the colour. */
export function findColor(png: Buffer, color: [number, number, number], tolerance: number): { x: number; y: number } | null {
  const { width, height, data } = PNG.sync.read(png);
  const matches = (x: number, y: number) => color.every((value, channel) => Math.abs(data[4 * (y * width + x) + channel]! - value) <= tolerance);
  const around = [-1, 0, 1];
  const found: { x: number; y: number }[] = [];
  for (let y = 1; y < height - 1; y++) {
    for (let x = 1; x < width - 1; x++) {
      if (around.every((dy) => around.every((dx) => matches(x + dx, y + dy)))) found.push({ x, y });
    }
  }
  return found[found.length >> 1] ?? null;
}
