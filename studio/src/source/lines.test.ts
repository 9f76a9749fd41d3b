import { Text } from '@codemirror/state';
import { expect, test } from 'vitest';
import { linesOf, minimalChange, offsetOf, withLines } from './lines';

test('line ends and byte order mark come back', () => {
  for (const file of ['', 'a\nb\n', 'a\r\nb\r\n', '\uFEFFa\r\nb', '\uFEFF', '\n\n', '\r\n']) {
    const lines = linesOf(file);
    expect(lines.text).not.toMatch(/[\r\uFEFF]/);
    expect(withLines(lines.text, lines)).toBe(file);
  }
});

test('a line that is added gets the end of the others', () => {
  const lines = linesOf('a\r\nb\r\n');
  expect(withLines(`${lines.text}c\n`, lines)).toBe('a\r\nb\r\nc\r\n');
});

test('a change is no longer than it must be, and leads from one text to the other', () => {
  expect(minimalChange('eta = 2.0\n', 'eta = 2.42\n')).toEqual({ from: 8, to: 9, insert: '42' });
  expect(minimalChange('a', 'a')).toBeNull();
  for (const [before, after] of [['aaa', 'aa'], ['aa', 'aaa'], ['', 'x'], ['x', ''], ['abab', 'ab'], ['🔮', '🔭'], ['ab', 'ba']] as const) {
    const { from, to, insert } = minimalChange(before, after)!;
    expect(from).toBeLessThanOrEqual(to);
    expect(before.slice(0, from) + insert + before.slice(to)).toBe(after);
  }
});

test('columns are characters, and what lies outside is moved in', () => {
  const doc = Text.of(['🔮🔮 eta', 'k']);
  expect(offsetOf(doc, 1, 1)).toBe(0);
  expect(offsetOf(doc, 1, 4)).toBe(5);
  expect(offsetOf(doc, 1, 99)).toBe(8);
  expect(offsetOf(doc, 2, 2)).toBe(10);
  expect(offsetOf(doc, 9, 9)).toBe(10);
  expect(offsetOf(doc, 0, 0)).toBe(0);
});
