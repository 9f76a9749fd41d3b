/** The scene and the rays of one sample in 3D. */

import { Raycaster, Vector2, Vector3 } from 'three';
import type { RayNode, RayTreeDocument, ViewScene } from '../data';
import { element } from '../dom';
import { rayLine } from '../lines';
import type { TreeModel } from '../model';
import { decodePicture, middleOf, type Pixel } from '../pixels';
import type { Theme } from '../theme';
import { Apparatus } from './apparatus';
import { type Extent, extentOf } from './extent';
import { ImagePlane } from './image-plane';
import { Names } from './names';
import { Objects } from './objects';
import { pick, type PickedLine } from './picking';
import { type RayState, Rays } from './rays';
import { Stage } from './stage';
import { stillOf } from './still';
import { scaledNodes, scaledScene, unitFor } from './unit';
import { fromLight, overview, throughCamera, type Viewpoint } from './viewpoints';

export interface DrawingEvents {
  select(id: number | null): void;
  hover(id: number | null): void;
  pixel(pixel: Pixel): void;
  /** A frame has been drawn. */
  frame(): void;
}

/** More lines would hide each other. */
const MAX_RAYS = 400;
const MAX_NAMES = 24;
/** Of a ray that leaves the scene, in radii of the drawing. */
const REACH = 0.55;
/** Pixels that the pointer may move between down and up in a click. */
const CLICK = 4;

export class Drawing {
  readonly root = element('div', { class: 'stage' });
  readonly names: Names;
  readonly stage: Stage;
  readonly plane: ImagePlane;
  /** Can pixels of the picture be clicked? */
  picksPixels = false;
  /** In the drawing's own unit, like all lengths here. */
  private readonly scene: ViewScene;
  /** By what lengths are multiplied. */
  private readonly unit: number;
  private readonly extent: Extent;
  private readonly objects: Objects;
  private readonly apparatus: Apparatus;
  /** What is seen at first: with the rays that are shown. */
  private home: Extent;
  private rays: Rays | null = null;
  private lines: PickedLine[] = [];
  private readonly target = element('span', { class: 'target', 'aria-hidden': true, hidden: true });
  private pressed = new Vector3();
  private pictures = 0;
  private readonly overview = () => overview(this.scene.camera, this.home, this.stage.aspect, this.plane.size !== null);
  /** The viewpoint that the eye is at, fitted to each new size; `null` when somebody has moved it. */
  private standing: (() => Viewpoint) | null = this.overview;

  constructor(
    given: ViewScene,
    tree: RayTreeDocument | null,
    private readonly events: DrawingEvents,
  ) {
    this.unit = unitFor(extentOf(given, strongestOf(tree)).radius);
    const scene = (this.scene = scaledScene(given, this.unit));
    this.home = this.extent = extentOf(scene, this.strongest(tree));
    this.stage = new Stage(new Vector3(...scene.camera.up).normalize(), this.extent.radius);
    this.objects = new Objects(scene, scene.transfer, this.stage.uniforms);
    this.apparatus = new Apparatus(scene, this.extent, this.stage.uniforms);
    this.plane = new ImagePlane(scene.camera, this.stage.uniforms);
    this.names = new Names(this.extent);
    this.stage.scene.add(this.objects.group, this.plane.group, this.apparatus.group);
    this.stage.scene.onBeforeRender = () => this.plane.prepare(this.stage.camera, this.stage.uniforms.size.value.y);
    this.stage.onFrame = () => {
      const { x, y } = this.stage.uniforms.size.value;
      this.names.update(this.stage.camera, x, y);
      this.events.frame();
    };
    this.root.append(this.stage.canvas, this.names.root, this.target);
    this.stage.onResize = () => this.standing && this.stage.show(this.standing(), false);
    this.stage.onMove = () => (this.standing = null);
    this.listen(this.stage.canvas);
  }

  /** Prepares for the rays of a pixel. The eye stays where it is. */
  setTree(tree: RayTreeDocument | null): void {
    this.removeRays();
    this.home = extentOf(this.scene, this.strongest(tree));
    this.names.set(named(this.scene, tree));
  }

