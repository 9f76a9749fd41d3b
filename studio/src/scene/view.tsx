/** The scene in 3D: turn it, look through the camera or from a light, move things, and see the rays of a pixel. */

import { effect, untracked } from '@preact/signals';
import { mount, type ObjectRef, TreePanel, type Viewer } from 'snell-viewer';
import { useEffect, useRef } from 'preact/hooks';
import type { Store } from '../store';
import { editsFor } from './movement';
import { objectsOf, placeOf, roundTo, type SceneObject, type Vec3 } from './objects';

export type Handles = 'move' | 'turn' | 'scale';

/** The drawing of the studio, which the panel beside it takes part in. */
export class Space {
  readonly viewer: Viewer;
  private readonly ends: (() => void)[] = [];
  private drag: { object: SceneObject; center: Vec3; radius: number; group: string } | null = null;

  constructor(
    parent: HTMLElement,
    private readonly store: Store,
  ) {
    const { value: revision } = store.revision;
    this.viewer = mount(parent, { scene: revision!.view }, { panel: false, header: false, toolbar: 'studio' });
    this.ends.push(
      this.viewer.on('pixel', (x, y) => store.pin([x, y])),
      this.viewer.on('object', (object) => store.select(object?.name ?? null)),
      this.viewer.on('move', (movement) => this.move(movement)),
      this.viewer.on('moved', () => this.moved()),
    );
    let base = untracked(() => store.base.value);
    this.ends.push(
      effect(() => {
        const { view, size } = store.revision.value!;
        this.viewer.setScene(view, { reset: base !== store.base.value });
        base = store.base.value;
        this.viewer.setLivePicture(store.surface.canvas, size);
      }),
      effect(() => {
        void store.frame.value;
        this.viewer.pictureChanged();
      }),
      effect(() => this.viewer.setTree(store.tree.value, { panel: store.pinned.value !== null })),
      effect(() => {
        const selected = this.refOf(store.selected.value);
        this.viewer.setObjects({ selected, handles: selected && store.handles.value, snap: store.snap.value });
      }),
    );
  }

  /** Puts the tree of rays there. */
  placeTree(parent: HTMLElement): () => void {
    const panel = new TreePanel(parent, this.viewer);
    return () => panel.dispose();
  }

  dispose(): void {
    for (const end of this.ends) end();
    this.viewer.dispose();
  }

  private refOf(object: SceneObject | null): ObjectRef | null {
    if (object === null) return null;
    const { view } = this.store.revision.value!;
    const { name } = object;
    const found = (kind: ObjectRef['kind'], list: { name: string }[]): ObjectRef | null => {
      const index = list.findIndex((one) => one.name === name);
      return index < 0 ? null : { kind, index, name };
    };
    if (object.kind === 'camera') return { kind: 'camera', index: 0, name };
    if (object.kind === 'light') return found('light', view.lights);
    return found('sphere', view.spheres) ?? found('mesh', view.meshes);
  }

  private move(movement: Parameters<Parameters<Viewer['on']>[1]>[0] & { object: ObjectRef }): void {
    const { store } = this;
    if (this.drag?.object.name !== movement.object.name) {
      const { scene, view } = store.revision.value!;
      const object = objectsOf(scene).find(({ name }) => name === movement.object.name);
      const place = object && placeOf(object, view);
      if (!place) return;
      this.drag = { object, ...place, group: `space ${object.key} ${performance.now()}` };
    }
    const { object, center, radius, group } = this.drag;
    const rounded = movement.kind === 'move' ? { ...movement, by: movement.by.map((value: number) => roundTo(value, radius || length(center))) as Vec3 } : movement;
    store.edit(editsFor(object, rounded, center), { label: `${movement.kind} ${object.name}`, group });
  }

  private moved(): void {
    this.drag = null;
    this.store.endGroup();
  }
}

function length(vector: Vec3): number {
  return Math.hypot(...vector);
}

export function SpaceView({ store, onSpace }: { store: Store; onSpace(space: Space | null): void }) {
  const place = useRef<HTMLDivElement>(null);
  const ready = store.revision.value !== null;
  useEffect(() => {
    if (!ready) return;
    const space = new Space(place.current!, store);
    onSpace(space);
    return () => {
      onSpace(null);
      space.dispose();
    };
  }, [ready]);
  return <div ref={place} class="space" />;
}
