/** How the text looks, in the colours of the page: those of `setProperties` in the viewer. */

import { HighlightStyle, StreamLanguage, syntaxHighlighting } from '@codemirror/language';
import { toml as mode } from '@codemirror/legacy-modes/mode/toml';
import { EditorView } from '@codemirror/view';
import { tags } from '@lezer/highlight';

export const toml = StreamLanguage.define(mode);

const colors = HighlightStyle.define([
  { tag: tags.comment, color: 'var(--quiet)', fontStyle: 'italic' },
  { tag: tags.string, color: 'var(--ray-refracted)' },
  { tag: tags.number, color: 'var(--accent)' },
  // Headers, true and false.
  { tag: tags.atom, color: 'var(--ray-inside)', fontWeight: '600' },
]);

const MONOSPACE = "ui-monospace, 'SF Mono', Menlo, Consolas, 'DejaVu Sans Mono', monospace";

const layout = EditorView.theme({
  '&': { height: '100%', backgroundColor: 'var(--paper)', color: 'var(--ink)', fontSize: '0.8125rem' },
  '&.cm-focused': { outline: 'none' },
  // Above the gutters, which have a colour of their own.
  '&.cm-focused::after': { content: '""', position: 'absolute', inset: '0', zIndex: '300', border: '2px solid var(--accent)', pointerEvents: 'none' },
  '.cm-scroller': { fontFamily: MONOSPACE, lineHeight: '1.55' },
  '.cm-content': { caretColor: 'var(--ink)' },
  '.cm-cursor': { borderLeftColor: 'var(--ink)' },
  '.cm-gutters': { backgroundColor: 'var(--paper)', color: 'var(--quiet)', border: 'none' },
  '.cm-activeLine, .cm-activeLineGutter': { backgroundColor: 'color-mix(in srgb, var(--tint) 60%, transparent)' },
  '&.cm-focused > .cm-scroller > .cm-selectionLayer .cm-selectionBackground, .cm-selectionBackground': {
    backgroundColor: 'color-mix(in srgb, var(--accent) 25%, transparent)',
  },
  '.cm-selectionMatch, &.cm-focused .cm-matchingBracket': { backgroundColor: 'color-mix(in srgb, var(--accent) 18%, transparent)' },
  '.cm-searchMatch': { backgroundColor: 'color-mix(in srgb, var(--bulb) 35%, transparent)' },
  '.cm-foldPlaceholder': { backgroundColor: 'var(--tint)', border: '1px solid var(--line)', color: 'var(--quiet)' },
  '.cm-panels': { backgroundColor: 'var(--paper)', color: 'var(--ink)' },
  '.cm-panels.cm-panels-top': { borderBottomColor: 'var(--line)' },
  '.cm-tooltip': { backgroundColor: 'var(--paper)', color: 'var(--ink)', border: '1px solid var(--line)', borderRadius: '0.4rem', boxShadow: '0 4px 16px rgb(0 0 0 / 0.18)' },
  '.cm-tooltip p': { margin: '0', maxWidth: '28rem', whiteSpace: 'pre-wrap' },
  '.cm-tooltip code': { fontFamily: MONOSPACE, fontSize: '0.95em' },
  '.cm-explanation, .cm-tooltip .cm-completionInfo': { padding: '0.4rem 0.6rem', fontFamily: 'system-ui, sans-serif' },
  '.cm-tooltip.cm-tooltip-autocomplete > ul': { fontFamily: MONOSPACE },
  '.cm-tooltip-autocomplete ul li[aria-selected]': { backgroundColor: 'var(--accent)', color: 'var(--paper)' },
  '.cm-completionDetail': { color: 'var(--quiet)', fontStyle: 'normal' },
  'li[aria-selected] .cm-completionDetail': { color: 'inherit' },
  '.cm-button, .cm-textfield': { background: 'var(--tint)', color: 'var(--ink)', border: '1px solid var(--line)', borderRadius: '0.3rem' },
});

export const style = [layout, syntaxHighlighting(colors)];
