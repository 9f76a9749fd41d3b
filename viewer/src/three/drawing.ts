/** The scene and the rays of one sample in 3D. */

import { Vector3 } from 'three';
import { type Figure, figureOf } from '../angles';
import type { RayNode, RayTreeDocument, ViewScene } from '../data';
import { element } from '../dom';
import type { Editing, ObjectRef } from '../editing';
import { dot, rayLine } from '../lines';
import type { TreeModel } from '../model';
import { decodePicture, middleOf, type Pixel } from '../pixels';
import type { Theme } from '../theme';
import { Apparatus } from './apparatus';
import { Editor, type EditorEvents } from './editor';
import { type Extent, extentOf } from './extent';
import { ImagePlane } from './image-plane';
import { Names, sceneLabels } from './names';
import { Objects } from './objects';
import { pick, type PickedLine } from './picking';
import { type DrawnSample, type RayState, Rays } from './rays';
import { Stage } from './stage';
import { stillOf } from './still';
import { axisPoint, objectAt } from './subjects';
import { scaledNodes, scaledScene, unitFor } from './unit';
import { fromLight, overview, throughCamera, type Viewpoint } from './viewpoints';

export interface DrawingEvents extends EditorEvents {
  select(id: number | null): void;
  hover(id: number | null): void;
  pixel(pixel: Pixel): void;
  object(object: ObjectRef | null): void;
  /** A frame has been drawn. */
  frame(): void;
}

/** More lines would hide each other. */
const MAX_RAYS = 400;
const MAX_NAMES = 24;
/** Of a ray that leaves the scene, in radii of the drawing. */
const REACH = 0.55;
/** Of the arcs of angles, in the same. */
const ANGLES = 0.09;
/** Pixels that the pointer may move between down and up in a click. */
const CLICK = 4;

/** Of the radius: what grows or moves less is still the same drawing, in which the arrows of lights and the like stay. */
const [GROWS, MOVES] = [1.5, 0.5];

export class Drawing {
  readonly root = element('div', { class: 'stage' });
  readonly names = new Names();
  readonly stage: Stage;
  readonly plane: ImagePlane;
  /** Can pixels of the picture be clicked? */
  picksPixels = false;
  /** And objects? */
  picksObjects = false;
  /** In the drawing's own unit, like all lengths here. */
  scene: ViewScene;
  /** By what lengths are multiplied. */
  unit!: number;
  extent!: Extent;
  private tree: RayTreeDocument | null;
  private model: TreeModel | null = null;
  private sample: DrawnSample | null = null;
  readonly objects: Objects;
  private readonly apparatus: Apparatus;
  private readonly rays: Rays;
  private readonly editor: Editor;
  private editing: Editing = { selected: null, handles: null, snap: null };
  private lines: PickedLine[] = [];
  private generation = Infinity;
  private readonly pixelLabel = element('span', { class: 'target', 'aria-hidden': true, hidden: true });
  private pressed = new Vector3();
  private pictures = 0;
  private readonly overview = () => overview(this.scene.camera, this.home(), this.stage.aspect, this.plane.size !== null);
  /** The viewpoint that the eye is at, fitted to each new size; `null` when somebody has moved it. */
  private standing: (() => Viewpoint) | null = this.overview;

  constructor(
    given: ViewScene,
    tree: RayTreeDocument | null,
    public theme: Theme,
    private readonly events: DrawingEvents,
  ) {
    this.tree = tree;
    this.scene = this.measure(given);
    this.stage = new Stage(this.up, this.extent.radius);
    const { uniforms, scene } = this.stage;
    this.objects = new Objects(uniforms);
    this.apparatus = new Apparatus(uniforms);
    this.plane = new ImagePlane(uniforms);
    this.rays = new Rays(uniforms);
    // Its listeners come first.
    this.stage.canvas.addEventListener('pointerdown', ({ clientX, clientY }) => this.pressed.set(clientX, clientY, 0), { capture: true });
    this.editor = new Editor(this.stage, () => this, (event) => this.objectAt(event), events);
    scene.add(this.objects.group, this.plane.group, this.apparatus.group, this.rays.group, this.editor.group);
    scene.onBeforeRender = () => {
      this.plane.prepare(this.stage.camera, uniforms.size.value.y);
      this.editor.prepare();
    };
    this.stage.onFrame = () => {
      const { x, y } = uniforms.size.value;
      this.names.update(this.stage.camera, x, y);
      this.events.frame();
    };
    this.root.append(this.stage.canvas, this.names.root, this.pixelLabel);
    this.stage.onResize = () => this.standing && this.stage.show(this.standing(), false);
    this.stage.onMove = () => (this.standing = null);
    this.listen(this.stage.canvas);
    this.showScene();
  }

