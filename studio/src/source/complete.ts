/** What can be written at a place in a scene: keys, values, and the names of what the scene has. */

import { entriesAt, type Entry, headers, valuesAt } from './schema';
import { type Context, contextAt, keysOf } from './toml';

/** What a scene may name besides its own parts. */
export interface KnownNames {
  /** Of the catalogue. */
  glasses?: readonly string[];
  /** Of the files that came with the scene. */
  files?: readonly string[];
}

export interface Suggestion {
  name: string;
  kind: 'key' | 'value' | 'table';
  insert: string;
  detail?: string;
  description?: string;
  isRequired?: boolean;
}

export interface Suggestions {
  /** What is replaced. */
  from: number;
  to: number;
  suggestions: Suggestion[];
}

export function suggestionsAt(text: string, offset: number, known: KnownNames = {}): Suggestions {
  const context = contextAt(text, offset);
  return { from: context.from, to: wordEnd(text, offset, context), suggestions: suggestions(text, offset, context, known) };
}

function suggestions(text: string, offset: number, context: Context, known: KnownNames): Suggestion[] {
  switch (context.place) {
    case 'key':
      return context.path.length === 0 ? atRoot(text) : keys(text, offset, context);
    case 'table':
    case 'element':
      return context.path.length === 0 ? names(text, offset, context.place) : [];
    case 'value':
      return values(text, context, known);
    case 'nothing':
      return [];
  }
}

function keys(text: string, offset: number, { path, table, quote }: Context): Suggestion[] {
  if (quote !== '') return [];
  const there = keysOf(text).filter((key) => key.table === table && key.path.length === path.length + 1 && (offset < key.from || key.to < offset));
  const present = new Set(there.map((key) => key.path.at(-1)));
  return entriesAt(path).filter((entry) => !present.has(entry.name)).map(asKey);
}

/** Before the first header: keys of the scene itself, and headers. */
function atRoot(text: string): Suggestion[] {
  const tables = headers('table').map((entry) => asHeader(entry, `[${entry.name}${entry.isNamed ? '.' : ']'}`));
  const elements = headers('element').map((entry) => asHeader(entry, `[[${entry.name}]]`));
  const taken = new Set([...tables, ...elements].map(({ name }) => name));
  const present = new Set(keysOf(text).filter((key) => key.path.length === 1).map((key) => key.path[0]));
  const plain = entriesAt([]).filter((entry) => !taken.has(entry.name) && !present.has(entry.name));
  return [...plain.map(asKey), ...tables, ...elements];
}

function names(text: string, offset: number, place: 'table' | 'element'): Suggestion[] {
  const closing = place === 'table' ? ']' : ']]';
  const isClosed = /^[\w-]*\]/.test(text.slice(offset, offset + 100));
  return headers(place).map((entry) => asHeader(entry, entry.name + (entry.isNamed ? '.' : isClosed ? '' : closing)));
}

function asKey(entry: Entry): Suggestion {
  const { name, description, isRequired } = entry;
  const detail = isRequired ? 'required' : entry.default === undefined ? undefined : `default ${entry.default}`;
  return { name, kind: 'key', insert: `${name} = `, description, isRequired, ...(detail && { detail }) };
}

function asHeader({ name, description }: Entry, insert: string): Suggestion {
  return { name, kind: 'table', insert, description };
}

function values(text: string, { path, quote }: Context, known: KnownNames): Suggestion[] {
  const texts = [...namesFor(text, path, known)].map((name) => ({ toml: JSON.stringify(name), description: '' }));
  return [...texts, ...valuesAt(path)].flatMap(({ toml, description }): Suggestion[] => {
    const isText = toml.startsWith('"');
    if (!isText) return quote === '' ? [{ name: toml, kind: 'value', insert: toml, description }] : [];
    const name = JSON.parse(toml) as string;
    // In single quotes nothing can be escaped.
    if (quote === "'" && (name.includes("'") || JSON.stringify(name) !== `"${name}"`)) return [];
    const insert = quote === '' ? toml : quote === '"' ? toml.slice(1) : `${name}'`;
    return [{ name, kind: 'value', insert, description }];
  });
}

/** The names that the scene has of what a key refers to. */
function namesFor(text: string, path: readonly string[], known: KnownNames): Iterable<string> {
  const [key, parent] = [path.at(-1)!, path.at(-2)];
  if (['material', 'inside', 'outside'].includes(key) || parent === 'materials') return namesIn(text, 'material');
  if (key === 'texture') return namesIn(text, 'texture');
  if (key === 'glass') return known.glasses ?? [];
  const endings = key === 'file' ? MODELS : key === 'image' ? PICTURES : null;
  return endings ? (known.files ?? []).filter((name) => endings.test(name)) : [];
}

const MODELS = /\.(obj|ply|stl)$/i;
const PICTURES = /\.(png|ppm|exr)$/i;

function namesIn(text: string, table: string): Set<string> {
  return new Set(keysOf(text).flatMap(({ path }) => (path[0] === table && path.length > 1 ? [path[1]!] : [])));
}

/** Where the word ends, with its closing quote and what stands between a key and its value. */
function wordEnd(text: string, offset: number, { place, quote }: Context): number {
  const rest = text.slice(offset, lineEnd(text, offset));
  if (place === 'nothing') return offset;
  if (quote !== '') {
    const end = new RegExp(`^(?:\\\\.|[^\\\\${quote}])*${quote}`).exec(rest);
    return offset + (end ? end[0].length : 0);
  }
  const word = /^[\w-]*/.exec(rest)![0].length;
  const equals = place === 'key' ? (/^[ \t]*=[ \t]*/.exec(rest.slice(word))?.[0].length ?? 0) : 0;
  return offset + word + equals;
}

function lineEnd(text: string, offset: number): number {
  const end = text.indexOf('\n', offset);
  return end < 0 ? text.length : end;
}
