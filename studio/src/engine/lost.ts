/** The light that pixels have lost where rays were not followed, sorted by how much of a pixel it is. */

/** The engine counts throughput in whole units of this size. */
const UNIT = 2 ** -32;
/** The share of a pixel at which each bin begins; but the first bin has the pixels that have lost nothing. */
export const FROM = [0, 0, 1e-4, 2e-4, 5e-4, 1e-3, 2e-3, 5e-3, 0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1];
/** Rows that are asked for at once. */
const ROWS = 64;

export interface LostLight {
  /** How many pixels there are in each bin. */
  pixels: number[];
  /** The bin of each pixel, row by row. */
  bins: Uint8Array<ArrayBuffer>;
  /** The pixel that has lost most, the first one of equals, and what share of it that is. */
  worst: { pixel: [number, number]; share: number };
}

/** `unitsOf` tells what the pixels of some rows have lost over all of their `spp` samples. */
export function lostLight([width, height]: [number, number], spp: number, unitsOf: (y: number, rows: number) => Float64Array): LostLight {
  const pixels = FROM.map(() => 0);
  const bins = new Uint8Array(width * height);
  const most = { at: 0, units: 0 };
  for (let y = 0; y < height; y += ROWS) {
    const first = y * width;
    unitsOf(y, Math.min(ROWS, height - y)).forEach((units, at) => {
      const bin = binOf((units * UNIT) / spp);
      pixels[bin]!++;
      bins[first + at] = bin;
      if (units > most.units) Object.assign(most, { at: first + at, units });
    });
  }
  return { pixels, bins, worst: { pixel: [most.at % width, Math.floor(most.at / width)], share: (most.units * UNIT) / spp } };
}

/** For each pixel 1 if it is in a bin, else 0. */
export function maskOf({ bins }: LostLight, bin: number): Uint8Array {
  const mask = new Uint8Array(bins.length);
  // A loop, as pictures may have millions of pixels and the page waits for this.
  for (let at = 0; at < bins.length; at++) if (bins[at] === bin) mask[at] = 1;
  return mask;
}

function binOf(share: number): number {
  if (share === 0) return 0;
  let bin = FROM.length - 1;
  while (share < FROM[bin]!) bin--;
  return bin;
}
