/** The rays of one sample as a tree: who follows whom, how much each matters, what a folded tree shows. */

import type { Color, RayNode } from './data';

/** Children with less than this of the sample's light share a row, if together they have less than `FEW`. */
const [WEAK, FEW] = [0.01, 0.05];

/**
 * One line of the text tree: a ray, or children of a ray that matter little and share a line. The id of such a line is the
 * complement of their parent's, `~parent`.
 */
export interface Row {
  id: number;
  /** The id of the row above it in the tree. */
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
  /** The last generation. */
  readonly last: number;
  private readonly below: number[][];
  private readonly generations: number[] = [];
  private readonly total: number;

  constructor(readonly nodes: RayNode[]) {
    this.below = nodes.map(() => []);
    for (const { id, parent } of nodes) (parent === null ? this.roots : this.below[parent]!).push(id);
    for (const { parent } of nodes) this.generations.push(parent === null ? 0 : this.generations[parent]! + 1);
    this.last = this.generations.reduce((most, generation) => Math.max(most, generation), 0);
    this.total = this.roots.reduce((sum, id) => sum + brightness(nodes[id]!.subtotal), 0);
  }

  children(id: number): number[] {
    return this.below[id]!;
  }

  /** How many rays come before this one on its path. */
  generation(id: number): number {
    return this.generations[id]!;
  }

  /**
   * What the rays up to a generation add to the sample, in the order in which Snell adds: up to the last one, that is the colour of
   * the sample, bit for bit.
   */
  colorUntil(generation: number): Color {
    const sum: Color = [0, 0, 0];
    for (const { id, contribution } of this.nodes) {
      if (this.generations[id]! <= generation) contribution.forEach((value, channel) => (sum[channel]! += value));
    }
    return sum;
  }

  /** How many rays there are up to a generation. */
  countUntil(generation: number): number {
    return this.generations.filter((own) => own <= generation).length;
  }

  /** How much of the sample's light comes along this ray or row, from 0 to 1; all channels count the same. */
  share(id: number): number {
    if (id < 0) return this.others(~id).reduce((sum, other) => sum + this.share(other), 0);
    return this.total > 0 ? Math.min(1, brightness(this.nodes[id]!.subtotal) / this.total) : 0;
  }

  /** The children of a ray that share a row. Never only one: its row would be no shorter. Where all is black, nothing matters less. */
  others(id: number): number[] {
    if (this.total === 0) return [];
    const weak = this.children(id).filter((child) => this.share(child) < WEAK);
    return weak.length > 1 && weak.reduce((sum, child) => sum + this.share(child), 0) < FEW ? weak : [];
  }

  /** The rows that must be unfolded for the row of a ray to be seen. */
  above(id: number): number[] {
    const path = this.path(id);
    return path.slice(0, -1).flatMap((at, index) => (this.others(at).includes(path[index + 1]!) ? [at, ~at] : [at]));
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

  /** The rows that can be seen if just those in `expanded` are unfolded, up to a generation. */
  rows(expanded: ReadonlySet<number>, last = Infinity): Row[] {
    const rows: Row[] = [];
    // A stack of its own: a light path may be deeper than the stack of calls.
    const waiting: Row[] = this.rowsOf(this.roots, null, 1, expanded, last).reverse();
    for (let row = waiting.pop(); row !== undefined; row = waiting.pop()) {
      rows.push(row);
      if (row.expanded) waiting.push(...this.rowsOf(this.rowsBelow(row.id), row.id, row.level + 1, expanded, last).reverse());
    }
    return rows;
  }

  private rowsBelow(id: number): number[] {
    if (id < 0) return this.others(~id);
    const others = new Set(this.others(id));
    return others.size === 0 ? this.children(id) : [...this.children(id).filter((child) => !others.has(child)), ~id];
  }

  private rowsOf(ids: number[], parent: number | null, level: number, expanded: ReadonlySet<number>, last: number): Row[] {
    return ids.map((id, index) => {
      const expandable = id < 0 || (this.children(id).length > 0 && this.generation(id) < last);
      const place = { place: index + 1, siblings: ids.length };
      return { id, parent, level, ...place, expandable, expanded: expandable && expanded.has(id) };
    });
  }
}

/** Not weighted for the eye: a blue ray explains as much as a green one. */
function brightness(color: Color): number {
  return Math.max(0, color[0] + color[1] + color[2]);
}
