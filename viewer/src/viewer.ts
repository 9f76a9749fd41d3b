/** The drawing of a scene and, if there is one, the ray tree of a pixel beside it. */

import type { RayTreeDocument, ViewerData, ViewScene } from './data';
import { button, checkbox, element } from './dom';
import { TreeModel } from './model';
import type { Editing, Movement, ObjectRef } from './editing';
import { Panel } from './panel';
import { nextPixel, type Pixel } from './pixels';
import { styled } from './style';
import { alternative, legend, pixelHeader, sceneHeader, selectedWords } from './texts';
import { followTheme, LIGHT, type Scheme, setProperties, type Theme } from './theme';
import { Drawing } from './three/drawing';
import { validate, validatePicture, validateScene, validateTree } from './validate';

export interface ViewerOptions {
  /** Dark or light as the page asks for (`auto`), or always the same. */
  scheme?: Scheme;
  /** The sentence above the drawing; shown unless it is `false`. */
  header?: boolean;
  /** The ray tree beside the drawing; shown unless it is `false`: then a `TreePanel` may show it elsewhere. */
  panel?: boolean;
  /** Buttons for the viewpoints and boxes (`full`), or only boxes, where the page has buttons of its own (`studio`). */
  toolbar?: 'full' | 'studio';
}

export interface ViewerEvents {
  /** A ray of the sample that is shown, or none. */
  select: (id: number | null) => void;
  /** The ray under the pointer, in the drawing or in the tree. */
  hover: (id: number | null) => void;
  /** Someone asks for the rays of a pixel: its column and row, counted from the left and from the top. */
  pixel: (x: number, y: number) => void;
  /** Someone has clicked an object, or none: choosing it is for `setObjects`. */
  object: (object: ObjectRef | null) => void;
  /** The selected object is being dragged. The same drag begins with the old scene each time. */
  move: (change: Movement) => void;
  /** It has been dragged, or its drag has been taken back: the last of its changes once more. */
  moved: (change: Movement) => void;
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
  private readonly lightButtons = element('div', { style: 'display: contents' });
  private readonly drawing: Drawing | null;
  private readonly panel: Panel;
  private readonly listeners: { [E in keyof ViewerEvents]: Set<ViewerEvents[E]> } = {
    select: new Set(),
    hover: new Set(),
    pixel: new Set(),
    object: new Set(),
    move: new Set(),
    moved: new Set(),
    draw: new Set(),
  };
  private header = element('header');
  private editing: Editing = { selected: null, handles: null, snap: null };
  private scene: ViewScene;
  /** What is drawn; the panel may show another pixel. */
  private tree: RayTreeDocument | null = null;
  private model: TreeModel | null = null;
  /** What the note says of the drawing, of the picture, and for others. */
  private notes = { drawing: '', picture: '', hint: '', other: '' };
  /** The pixel that is shown, or has been asked for since. */
  private pixel: Pixel | null = null;
  private stopTheme: () => void = () => {};
  private theme: Theme = LIGHT;
  private state = { selected: null as number | null, hovered: null as number | null, allShadows: false, generation: Infinity };
  /** What the colours of the theme are set on. */
  private readonly themed: HTMLElement[] = [this.frame];

  /** See `mount`. */
  constructor(
    parent: HTMLElement,
    private readonly data: ViewerData,
    private readonly options: ViewerOptions,
  ) {
    this.scene = data.scene;
    this.panel = new Panel({
      select: (id) => this.inPanel(() => this.select(id)),
      hover: (id) => this.inPanel(() => this.hover(id)),
      sample: () => this.draw(this.panel.document, this.panel.model, null),
      step: () => this.inPanel(() => this.step()),
    });
    this.drawing = this.makeDrawing();
    // The page of a studio says how tall it is, also where it is narrow.
    this.frame.classList.toggle('fills', options.toolbar === 'studio');
    if (options.header !== false) this.frame.append(this.header);
    this.frame.append(this.view());
    if (options.panel !== false) this.frame.append(this.panel.root);
    styled(this.host).append(this.frame);
    parent.append(this.host);
    this.setScheme(options.scheme ?? 'auto');
    this.showLights();
    this.showHeader();
    this.setTree(data.tree ?? null);
    void this.showPictureOf(data.picture ?? null);
  }

  /** The selected ray of the sample that is shown. */
  get selected(): number | null {
    return this.state.selected;
  }

  select(id: number | null): void {
    this.check(id);
    if (id === this.state.selected) return;
    this.state.selected = id;
    if (this.panel.model === this.model) this.panel.select(id);
    this.update();
    this.tell('select', id);
  }

