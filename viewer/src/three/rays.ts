/** The rays of a pixel as lines, the selected one and its way through the scene brought forward. */

import { Group } from 'three';
import type { RayNode, Vec3 } from '../data';
import { along, lineOpacity, lineWidth, rayLine, shadowLines, stepLine } from '../lines';
import type { TreeModel } from '../model';
import type { Theme } from '../theme';
import { type DrawnLine, LineSet, type ScreenUniforms } from './line-set';
import { type Mark, MarkSet } from './marks';

export interface RayState {
  selected: number | null;
  hovered: number | null;
  allShadows: boolean;
}

/** Of rays beside the way to the selected one. */
const DIMMED = 0.35;

export class Rays {
  readonly group = new Group();
  private readonly lines: LineSet;
  private readonly marks: MarkSet;

  /** `nodes` are those of the model where they are drawn; `drawn` the ids of the rays that are shown unless they are selected. */
  constructor(
    private readonly model: TreeModel,
    private readonly nodes: RayNode[],
    private readonly drawn: number[],
    private readonly reach: number,
    private readonly eye: Vec3,
    uniforms: ScreenUniforms,
  ) {
    this.lines = new LineSet(uniforms);
    this.marks = new MarkSet(uniforms);
    this.group.add(this.lines.group, this.marks.points);
  }

  show(state: RayState, theme: Theme): void {
    const way = new Set(state.selected === null ? [] : this.model.path(state.selected));
    const ids = [...new Set([...this.drawn, ...way])];
    // The important ones are drawn last, over the others.
    ids.sort((a, b) => Number(way.has(a)) - Number(way.has(b)) || this.model.share(a) - this.model.share(b));
    const dim = (id: number) => (way.size === 0 || way.has(id) ? 1 : DIMMED);
    const shaded = state.allShadows ? ids : ids.filter((id) => id === state.selected);
    this.lines.set([
      ...[state.selected, state.hovered].flatMap((id) => (id === null ? [] : [this.halo(id, id === state.selected, theme)])),
      ...shaded.flatMap((id) => this.shadows(id, dim(id), theme)),
      ...this.model.roots.flatMap((id) => this.fromEye(id, dim(id), theme)),
      ...ids.flatMap((id) => this.step(id, dim(id), theme)),
      ...ids.map((id) => this.ray(id, id === state.selected, dim(id), theme)),
      ...(state.selected === null ? [] : this.normal(state.selected, theme)),
    ]);
    this.marks.set(ids.flatMap((id) => this.end(id, id === state.selected, dim(id), theme)));
  }

  dispose(): void {
    this.lines.dispose();
    this.marks.dispose();
  }

  /** In the models whose rays begin at the image plane, a thin line shows where they come from. */
  private fromEye(id: number, dim: number, theme: Theme): DrawnLine[] {
    const { origin } = this.nodes[id]!;
    if (origin.every((x, axis) => x === this.eye[axis])) return [];
    return [{ from: this.eye, to: origin, open: false, color: theme.rays.camera, width: 1.2, opacity: 0.8 * dim }];
  }

  private ray(id: number, selected: boolean, dim: number, theme: Theme): DrawnLine {
    const node = this.nodes[id]!;
    const share = this.model.share(id);
    const width = lineWidth(share) + (selected ? 1 : 0);
    const opacity = selected ? 1 : dim * lineOpacity(share);
    return { ...rayLine(node, this.reach), color: theme.rays[node.kind], width, opacity, arrow: true };
  }

  /** What a model of light goes through at once is drawn as a way inside. */
  private step(id: number, dim: number, theme: Theme): DrawnLine[] {
    const node = this.nodes[id]!;
    const line = node.parent === null ? null : stepLine(this.nodes[node.parent]!, node);
    const share = this.model.share(id);
    return line === null ? [] : [{ ...line, color: theme.rays.inside, width: lineWidth(share), opacity: dim * lineOpacity(share) }];
  }

  private halo(id: number, selected: boolean, theme: Theme): DrawnLine {
    const width = lineWidth(this.model.share(id)) + 10;
    return { ...rayLine(this.nodes[id]!, this.reach), color: theme.accent, width, opacity: selected ? 0.4 : 0.25 };
  }

  private shadows(id: number, dim: number, theme: Theme): DrawnLine[] {
    const look = { color: theme.rays.shadow, width: 1.5, opacity: 0.9 * dim };
    return shadowLines(this.nodes[id]!, this.reach).map((line) => ({ ...line, ...look, dashed: line.blocked }));
  }

  private normal(id: number, theme: Theme): DrawnLine[] {
    const { hit } = this.nodes[id]!;
    if (hit === null) return [];
    const to = along(hit.point, hit.normal, this.reach / 6);
    return [{ from: hit.point, to, open: false, color: theme.ink, width: 1.2, opacity: 0.8 }];
  }

  private end(id: number, selected: boolean, dim: number, theme: Theme): Mark[] {
    const node = this.nodes[id]!;
    if (node.hit === null) return [];
    const size = selected ? 8 : 3 + lineWidth(this.model.share(id));
    return [{ at: node.hit.point, color: selected ? theme.ink : theme.rays[node.kind], size, opacity: dim }];
  }
}
