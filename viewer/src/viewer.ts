/** The drawing of a scene and, if there is one, the ray tree of a pixel beside it. */

import type { RayTreeDocument, ViewerData } from './data';
import { button, checkbox, element } from './dom';
import { Panel } from './panel';
import { nextPixel, type Pixel } from './pixels';
import frameStyle from './style/frame.css?inline';
import panelStyle from './style/panel.css?inline';
import { alternative, legend, pixelHeader, sceneHeader } from './texts';
import { followTheme, LIGHT, type Scheme, setProperties, type Theme } from './theme';
import { Drawing } from './three/drawing';
import { validate, validatePicture, validateTree } from './validate';

export interface ViewerOptions {
  /** Dark or light as the page asks for (`auto`), or always the same. */
  scheme?: Scheme;
}

export interface ViewerEvents {
  /** A ray of the sample that is shown, or none. */
  select: (id: number | null) => void;
  /** Someone asks for the rays of a pixel: its column and row, counted from the left and from the top. */
  pixel: (x: number, y: number) => void;
  /** The drawing has changed; not while the pointer is on a ray. */
  draw: () => void;
}

/** Shows the data in `parent`. Throws a `ViewerDataError` if it cannot be shown. */
export function mount(parent: HTMLElement, data: ViewerData, options: ViewerOptions = {}): Viewer {
  validate(data);
  return new Viewer(parent, data, options);
}

export class Viewer {
  private readonly host = element('div');
  private readonly frame = element('div', { class: 'viewer' });
  private readonly note = element('p', { role: 'status' });
  private readonly alternative = element('p', { id: 'alternative', class: 'hidden-text' });
  private readonly pictureBox = checkbox('Picture', true, (shown) => this.showPicture(shown));
  private readonly drawing: Drawing | null;
  private readonly listeners: { [E in keyof ViewerEvents]: Set<ViewerEvents[E]> } = { select: new Set(), pixel: new Set(), draw: new Set() };
  private header = element('header');
  private panel: Panel | null = null;
  private tree: RayTreeDocument | null = null;
  /** What the note says of the drawing, of the picture, and for others. */
  private notes = { drawing: '', picture: '', hint: '', other: '' };
  /** The pixel that is shown, or has been asked for since. */
  private pixel: Pixel | null = null;
  private stopTheme: () => void = () => {};
  private theme: Theme = LIGHT;
  private state = { selected: null as number | null, hovered: null as number | null, allShadows: false };

  /** See `mount`. */
  constructor(
    parent: HTMLElement,
    private readonly data: ViewerData,
    options: ViewerOptions,
  ) {
    // The style of the page and that of the viewer must not meet.
    const root = this.host.attachShadow({ mode: 'open' });
    const sheet = new CSSStyleSheet();
    sheet.replaceSync(panelStyle + frameStyle);
    root.adoptedStyleSheets = [sheet];
    this.drawing = this.makeDrawing();
    this.frame.append(this.header, this.view());
    root.append(this.frame);
    parent.append(this.host);
    this.setScheme(options.scheme ?? 'auto');
    this.showTree(data.tree ?? null);
    void this.showPictureOf(data.picture ?? null);
  }

  /** The selected ray of the sample that is shown. */
  get selected(): number | null {
    return this.state.selected;
  }

  select(id: number | null): void {
    if (id !== null && this.panel?.model.nodes[id] === undefined) throw new RangeError(`there is no ray ${id} in this sample`);
    if (id === this.state.selected) return;
    this.state.selected = id;
    this.panel?.select(id);
    this.update();
    for (const listener of this.listeners.select) listener(id);
  }

  /** Shows the rays of another pixel, or none; the eye stays where it is. Throws a `ViewerDataError`. */
  setTree(tree: RayTreeDocument | null): void {
    validateTree(tree);
    this.select(null);
    this.showTree(tree);
  }

  /** Shows another PNG on the image plane, or none. Throws a `ViewerDataError`; a note tells of bytes that are no picture. */
  setPicture(png: BufferSource | null): Promise<void> {
    validatePicture(png);
    return this.showPictureOf(png);
  }

  /** A quiet line below the drawing. */
  setNote(text: string): void {
    this.showNote({ other: text });
  }

  setScheme(scheme: Scheme): void {
    this.stopTheme();
    this.stopTheme = followTheme(scheme, (theme) => {
      this.theme = theme;
      setProperties(this.frame, theme);
      this.drawing?.setTheme(theme);
      this.update();
    });
  }

  /** Calls back with each event of a kind. Returns what ends that. */
  on<E extends keyof ViewerEvents>(event: E, listener: ViewerEvents[E]): () => void {
    this.listeners[event].add(listener);
    this.showPixels();
    return () => {
      this.listeners[event].delete(listener);
      this.showPixels();
    };
  }

  /** A PNG of the drawing, in the resolution of the screen but not wider than `maxWidth`; `null` if there is no drawing. */
  still(maxWidth: number): Promise<Blob | null> {
    return this.drawing?.still(this.theme, maxWidth) ?? Promise.resolve(null);
  }

  /** Takes the viewer out of the page. */
  dispose(): void {
    this.stopTheme();
    for (const listeners of Object.values(this.listeners)) listeners.clear();
    this.drawing?.dispose();
    this.host.remove();
  }