  /** Brings a ray forward as if the pointer were on it. */
  hover(id: number | null): void {
    this.check(id);
    if (id === this.state.hovered) return;
    this.state.hovered = id;
    if (this.panel.model === this.model) this.panel.hover(id);
    this.update();
    this.tell('hover', id);
  }

  /**
   * Shows another scene. The eye stays where it is, unless it is to be `reset` as for the first one; rays and the mark of the pixel
   * stay until there is another tree. Throws a `ViewerDataError`.
   */
  setScene(scene: ViewScene, { reset = false } = {}): void {
    validateScene(scene);
    const others = this.scene.lights.map(({ name }) => name).join() !== scene.lights.map(({ name }) => name).join();
    this.scene = scene;
    this.drawing?.setScene(scene, reset);
    if (others) this.showLights();
    if (this.panel.document === null) this.showHeader();
    this.showPixels();
    this.update();
  }

  /**
   * Shows the rays of another pixel, or none; the eye stays where it is. With `keepSelection`, the ray that has come the same way
   * is selected if one was. With `panel: false`, only the drawing shows them: as long as the pointer is on the pixel.
   * Throws a `ViewerDataError`.
   */
  setTree(tree: RayTreeDocument | null, { keepSelection = false, panel = true } = {}): void {
    validateTree(tree);
    if (panel && tree !== this.panel.document) {
      this.panel.setTree(tree);
      this.showHeader();
    }
    const shown = tree === this.panel.document;
    const model = shown ? this.panel.model : tree && new TreeModel(tree.samples[0]!.nodes);
    const before = keepSelection && this.model && this.state.selected !== null ? this.model.way(this.state.selected) : null;
    const kept = before && model ? model.find(before) : null;
    this.draw(tree, model, kept ?? (shown ? this.panel.selected : null));
  }

  /** Shows another PNG on the image plane, or none. Throws a `ViewerDataError`; a note tells of bytes that are no picture. */
  setPicture(png: BufferSource | null): Promise<void> {
    validatePicture(png);
    return this.showPictureOf(png);
  }

  /** Shows a canvas on the image plane, or none. `size` is that of the picture; the canvas may have fewer pixels. */
  setLivePicture(canvas: HTMLCanvasElement | OffscreenCanvas | null, size: Pixel): void {
    this.drawing?.setLivePicture(canvas, size);
    this.showPixels();
  }

  /** With the next frame, the image plane shows what its canvas shows then. */
  pictureChanged(): void {
    this.drawing?.pictureChanged();
  }

  lookThroughCamera(): void {
    this.drawing?.lookThroughCamera();
  }

  /** Throws a `RangeError` if there is no such light. */
  lookFromLight(index: number): void {
    if (this.scene.lights[index] === undefined) throw new RangeError(`there is no light ${index} in this scene`);
    this.drawing?.lookFromLight(index);
  }

  /** Looks at all from the side, as at first. */
  reset(): void {
    this.drawing?.reset(true);
  }

  /** For `TreePanel`. */
  placePanel(frame: HTMLElement): void {
    this.themed.push(frame);
    setProperties(frame, this.theme);
    frame.append(this.panel.root);
  }

  /** Marks an object as selected, with handles to drag it by. */
  setObjects(editing: Editing): void {
    this.editing = editing;
    this.drawing?.setEditing(editing);
    this.showPixels();
    this.update();
  }

  /** A quiet line below the drawing. */
  setNote(text: string): void {
    this.showNote({ other: text });
  }

