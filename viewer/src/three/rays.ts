/** The rays of a pixel as lines, the selected one and its way through the scene brought forward. */

import { Group } from 'three';
import type { Figure } from '../angles';
import type { RayNode, Vec3 } from '../data';
import { lineOpacity, lineWidth, rayLine, shadowLines, stepLine } from '../lines';
import type { TreeModel } from '../model';
import { spectralColor } from '../spectrum';
import type { Theme } from '../theme';
import { type DrawnLine, LineSet, type ScreenUniforms } from './line-set';
import { type Mark, MarkSet } from './marks';

export interface RayState {
  selected: number | null;
  hovered: number | null;
  allShadows: boolean;
  /** Later rays are not shown. */
  generation: number;
}

/** The rays of one sample, and where they are drawn. */
export interface DrawnSample {
  model: TreeModel;
  /** Those of the model, in the drawing's own unit. */
  nodes: RayNode[];
  /** The ids of the rays that are shown even if they are not selected. */
  drawn: number[];
  /** How far a ray is drawn that leaves the scene. */
  reach: number;
  eye: Vec3;
}

/** Of rays beside the way to the selected one. */
const DIMMED = 0.35;

export class Rays {
  readonly group = new Group();
  private readonly lines: LineSet;
  private readonly marks: MarkSet;

  constructor(uniforms: ScreenUniforms) {
    this.lines = new LineSet(uniforms);
    this.marks = new MarkSet(uniforms);
    this.group.add(this.lines.group, this.marks.points);
  }

  /** With the figure of angles at the selected ray. */
  show(sample: DrawnSample | null, figure: Figure | null, state: RayState, theme: Theme): void {
    const { lines, marks } = sample === null ? { lines: [], marks: [] } : new Look(sample, state, theme);
    this.lines.set([...lines, ...(figure === null ? [] : drawnFigure(figure, theme))]);
    this.marks.set(marks);
  }

  dispose(): void {
    this.lines.dispose();
    this.marks.dispose();
  }
}

function drawnFigure({ normal, arcs }: Figure, theme: Theme): DrawnLine[] {
  const look = { color: theme.ink, width: 1.6, opacity: 0.9 };
  const pieces = arcs.flatMap(({ points }) => points.slice(1).map((to, index) => ({ from: points[index]!, to, open: false, ...look })));
  return [{ ...normal, ...look, width: 1.3, dashed: true }, ...pieces];
}

/** What the rays look like at a time. */
class Look {
  readonly lines: DrawnLine[];
  readonly marks: Mark[];

  constructor(
    private readonly sample: DrawnSample,
    { selected, hovered, allShadows, generation }: RayState,
    private readonly theme: Theme,
  ) {
    const { model, drawn } = sample;
    const way = new Set(selected === null ? [] : model.path(selected));
    const ids = [...new Set([...drawn, ...way])].filter((id) => model.generation(id) <= generation);
    // The important ones are drawn last, over the others.
    ids.sort((a, b) => Number(way.has(a)) - Number(way.has(b)) || model.share(a) - model.share(b));
    const dim = (id: number) => (way.size === 0 || way.has(id) ? 1 : DIMMED);
    const shaded = allShadows ? ids : ids.filter((id) => id === selected);
    this.lines = [
      ...[selected, hovered].flatMap((id) => (id === null ? [] : [this.halo(id, id === selected)])),
      ...shaded.flatMap((id) => this.shadows(id, dim(id))),
      ...model.roots.flatMap((id) => this.fromEye(id, dim(id))),
      ...ids.flatMap((id) => this.step(id, dim(id))),
      ...ids.map((id) => this.ray(id, id === selected, dim(id))),
    ];
    this.marks = ids.flatMap((id) => this.end(id, id === selected, dim(id)));
  }

  /** In the models whose rays begin at the image plane, a thin line shows where they come from. */
  private fromEye(id: number, dim: number): DrawnLine[] {
    const { origin } = this.node(id);
    const { eye } = this.sample;
    if (origin.every((x, axis) => x === eye[axis])) return [];
    return [{ from: eye, to: origin, open: false, color: this.theme.rays.camera, width: 1.2, opacity: 0.8 * dim }];
  }

  private ray(id: number, selected: boolean, dim: number): DrawnLine {
    const node = this.node(id);
    const share = this.share(id);
    const width = lineWidth(share) + (selected ? 1 : 0);
    const opacity = selected ? 1 : dim * lineOpacity(share);
    return { ...rayLine(node, this.sample.reach), color: this.color(node), width, opacity, arrow: true };
  }

  /** What a model of light goes through at once is drawn as a way inside. */
  private step(id: number, dim: number): DrawnLine[] {
    const node = this.node(id);
    const line = node.parent === null ? null : stepLine(this.node(node.parent), node);
    const share = this.share(id);
    if (line === null) return [];
    const color = this.color({ ...node, kind: 'inside' });
    return [{ ...line, color, width: lineWidth(share), opacity: dim * lineOpacity(share) }];
  }

  private halo(id: number, selected: boolean): DrawnLine {
    const width = lineWidth(this.share(id)) + 10;
    return { ...rayLine(this.node(id), this.sample.reach), color: this.theme.accent, width, opacity: selected ? 0.4 : 0.25 };
  }

  private shadows(id: number, dim: number): DrawnLine[] {
    const look = { color: this.theme.rays.shadow, width: 1.5, opacity: 0.9 * dim };
    return shadowLines(this.node(id), this.sample.reach).map((line) => ({ ...line, ...look, dashed: line.blocked }));
  }

  private end(id: number, selected: boolean, dim: number): Mark[] {
    const node = this.node(id);
    if (node.hit === null) return [];
    const size = selected ? 8 : 3 + lineWidth(this.share(id));
    return [{ at: node.hit.point, color: selected ? this.theme.ink : this.color(node), size, opacity: dim }];
  }

  private color(node: RayNode): string {
    return node.band_nm === null ? this.theme.rays[node.kind] : spectralColor(node.band_nm, this.theme.spectrum);
  }

  private node(id: number): RayNode {
    return this.sample.nodes[id]!;
  }

  private share(id: number): number {
    return this.sample.model.share(id);
  }
}
