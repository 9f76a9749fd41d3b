/** The scene's text, to be edited. It has no history of its own: undo is the page's, and covers the views as well. */

import { autocompletion, type Completion, completionKeymap, type CompletionSource, startCompletion } from '@codemirror/autocomplete';
import { defaultKeymap } from '@codemirror/commands';
import { bracketMatching, codeFolding, foldGutter, foldKeymap, foldService } from '@codemirror/language';
import { type Diagnostic, lintGutter, lintKeymap, setDiagnostics } from '@codemirror/lint';
import { highlightSelectionMatches, search, searchKeymap } from '@codemirror/search';
import { Annotation, Compartment, EditorState, type Text } from '@codemirror/state';
import {
  drawSelection, EditorView, highlightActiveLine, highlightActiveLineGutter, hoverTooltip, keymap, lineNumbers, type Rect, type Tooltip,
} from '@codemirror/view';
import type { Finding } from '../engine/protocol';
import { type KnownNames, type Suggestion, suggestionsAt } from './complete';
import { type Lines, linesOf, minimalChange, offsetOf, withLines } from './lines';
import { entryAt } from './schema';
import { style, toml } from './style';
import { keysOf } from './toml';

export interface EditorOptions {
  text: string;
  /** A person has changed it. */
  onChange(text: string): void;
  /** For readers of screens. */
  label: string;
  readOnly?: boolean;
  /** What can be named, as it is now. */
  known?: () => KnownNames;
  /** Undo was chosen in a menu of the browser, which knows nothing of the page's. */
  onHistory?(step: 'undo' | 'redo'): void;
}

const fromOutside = Annotation.define<true>();

export class SourceEditor {
  private readonly view: EditorView;
  private readonly scheme = new Compartment();
  /** What the text is like as a file. */
  private lines: Lines;

  constructor(parent: HTMLElement, private readonly options: EditorOptions) {
    this.lines = linesOf(options.text);
    const { label, readOnly = false, known = () => ({}) } = options;
    this.view = new EditorView({
      parent,
      doc: this.lines.text,
      extensions: [
        lineNumbers(),
        foldGutter(),
        lintGutter(),
        drawSelection(),
        bracketMatching(),
        highlightActiveLine(),
        highlightActiveLineGutter(),
        highlightSelectionMatches(),
        search({ top: true }),
        toml,
        foldService.of(tableAt),
        codeFolding(),
        autocompletion({ override: [completions(known)], icons: false, positionInfo: besideOrBelow }),
        hoverTooltip(explanation),
        // Tab is not among them: it leaves the editor, as it leaves everything else.
        keymap.of([...completionKeymap, ...searchKeymap, ...foldKeymap, ...lintKeymap, ...defaultKeymap]),
        EditorState.readOnly.of(readOnly),
        // It can be focused anyway, but not all tools see that.
        EditorView.contentAttributes.of({ 'aria-label': label, spellcheck: 'false', tabindex: '0' }),
        EditorView.domEventHandlers({ beforeinput: (event) => this.takeHistory(event) }),
        EditorView.updateListener.of((update) => {
          const isTyped = update.docChanged && !update.transactions.some((transaction) => transaction.annotation(fromOutside));
          if (isTyped) options.onChange(withLines(update.state.doc.toString(), this.lines));
        }),
        style,
        this.scheme.of([]),
      ],
    });
  }

  get text(): string {
    return withLines(this.view.state.doc.toString(), this.lines);
  }

  /** Takes what was not typed here. Cursor, scroll and folds stay where the text stays. */
  setText(text: string): void {
    this.lines = linesOf(text);
    const change = minimalChange(this.view.state.doc.toString(), this.lines.text);
    if (change) this.view.dispatch({ changes: change, annotations: fromOutside.of(true) });
  }

  /** Shows what was found in the text. Of what lies in other files nothing is shown, if the name of this one is given. */
  setFindings(findings: readonly Finding[], file?: string): void {
    const { doc } = this.view.state;
    const here = findings.filter(({ place }) => place && (file === undefined || place.file === file));
    this.view.dispatch(setDiagnostics(this.view.state, here.map((finding) => diagnostic(finding, doc))));
  }

  /** Puts the cursor to a place, counted from 1, and scrolls to it. */
  reveal(line: number, column: number): void {
    const anchor = offsetOf(this.view.state.doc, line, column);
    this.view.dispatch({ selection: { anchor }, effects: EditorView.scrollIntoView(anchor, { y: 'center' }) });
  }

  focus(): void {
    this.view.focus();
  }

  setTheme(theme: 'light' | 'dark'): void {
    this.view.dispatch({ effects: this.scheme.reconfigure(EditorView.darkTheme.of(theme === 'dark')) });
  }

