/** The scene in 3D: turn it, look through the camera or from a light, move things, and see the rays of a pixel. */

import { effect, untracked, useComputed } from '@preact/signals';
import { type Change, mount, type Movement, TreePanel, type Viewer, type ViewScene } from 'snell-viewer';
import { useEffect, useRef, useState } from 'preact/hooks';
import type { Base, Store } from '../store';
import { SmallCopy } from './copy';
import { editsFor } from './movement';
import { placeOf, roundTo, type SceneObject, snapOf, type Vec3 } from './objects';
import { Pace } from './pace';

/** The drawing of the studio, which the panel beside it takes part in. */
export class Space {
  readonly viewer: Viewer;
  private readonly copy = new SmallCopy();
  private readonly ends: (() => void)[] = [];
  private readonly pace = new Pace(() => this.show());
  /** What the drawing has of the store. */
  private shown: { base: Base | null; view: ViewScene; editing: string };
  private drag: { object: SceneObject; center: Vec3; radius: number; group: string } | null = null;

  constructor(
    parent: HTMLElement,
    private readonly store: Store,
  ) {
    const { view } = store.revision.peek()!;
    this.viewer = mount(parent, { scene: view }, { panel: false, header: false, toolbar: 'studio' });
    this.ends.push(
      this.viewer.on('pixel', (x, y) => store.pin([x, y])),
      this.viewer.on('object', (object) => store.select((object && store.objectOf(object)?.key) ?? null)),
      this.viewer.on('hover', (id) => this.point(id ?? this.viewer.selected)),
      this.viewer.on('select', (id) => this.point(id)),
      this.viewer.on('move', (movement) => this.move(movement)),
      this.viewer.on('moved', () => this.moved()),
    );
    this.shown = { base: store.base.peek(), view, editing: '' };
    this.ends.push(
      effect(() => {
        void store.revision.value;
        // A hand in the drawing must feel what it does; all else can be seen in the picture, whose time this must not take.
        untracked(() => (this.drag === null ? this.pace.request() : this.pace.flush()));
      }),
      effect(() => {
        void store.frame.value;
        this.pace.request();
      }),
      effect(() => {
        void [store.selectedKey.value, store.handles.value, store.snaps.value];
        untracked(() => this.pace.flush());
      }),
      effect(() => this.viewer.setTree(store.tree.value, { panel: store.pinned.value !== null })),
    );
  }

  /** Puts the tree of rays there. */
  placeTree(parent: HTMLElement): () => void {
    const panel = new TreePanel(parent, this.viewer);
    return () => panel.dispose();
  }

  dispose(): void {
    for (const end of this.ends) end();
    this.pace.cancel();
    this.viewer.dispose();
  }

  private move(movement: Movement): void {
    const { store } = this;
    if (this.drag === null) {
      const chosen = store.objectOf(movement.object);
      const object: SceneObject | null = chosen?.kind === 'camera' && movement.object.index === 1 ? { ...chosen, kind: 'target' } : chosen;
      const place = object && placeOf(object, movement.object, store.revision.value!.view);
      if (!place) return;
      this.drag = { object, ...place, group: `space ${object.key} ${performance.now()}` };
    }
    const { object, center, radius, group } = this.drag;
    store.edit(editsFor(object, rounded(movement, radius || Math.hypot(...center)), center), { label: `${movement.kind} ${object.title}`, group });
  }

  private show(): void {
    const { base, revision, surface, selected, things, handles, snaps } = this.store;
    const { scene, view, size } = revision.peek()!;
    const { shown } = this;
    this.shown = { base: base.peek(), view, editing: [selected.peek()?.key, handles.peek(), snaps.peek()].join() };
    const isNew = view !== shown.view;
    if (isNew) this.viewer.setScene(view, { reset: this.shown.base !== shown.base });
    if (isNew || this.shown.editing !== shown.editing) {
      const object = selected.peek();
      const ref = (object && things.peek().get(object.key)?.[0]) ?? null;
      const snap = snaps.peek() ? snapOf(scene) : null;
      this.viewer.setObjects({ selected: ref, handles: ref && handles.peek(), snap, target: scene.camera.look_at as Vec3 });
    }
    this.viewer.setLivePicture(this.copy.of(surface.canvas), size);
  }

