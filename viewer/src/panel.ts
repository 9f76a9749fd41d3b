/** The ray tree of one pixel as text: its samples, the rays of the one that is shown, the details of the selected ray. */

import type { RayTreeDocument } from './data';
import { DetailView } from './detail-view';
import { element } from './dom';
import { TreeModel } from './model';
import { Player } from './player';
import { type TreeEvents, TreeView } from './tree-view';

export interface PanelEvents extends TreeEvents {
  /** Another sample is shown. */
  sample(): void;
  /** Only the rays up to a generation are shown. */
  step(generation: number): void;
}

export class Panel {
  readonly root = element('section', { class: 'panel', 'aria-label': 'Ray tree and details' });
  document: RayTreeDocument | null = null;
  model: TreeModel | null = null;
  selected: number | null = null;
  private tree: TreeView | null = null;
  private player: Player | null = null;
  private detail: DetailView | null = null;

  constructor(private readonly events: PanelEvents) {
    this.setTree(null);
  }

  setTree(document: RayTreeDocument | null): void {
    this.document = document;
    this.root.hidden = document === null;
    this.detail = document && new DetailView(document.transfer);
    this.showSample(0);
  }

  /** The last one that is shown. */
  get generation(): number {
    return this.player?.generation ?? Infinity;
  }

  select(id: number | null): void {
    this.selected = id;
    if (id !== null && this.model!.generation(id) > this.generation) {
      this.player!.stop();
      this.player!.go(this.model!.last);
    }
    this.tree?.select(id);
    if (this.model !== null) this.detail?.show(this.model, id);
  }

  hover(id: number | null): void {
    this.tree?.hover(id);
  }

  dispose(): void {
    this.player?.stop();
    this.root.remove();
  }

  private showSample(index: number): void {
    const { document } = this;
    this.player?.stop();
    this.player = null;
    this.selected = null;
    this.model = document && new TreeModel(document.samples[index]!.nodes);
    this.tree = document && new TreeView(this.model!, document.transfer, this.events);
    if (this.model === null) return this.root.replaceChildren();
    this.player = new Player(this.model, document!.transfer, (generation) => {
      this.tree!.showUntil(generation);
      this.events.step(generation);
    });
    this.detail!.show(this.model, null);
    const head = element('div', {}, this.head(document!, index), this.player.root);
    this.root.replaceChildren(head, this.tree!.root, this.detail!.root);
  }

  private head({ samples }: RayTreeDocument, index: number): HTMLElement {
    const head = element('div', { class: 'panel-head' }, element('h2', {}, 'Ray tree'));
    if (samples.length > 1) {
      const picker = element('select', { 'aria-label': 'Sample' });
      samples.forEach((_, index) => picker.append(element('option', {}, `Sample ${index + 1} of ${samples.length}`)));
      picker.selectedIndex = index;
      picker.addEventListener('change', () => {
        this.showSample(picker.selectedIndex);
        this.root.querySelector('select')!.focus();
        this.events.sample();
      });
      head.append(picker);
    }
    return head;
  }
}