  /**
   * Shows another scene. The eye stays where it is, unless it looks through the camera or from a light, or all begins anew:
   * then the scene may be of another size too.
   */
  setScene(given: ViewScene, reset: boolean): void {
    if (reset) {
      this.scene = this.measure(given);
      this.stage.setSpace(this.up, this.extent.radius);
      this.setSample();
    } else {
      this.scene = scaledScene(given, this.unit);
      const next = this.home();
      const { center, radius } = this.extent;
      const ratio = next.radius / radius;
      if (ratio > GROWS || ratio < 1 / GROWS || next.center.distanceTo(center) > MOVES * radius) this.extent = next;
    }
    this.showScene();
    if (reset) this.reset(false);
    else if (this.standing !== null && this.standing !== this.overview && !this.editor.dragging) this.stage.show(this.standing(), false);
    this.stage.requestFrame();
  }

  /** Prepares for the rays of a pixel. The eye stays where it is. */
  setTree(tree: RayTreeDocument | null): void {
    this.tree = tree;
    this.showNames();
  }

  /** Shows the rays of a sample, or none; returns how many of them are not drawn. */
  setModel(model: TreeModel | null): number {
    this.model = model;
    this.setSample();
    return model === null ? 0 : model.nodes.length - this.sample!.drawn.length;
  }

  /** Rejects what is not a PNG. The last call wins, whichever is read first. */
  async setPicture(png: BufferSource | null): Promise<void> {
    const number = ++this.pictures;
    const picture = png && (await decodePicture(png));
    if (number !== this.pictures) return picture?.bitmap.close();
    this.plane.setPicture(picture && picture.bitmap, picture && picture.size);
    if (this.standing === this.overview) this.reset(false);
    this.stage.requestFrame();
  }

  /** Shows a canvas that changes, instead of a PNG. */
  setLivePicture(canvas: HTMLCanvasElement | OffscreenCanvas | null, size: Pixel): void {
    this.pictures++;
    const first = this.plane.size === null;
    this.plane.setPicture(canvas, canvas && size);
    if (first && this.standing === this.overview) this.reset(false);
    this.stage.requestFrame();
  }

  pictureChanged(): void {
    this.plane.pictureChanged();
    this.stage.requestFrame();
  }

  mark(pixel: Pixel | null, size: Pixel | null): void {
    this.plane.mark(pixel && size && middleOf(pixel, size));
    this.stage.requestFrame();
  }

  /** What is selected in the scene, and how it can be moved. */
  setEditing(editing: Editing): void {
    this.editing = editing;
    this.editor.set(editing);
    this.stage.requestFrame();
  }

  show(state: RayState): void {
    this.generation = state.generation;
    const figure = this.figure(state);
    this.rays.show(this.sample, figure, state, this.theme);
    const arcs = figure?.arcs ?? [];
    this.names.set('angles', arcs.map(({ at, text }) => ({ text, at: new Vector3(...at), kind: 'angle', offset: 0, rank: 0 })));
    const met = [state.selected, state.hovered].map((id) => this.objectMetBy(id));
    this.names.setImportant(new Set([this.editing.selected?.name ?? '', ...met]));
    this.stage.canvas.classList.toggle('on-ray', state.hovered !== null);
    this.stage.requestFrame();
  }

  setTheme(theme: Theme): void {
    this.theme = theme;
    this.objects.setTheme(theme);
    this.apparatus.set(this.scene, this.extent, theme);
    this.plane.setTheme(theme);
  }

  reset(smoothly: boolean): void {
    this.stand(this.overview, smoothly);
  }

  lookThroughCamera(): void {
    this.stand(() => throughCamera(this.scene.camera, this.extent, this.stage.aspect), true);
  }

  lookFromLight(index: number): void {
    const { camera, lights } = this.scene;
    this.stand(() => fromLight(lights[index]!, camera, this.extent, this.stage.aspect), true);
  }

  /** A PNG of what is shown; `null` while it has no place in a page. */
  async still(maxWidth: number): Promise<Blob | null> {
    const { canvas } = this.stage;
    if (canvas.clientWidth === 0) return null;
    this.stage.render();
    return stillOf(canvas, this.names, this.theme, maxWidth);
  }

  dispose(): void {
    this.pictures++;
    this.rays.dispose();
    this.editor.dispose();
    this.objects.dispose();
    this.apparatus.dispose();
    this.plane.dispose();
    this.stage.dispose();
  }

  /** What the camera looks at, while the camera is selected. */
  get target(): Vector3 | null {
    const { selected, target } = this.editing;
    if (selected?.kind !== 'camera') return null;
    return target ? new Vector3(...target).multiplyScalar(this.unit) : axisPoint(this.scene, this.extent);
  }

  private get up(): Vector3 {
    return new Vector3(...this.scene.camera.up).normalize();
  }

  /** Chooses the unit for a scene, and returns the scene in it. */
  private measure(given: ViewScene): ViewScene {
    const nodes = strongestOf(this.tree);
    this.unit = unitFor(extentOf(given, nodes).radius);
    const scene = scaledScene(given, this.unit);
    this.extent = extentOf(scene, scaledNodes(nodes, this.unit));
    return scene;
  }

  /** The extent of the scene as it is, with the rays that are shown. */
  private home(): Extent {
    return extentOf(this.scene, scaledNodes(strongestOf(this.tree), this.unit));
  }

