/** The ray tree as text: an ARIA tree whose rows are made when they are unfolded. */

import { cssColor } from './color';
import type { Color, Transfer } from './data';
import { element, rayStroke, swatch } from './dom';
import { treeAction } from './keyboard';
import type { Row, TreeModel } from './model';
import { percent, rayTitle } from './words';

export interface TreeEvents {
  select(id: number): void;
  hover(id: number | null): void;
}

/** Deeper rows are not indented more: a narrow panel must show their text. */
const MAX_INDENT = 10;
/** While generations are shown one after the other. */
const MAX_UNFOLDED = 100;

export class TreeView {
  readonly root = element('div', { role: 'tree', class: 'tree', 'aria-label': 'Ray tree' });
  private readonly rows = new Map<number, HTMLElement>();
  private readonly expanded: Set<number>;
  /** The one row that Tab reaches. */
  private current: number | undefined;
  /** Rays of later generations have no row. */
  private last = Infinity;

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
    this.root.addEventListener('pointerover', (event) => this.events.hover(rayId(event.target)));
    this.root.addEventListener('pointerleave', () => this.events.hover(null));
    this.root.addEventListener('focusin', (event) => this.events.hover(rayId(event.target)));
    this.root.addEventListener('focusout', () => this.events.hover(null));
  }

  /** Unfolds what is above the selected row, and scrolls to it. */
  select(id: number | null): void {
    if (id !== null) {
      for (const above of this.model.above(id)) this.expanded.add(above);
      this.current = id;
    }
    this.render();
    for (const [row, item] of this.rows) if (row >= 0) item.setAttribute('aria-selected', String(row === id));
    if (id !== null) this.rows.get(id)!.scrollIntoView({ block: 'nearest' });
  }

  /** Shows the rays up to a generation, with those unfolded that matter. */
  showUntil(generation: number): void {
    this.last = generation;
    for (const id of this.model.strongest(MAX_UNFOLDED)) if (this.model.generation(id) < generation) this.expanded.add(id);
    this.render();
  }

  hover(id: number | null): void {
    for (const [row, item] of this.rows) item.classList.toggle('hovered', row === id);
  }

  private onKey(event: KeyboardEvent): void {
    if (event.altKey || event.ctrlKey || event.metaKey || this.current === undefined) return;
    const rows = this.model.rows(this.expanded, this.last);
    const action = treeAction(event.key, rows, this.current, (id) => this.title(id));
    if (action === null) return;
    event.preventDefault();
    if (action.do === 'select' && action.id >= 0) return this.events.select(action.id);
    if (action.do === 'focus') this.current = action.id;
    else if (action.do === 'select') this.fold(action.id, this.expanded.has(action.id));
    else for (const id of action.ids) this.fold(id, action.do === 'collapse');
    this.render();
    this.rows.get(this.current)!.focus();
  }

  private onClick(event: MouseEvent): void {
    const id = rowId(event.target);
    if (id === null) return;
    this.current = id;
    const twist = (event.target as Element).closest('.twist') !== null && this.model.children(id).length > 0;
    if (id < 0 || twist) {
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
    const rows = this.model.rows(this.expanded, this.last);
    if (!rows.some((row) => row.id === this.current)) this.current = rows[0]?.id;
    const shown = new Set(rows.map((row) => row.id));
    for (const [id, item] of this.rows) if (!shown.has(id)) item.remove();
    let previous: Element | null = null;
    for (const row of rows) {
      const item = this.rows.get(row.id) ?? this.makeRow(row);
      if (row.expandable) item.setAttribute('aria-expanded', String(row.expanded));
      else item.removeAttribute('aria-expanded');
      item.tabIndex = row.id === this.current ? 0 : -1;
      const place: Element | null = previous === null ? this.root.firstElementChild : previous.nextElementSibling;
      if (place !== item) this.root.insertBefore(item, place);
      previous = item;
    }
  }

  private makeRow(row: Row): HTMLElement {
    const share = percent(this.model.share(row.id));
    const title = this.title(row.id);
    const item = element(
      'div',
      {
        role: 'treeitem',
        class: row.id < 0 ? 'row others' : 'row',
        'data-id': row.id,
        'aria-level': row.level,
        'aria-setsize': row.siblings,
        'aria-posinset': row.place,
        // What is no ray cannot be selected.
        ...(row.id < 0 ? {} : { 'aria-selected': false }),
        'aria-label': `${title}, ${share} of the light`,
      },
      element('span', { class: 'twist', 'aria-hidden': true }),
      ...(row.id < 0 ? [] : [rayStroke(this.model.nodes[row.id]!)]),
      element('span', { class: 'title' }, title),
      // Read out, the two are words of their own.
      ' ',
      swatch(cssColor(this.subtotal(row.id), this.transfer)),
      element('span', { class: 'share' }, share),
    );
    item.style.setProperty('--indent', String(Math.min(row.level - 1, MAX_INDENT)));
    this.rows.set(row.id, item);
    return item;
  }

  private title(id: number): string {
    return id < 0 ? `${this.model.others(~id).length} others` : rayTitle(this.model.nodes[id]!);
  }

  private subtotal(id: number): Color {
    const { nodes } = this.model;
    if (id >= 0) return nodes[id]!.subtotal;
    const others = this.model.others(~id).map((other) => nodes[other]!.subtotal);
    return others.reduce<Color>((sum, own) => [sum[0] + own[0], sum[1] + own[1], sum[2] + own[2]], [0, 0, 0]);
  }
}

function rowId(target: EventTarget | null): number | null {
  const row = target instanceof Element ? target.closest<HTMLElement>('.row') : null;
  return row === null ? null : Number(row.dataset.id);
}

function rayId(target: EventTarget | null): number | null {
  const id = rowId(target);
  return id !== null && id >= 0 ? id : null;
}
