/** The rays of one sample as a tree: who follows whom, how much each matters, what a folded tree shows. */

import type { Color, RayNode } from './data';

/** One line of the text tree. */
export interface Row {
  id: number;
  parent: number | null;
  /** The top has level 1, as in `aria-level`. */
  level: number;
  /** Place among the rays of the same parent, counted from 1, and how many there are. */
  place: number;
  siblings: number;
  expandable: boolean;
  expanded: boolean;
}

export class TreeModel {
  readonly roots: number[] = [];
  private readonly below: number[][];
  private readonly total: number;

  constructor(readonly nodes: RayNode[]) {
    this.below = nodes.map(() => []);
    for (const { id, parent } of nodes) (parent === null ? this.roots : this.below[parent]!).push(id);
    this.total = this.roots.reduce((sum, id) => sum + brightness(nodes[id]!.subtotal), 0);
  }

  children(id: number): number[] {
    return this.below[id]!;
  }

  /** How much of the sample's light comes along this ray, from 0 to 1; all channels count the same. */
  share(id: number): number {
    return this.total > 0 ? Math.min(1, brightness(this.nodes[id]!.subtotal) / this.total) : 0;
  }

  /** From the top down to `id`, both included. */
  path(id: number): number[] {
    const path: number[] = [];
    for (let at: number | null = id; at !== null; at = this.nodes[at]!.parent) path.unshift(at);
    return path;
  }

  /** What happens on the path to a ray: the same for rays of other pixels that come the same way. */
  way(id: number): string[] {
    return this.path(id).map((at) => {
      const { kind, band_nm, hit } = this.nodes[at]!;
      return `${kind} ${band_nm} ${hit?.object}`;
    });
  }

  /** The first ray that has come a way, if there is one. */
  find(way: string[]): number | null {
    const found = this.nodes.find(({ id }) => {
      const own = this.way(id);
      return own.length === way.length && own.every((step, index) => step === way[index]);
    });
    return found?.id ?? null;
  }

  /**
   * The `limit` rays with the largest shares, in the order of their ids.
   * None is without its parent: no ray has a larger share than its parent, which comes first among equals.
   */
  strongest(limit: number): number[] {
    const byShare = this.nodes.map(({ id }) => id).sort((a, b) => this.share(b) - this.share(a) || a - b);
    return byShare.slice(0, limit).sort((a, b) => a - b);
  }

  /** The rows that can be seen if just the rays in `expanded` are unfolded. */
  rows(expanded: ReadonlySet<number>): Row[] {
    const rows: Row[] = [];
    // A stack of its own: a light path may be deeper than the stack of calls.
    const waiting: Row[] = this.rowsOf(this.roots, null, 1, expanded).reverse();
    for (let row = waiting.pop(); row !== undefined; row = waiting.pop()) {
      rows.push(row);
      if (row.expanded) waiting.push(...this.rowsOf(this.children(row.id), row.id, row.level + 1, expanded).reverse());
    }
    return rows;
  }

  private rowsOf(ids: number[], parent: number | null, level: number, expanded: ReadonlySet<number>): Row[] {
    return ids.map((id, index) => {
      const expandable = this.children(id).length > 0;
      const place = { place: index + 1, siblings: ids.length };
      return { id, parent, level, ...place, expandable, expanded: expandable && expanded.has(id) };
    });
  }
}

/** Not weighted for the eye: a blue ray explains as much as a green one. */
function brightness(color: Color): number {
  return Math.max(0, color[0] + color[1] + color[2]);
}
