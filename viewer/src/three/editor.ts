/** The selected object: drawn, and dragged with the pointer or moved with keys. */

import { Group, MathUtils, Vector3 } from 'three';
import type { Vec3 } from '../data';
import { type Change, type Editing, type Movement, type ObjectRef, snapped, undone } from '../editing';
import type { Theme } from '../theme';
import { Drag, type Grip } from './drag';
import { axis, drawnHandle, type Handle, handlesFor, outline } from './handles';
import { LineSet } from './line-set';
import { MarkSet } from './marks';
import { FINGER, pick } from './picking';
import type { Stage } from './stage';
import { placeOf, type Places } from './subjects';

/** Pixels that the pointer moves before it drags: less is a click. */
const SLACK = 4;
/** Of the drawing's radius, with each key. */
const KEY_STEP = 1 / 50;
/** To the right, up, and away. */
const KEYS: Record<string, Vec3> = {
  ArrowLeft: [-1, 0, 0],
  ArrowRight: [1, 0, 0],
  ArrowDown: [0, -1, 0],
  ArrowUp: [0, 1, 0],
  PageUp: [0, 0, 1],
  PageDown: [0, 0, -1],
};

export interface EditorEvents {
  move(change: Movement): void;
  moved(change: Movement): void;
}

/** What the editor needs to know of the drawing around it. */
export interface Surroundings extends Places {
  /** By what lengths of the scene are multiplied. */
  unit: number;
  theme: Theme;
}

interface Pull {
  drag: Drag;
  object: ObjectRef;
  pointer: number;
  from: [number, number];
  /** `null` until the pointer has moved far enough. */
  change: Change | null;
}

export class Editor {
  readonly group = new Group();
  private editing: Editing = { selected: null, handles: null, snap: null };
  private hovered: Handle | null = null;
  private handles: Handle[] = [];
  private pull: Pull | null = null;
  /** A move with the keys goes on until they are let go. */
  private keyed: { object: ObjectRef; at: Vec3; by: Vector3 } | null = null;
  private readonly lines: LineSet;
  private readonly marks: MarkSet;

  constructor(
    private readonly stage: Stage,
    private readonly around: () => Surroundings,
    /** The object under the pointer. */
    private readonly objectAt: (event: MouseEvent) => ObjectRef | null,
    private readonly events: EditorEvents,
  ) {
    this.lines = new LineSet(stage.uniforms, 12, 1);
    this.marks = new MarkSet(stage.uniforms);
    this.marks.points.renderOrder = 13;
    this.group.add(this.lines.group, this.marks.points);
    this.listen(stage.canvas);
  }

  set(editing: Editing): void {
    if (!same(editing.selected, this.editing.selected)) {
      this.cancel();
      this.endKeys();
      this.hovered = null;
    }
    this.editing = editing;
  }

  get dragging(): boolean {
    return this.pull?.change != null;
  }

  /** Before each frame: handles keep their size when the eye comes nearer. */
  prepare(): void {
    const { scene, theme, target } = this.around();
    const { selected, handles } = this.editing;
    const at = this.place();
    this.handles = [];
    if (selected === null || at === null) {
      this.lines.set([]);
      return this.marks.set([]);
    }
    const { camera, uniforms } = this.stage;
    const seen = { object: selected, at, scene, camera, theme };
    const distance = at.distanceTo(camera.position);
    const pixel = (2 * Math.tan(MathUtils.degToRad(camera.fov) / 2) * distance) / (camera.view?.fullHeight ?? uniforms.size.value.y);
    if (handles !== null) this.handles = handlesFor(seen, handles, pixel);
    const pulled = this.dragging ? this.pull!.drag.grip : this.hovered?.grip;
    const parts = [
      outline(seen),
      ...(target === null ? [] : [axis(scene.camera.eye, target.toArray(), theme)]),
      ...this.handles.map((handle) => drawnHandle(handle, pulled !== undefined && sameGrip(handle.grip, pulled))),
    ];
    this.lines.set(parts.flatMap(({ lines }) => lines));
    this.marks.set(parts.flatMap(({ marks }) => marks));
  }

  /** Is the pointer on a handle? */
  hover(event: MouseEvent): boolean {
    const found = this.handleAt(event);
    if (found?.grip !== this.hovered?.grip) this.stage.requestFrame();
    this.hovered = found;
    return found !== null;
  }

  /** The pointer is elsewhere. */
  leave(): void {
    this.hovered = null;
    this.stage.requestFrame();
  }

  dispose(): void {
    this.lines.dispose();
    this.marks.dispose();
  }

  private place(): Vector3 | null {
    const { selected } = this.editing;
    return selected && placeOf(selected, this.around());
  }

  private handleAt(event: MouseEvent): Handle | null {
    const lines = this.handles.flatMap(({ lines }, id) => lines.map((line) => ({ id, ...line })));
    const { x: width, y: height } = this.stage.uniforms.size.value;
    const tolerance = event instanceof PointerEvent && event.pointerType === 'touch' ? FINGER : undefined;
    const found = pick(lines, ...this.stage.pixelOf(event), this.stage.projection, width, height, tolerance);
    return found === null ? null : this.handles[found]!;
  }

  /** Comes before the controls that turn the eye. */
  private listen(canvas: HTMLCanvasElement): void {
    const capture = { capture: true };
    canvas.addEventListener('pointerdown', (event) => this.onDown(event), capture);
    canvas.addEventListener('pointermove', (event) => this.onMove(event), capture);
    for (const type of ['pointerup', 'pointercancel'] as const) canvas.addEventListener(type, (event) => this.onUp(event), capture);
    canvas.addEventListener('keydown', (event) => this.onKey(event), capture);
    canvas.addEventListener('keyup', (event) => event.key in KEYS && this.endKeys());
    canvas.addEventListener('blur', () => this.endKeys());
  }