  /** Shows the rays of a sample; returns how many of them are not drawn. */
  setModel(model: TreeModel): number {
    this.removeRays();
    const drawn = model.strongest(MAX_RAYS);
    const reach = REACH * this.extent.radius;
    const nodes = scaledNodes(model.nodes, this.unit);
    this.rays = new Rays(model, nodes, drawn, reach, this.scene.camera.eye, this.stage.uniforms);
    this.stage.scene.add(this.rays.group);
    this.lines = drawn.map((id) => ({ id, ...rayLine(nodes[id]!, reach) }));
    return model.nodes.length - drawn.length;
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

  mark(pixel: Pixel | null, size: Pixel | null): void {
    this.plane.mark(pixel && size && middleOf(pixel, size));
    this.stage.requestFrame();
  }

  show(state: RayState, theme: Theme): void {
    this.rays?.show(state, theme);
    this.stage.canvas.classList.toggle('on-ray', state.hovered !== null);
    this.stage.requestFrame();
  }

  setTheme(theme: Theme): void {
    this.objects.setTheme(theme);
    this.apparatus.setTheme(theme);
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
  async still(theme: Theme, maxWidth: number): Promise<Blob | null> {
    const { canvas } = this.stage;
    if (canvas.clientWidth === 0) return null;
    this.stage.render();
    return stillOf(canvas, this.names, theme, maxWidth);
  }

  dispose(): void {
    this.pictures++;
    this.removeRays();
    this.objects.dispose();
    this.apparatus.dispose();
    this.plane.dispose();
    this.stage.dispose();
  }

  private strongest(tree: RayTreeDocument | null): RayNode[] {
    return scaledNodes(strongestOf(tree), this.unit);
  }

  private stand(view: () => Viewpoint, smoothly: boolean): void {
    this.standing = view;
    this.stage.show(view(), smoothly);
  }

  private removeRays(): void {
    if (this.rays === null) return;
    this.stage.scene.remove(this.rays.group);
    this.rays.dispose();
    this.rays = null;
    this.lines = [];
  }

  private listen(canvas: HTMLCanvasElement): void {
    canvas.addEventListener('pointerdown', ({ clientX, clientY }) => this.pressed.set(clientX, clientY, 0));
    canvas.addEventListener('click', (event) => {
      if (this.pressed.distanceTo(new Vector3(event.clientX, event.clientY)) > CLICK) return;
      const ray = this.rayAt(event);
      const pixel = ray === null ? this.pixelAt(event) : null;
      if (pixel !== null) this.events.pixel(pixel);
      else this.events.select(ray);
    });
    canvas.addEventListener('pointermove', (event) => {
      if (event.buttons !== 0) return;
      const ray = this.rayAt(event);
      this.events.hover(ray);
      this.aim(ray === null ? this.pixelAt(event) : null, event.offsetX, event.offsetY);
    });
    canvas.addEventListener('pointerleave', () => {
      this.events.hover(null);
      this.aim(null);
    });
  }

  /** Says which pixel of the picture is under the pointer. */
  private aim(pixel: Pixel | null, x = 0, y = 0): void {
    this.stage.canvas.classList.toggle('on-pixel', pixel !== null);
    this.target.hidden = pixel === null;
    if (pixel === null) return;
    this.target.textContent = pixel.join(', ');
    this.target.style.transform = `translate(${x}px, ${y}px) translate(0.7rem, -1.9rem)`;
  }

  private rayAt(event: MouseEvent): number | null {
    const { camera, uniforms, canvas } = this.stage;
    const { left, top } = canvas.getBoundingClientRect();
    const projection = camera.projectionMatrix.clone().multiply(camera.matrixWorldInverse);
    const { x: width, y: height } = uniforms.size.value;
    return pick(this.lines, event.clientX - left, event.clientY - top, projection, width, height);
  }

  private pixelAt(event: MouseEvent): Pixel | null {
    if (!this.picksPixels) return null;
    const { left, top, width, height } = this.stage.canvas.getBoundingClientRect();
    const caster = new Raycaster();
    caster.setFromCamera(
      new Vector2((2 * (event.clientX - left)) / width - 1, 1 - (2 * (event.clientY - top)) / height),
      this.stage.camera,
    );
    return this.plane.pixelAt(caster.ray);
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
