/** The ray tree as text: an ARIA tree whose rows are made when they are unfolded. */

import { cssColor } from './color';
import type { Transfer } from './data';
import { element, stroke, swatch } from './dom';
import { treeAction } from './keyboard';
import type { Row, TreeModel } from './model';
import { percent, rayTitle } from './words';

export interface TreeEvents {
  select(id: number): void;
  hover(id: number | null): void;
}

/** Deeper rows are not indented more: a narrow panel must show their text. */
const MAX_INDENT = 10;

export class TreeView {
  readonly root = element('div', { role: 'tree', class: 'tree', 'aria-label': 'Ray tree' });
  private readonly rows = new Map<number, HTMLElement>();
  private readonly expanded: Set<number>;
  /** The one row that Tab reaches. */
  private current: number | undefined;

  constructor(
    private readonly model: TreeModel,
    private readonly transfer: Transfer,
    private readonly events: TreeEvents,
  ) {
    this.expanded = new Set(model.roots);
    this.current = model.roots[0];
    this.render();
    this.root.addEventListener('keydown', (event) => this.onKey(event));
    this.root.addEventListener('click', (event) => this.onClick(event));
    this.root.addEventListener('pointerover', (event) => this.events.hover(rowId(event.target)));
    this.root.addEventListener('pointerleave', () => this.events.hover(null));
    this.root.addEventListener('focusin', (event) => this.events.hover(rowId(event.target)));
    this.root.addEventListener('focusout', () => this.events.hover(null));
  }

  /** Unfolds what is above the selected row, and scrolls to it. */
  select(id: number | null): void {
    if (id !== null) {
      for (const above of this.model.path(id).slice(0, -1)) this.expanded.add(above);
      this.current = id;
    }
    this.render();
    for (const [row, item] of this.rows) item.setAttribute('aria-selected', String(row === id));
    if (id !== null) this.rows.get(id)!.scrollIntoView({ block: 'nearest' });
  }

  hover(id: number | null): void {
    for (const [row, item] of this.rows) item.classList.toggle('hovered', row === id);
  }

  private onKey(event: KeyboardEvent): void {
    if (event.altKey || event.ctrlKey || event.metaKey || this.current === undefined) return;
    const rows = this.model.rows(this.expanded);
    const action = treeAction(event.key, rows, this.current, (id) => rayTitle(this.model.nodes[id]!));
    if (action === null) return;
    event.preventDefault();
    if (action.do === 'select') return this.events.select(action.id);
    if (action.do === 'focus') this.current = action.id;
    else for (const id of action.ids) this.fold(id, action.do === 'collapse');
    this.render();
    this.rows.get(this.current)!.focus();
  }

  private onClick(event: MouseEvent): void {
    const id = rowId(event.target);
    if (id === null) return;
    this.current = id;
    if ((event.target as Element).closest('.twist') && this.model.children(id).length > 0) {
      this.fold(id, this.expanded.has(id));
      this.render();
    } else {
      this.events.select(id);
    }
    this.rows.get(id)!.focus();
  }

  private fold(id: number, closed: boolean): void {
    if (closed) this.expanded.delete(id);
    else this.expanded.add(id);
  }

  /** Rows that stay are not moved, so that they keep the focus. */
  private render(): void {
    const rows = this.model.rows(this.expanded);
    if (!rows.some((row) => row.id === this.current)) this.current = rows[0]?.id;
    const shown = new Set(rows.map((row) => row.id));
    for (const [id, item] of this.rows) if (!shown.has(id)) item.remove();
    let previous: Element | null = null;
    for (const row of rows) {
      const item = this.rows.get(row.id) ?? this.makeRow(row);
      if (row.expandable) item.setAttribute('aria-expanded', String(row.expanded));
      item.tabIndex = row.id === this.current ? 0 : -1;
      const place: Element | null = previous === null ? this.root.firstElementChild : previous.nextElementSibling;
      if (place !== item) this.root.insertBefore(item, place);
      previous = item;
    }
  }

  private makeRow(row: Row): HTMLElement {
    const node = this.model.nodes[row.id]!;
    const share = percent(this.model.share(row.id));
    const title = rayTitle(node);
    const item = element(
      'div',
      {
        role: 'treeitem',
        class: 'row',
        'data-id': row.id,
        'aria-level': row.level,
        'aria-setsize': row.siblings,
        'aria-posinset': row.place,
        'aria-selected': false,
        'aria-label': `${title}, ${share} of the light`,
      },
      element('span', { class: 'twist', 'aria-hidden': true }),
      stroke(node.kind),
      element('span', { class: 'title' }, title),
      swatch(cssColor(node.subtotal, this.transfer)),
      element('span', { class: 'share' }, share),
    );
    item.style.setProperty('--indent', String(Math.min(row.level - 1, MAX_INDENT)));
    this.rows.set(row.id, item);
    return item;
  }
}

function rowId(target: EventTarget | null): number | null {
  const row = target instanceof Element ? target.closest<HTMLElement>('.row') : null;
  return row === null ? null : Number(row.dataset.id);
}
