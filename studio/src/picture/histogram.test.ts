import { expect, test } from 'vitest';
import { filmHistogram, histogram, lostLight } from './histogram';

const total = ({ counts, below, above, strange }: ReturnType<typeof histogram>) => counts.reduce((sum, count) => sum + count, 0) + below + above + strange;

test('every value is in the bin between whose edges it lies', () => {
  for (const isLogarithmic of [false, true]) {
    for (const [low, high, count] of [[0.1, 0.7, 6], [1e-6, 1, 24], [1 / 3, 3, 7], [1, 1 + 1e-9, 5]] as const) {
      const { edges } = histogram([], { low, high, count, isLogarithmic });
      expect([edges[0], edges[count]]).toEqual([low, high]);
      // The edges themselves, and their neighbours among numbers.
      const values = [...edges].flatMap((edge) => [edge, edge * (1 - 2 ** -52), edge * (1 + 2 ** -52)]).filter((value) => value >= low && value <= high);
      for (const value of values) {
        const { counts } = histogram([value], { low, high, count, isLogarithmic });
        const index = counts.indexOf(1);
        expect(value).toBeGreaterThanOrEqual(edges[index]!);
        if (index < count - 1) expect(value).toBeLessThan(edges[index + 1]!);
      }
    }
  }
});

test('what lies outside is counted apart', () => {
  const made = histogram([-1, 0, 0.5, 1, 1.5, NaN, Infinity, -Infinity, -0], { low: 0, high: 1, count: 2 });
  expect([...made.counts]).toEqual([2, 2]);
  expect(made).toMatchObject({ below: 2, above: 2, strange: 1 });
  expect(histogram([0, -1, 1], { low: 1e-3, high: 10, count: 4, isLogarithmic: true })).toMatchObject({ below: 2 });
});

test('bins that cannot be are refused', () => {
  expect(() => histogram([], { low: 1, high: 1, count: 2 })).toThrow(RangeError);
  expect(() => histogram([], { low: 0, high: 1, count: 2, isLogarithmic: true })).toThrow(RangeError);
  expect(() => histogram([], { low: NaN, high: 1, count: 2 })).toThrow(RangeError);
});

test('channels are not mixed up', () => {
  const film = Float64Array.of(1, 0, 0, 1, 0.5, 0, 1, 0.5, 0.25);
  const { red, green, blue, luminance } = filmHistogram(film, 4);
  expect([red, green, blue].map(({ counts }) => [...counts])).toEqual([[0, 0, 0, 3], [1, 0, 2, 0], [2, 1, 0, 0]]);
  // 0.2126, 0.5702, 0.58825
  expect([...luminance.counts]).toEqual([1, 0, 2, 0]);
});

test('a film brighter than white is counted to its end, an empty one not at all', () => {
  const bright = filmHistogram(Float64Array.of(4, 4, 4, 0, 0, 0), 2);
  expect(bright.red.edges[2]).toBe(4);
  expect([...bright.luminance.counts]).toEqual([1, 1]);
  expect(bright.luminance.above).toBe(0);
  expect(total(filmHistogram(new Float64Array(), 4).red)).toBe(0);
  expect(filmHistogram(Float64Array.of(Infinity, NaN, 0.5), 4).red).toMatchObject({ above: 1 });
});

test('lost light: from next to nothing to more than all', () => {
  const lost = Float64Array.of(0, 0, 1e-9, 2e-6, 0.03, 2);
  const { histogram: made, largest, pixel, mean } = lostLight(lost);
  expect({ largest, pixel }).toEqual({ largest: 2, pixel: 5 });
  expect(mean).toBeCloseTo(2.030002 / 6, 6);
  expect(made).toMatchObject({ below: 3, above: 0 });
  expect(total(made)).toBe(6);
  expect(made.edges[4]! / made.edges[0]!).toBeCloseTo(10, 9);
});

test('where nothing is lost, all is below', () => {
  expect(lostLight(new Float64Array(9))).toMatchObject({ largest: 0, mean: 0, histogram: { below: 9, above: 0 } });
  expect(lostLight(new Float64Array()).mean).toBe(0);
});
