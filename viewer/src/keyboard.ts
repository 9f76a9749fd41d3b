/** What a key does in the tree, after the practice for trees of WAI-ARIA. */

import type { Row } from './model';

export type TreeAction =
  | { do: 'focus'; id: number }
  | { do: 'select'; id: number }
  | { do: 'expand'; ids: number[] }
  | { do: 'collapse'; ids: number[] };

/** `rows` are those that can be seen, `current` is the one with the focus. `label` is what it is found by when typing. */
export function treeAction(key: string, rows: Row[], current: number, label: (id: number) => string): TreeAction | null {
  const at = rows.findIndex((row) => row.id === current);
  const row = rows[at];
  if (row === undefined) return null;
  const focus = (other: Row | undefined): TreeAction | null => (other ? { do: 'focus', id: other.id } : null);
  switch (key) {
    case 'ArrowDown':
      return focus(rows[at + 1]);
    case 'ArrowUp':
      return focus(rows[at - 1]);
    case 'Home':
      return focus(rows[0]);
    case 'End':
      return focus(rows[rows.length - 1]);
    case 'ArrowRight':
      if (row.expandable && !row.expanded) return { do: 'expand', ids: [row.id] };
      return row.expanded ? focus(rows[at + 1]) : null;
    case 'ArrowLeft':
      if (row.expanded) return { do: 'collapse', ids: [row.id] };
      return focus(rows.find((other) => other.id === row.parent));
    case 'Enter':
    case ' ':
      return { do: 'select', id: row.id };
    case '*':
      return { do: 'expand', ids: rows.filter((r) => r.parent === row.parent && r.expandable).map((r) => r.id) };
  }
  if (key.length !== 1) return null;
  const others = [...rows.slice(at + 1), ...rows.slice(0, at)];
  return focus(others.find((other) => label(other.id).toLowerCase().startsWith(key.toLowerCase())));
}