  private point(id: number | null): void {
    const { value: tree } = this.store.tree;
    // Of several samples it is not known which one is shown.
    const node = id === null || tree?.samples.length !== 1 ? undefined : tree.samples[0]!.nodes[id];
    this.store.branch.value = node?.hit?.point ?? null;
  }

  private moved(): void {
    this.drag = null;
  }
}

/** What a hand aims at has few digits. */
function rounded(change: Change, extent: number): Change {
  switch (change.kind) {
    case 'move':
      return { ...change, by: change.by.map((value) => roundTo(value, extent)) as Vec3 };
    case 'turn':
      return { ...change, degrees: roundTo(change.degrees, 360) };
    case 'scale':
      return { ...change, by: typeof change.by === 'number' ? roundTo(change.by, 1) : (change.by.map((value) => roundTo(value, 1)) as Vec3) };
  }
}

export function SpaceView({ store, onSpace }: { store: Store; onSpace(space: Space | null): void }) {
  const place = useRef<HTMLDivElement>(null);
  const [shown, show] = useState<Space | null>(null);
  // The picture first: to set up a drawing in 3D takes a browser longer than the engine takes for all of it.
  const ready = useComputed(() => store.revision.value !== null && store.frame.value > 0).value;
  useEffect(() => {
    if (!ready) return;
    let space: Space | null = null;
    // After the frame in which the picture is shown.
    const soon = setTimeout(() => {
      space = new Space(place.current!, store);
      onSpace(space);
      show(space);
    }, 30);
    return () => {
      clearTimeout(soon);
      onSpace(null);
      show(null);
      space?.dispose();
    };
  }, [ready]);
  return (
    <div class="space">
      {ready && <SpaceTools store={store} space={shown} />}
      <div ref={place} class="drawing" />
    </div>
  );
}

const HANDLES = [['move', 'Move'], ['turn', 'Turn'], ['scale', 'Scale']] as const;

function SpaceTools({ store, space }: { store: Store; space: Space | null }) {
  const lights = store.objects.value.filter(({ kind }) => kind === 'light');
  const selected = store.selected.value;
  const movable = selected !== null;
  return (
    <div class="space-tools">
      <div class="group" role="group" aria-label="Look">
        <button type="button" onClick={() => space?.viewer.reset()}>
          Overview
        </button>
        <button type="button" onClick={() => space?.viewer.lookThroughCamera()}>
          Through the camera
        </button>
        {lights.length > 0 && (
          <select
            aria-label="Look from a light"
            value=""
            onChange={(event) => {
              space?.viewer.lookFromLight(Number(event.currentTarget.value));
              event.currentTarget.value = '';
            }}
          >
            <option value="" disabled>
              From a light
            </option>
            {lights.map(({ title }, index) => (
              <option key={index} value={index}>
                {title}
              </option>
            ))}
          </select>
        )}
      </div>
      {/* Always there, so that the drawing beneath does not jump when something is chosen. */}
      <div class="group" role="group" aria-label={movable ? `Handles of ${selected!.title}` : 'Handles'}>
        {HANDLES.map(([value, title]) => (
          <button type="button" key={value} disabled={!movable} aria-pressed={movable && store.handles.value === value} onClick={() => (store.handles.value = value)}>
            {title}
          </button>
        ))}
        <label class="button">
          <input type="checkbox" checked={store.snaps.value} onChange={(event) => (store.snaps.value = event.currentTarget.checked)} /> Snap
        </label>
      </div>
    </div>
  );
}
