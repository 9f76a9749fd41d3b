/** The drawing, the text tree and the details of one pixel, side by side. */

import { cssColor } from './color';
import type { ViewerData } from './data';
import { DetailView } from './detail-view';
import { button, checkbox, element, stroke, swatch } from './dom';
import { TreeModel } from './model';
import frameStyle from './style/frame.css?inline';
import panelStyle from './style/panel.css?inline';
import { followTheme, LIGHT, setProperties, type Theme } from './theme';
import { Drawing } from './three/drawing';
import { TreeView } from './tree-view';
import { validate } from './validate';
import { KIND_NAMES } from './words';

export interface ViewerOptions {
  /** Dark or light as the page asks for (`auto`), or always the same. */
  scheme?: 'auto' | 'light' | 'dark';
}

/** Names in the text alternative: nobody listens to a hundred. */
const MAX_SPOKEN = 12;

export type SelectListener = (id: number | null) => void;

/** Shows the data in `parent`. Throws a `ViewerDataError` if it cannot be shown. */
export function mount(parent: HTMLElement, data: ViewerData, options: ViewerOptions = {}): Viewer {
  validate(data);
  return new Viewer(parent, data, options);
}

export class Viewer {
  private readonly host = element('div');
  private readonly detail: DetailView;
  private readonly treePlace = element('div', { style: 'display: contents' });
  private readonly note = element('p', { role: 'status' });
  private readonly drawing: Drawing | null;
  private readonly listeners = new Set<SelectListener>();
  private readonly stopTheme: () => void;
  private theme: Theme = LIGHT;
  private model!: TreeModel;
  private tree!: TreeView;
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
    this.detail = new DetailView(data.tree.transfer);
    this.drawing = this.makeDrawing();
    const viewer = element('div', { class: 'viewer' }, this.header(), this.view(), this.panel());
    root.append(viewer);
    parent.append(this.host);
    this.showSample(0);
    this.stopTheme = followTheme(options.scheme ?? 'auto', (theme) => {
      this.theme = theme;
      setProperties(viewer, theme);
      this.drawing?.setTheme(theme);
      this.update();
    });
  }

  /** The selected ray of the sample that is shown. */
  get selected(): number | null {
    return this.state.selected;
  }

  select(id: number | null): void {
    if (id !== null && this.model.nodes[id] === undefined) throw new RangeError(`there is no ray ${id} in this sample`);
    if (id === this.state.selected) return;
    this.state.selected = id;
    this.tree.select(id);
    this.detail.show(this.model, id);
    this.update();
    for (const listener of this.listeners) listener(id);
  }

  /** Calls back with each newly selected ray. Returns what ends that. */
  on(_event: 'select', listener: SelectListener): () => void {
    this.listeners.add(listener);
    return () => this.listeners.delete(listener);
  }

  /** Takes the viewer out of the page. */
  dispose(): void {
    this.stopTheme();
    this.listeners.clear();
    this.drawing?.dispose();
    this.host.remove();
  }

  private showSample(index: number): void {
    this.state.hovered = null;
    this.model = new TreeModel(this.data.tree.samples[index]!.nodes);
    const hover = (id: number | null) => this.hover(id);
    this.tree = new TreeView(this.model, this.data.tree.transfer, { select: (id) => this.select(id), hover });
    this.treePlace.replaceChildren(this.tree.root);
    this.detail.show(this.model, null);
    const left = this.drawing?.setModel(this.model) ?? 0;
    if (this.drawing) this.note.textContent = left > 0 ? `The ${left} weakest rays are not drawn; the tree has them all.` : '';
    this.update();
  }

  private hover(id: number | null): void {
    if (id === this.state.hovered) return;
    this.state.hovered = id;
    this.tree.hover(id);
    this.update();
  }

  private update(): void {
    this.drawing?.show(this.state, this.theme);
  }

  private makeDrawing(): Drawing | null {
    try {
      return new Drawing(this.data, { select: (id) => this.select(id), hover: (id) => this.hover(id) });
    } catch (error) {
      // Without WebGL the text still says everything.
      this.note.textContent = `There is no drawing, since this browser offers no WebGL (${(error as Error).message}).`;
      return null;
    }
  }

  private header(): HTMLElement {
    const { sentence, pixel, size, scene, integrator, spp, color, transfer } = this.data.tree;
    const samples = spp === 1 ? '1 sample' : `${spp} samples`;
    const facts = `Pixel (${pixel.join(', ')}) of ${size.join(' × ')} · ${scene} · ${integrator} · ${samples} per pixel`;
    const texts = element('div', {}, element('p', { class: 'sentence' }, sentence), element('p', { class: 'quiet' }, facts));
    return element('header', {}, swatch(cssColor(color, transfer)), texts);
  }

  private view(): HTMLElement {
    const view = element('section', { class: 'view', 'aria-label': 'Drawing' });
    const { drawing } = this;
    if (drawing !== null) {
      const { canvas } = drawing.stage;
      const [x, y] = this.data.tree.pixel;
      canvas.setAttribute('role', 'application');
      canvas.setAttribute('aria-roledescription', '3D drawing');
      canvas.setAttribute('aria-label', `The scene and the rays of pixel (${x}, ${y}) in 3D`);
      canvas.setAttribute('aria-describedby', 'alternative');
      const toolbar = element(
        'div',
        { class: 'toolbar', role: 'group', 'aria-label': 'Views' },
        button('Reset', () => drawing.reset(true)),
        button('Look through the camera', () => drawing.lookThroughCamera()),
        ...this.data.scene.lights.map(({ name }, index) => button(`From light ${name}`, () => drawing.lookFromLight(index))),
        checkbox('Names', true, (shown) => (drawing.names.root.hidden = !shown)),
        checkbox('All shadow rays', false, (allShadows) => {
          this.state.allShadows = allShadows;
          this.update();
        }),
      );
      view.append(drawing.root, toolbar, element('p', { id: 'alternative', class: 'hidden-text' }, this.alternative()));
    }
    view.append(element('div', { class: 'footer' }, this.note, ...(drawing === null ? [] : [legend()])));
    return view;
  }

  private panel(): HTMLElement {
    const head = element('div', { class: 'panel-head' }, element('h2', {}, 'Ray tree'));
    const { samples } = this.data.tree;
    if (samples.length > 1) {
      const picker = element('select', { 'aria-label': 'Sample' });
      samples.forEach((_, index) => picker.append(element('option', {}, `Sample ${index + 1} of ${samples.length}`)));
      picker.addEventListener('change', () => {
        this.select(null);
        this.showSample(picker.selectedIndex);
      });
      head.append(picker);
    }
    return element('section', { class: 'panel', 'aria-label': 'Ray tree and details' }, head, this.treePlace, this.detail.root);
  }

  /** What the drawing shows, for those who do not see it. */
  private alternative(): string {
    const { spheres, meshes, lights } = this.data.scene;
    return (
      `Spheres: ${names(spheres)}. Meshes: ${names(meshes)}. Lights: ${names(lights)}. ` +
      'The tree of rays beside the drawing says where each ray goes and what it adds. ' +
      'Arrow keys turn the drawing, plus and minus go nearer and farther.'
    );
  }
}

function names(things: { name: string }[]): string {
  if (things.length === 0) return 'none';
  const first = things.slice(0, MAX_SPOKEN).map(({ name }) => name).join(', ');
  return things.length > MAX_SPOKEN ? `${first} and ${things.length - MAX_SPOKEN} more` : first;
}

function legend(): HTMLElement {
  const items = Object.entries(KIND_NAMES).map(([kind, name]) => element('li', {}, stroke(kind), name));
  return element('ul', { class: 'legend', 'aria-label': 'Colours of the rays' }, ...items);
}
