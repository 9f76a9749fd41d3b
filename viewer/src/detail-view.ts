/** All that is known of one ray, in words and numbers. */

import { cssColor } from './color';
import type { Color, Hit, LightAtHit, RayNode, Transfer } from './data';
import { element, swatch } from './dom';
import type { TreeModel } from './model';
import { decimal, degrees, ENDINGS, KIND_NAMES, percent, rayTitle, triple } from './words';

type Content = (Node | string)[];

export class DetailView {
  readonly root = element('section', { class: 'detail', 'aria-label': 'Selected ray' });

  constructor(private readonly transfer: Transfer) {}

  show(model: TreeModel, id: number | null): void {
    const node = id === null ? undefined : model.nodes[id];
    if (node === undefined) {
      const hint = 'Select a ray in the drawing or in the tree to see where it goes and what it adds.';
      this.root.replaceChildren(element('p', { class: 'quiet' }, hint));
      return;
    }
    const share = `${percent(model.share(node.id))} of the light of this pixel`;
    this.root.replaceChildren(
      element('h3', {}, rayTitle(node)),
      table(this.ray(node)),
      ...(node.hit ? [element('h4', {}, 'Where it ends'), table(hitRows(node.hit))] : []),
      ...(node.local ? this.surface(node) : []),
      element('h4', {}, 'What it adds'),
      table([
        ['Throughput', [triple(node.throughput)]],
        ['Here', this.color(node.contribution)],
        ['With all below', [...this.color(node.subtotal), element('br'), share]],
      ]),
    );
  }

  private ray(node: RayNode): [string, Content][] {
    const rows: [string, Content][] = [
      ['Kind', [`${KIND_NAMES[node.kind]}, depth ${node.depth}`]],
      ['Travels in', [`${node.medium}, index ${decimal(node.eta)}`]],
      ['From', [triple(node.origin)]],
      ['Direction', [triple(node.dir)]],
    ];
    if (node.band_nm !== null) rows.push(['Wavelength', [`${decimal(node.band_nm)} nm`]]);
    if (node.ended !== null) rows.push(['Ending', [ENDINGS[node.ended]]]);
    if (node.bound !== null) rows.push(['Could still add', ['at most ', ...this.color(node.bound)]]);
    return rows;
  }

  private surface(node: RayNode): Content {
    const { ambient, emission, lights } = node.local!;
    const rows: [string, Content][] = [['Ambient', this.color(ambient)]];
    if (emission.some((value) => value > 0)) rows.push(['Emission', this.color(emission)]);
    for (const light of lights) rows.push([light.name, this.light(light)]);
    return [element('h4', {}, 'Light on the surface'), table(rows)];
  }

  private light(light: LightAtHit): Content {
    if (!light.facing) return ['The surface faces away from it.'];
    const notes: Content = light.blocked_by === null ? [] : [`Blocked by ${light.blocked_by}.`];
    if (light.transmittance.every((value) => value === 0)) return notes.length > 0 ? notes : ['None of it comes through.'];
    const lines: Content[] = [...notes.map((note) => [note])];
    if (light.transmittance.some((value) => value < 1)) lines.push(['comes through: ', triple(light.transmittance)]);
    lines.push(['diffuse ', ...this.color(light.diffuse)], ['highlight ', ...this.color(light.highlight)]);
    return lines.flatMap((line, index) => (index === 0 ? line : [element('br'), ...line]));
  }

  private color(color: Color): Content {
    return [swatch(cssColor(color, this.transfer)), triple(color)];
  }
}

function hitRows(hit: Hit): [string, Content][] {
  const behind = hit.total_reflection
    ? `${degrees(hit.angle_in)} in, total reflection`
    : `${degrees(hit.angle_in)} in${hit.angle_out === null ? '' : `, ${degrees(hit.angle_out)} out`}`;
  return [
    ['Object', [`${hit.object}, primitive ${hit.primitive}`]],
    ['Material', [hit.material]],
    ['Point', [triple(hit.point)]],
    ['Distance t', [decimal(hit.t)]],
    ['Normal', [triple(hit.normal)]],
    ['Angles', [behind]],
    ['Indices', [`${decimal(hit.eta_before)} before, ${decimal(hit.eta_behind)} behind`]],
  ];
}

function table(rows: [string, Content][]): HTMLElement {
  return element('dl', {}, ...rows.flatMap(([name, value]) => [element('dt', {}, name), element('dd', {}, ...value)]));
}
