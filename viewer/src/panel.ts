/** The ray tree of one pixel as text: its samples, the rays of the one that is shown, the details of the selected ray. */

import type { RayTreeDocument } from './data';
import { DetailView } from './detail-view';
import { element } from './dom';
import { TreeModel } from './model';
import { type TreeEvents, TreeView } from './tree-view';

export interface PanelEvents extends TreeEvents {
  /** Another sample is shown. */
  sample(): void;
}

export class Panel {
  readonly root = element('section', { class: 'panel', 'aria-label': 'Ray tree and details' });
  model!: TreeModel;
  private tree!: TreeView;
  private readonly detail: DetailView;
  private readonly treePlace = element('div', { style: 'display: contents' });

  constructor(
    private readonly document: RayTreeDocument,
    private readonly events: PanelEvents,
  ) {
    this.detail = new DetailView(document.transfer);
    this.root.append(this.head(), this.treePlace, this.detail.root);
    this.showSample(0);
  }

  select(id: number | null): void {
    this.tree.select(id);
    this.detail.show(this.model, id);
  }

  hover(id: number | null): void {
    this.tree.hover(id);
  }

  private showSample(index: number): void {
    this.model = new TreeModel(this.document.samples[index]!.nodes);
    this.tree = new TreeView(this.model, this.document.transfer, this.events);
    this.treePlace.replaceChildren(this.tree.root);
    this.detail.show(this.model, null);
  }

  private head(): HTMLElement {
    const head = element('div', { class: 'panel-head' }, element('h2', {}, 'Ray tree'));
    const { samples } = this.document;
    if (samples.length > 1) {
      const picker = element('select', { 'aria-label': 'Sample' });
      samples.forEach((_, index) => picker.append(element('option', {}, `Sample ${index + 1} of ${samples.length}`)));
      picker.addEventListener('change', () => {
        this.showSample(picker.selectedIndex);
        this.events.sample();
      });
      head.append(picker);
    }
    return head;
  }
}
