/** Which key stands where in a TOML text, also in one that is being typed. No values: the engine reads those. */

export interface Key {
  /** Names from the root on; elements of a list have none. */
  path: string[];
  /** Which table or element it stands in: of those with the same number. */
  table: number;
  /** Where its last name stands. */
  from: number;
  to: number;
}

export interface Context {
  /** What is to be written here: the name of a `[table]` or of an element `[[of a list]]`, a key, or a value. */
  place: 'table' | 'element' | 'key' | 'value' | 'nothing';
  /** Of a value, whose it is; else what the name belongs to. */
  path: string[];
  /** The number of the table of a key, as in `Key`. */
  table: number;
  /** Where the word begins that ends here, behind its quote if it has one. */
  from: number;
  quote: '"' | "'" | '';
}

/** What is to be written at an offset of a text. */
export function contextAt(text: string, offset: number): Context {
  const reader = new Reader();
  let [from, quote, isComment]: [number, Context['quote'], boolean] = [offset, '', false];
  for (const token of tokens(text, offset)) {
    // A word goes on where it ends, other things are over.
    const isOpen = token.to === offset && (token.kind === 'word' || token.kind === 'comment' || token.isClosed === false);
    if (isOpen) {
      isComment = token.kind === 'comment';
      quote = token.kind === 'string' ? (text[token.from] as Context['quote']) : '';
      from = token.from + (token.kind === 'string' ? token.quotes! : 0);
    } else {
      reader.take(token, text);
    }
  }
  const { place, path, table } = reader;
  return { place: isComment ? 'nothing' : place, path, table, from, quote };
}

/** All keys of a text, and the names in its headers. */
export function keysOf(text: string): Key[] {
  const reader = new Reader();
  for (const token of tokens(text, text.length)) reader.take(token, text);
  return reader.keys;
}

interface Token {
  kind: 'word' | 'string' | 'comment' | 'line' | '[' | ']' | '{' | '}' | '=' | ',' | '.';
  from: number;
  to: number;
  /** Of a string: how many signs begin it, and whether something ends it. */
  quotes?: number;
  isClosed?: boolean;
}