  dispose(): void {
    this.view.destroy();
  }

  private takeHistory(event: InputEvent): boolean {
    const step = event.inputType === 'historyUndo' ? 'undo' : event.inputType === 'historyRedo' ? 'redo' : null;
    if (step === null) return false;
    event.preventDefault();
    this.options.onHistory?.(step);
    return true;
  }
}

/** A table is folded from the end of its header to the end of what stands in it. */
function tableAt(state: EditorState, lineStart: number): { from: number; to: number } | null {
  const header = state.doc.lineAt(lineStart);
  if (!HEADER.test(header.text)) return null;
  let last = header;
  for (let number = header.number + 1; number <= state.doc.lines; number += 1) {
    const line = state.doc.line(number);
    if (HEADER.test(line.text)) break;
    // Comments directly above a header belong to that.
    if (/^\s*[^#\s]/.test(line.text)) last = line;
  }
  return last.number > header.number ? { from: header.to, to: last.to } : null;
}

const HEADER = /^\[\[?[^\],=]+\]\]?[ \t]*(#.*)?$/;

function completions(known: () => KnownNames): CompletionSource {
  return ({ state, pos, explicit }) => {
    const text = state.doc.toString();
    const { from, to, suggestions } = suggestionsAt(text, pos, known());
    const isWord = from < pos || /["'[=]\s?$/.test(text.slice(Math.max(0, pos - 2), pos));
    if (suggestions.length === 0 || !(explicit || isWord)) return null;
    const behind = to - pos;
    const options = suggestions.map((suggestion) => asCompletion(suggestion, behind));
    // Where there is a value already, all others can be taken instead.
    const hasValue = explicit && suggestions[0]!.kind === 'value' && behind > 0;
    return hasValue ? { from, options, filter: false } : { from, options, validFor: /^[\w -]*$/ };
  };
}

/** Where the description of a completion goes: never over the other ones. */
function besideOrBelow(_view: EditorView, list: Rect, _option: Rect, info: Rect, space: Rect): { style: string } {
  if (list.right + info.right - info.left <= space.right) return { style: 'left: 100%; top: 0' };
  const isRoomBelow = list.bottom + info.bottom - info.top <= space.bottom;
  return { style: isRoomBelow ? 'left: 0; top: 100%' : 'left: 0; bottom: 100%' };
}

function asCompletion({ name, kind, insert, detail, description, isRequired }: Suggestion, behind: number): Completion {
  return {
    label: name,
    ...(detail && { detail }),
    ...(description && { info: () => prose(description) }),
    type: kind === 'value' ? 'constant' : kind === 'key' ? 'property' : 'namespace',
    boost: isRequired ? 1 : 0,
    apply: (view, _completion, from, to) => {
      const end = Math.min(view.state.doc.length, to + behind);
      const anchor = from + insert.length;
      view.dispatch({ changes: { from, to: end, insert }, selection: { anchor }, userEvent: 'input.complete' });
      if (kind === 'key') startCompletion(view);
    },
  };
}

/** What a key means. */
function explanation(view: EditorView, at: number): Tooltip | null {
  const key = keysOf(view.state.doc.toString()).find(({ from, to }) => from <= at && at <= to);
  const entry = key && entryAt(key.path);
  if (!entry) return null;
  const { name, description, isRequired } = entry;
  const note = isRequired ? 'It is required.' : entry.default === undefined ? '' : `Left out, it is \`${entry.default}\`.`;
  const create = () => {
    const dom = document.createElement('div');
    dom.className = 'cm-explanation';
    const title = document.createElement('strong');
    title.textContent = name;
    dom.append(title, prose(`${description} ${note}`));
    return { dom };
  };
  return { pos: key.from, end: key.to, above: true, create };
}

/** A description, of which only the code is marked up. */
function prose(text: string): HTMLElement {
  const paragraph = document.createElement('p');
  text.split('`').forEach((part, index) => {
    const node = document.createElement(index % 2 === 1 ? 'code' : 'span');
    node.textContent = part;
    paragraph.append(node);
  });
  return paragraph;
}

function diagnostic({ code, message, help, place }: Finding, doc: Text): Diagnostic {
  const from = offsetOf(doc, place!.line, place!.column);
  const to = Math.max(from, offsetOf(doc, place!.end_line, place!.end_column));
  return {
    from,
    to,
    severity: code === undefined ? 'error' : 'warning',
    message: help === undefined ? message : `${message}: ${help}`,
    ...(code !== undefined && { source: code }),
    renderMessage: () => {
      const dom = document.createElement('div');
      dom.append(prose(message), ...(help === undefined ? [] : [prose(help)]));
      return dom;
    },
  };
}
