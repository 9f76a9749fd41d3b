/** The ray tree and the details of a viewer in another place of the page. */

import { element } from './dom';
import { styled } from './style';
import type { Viewer } from './viewer';

export class TreePanel {
  private readonly host = element('div', { style: 'height: 100%' });

  /** The viewer should have been mounted with `panel: false`. */
  constructor(parent: HTMLElement, viewer: Viewer) {
    const frame = element('div', { class: 'viewer panel-only' });
    styled(this.host).append(frame);
    parent.append(this.host);
    viewer.placePanel(frame);
  }

  dispose(): void {
    this.host.remove();
  }
}
