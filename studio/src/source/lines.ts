/** Texts as files have them, and as the editor has them: lines that end with `\n`, without a byte order mark. */

export interface Lines {
  text: string;
  /** What ends a line of the file. */
  end: '\n' | '\r\n';
  mark: '' | '\uFEFF';
}

export function linesOf(file: string): Lines {
  const mark = file.startsWith('\uFEFF') ? '\uFEFF' : '';
  const first = file.indexOf('\n');
  const end = first > 0 && file[first - 1] === '\r' ? '\r\n' : '\n';
  return { text: file.slice(mark.length).replace(/\r\n?/g, '\n'), end, mark };
}

export function withLines(text: string, { end, mark }: Lines): string {
  return mark + (end === '\n' ? text : text.replaceAll('\n', end));
}

/** The one change, as short as possible, that makes another text of a text. */
export function minimalChange(before: string, after: string): { from: number; to: number; insert: string } | null {
  if (before === after) return null;
  const shorter = Math.min(before.length, after.length);
  let start = 0;
  while (start < shorter && before[start] === after[start]) start += 1;
  let end = 0;
  while (end < shorter - start && before[before.length - 1 - end] === after[after.length - 1 - end]) end += 1;
  return { from: start, to: before.length - end, insert: after.slice(start, after.length - end) };
}

/** The part of a document that is needed here. */
interface Document {
  lines: number;
  length: number;
  line(number: number): { from: number; text: string };
}

/** The offset of a line and a column in characters, both from 1; what lies outside is moved to the nearest place. */
export function offsetOf(doc: Document, line: number, column: number): number {
  if (line > doc.lines) return doc.length;
  const { from, text } = doc.line(Math.max(1, line));
  let offset = 0;
  for (const character of text) {
    if (--column < 1) break;
    offset += character.length;
  }
  return from + offset;
}
