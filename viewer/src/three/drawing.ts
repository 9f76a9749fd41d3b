/** The scene and the rays of one sample in 3D. */

import { Vector3 } from 'three';
import type { Sample, ViewerData, ViewScene } from '../data';
import { element } from '../dom';
import { rayLine } from '../lines';
import type { TreeModel } from '../model';
import type { Theme } from '../theme';
import { Apparatus } from './apparatus';
import { type Extent, extentOf } from './extent';
import { Names } from './names';
import { Objects } from './objects';
import { pick, type PickedLine } from './picking';
import { type RayState, Rays } from './rays';
import { Stage } from './stage';
import { fromLight, overview, throughCamera } from './viewpoints';

export interface DrawingEvents {
  select(id: number | null): void;
  hover(id: number | null): void;
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
  private readonly extent: Extent;
  private readonly objects: Objects;
  private readonly apparatus: Apparatus;
  private rays: Rays | null = null;
  private lines: PickedLine[] = [];
  private pressed = new Vector3();
  /** Nobody has moved the eye: the view may be fitted to a new size. */
  private atHome = true;

  constructor(
    private readonly data: ViewerData,
    private readonly events: DrawingEvents,
  ) {
    const { scene, tree } = data;
    this.extent = extentOf(scene, strongestOf(tree.samples));
    this.stage = new Stage(new Vector3(...scene.camera.up).normalize(), this.extent.radius);
    this.objects = new Objects(scene, tree.transfer, this.stage.uniforms);
    this.apparatus = new Apparatus(scene, this.extent, this.stage.uniforms);
    this.names = new Names(named(data), this.extent);
    this.stage.scene.add(this.objects.group, this.apparatus.group);
    this.stage.onFrame = () => {
      const { x, y } = this.stage.uniforms.size.value;
      this.names.update(this.stage.camera, x, y);
    };
    this.root.append(this.stage.canvas, this.names.root);
    this.stage.onResize = () => this.atHome && this.reset(false);
    this.stage.onMove = () => (this.atHome = false);
    this.listen(this.stage.canvas);
  }

  /** Shows the rays of another sample; returns how many of them are not drawn. */
  setModel(model: TreeModel): number {
    this.removeRays();
    const drawn = model.strongest(MAX_RAYS);
    const reach = REACH * this.extent.radius;
    this.rays = new Rays(model, drawn, reach, this.data.scene.camera.eye, this.stage.uniforms);
    this.stage.scene.add(this.rays.group);
    this.lines = drawn.map((id) => ({ id, ...rayLine(model.nodes[id]!, reach) }));
    return model.nodes.length - drawn.length;
  }

  show(state: RayState, theme: Theme): void {
    this.rays?.show(state, theme);
    this.stage.canvas.classList.toggle('on-ray', state.hovered !== null);
    this.stage.requestFrame();
  }

  setTheme(theme: Theme): void {
    this.objects.setTheme(theme);
    this.apparatus.setTheme(theme);
  }

  reset(smoothly: boolean): void {
    this.atHome = true;
    this.stage.show(overview(this.data.scene.camera, this.extent, this.stage.aspect), smoothly);
  }

  lookThroughCamera(): void {
    this.atHome = false;
    this.stage.show(throughCamera(this.data.scene.camera, this.extent, this.stage.aspect), true);
  }

  lookFromLight(index: number): void {
    const { camera, lights } = this.data.scene;
    this.atHome = false;
    this.stage.show(fromLight(lights[index]!, camera, this.extent, this.stage.aspect), true);
  }

  dispose(): void {
    this.removeRays();
    this.objects.dispose();
    this.apparatus.dispose();
    this.stage.dispose();
  }

  private removeRays(): void {
    if (this.rays === null) return;
    this.stage.scene.remove(this.rays.group);
    this.rays.dispose();
    this.rays = null;
  }

  private listen(canvas: HTMLCanvasElement): void {
    canvas.addEventListener('pointerdown', ({ clientX, clientY }) => this.pressed.set(clientX, clientY, 0));
    canvas.addEventListener('click', (event) => {
      const moved = this.pressed.distanceTo(new Vector3(event.clientX, event.clientY));
      if (moved <= CLICK) this.events.select(this.rayAt(event));
    });
    canvas.addEventListener('pointermove', (event) => {
      if (event.buttons === 0) this.events.hover(this.rayAt(event));
    });
    canvas.addEventListener('pointerleave', () => this.events.hover(null));
  }

  private rayAt(event: MouseEvent): number | null {
    const { camera, uniforms, canvas } = this.stage;
    const { left, top } = canvas.getBoundingClientRect();
    const projection = camera.projectionMatrix.clone().multiply(camera.matrixWorldInverse);
    const { x: width, y: height } = uniforms.size.value;
    return pick(this.lines, event.clientX - left, event.clientY - top, projection, width, height);
  }
}

/** The scene with the objects that get a name: all, or if that would be a crowd those that rays meet. */
function named({ scene, tree }: ViewerData): ViewScene {
  if (scene.spheres.length + scene.meshes.length <= MAX_NAMES) return scene;
  const met = new Set(tree.samples.flatMap(({ nodes }) => nodes.map(({ hit }) => hit?.object)));
  const isMet = ({ name }: { name: string }) => met.has(name);
  return { ...scene, spheres: scene.spheres.filter(isMet), meshes: scene.meshes.filter(isMet) };
}

/** What the drawing must make room for: turning to another sample should not move the eye. */
function strongestOf(samples: Sample[]): Sample['nodes'] {
  return samples.flatMap((sample) => sample.nodes.slice(0, MAX_RAYS));
}