const SIGNS = '[]{}=,.';
const WORD = /[^\s[\]{}=,."'#]+/y;
const SPACE = /[^\S\n]+/y;

function* tokens(text: string, end: number): Generator<Token> {
  for (let at = 0; at < end; ) {
    const [from, sign] = [at, text[at]!];
    if (sign === '\n') yield { kind: 'line', from, to: (at += 1) };
    else if (SIGNS.includes(sign)) yield { kind: sign as Token['kind'], from, to: (at += 1) };
    else if (sign === '#') {
      at = Math.min(end, indexOr(text, '\n', at, end));
      yield { kind: 'comment', from, to: at };
    } else if (sign === '"' || sign === "'") {
      const string = stringAt(text, at, end);
      at = string.to;
      yield string;
    } else {
      const space = matchEnd(SPACE, text, at);
      at = Math.min(end, space ?? matchEnd(WORD, text, at)!);
      if (space === undefined) yield { kind: 'word', from, to: at };
    }
  }
}

/** A string that is not closed ends with its line, or with the text if it may have several. */
function stringAt(text: string, from: number, end: number): Token {
  const quote = text[from]!;
  const quotes = text.startsWith(quote.repeat(3), from) && from + 3 <= end ? 3 : 1;
  const closing = quote.repeat(quotes);
  let at = from + quotes;
  while (at < end && (quotes === 3 || text[at] !== '\n')) {
    if (text[at] === '\\' && quote === '"') at += 2;
    else if (text.startsWith(closing, at) && at + quotes <= end) {
      at += quotes;
      // Up to two quotes may stand before the closing three.
      while (quotes === 3 && at < end && text[at] === quote) at += 1;
      return { kind: 'string', from, to: at, quotes, isClosed: true };
    } else at += 1;
  }
  return { kind: 'string', from, to: Math.min(at, end), quotes, isClosed: false };
}

function matchEnd(pattern: RegExp, text: string, from: number): number | undefined {
  pattern.lastIndex = from;
  return pattern.test(text) ? pattern.lastIndex : undefined;
}

function indexOr(text: string, sign: string, from: number, other: number): number {
  const at = text.indexOf(sign, from);
  return at < 0 ? other : at;
}

/** A list or an inline table that is not closed yet. */
interface Open {
  sign: '[' | '{';
  path: string[];
  table: number;
}

class Reader {
  readonly keys: Key[] = [];
  place: Context['place'] = 'key';
  private header: string[] = [];
  private headerTable = 0;
  private tables = 0;
  private open: Open[] = [];
  /** Names that the key has so far. */
  private names: string[] = [];

  get path(): string[] {
    const isHeader = this.place === 'table' || this.place === 'element';
    const open = this.open.at(-1);
    if (open?.sign === '[') return open.path;
    return [...(isHeader ? [] : (open?.path ?? this.header)), ...this.names];
  }

  get table(): number {
    return this.open.at(-1)?.table ?? this.headerTable;
  }

  take(token: Token, text: string): void {
    const inner = this.open.at(-1);
    switch (token.kind) {
      case 'line':
        if (inner === undefined || beginsStatement(text, token.to, inner.sign === '[')) this.begin();
        return;
      case 'word':
      case 'string':
        return this.name(token, text);
      case '=':
        if (this.place === 'key') this.place = this.names.length > 0 ? 'value' : 'nothing';
        return;
      case '[':
        if (this.place === 'value') this.open.push({ sign: '[', path: this.path, table: this.table });
        else if (this.place === 'table' && this.names.length === 0) this.place = 'element';
        else this.place = this.place === 'key' && this.names.length === 0 && inner === undefined ? 'table' : 'nothing';
        return;
      case '{':
        if (this.place !== 'value') return;
        this.open.push({ sign: '{', path: this.path, table: ++this.tables });
        return this.next('key');
      case ',':
        if (inner !== undefined) this.next(inner.sign === '{' ? 'key' : 'value');
        return;
      case ']':
        if (this.place === 'table' || this.place === 'element') [this.header, this.headerTable] = [this.names, ++this.tables];
        return this.close('[');
      case '}':
        return this.close('{');
    }
  }

  private begin(): void {
    this.open = [];
    this.next('key');
  }

  private next(place: Context['place']): void {
    this.names = [];
    this.place = place;
  }

  private name(token: Token, text: string): void {
    if (this.place === 'value') this.place = 'nothing';
    if (this.place === 'nothing') return;
    const isString = token.kind === 'string';
    const quotes = isString ? token.quotes! : 0;
    this.names = [...this.names, unquoted(text.slice(token.from + quotes, token.to - (token.isClosed ? quotes : 0)))];
    this.keys.push({ path: this.path, table: this.table, from: token.from, to: token.to });
  }

  /** Ends the innermost list or table of this kind; what was left open in it is over, too. */
  private close(sign: Open['sign']): void {
    const at = this.open.map((open) => open.sign).lastIndexOf(sign);
    if (at >= 0) this.open.length = at;
    this.names = [];
    this.place = 'nothing';
  }
}

function unquoted(name: string): string {
  if (!name.includes('\\')) return name;
  try {
    return JSON.parse(`"${name}"`) as string;
  } catch {
    return name;
  }
}

const HEADER = /[ \t]*\[\[?[ \t]*(?!(?:true|false|inf|nan)\b)[A-Za-z_][\w-]*[ \t]*(?:\.[^\n=]*)?\]\]?[ \t]*(?:#.*)?\r?$/my;
const ASSIGNMENT = /[ \t]*[A-Za-z_][\w-]*(?:[ \t]*\.[ \t]*[\w"'-]+)*[ \t]*=/y;

/** Can a line only be the beginning of something new, so that what is open was forgotten? In a list there are no keys. */
function beginsStatement(text: string, lineStart: number, inList: boolean): boolean {
  return matchEnd(HEADER, text, lineStart) !== undefined || (inList && matchEnd(ASSIGNMENT, text, lineStart) !== undefined);
}
