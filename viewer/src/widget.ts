/**
 * The viewer in a notebook: the front end of a widget made with anywidget. Python sets the traits; a click on a pixel
 * of the picture asks Python for its rays, which come back as the trait `tree`.
 */

import type { RayTreeDocument, ViewScene } from './data';
import { element } from './dom';
import { hideStillBefore, jupyterScheme, onJupyterTheme } from './jupyter';
import type { Pixel } from './pixels';
import { ViewerDataError } from './validate';
import { mount, type Viewer } from './viewer';

export interface WidgetTraits {
  scene: ViewScene;
  tree: RayTreeDocument | null;
  /** The bytes of a PNG; none at all for no picture. */
  picture: DataView<ArrayBuffer> | null;
  /** Of the viewer, as a length of CSS. */
  height: string;
  title: string;
}

/** What the widget tells Python: explain this pixel; and a still picture, its PNG in the buffer, for when nothing answers. */
export type WidgetMessage = { kind: 'explain'; pixel: Pixel } | { kind: 'still' };

/** The part of anywidget's model that is used here. */
export interface WidgetModel {
  get<T extends keyof WidgetTraits>(trait: T): WidgetTraits[T];
  on(event: string, listener: (message: unknown) => void): void;
  off(event: string, listener: (message: unknown) => void): void;
  send(message: WidgetMessage, callbacks?: undefined, buffers?: ArrayBuffer[]): void;
}

/** Milliseconds after the last change before a still picture is made. */
const CALM = 700;
const STILL_WIDTH = 1200;

/** What anywidget calls with each view of the widget. */
export const widget = {
  render({ model, el }: { model: WidgetModel; el: HTMLElement }): () => void {
    const view = new WidgetView(model, el);
    return () => view.dispose();
  },
};

class WidgetView {
  private viewer: Viewer | null = null;
  /** The pixel that Python has been asked for. */
  private asked: Pixel | null = null;
  private waiting: ReturnType<typeof setTimeout> | undefined;
  private lastStill = new Uint8Array();
  private readonly ends: (() => void)[] = [];

  constructor(
    private readonly model: WidgetModel,
    private readonly el: HTMLElement,
  ) {
    // Keys pressed in the drawing are not for the notebook.
    el.setAttribute('data-lm-suppress-shortcuts', 'true');
    this.listen('change:scene', () => this.show());
    this.listen('change:title', () => this.show());
    this.listen('change:tree', () => this.showTree());
    this.listen('change:picture', () => this.attempt(() => void this.viewer?.setPicture(this.picture())));
    this.listen('change:height', () => this.setHeight());
    this.listen('msg:custom', (message) => this.hear(message));
    this.ends.push(hideStillBefore(el), onJupyterTheme(() => this.viewer?.setScheme(jupyterScheme())));
    this.setHeight();
    this.show();
  }

  dispose(): void {
    for (const end of this.ends) end();
    this.close();
  }

  /** Also after a new scene: the drawing is made anew. */
  private show(): void {
    this.close();
    const [scene, tree, title] = [this.model.get('scene'), this.model.get('tree'), this.model.get('title')];
    const data = { scene, tree, picture: this.picture(), ...(title ? { title } : {}) };
    this.attempt(() => {
      this.viewer = mount(this.el, data, { scheme: jupyterScheme() });
      this.viewer.on('pixel', (x, y) => this.ask([x, y]));
      this.viewer.on('draw', () => this.makeStillSoon());
    });
  }

  private close(): void {
    clearTimeout(this.waiting);
    this.asked = null;
    this.viewer?.dispose();
    this.viewer = null;
    this.el.replaceChildren();
  }

  /** Data that cannot be shown becomes a text in the notebook. */
  private attempt(act: () => void): void {
    try {
      act();
    } catch (error) {
      if (!(error instanceof ViewerDataError)) throw error;
      if (this.viewer) this.viewer.setNote(error.message);
      else this.el.replaceChildren(element('p', { role: 'alert' }, `The scene is not shown. ${error.message}`));
    }
  }

  private showTree(): void {
    const tree = this.model.get('tree');
    const { asked } = this;
    // An answer to an earlier question: the last one is still to come.
    if (asked && tree && !(tree.pixel[0] === asked[0] && tree.pixel[1] === asked[1])) return;
    this.asked = null;
    this.attempt(() => {
      this.viewer?.setNote('');
      this.viewer?.setTree(tree);
    });
  }

  private ask(pixel: Pixel): void {
    this.asked = pixel;
    this.viewer?.setNote(`Following the rays of pixel (${pixel.join(', ')}) …`);
    this.model.send({ kind: 'explain', pixel });
  }

  private hear(message: unknown): void {
    const { kind, message: text } = Object(message) as { kind?: unknown; message?: unknown };
    if (kind !== 'error') return;
    this.asked = null;
    this.viewer?.setNote(String(text));
  }

  private picture(): DataView<ArrayBuffer> | null {
    const picture = this.model.get('picture');
    return picture && picture.byteLength > 0 ? picture : null;
  }

  private setHeight(): void {
    this.el.style.setProperty('--snell-viewer-height', this.model.get('height') || '30rem');
  }

  private makeStillSoon(): void {
    clearTimeout(this.waiting);
    this.waiting = setTimeout(() => void this.makeStill(), CALM);
  }

  private async makeStill(): Promise<void> {
    const { viewer } = this;
    const png = await (await viewer?.still(STILL_WIDTH))?.arrayBuffer();
    if (png === undefined || viewer !== this.viewer) return;
    const bytes = new Uint8Array(png);
    if (bytes.length === this.lastStill.length && bytes.every((byte, index) => byte === this.lastStill[index])) return;
    this.lastStill = bytes.slice();
    this.model.send({ kind: 'still' }, undefined, [png]);
  }

  private listen(event: string, listener: (message: unknown) => void): void {
    this.model.on(event, listener);
    this.ends.push(() => this.model.off(event, listener));
  }
}