  private showTree(tree: RayTreeDocument | null): void {
    this.tree = tree;
    this.pixel = tree && tree.pixel;
    const header = tree ? pixelHeader(tree) : sceneHeader(this.data.title ?? 'Scene', this.data.scene);
    this.header.replaceWith(header);
    this.header = header;
    this.panel?.root.remove();
    const events = {
      select: (id: number | null) => this.select(id),
      hover: (id: number | null) => this.hover(id),
      sample: () => {
        this.select(null);
        this.showSample();
      },
    };
    this.panel = tree && new Panel(tree, events);
    if (this.panel) this.frame.append(this.panel.root);
    this.frame.classList.toggle('alone', tree === null);
    this.drawing?.setTree(tree);
    this.showPixels();
    this.showSample();
  }

  private showSample(): void {
    this.state.hovered = null;
    const left = (this.panel && this.drawing?.setModel(this.panel.model)) ?? 0;
    if (this.drawing) this.showNote({ drawing: left > 0 ? `The ${left} weakest rays are not drawn; the tree has them all.` : '' });
    this.update();
  }

  private async showPictureOf(png: BufferSource | null): Promise<void> {
    try {
      await this.drawing?.setPicture(png);
      this.showNote({ picture: '' });
    } catch (error) {
      this.showNote({ picture: `The picture is not shown: its bytes are no PNG (${(error as Error).message}).` });
    }
    this.showPixels();
  }

  private showPicture(shown: boolean): void {
    this.drawing?.plane.showPicture(shown);
    this.update();
  }

  /** What depends on whether pixels can be pointed at, and on the one that is. */
  private showPixels(): void {
    const { drawing } = this;
    if (drawing === null) return;
    const size = drawing.plane.size;
    drawing.picksPixels = this.listeners.pixel.size > 0;
    drawing.mark(this.pixel, this.tree && this.pixel === this.tree.pixel ? this.tree.size : size);
    this.pictureBox.hidden = drawing.plane.size === null;
    this.alternative.textContent = alternative(this.data.scene, this.tree !== null, drawing.picksPixels && this.pixelsSize() !== null);
    const asks = drawing.picksPixels && size !== null && this.pixel === null;
    this.showNote({ hint: asks ? 'Look through the camera and click a pixel to see its rays.' : '' });
    const rays = this.tree ? ` and the rays of pixel (${this.tree.pixel.join(', ')})` : '';
    drawing.stage.canvas.setAttribute('aria-label', `The scene${rays} in 3D`);
  }

  /** Columns and rows of what pixels are asked for. */
  private pixelsSize(): Pixel | null {
    return this.drawing?.plane.size ?? this.tree?.size ?? null;
  }

  private ask(pixel: Pixel): void {
    this.pixel = pixel;
    this.showPixels();
    for (const listener of this.listeners.pixel) listener(...pixel);
  }

  private onKey(event: KeyboardEvent): void {
    const size = this.pixelsSize();
    if (!event.shiftKey || event.ctrlKey || event.metaKey || event.altKey || size === null || this.listeners.pixel.size === 0) return;
    const pixel = nextPixel(event.key, this.pixel, size);
    if (pixel === null) return;
    event.preventDefault();
    this.ask(pixel);
  }

  private hover(id: number | null): void {
    if (id === this.state.hovered) return;
    this.state.hovered = id;
    this.panel?.hover(id);
    this.update();
  }

  private update(): void {
    this.drawing?.show(this.state, this.theme);
  }

  private showNote(notes: Partial<Viewer['notes']>): void {
    Object.assign(this.notes, notes);
    this.note.textContent = Object.values(this.notes).filter((text) => text !== '').join(' ');
  }

  private makeDrawing(): Drawing | null {
    try {
      return new Drawing(this.data.scene, this.data.tree ?? null, {
        select: (id) => this.select(id),
        hover: (id) => this.hover(id),
        pixel: (pixel) => this.ask(pixel),
        frame: () => {
          if (this.state.hovered === null) for (const listener of this.listeners.draw) listener();
        },
      });
    } catch (error) {
      // Without WebGL the text still says everything.
      this.showNote({ drawing: `There is no drawing, since this browser offers no WebGL (${(error as Error).message}).` });
      return null;
    }
  }

  private view(): HTMLElement {
    const view = element('section', { class: 'view', 'aria-label': 'Drawing' });
    const { drawing } = this;
    const footer = element('div', { class: 'footer' }, this.note, ...(drawing === null ? [] : [legend()]));
    if (drawing !== null) {
      const { canvas } = drawing.stage;
      canvas.setAttribute('role', 'application');
      canvas.setAttribute('aria-roledescription', '3D drawing');
      canvas.setAttribute('aria-describedby', 'alternative');
      canvas.addEventListener('keydown', (event) => this.onKey(event));
      const shadows = checkbox('All shadow rays', false, (allShadows) => {
        this.state.allShadows = allShadows;
        this.update();
      });
      shadows.classList.add('of-rays');
      const toolbar = element(
        'div',
        { class: 'toolbar', role: 'group', 'aria-label': 'Views' },
        button('Reset', () => drawing.reset(true)),
        button('Look through the camera', () => drawing.lookThroughCamera()),
        ...this.data.scene.lights.map(({ name }, index) => button(`From light ${name}`, () => drawing.lookFromLight(index))),
        checkbox('Names', true, (shown) => (drawing.names.root.hidden = !shown)),
        this.pictureBox,
        shadows,
      );
      drawing.stage.cover(toolbar, footer);
      view.append(drawing.root, toolbar, this.alternative);
    }
    view.append(footer);
    return view;
  }
}
