/** A canvas with a camera that people turn; draws only when something has changed. */

import { type Matrix4, PerspectiveCamera, type Ray, Raycaster, Scene, Vector2, Vector3, WebGLRenderer } from 'three';
import { OrbitControls } from 'three/addons/controls/OrbitControls.js';
import { element } from '../dom';
import { Flight } from './flight';
import type { ScreenUniforms } from './line-set';
import type { Viewpoint } from './viewpoints';

const KEYS: Record<string, [sideways: number, down: number, zoom: number]> = {
  ArrowLeft: [-0.09, 0, 1],
  ArrowRight: [0.09, 0, 1],
  ArrowUp: [0, -0.09, 1],
  ArrowDown: [0, 0.09, 1],
  '+': [0, 0, 0.9],
  '-': [0, 0, 1 / 0.9],
};

export class Stage {
  readonly scene = new Scene();
  readonly canvas = element('canvas', { tabindex: 0 });
  readonly camera = new PerspectiveCamera();
  readonly uniforms: ScreenUniforms = { size: { value: new Vector2(1, 1) }, ratio: { value: 1 }, near: { value: 1 } };
  /** After each frame. */
  onFrame: () => void = () => {};
  onResize: () => void = () => {};
  /** When a person moves the eye. */
  onMove: () => void = () => {};
  private readonly renderer: WebGLRenderer;
  private controls!: OrbitControls;
  private flight!: Flight;
  private readonly resizes = new ResizeObserver(() => this.resize());
  private readonly calm = window.matchMedia('(prefers-reduced-motion: reduce)');
  private frame = 0;
  private above: HTMLElement | null = null;
  private below: HTMLElement | null = null;

  /** Throws where there is no WebGL. For the rest see `setSpace`. */
  constructor(up: Vector3, radius: number) {
    this.renderer = new WebGLRenderer({ canvas: this.canvas, antialias: true, alpha: true });
    this.renderer.setClearColor(0, 0);
    this.canvas.addEventListener('wheel', (event) => this.keepPageScrolling(event), { capture: true });
    this.canvas.addEventListener('keydown', (event) => this.onKey(event));
    this.resizes.observe(this.canvas);
    this.setSpace(up, radius);
  }

  /** What is up, and the radius of the whole drawing. A viewpoint should be shown next. */
  setSpace(up: Vector3, radius: number): void {
    this.camera.up.copy(up);
    // A near plane much nearer would leave the depth buffer too few steps.
    this.camera.near = radius / 400;
    this.camera.far = radius * 100;
    this.uniforms.near.value = this.camera.near;
    // Controls look at what is up only once.
    (this.controls as OrbitControls | undefined)?.dispose();
    this.controls = new OrbitControls(this.camera, this.canvas);
    this.controls.enableDamping = !this.calm.matches;
    this.controls.dampingFactor = 0.12;
    this.controls.rotateSpeed = 0.7;
    this.controls.maxDistance = radius * 40;
    this.controls.addEventListener('change', () => this.requestFrame());
    this.controls.addEventListener('start', () => {
      this.flight.stop();
      this.onMove();
    });
    this.flight = new Flight(this.camera, this.controls);
  }

  /** Of the part that is free. */
  get aspect(): number {
    return this.camera.aspect;
  }

  /** From the space of the scene to that of the screen. */
  get projection(): Matrix4 {
    return this.camera.projectionMatrix.clone().multiply(this.camera.matrixWorldInverse);
  }

  /** The pointer's place on the canvas, from its top left corner. */
  pixelOf({ clientX, clientY }: MouseEvent): [number, number] {
    const { left, top } = this.canvas.getBoundingClientRect();
    return [clientX - left, clientY - top];
  }

  lineOfSight(x: number, y: number): Ray {
    const { x: width, y: height } = this.uniforms.size.value;
    const caster = new Raycaster();
    caster.setFromCamera(new Vector2((2 * x) / width - 1, 1 - (2 * y) / height), this.camera);
    return caster.ray;
  }

  /** Where a point is on the canvas; `null` if it is not before the eye. */
  onScreen(point: Vector3): [number, number] | null {
    const { x, y, z } = point.clone().project(this.camera);
    const { x: width, y: height } = this.uniforms.size.value;
    return Math.abs(z) > 1 ? null : [((x + 1) / 2) * width, ((1 - y) / 2) * height];
  }

  /** Keeps what is looked at clear of buttons above and notes below. */
  cover(above: HTMLElement, below: HTMLElement): void {
    [this.above, this.below] = [above, below];
    // Notes come and go, and should not move the drawing.
    this.resizes.observe(above);
  }

  show(view: Viewpoint, smoothly: boolean): void {
    if (smoothly && !this.calm.matches) this.flight.start(view, performance.now());
    else this.flight.jump(view);
    this.requestFrame();
  }

  requestFrame(): void {
    if (this.frame === 0) this.frame = requestAnimationFrame((now) => this.draw(now));
  }

  dispose(): void {
    cancelAnimationFrame(this.frame);
    this.resizes.disconnect();
    this.controls.dispose();
    this.renderer.dispose();
    // Browsers allow a page only a few contexts, and a notebook shows many pictures.
    this.renderer.forceContextLoss();
  }

  /** Now, not with the next frame. */
  render(): void {
    this.renderer.render(this.scene, this.camera);
  }

  private draw(now: number): void {
    this.frame = 0;
    if (this.flight.flying) this.flight.advance(now);
    else this.controls.update();
    this.render();
    this.onFrame();
    if (this.flight.flying) this.requestFrame();
  }

  private resize(): void {
    const { clientWidth, clientHeight } = this.canvas;
    if (clientWidth === 0 || clientHeight === 0) return;
    const ratio = Math.min(2, window.devicePixelRatio);
    this.renderer.setPixelRatio(ratio);
    this.renderer.setSize(clientWidth, clientHeight, false);
    this.uniforms.size.value.set(clientWidth, clientHeight);
    this.uniforms.ratio.value = ratio;
    // What is looked at stands in the middle of the part that is free, if that is most of it.
    const [top, bottom] = [coverOf(this.above), coverOf(this.below)];
    const free = clientHeight - top - bottom;
    if (free > clientHeight / 2) this.camera.setViewOffset(clientWidth, free, 0, -top, clientWidth, clientHeight);
    else this.camera.setViewOffset(clientWidth, clientHeight, 0, 0, clientWidth, clientHeight);
    this.onResize();
    this.requestFrame();
  }

  /** The wheel moves the eye only after a click into the drawing; a page that is read past it scrolls on. */
  private keepPageScrolling(event: WheelEvent): void {
    const focused = (this.canvas.getRootNode() as ShadowRoot | Document).activeElement === this.canvas;
    if (!focused && !event.ctrlKey) event.stopImmediatePropagation();
  }

  private onKey(event: KeyboardEvent): void {
    const move = KEYS[event.key === '=' ? '+' : event.key];
    // Arrows with Shift are for pixels.
    if (event.shiftKey && event.key.startsWith('Arrow')) return;
    if (move === undefined || event.ctrlKey || event.metaKey || event.altKey) return;
    event.preventDefault();
    this.flight.stop();
    this.flight.turn(...move);
    this.onMove();
    this.requestFrame();
  }
}

/** Its height, if it is not beside the drawing but on it. */
function coverOf(part: HTMLElement | null): number {
  return part !== null && getComputedStyle(part).position === 'absolute' ? part.offsetHeight : 0;
}