  setScheme(scheme: Scheme): void {
    this.stopTheme();
    this.stopTheme = followTheme(scheme, (theme) => {
      this.theme = theme;
      for (const frame of this.themed) setProperties(frame, theme);
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
    return this.drawing?.still(maxWidth) ?? Promise.resolve(null);
  }

  /** Takes the viewer out of the page. */
  dispose(): void {
    this.stopTheme();
    for (const listeners of Object.values(this.listeners)) listeners.clear();
    this.drawing?.dispose();
    this.panel.dispose();
    this.host.remove();
  }

  private check(id: number | null): void {
    if (id !== null && this.model?.nodes[id] === undefined) throw new RangeError(`there is no ray ${id} in this sample`);
  }

  /** Draws the rays of a sample, one of which may be selected. */
  private draw(tree: RayTreeDocument | null, model: TreeModel | null, selected: number | null): void {
    this.tree = tree;
    this.model = model;
    this.pixel = tree && tree.pixel;
    this.drawing?.setTree(tree);
    const left = this.drawing?.setModel(model) ?? 0;
    if (this.drawing) this.showNote({ drawing: left > 0 ? `The ${left} weakest rays are not drawn; the tree has them all.` : '' });
    this.frame.classList.toggle('without-rays', tree === null);
    this.frame.classList.toggle('alone', this.options.panel === false || this.panel.document === null);
    this.showPixels();
    const [before, hovered] = [this.state.selected, this.state.hovered];
    Object.assign(this.state, { selected, hovered: null, generation: this.panel.model === model ? this.panel.generation : Infinity });
    if (this.panel.model === model && this.panel.selected !== selected) this.panel.select(selected);
    this.update();
    if (hovered !== null) {
      this.panel.hover(null);
      this.tell('hover', null);
    }
    if (selected !== before) this.tell('select', selected);
  }

  private step(): void {
    this.state.generation = this.panel.generation;
    this.update();
  }

  /** What is done to the panel is about its own rays: they are drawn again if others are. */
  private inPanel(act: () => void): void {
    const { document, model, selected } = this.panel;
    if (model !== this.model) this.draw(document, model, selected);
    act();
  }

  private showHeader(): void {
    const { document } = this.panel;
    const header = document ? pixelHeader(document) : sceneHeader(this.data.title ?? 'Scene', this.scene);
    this.header.replaceWith(header);
    this.header = header;
  }

  private showLights(): void {
    const { drawing } = this;
    if (drawing === null || this.options.toolbar === 'studio') return;
    const { lights } = this.scene;
    this.lightButtons.replaceChildren(...lights.map(({ name }, index) => button(`From light ${name}`, () => drawing.lookFromLight(index))));
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
    drawing.picksObjects = this.listeners.object.size > 0;
    drawing.mark(this.pixel, this.tree && this.pixel === this.tree.pixel ? this.tree.size : size);
    this.pictureBox.hidden = drawing.plane.size === null;
    this.alternative.textContent = alternative(this.scene, {
      tree: this.tree !== null,
      pixels: drawing.picksPixels && this.pixelsSize() !== null,
      handles: this.editing.handles !== null,
    });
    const asks = drawing.picksPixels && size !== null && this.pixel === null;
    this.showNote({ hint: asks ? 'Look through the camera and click a pixel to see its rays.' : '' });
    const rays = this.tree ? ` and the rays of pixel (${this.tree.pixel.join(', ')})` : '';
    drawing.stage.canvas.setAttribute('aria-label', `The scene${rays} in 3D${selectedWords(this.editing.selected)}`);
  }

  /** Columns and rows of what pixels are asked for. */
  private pixelsSize(): Pixel | null {
    return this.drawing?.plane.size ?? this.tree?.size ?? null;
  }

  private ask(pixel: Pixel): void {
    this.pixel = pixel;
    this.showPixels();
    this.tell('pixel', ...pixel);
  }

  private onKey(event: KeyboardEvent): void {
    const size = this.pixelsSize();
    if (!event.shiftKey || event.ctrlKey || event.metaKey || event.altKey || size === null || this.listeners.pixel.size === 0) return;
    const pixel = nextPixel(event.key, this.pixel, size);
    if (pixel === null) return;
    event.preventDefault();
    this.ask(pixel);
  }

  private update(): void {
    this.drawing?.show(this.state);
  }

  private tell<E extends keyof ViewerEvents>(event: E, ...values: Parameters<ViewerEvents[E]>): void {
    for (const listener of this.listeners[event]) (listener as (...values: Parameters<ViewerEvents[E]>) => void)(...values);
  }

  private showNote(notes: Partial<Viewer['notes']>): void {
    Object.assign(this.notes, notes);
    this.note.textContent = Object.values(this.notes).filter((text) => text !== '').join(' ');
  }

  private makeDrawing(): Drawing | null {
    try {
      return new Drawing(this.scene, this.data.tree ?? null, this.theme, {
        select: (id) => this.select(id),
        hover: (id) => this.hover(id),
        pixel: (pixel) => this.ask(pixel),
        object: (object) => this.tell('object', object),
        move: (change) => this.tell('move', change),
        moved: (change) => this.tell('moved', change),
        frame: () => {
          if (this.state.hovered === null) this.tell('draw');
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
        ...(this.options.toolbar === 'studio'
          ? []
          : [button('Reset', () => this.reset()), button('Look through the camera', () => this.lookThroughCamera()), this.lightButtons]),
        checkbox('Names', true, (shown) => {
          drawing.names.shown = shown;
          drawing.stage.requestFrame();
        }),
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