  private onDown(event: PointerEvent): void {
    // A second finger does not turn the eye while the first one drags.
    if (this.pull !== null) return event.stopImmediatePropagation();
    if (event.button !== 0 || event.ctrlKey || event.metaKey || event.shiftKey) return;
    const object = this.editing.selected;
    const at = this.place();
    if (object === null || at === null || this.editing.handles === null) return;
    const grip = this.handleAt(event)?.grip ?? this.own(object, event);
    if (grip === null) return;
    event.stopImmediatePropagation();
    this.stage.canvas.setPointerCapture(event.pointerId);
    const sight = this.stage.camera.getWorldDirection(new Vector3());
    const drag = new Drag(grip, at, this.stage.lineOfSight(...this.stage.pixelOf(event)), sight);
    this.pull = { drag, object, pointer: event.pointerId, from: [event.clientX, event.clientY], change: null };
  }

  /** The object itself can be dragged too, if it has a place. */
  private own(object: ObjectRef, event: PointerEvent): Grip | null {
    const distant = object.kind === 'light' && this.around().scene.lights[object.index]!.position === null;
    return !distant && same(this.objectAt(event), object) ? { do: 'move', axis: null } : null;
  }

  private onMove(event: PointerEvent): void {
    const { pull } = this;
    if (pull === null) return;
    event.stopImmediatePropagation();
    if (event.pointerId !== pull.pointer) return;
    if (pull.change === null && Math.hypot(event.clientX - pull.from[0], event.clientY - pull.from[1]) < SLACK) return;
    const { unit } = this.around();
    const { snap } = this.editing;
    pull.change = pull.drag.change(this.stage.lineOfSight(...this.stage.pixelOf(event)), snap === null ? null : snap * unit);
    this.events.move(this.movement(pull, pull.change));
    this.stage.requestFrame();
  }

  private onUp(event: PointerEvent): void {
    const { pull } = this;
    if (pull === null || event.pointerId !== pull.pointer) return;
    event.stopImmediatePropagation();
    if (event.type === 'pointercancel') return this.cancel();
    this.pull = null;
    if (pull.change !== null) this.events.moved(this.movement(pull, pull.change));
    this.stage.requestFrame();
  }

  private cancel(): void {
    const { pull } = this;
    this.pull = null;
    if (pull === null || pull.change === null) return;
    const nothing = this.movement(pull, undone(pull.change));
    this.events.move(nothing);
    this.events.moved(nothing);
    this.stage.requestFrame();
  }

  private movement({ drag, object }: Pull, change: Change): Movement {
    const { unit } = this.around();
    const own: Change = change.kind === 'move' ? { kind: 'move', by: scaled(change.by, 1 / unit) } : change;
    return { ...own, object, at: scaled(drag.center.toArray(), 1 / unit) };
  }

  private onKey(event: KeyboardEvent): void {
    if (event.key === 'Escape' && this.pull !== null) {
      event.stopPropagation();
      event.preventDefault();
      return this.cancel();
    }
    const step = KEYS[event.key];
    const { selected, snap, handles } = this.editing;
    const at = this.place();
    if (step === undefined || !event.altKey || event.ctrlKey || event.metaKey) return;
    if (selected === null || at === null || handles === null) return;
    event.preventDefault();
    event.stopPropagation();
    const { unit, extent } = this.around();
    this.keyed ??= { object: selected, at: scaled(at.toArray(), 1 / unit), by: new Vector3() };
    const { camera } = this.stage;
    const axes = [new Vector3(), new Vector3(), new Vector3()] as const;
    camera.matrixWorld.extractBasis(...axes);
    const length = snap ?? (KEY_STEP * 2 * extent.radius) / unit;
    // The camera looks along its third axis, backwards.
    for (const [axis, part] of [[axes[0], step[0]], [axes[1], step[1]], [axes[2], -step[2]]] as const) {
      if (part !== 0) this.keyed.by.addScaledVector(snap === null ? axis : mainAxis(axis), part * length);
    }
    this.events.move(this.keyedMovement());
  }

  private endKeys(): void {
    if (this.keyed === null) return;
    const last = this.keyedMovement();
    this.keyed = null;
    this.events.moved(last);
  }

  private keyedMovement(): Movement {
    const { object, at, by } = this.keyed!;
    const { snap } = this.editing;
    return { kind: 'move', by: by.toArray().map((value) => snapped(value, snap)) as Vec3, object, at };
  }
}

/** The axis of the scene that a direction is nearest to: steps of a grid go along its lines. */
function mainAxis(direction: Vector3): Vector3 {
  const parts = direction.toArray();
  const most = parts.reduce((best, part, axis) => (Math.abs(part) > Math.abs(parts[best]!) ? axis : best), 0);
  return new Vector3().setComponent(most, Math.sign(parts[most]!));
}

function same(a: ObjectRef | null, b: ObjectRef | null): boolean {
  return a?.kind === b?.kind && a?.index === b?.index;
}

function sameGrip(a: Grip, b: Grip): boolean {
  return a.do === b.do && String(a.axis) === String(b.axis);
}

function scaled(at: Vec3, factor: number): Vec3 {
  return at.map((value) => factor * value) as Vec3;
}
