/** How often which values occur, in a picture or in what was lost of its light. */

export interface Histogram {
  /** Where the bins begin, and where the last one ends. */
  edges: Float64Array;
  counts: Uint32Array;
  /** Values below the first bin, above the last one, and those that are no numbers. */
  below: number;
  above: number;
  strange: number;
}

export interface Bins {
  low: number;
  high: number;
  count: number;
  /** Equal ratios instead of equal differences; `low` is above 0 then. */
  isLogarithmic?: boolean;
}

/** Counts values: every `stride`-th one, from the one at `offset` on. */
export function histogram(values: ArrayLike<number>, bins: Bins, stride = 1, offset = 0): Histogram {
  const { low, high, count, isLogarithmic = false } = bins;
  if (!(low < high) || (isLogarithmic && low <= 0)) throw new RangeError(`there are no bins from ${low} to ${high}`);
  const edges = Float64Array.from({ length: count + 1 }, (_, index) => {
    const part = index / count;
    // Both ends exactly.
    if (index === count) return high;
    return isLogarithmic ? low * (high / low) ** part : low + (high - low) * part;
  });
  const made: Histogram = { edges, counts: new Uint32Array(count), below: 0, above: 0, strange: 0 };
  const scale = count / (isLogarithmic ? Math.log(high / low) : high - low);
  for (let at = offset; at < values.length; at += stride) {
    const value = values[at]!;
    if (Number.isNaN(value)) made.strange += 1;
    else if (value < low) made.below += 1;
    else if (value > high) made.above += 1;
    else made.counts[bin(value, Math.floor(scale * (isLogarithmic ? Math.log(value / low) : value - low)), edges)]! += 1;
  }
  return made;
}

/** The bin of a value, near one that rounding may have missed. The highest value is in the last one. */
function bin(value: number, near: number, edges: Float64Array): number {
  const last = edges.length - 2;
  let index = Math.min(last, Math.max(0, near));
  while (index > 0 && value < edges[index]!) index -= 1;
  while (index < last && value >= edges[index + 1]!) index += 1;
  return index;
}

export interface FilmHistogram {
  red: Histogram;
  green: Histogram;
  blue: Histogram;
  luminance: Histogram;
}

/** Of a film: linear red, green and blue of each pixel. All have the same bins, from 0 to 1, or to the largest value if that is above. */
export function filmHistogram(film: Float64Array, count = 256): FilmHistogram {
  let high = 1;
  for (const value of film) if (value > high && value < Infinity) high = value;
  const bins = { low: 0, high, count };
  const [red, green, blue] = [0, 1, 2].map((channel) => histogram(film, bins, 3, channel)) as [Histogram, Histogram, Histogram];
  return { red, green, blue, luminance: histogram(luminances(film), bins) };
}

/** As Rec. 709 weighs the primaries of sRGB. */
function luminances(film: Float64Array): Float64Array {
  // Three products may add up to a little more than the largest of them.
  return Float64Array.from({ length: Math.floor(film.length / 3) }, (_, pixel) => {
    const [red, green, blue] = [film[3 * pixel]!, film[3 * pixel + 1]!, film[3 * pixel + 2]!];
    return Math.min(0.2126 * red + 0.7152 * green + 0.0722 * blue, Math.max(red, green, blue));
  });
}

export interface LostLight {
  /** In four bins for each power of ten; `below` counts the pixels that lost nothing worth naming. */
  histogram: Histogram;
  largest: number;
  /** Where that is. */
  pixel: number;
  mean: number;
}

const LEAST = 1e-6;

/** Of the light that each pixel has lost, as a share of white. */
export function lostLight(lost: Float64Array): LostLight {
  let [largest, pixel, sum] = [0, 0, 0];
  lost.forEach((value, index) => {
    sum += value;
    if (value > largest) [largest, pixel] = [value, index];
  });
  const decades = Math.max(1, Math.ceil(Math.log10(largest / LEAST)));
  const bins = { low: LEAST, high: LEAST * 10 ** decades, count: 4 * decades, isLogarithmic: true };
  return { histogram: histogram(lost, bins), largest, pixel, mean: lost.length > 0 ? sum / lost.length : 0 };
}