  private showScene(): void {
    this.objects.setScene(this.scene, this.theme);
    this.apparatus.set(this.scene, this.extent, this.theme);
    this.plane.setCamera(this.scene.camera);
    this.showNames();
  }

  private showNames(): void {
    this.names.set('scene', sceneLabels(named(this.scene, this.tree), this.extent));
  }

  private setSample(): void {
    const { model } = this;
    this.sample = null;
    this.lines = [];
    if (model === null) return;
    const drawn = model.strongest(MAX_RAYS);
    const reach = REACH * this.extent.radius;
    const nodes = scaledNodes(model.nodes, this.unit);
    this.sample = { model, nodes, drawn, reach, eye: this.scene.camera.eye };
    this.lines = drawn.map((id) => ({ id, ...rayLine(nodes[id]!, reach) }));
  }

  /** The angles at the end of the selected ray. */
  private figure({ selected, generation }: RayState): Figure | null {
    if (this.sample === null || selected === null || this.sample.model.generation(selected) > generation) return null;
    const { model, nodes } = this.sample;
    const node = nodes[selected]!;
    if (node.hit === null) return null;
    const { normal, t } = node.hit;
    const back = model.children(selected).some((child) => dot(nodes[child]!.dir, normal) > 0);
    return figureOf(node, back, Math.min(ANGLES * this.extent.radius, t / 2));
  }

  private objectMetBy(id: number | null): string {
    return (id !== null && this.model?.nodes[id]?.hit?.object) || '';
  }

  private stand(view: () => Viewpoint, smoothly: boolean): void {
    this.standing = view;
    this.stage.show(view(), smoothly);
  }

  private listen(canvas: HTMLCanvasElement): void {
    canvas.addEventListener('click', (event) => {
      if (this.pressed.distanceTo(new Vector3(event.clientX, event.clientY)) > CLICK) return;
      const ray = this.rayAt(event);
      const met = this.pointedAt(event, false);
      if (ray === null && met?.pixel) return this.events.pixel(met.pixel);
      this.events.select(ray);
      if (ray === null && this.picksObjects) this.events.object(met?.object ?? null);
    });
    canvas.addEventListener('pointermove', (event) => {
      if (event.buttons !== 0) return;
      const grip = this.editor.hover(event);
      const ray = grip ? null : this.rayAt(event);
      const met = grip || ray !== null ? null : this.pointedAt(event, true);
      this.events.hover(ray);
      canvas.classList.toggle('on-grip', grip);
      canvas.classList.toggle('on-object', met?.object !== undefined);
      this.aim(met?.pixel ?? null, event.offsetX, event.offsetY);
    });
    canvas.addEventListener('pointerleave', () => {
      this.events.hover(null);
      this.editor.leave();
      this.aim(null);
    });
  }

  /** Says which pixel of the picture is under the pointer. */
  private aim(pixel: Pixel | null, x = 0, y = 0): void {
    this.stage.canvas.classList.toggle('on-pixel', pixel !== null);
    this.pixelLabel.hidden = pixel === null;
    if (pixel === null) return;
    this.pixelLabel.textContent = pixel.join(', ');
    this.pixelLabel.style.transform = `translate(${x}px, ${y}px) translate(0.7rem, -1.9rem)`;
  }

  private rayAt(event: MouseEvent): number | null {
    const { x: width, y: height } = this.stage.uniforms.size.value;
    const lines = this.lines.filter(({ id }) => this.model!.generation(id) <= this.generation);
    return pick(lines, ...this.stage.pixelOf(event), this.stage.projection, width, height);
  }

  /** The pixel of the picture or the object under the pointer, whichever is nearer. */
  private pointedAt(event: MouseEvent, hasty: boolean): { pixel?: Pixel; object?: ObjectRef } | null {
    const place = this.stage.pixelOf(event);
    const pixel = this.picksPixels ? this.plane.pixelAt(this.stage.lineOfSight(...place)) : null;
    const object = this.picksObjects ? objectAt(this, ...place, hasty) : null;
    if (pixel !== null && (object === null || pixel.distance < object.distance)) return { pixel: pixel.at };
    return object && { object: object.object };
  }

  private objectAt(event: MouseEvent): ObjectRef | null {
    return objectAt(this, ...this.stage.pixelOf(event), false)?.object ?? null;
  }
}

/** The scene with the objects that get a name: all, or if that would be a crowd those that rays meet. */
function named(scene: ViewScene, tree: RayTreeDocument | null): ViewScene {
  if (scene.spheres.length + scene.meshes.length <= MAX_NAMES) return scene;
  const met = new Set(tree?.samples.flatMap(({ nodes }) => nodes.map(({ hit }) => hit?.object)));
  const isMet = ({ name }: { name: string }) => met.has(name);
  return { ...scene, spheres: scene.spheres.filter(isMet), meshes: scene.meshes.filter(isMet) };
}

/** What the drawing must make room for: turning to another sample should not move the eye. */
function strongestOf(tree: RayTreeDocument | null): RayNode[] {
  return tree === null ? [] : tree.samples.flatMap((sample) => sample.nodes.slice(0, MAX_RAYS));
}
