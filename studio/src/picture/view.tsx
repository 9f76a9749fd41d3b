/** The picture: point at it to ask, click to pin, drag things, zoom to the pixels. */

import { useEffect, useRef } from 'preact/hooks';
import { untracked, useComputed, useSignal, useSignalEffect } from '@preact/signals';
import { placeOf, roundTo, type SceneObject, type Vec3 } from '../scene/objects';
import { editsFor } from '../scene/movement';
import type { Pixel, Store } from '../store';
import { ComparisonSlider } from './comparison';
import { dragged } from './drag';
import { layAlways } from './lay';
import { Overlay } from './overlay';
import { aligned, fit, panBy, pixelAt, type Zoom, zoomAbout } from './zoom';

/** Pixels of the screen that a pointer may move between down and up in a click. */
const CLICK = 4;
const KEYS: Record<string, Pixel> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

type Gesture =
  | { kind: 'press'; x: number; y: number; pixel: Pixel | null; seen: Promise<SceneObject | null> }
  /** What is seen where the pointer came down is not known yet. */
  | { kind: 'wait'; to: { x: number; y: number }; released: boolean }
  | { kind: 'pan' }
  | { kind: 'drag'; x: number; y: number; move(dx: number, dy: number): void }
  | { kind: 'pinch'; distance: number; middle: [number, number] };

export function PictureView({ store }: { store: Store }) {
  const box = useRef<HTMLDivElement>(null);
  const zoom = useSignal<Zoom>({ scale: 1, x: 0, y: 0 });
  /** Zoomed by a person: not fitted to the next size. */
  const free = useRef(false);
  const gesture = useRef<Gesture | null>(null);
  const pointers = useRef(new Map<number, { x: number; y: number }>());
  const overlay = useRef<Overlay | null>(null);

  const size = () => store.revision.value?.size ?? ([1, 1] as [number, number]);
  const room = (): [number, number] => [box.current!.clientWidth, box.current!.clientHeight];
  const fitted = () => {
    const to = fit(size(), room());
    const { scale, x, y } = zoom.value;
    // Each change is drawn, and of most edits there is none.
    if (to.scale !== scale || to.x !== x || to.y !== y) zoom.value = to;
  };
  /** As it is on this screen. */
  const placed = useComputed(() => aligned(zoom.value, devicePixelRatio));

  useEffect(() => {
    const { canvas } = store.surface;
    box.current!.prepend(canvas);
    overlay.current = new Overlay(box.current!, store);
    const resizes = new ResizeObserver(() => {
      zoom.value = free.current ? { ...zoom.value } : fit(size(), room());
    });
    resizes.observe(box.current!);
    const wheel = (event: WheelEvent) => {
      event.preventDefault();
      free.current = true;
      const { x, y } = at(event);
      zoom.value = zoomAbout(zoom.value, Math.exp(-event.deltaY * (event.ctrlKey ? 0.01 : 0.002)), [x, y], size(), room());
    };
    // Not passive, so that the page does not zoom as well.
    box.current!.addEventListener('wheel', wheel, { passive: false });
    const laid = layAlways(canvas, store, placed);
    return () => {
      laid();
      resizes.disconnect();
      overlay.current!.dispose();
    };
  }, []);

  useSignalEffect(() => {
    if (store.revision.value && !free.current) untracked(fitted);
  });
  useSignalEffect(() => {
    void [store.hovered.value, store.pinned.value, store.tree.value, store.mask.value, store.branch.value, store.outcome.value];
    overlay.current?.draw(placed.value);
  });

  const at = (event: MouseEvent) => {
    const { left, top } = box.current!.getBoundingClientRect();
    return { x: event.clientX - left, y: event.clientY - top };
  };
  const pixelOf = (event: MouseEvent): Pixel | null => {
    const { x, y } = at(event);
    return pixelAt(placed.value, x, y, size());
  };

  /** What a drag moves that begins where this is seen first. */
  const grip = (seen: SceneObject | null): ((dx: number, dy: number) => void) | null => {
    const object = store.objects.value.find(({ key }) => key === seen?.key);
    const { view } = store.revision.value!;
    const place = object && placeOf(object, store.things.value.get(object.key)?.[0], view);
    if (!place) return null;
    store.select(object.key);
    const group = `drag ${object.key} ${performance.now()}`;
    return (dx, dy) => {
      const by = dragged(view.camera, size(), place.center, dx, dy).map((value) => roundTo(value, place.radius)) as Vec3;
      store.edit(editsFor(object, { kind: 'move', by }, place.center), { label: `move ${object.title}`, group });
    };
  };

  const down = (event: PointerEvent) => {
    box.current!.setPointerCapture(event.pointerId);
    pointers.current.set(event.pointerId, at(event));
    if (pointers.current.size === 2) {
      gesture.current = { kind: 'pinch', distance: spread(pointers.current), middle: middle(pointers.current) };
      return;
    }
    const pixel = pixelOf(event);
    if (event.pointerType !== 'mouse') store.hover(pixel);
    const pans = event.button === 1 || event.shiftKey;
    gesture.current = pans ? { kind: 'pan' } : { kind: 'press', ...at(event), pixel, seen: store.seenAt(pixel) };
  };

  const move = (event: PointerEvent) => {
    const before = pointers.current.get(event.pointerId);
    const here = at(event);
    if (before === undefined) return store.hover(pixelOf(event));
    pointers.current.set(event.pointerId, here);
    const state = gesture.current;
    if (state?.kind === 'press' && Math.hypot(here.x - state.x, here.y - state.y) > CLICK) {
      const waits = { kind: 'wait' as const, to: here, released: false };
      gesture.current = waits;
      void state.seen.then((object) => {
        if (gesture.current !== waits && !waits.released) return;
        const moves = grip(object);
        if (!waits.released) gesture.current = moves ? { kind: 'drag', x: state.x, y: state.y, move: moves } : { kind: 'pan' };
        moves?.((waits.to.x - state.x) / zoom.value.scale, (waits.to.y - state.y) / zoom.value.scale);
      });
    }
    switch (gesture.current?.kind) {
      case 'wait':
        gesture.current.to = here;
        break;
      case 'drag': {
        const { x, y, move } = gesture.current;
        move((here.x - x) / zoom.value.scale, (here.y - y) / zoom.value.scale);
        break;
      }
      case 'pan':
        if (free.current) zoom.value = panBy(zoom.value, here.x - before.x, here.y - before.y, size(), room());
        break;
      case 'pinch': {
        const { distance: before, middle: from } = gesture.current;
        const [distance, to] = [spread(pointers.current), middle(pointers.current)];
        free.current = true;
        // What was between the fingers stays there.
        const larger = zoomAbout(zoom.value, distance / before, from, size(), room());
        zoom.value = panBy(larger, to[0] - from[0], to[1] - from[1], size(), room());
        Object.assign(gesture.current, { distance, middle: to });
      }
    }
  };

  const up = (event: PointerEvent) => {
    pointers.current.delete(event.pointerId);
    const state = gesture.current;
    gesture.current = null;
    // A hand may be faster than the answer.
    if (state?.kind === 'wait') state.released = event.type === 'pointerup';
    if (state?.kind !== 'press' || event.type === 'pointercancel') return;
    box.current!.focus();
    store.pin(state.pixel);
  };

  const key = (event: KeyboardEvent) => {
    if (event.ctrlKey || event.metaKey || event.altKey) return;
    const [width, height] = size();
    const step = KEYS[event.key];
    const { value: pinned } = store.pinned;
    const [boxWidth, boxHeight] = room();
    const middleOfBox: [number, number] = [boxWidth / 2, boxHeight / 2];
    if (step) {
      const many = event.shiftKey ? 10 : 1;
      const from = pinned ?? store.hovered.value ?? [Math.floor(width / 2), Math.floor(height / 2)];
      const to: Pixel = pinned ? [from[0] + many * step[0], from[1] + many * step[1]] : from;
      store.pin([Math.min(width - 1, Math.max(0, to[0])), Math.min(height - 1, Math.max(0, to[1]))]);
    } else if (event.key === '+' || event.key === '=' || event.key === '-') {
      free.current = true;
      zoom.value = zoomAbout(zoom.value, event.key === '-' ? 1 / 1.25 : 1.25, middleOfBox, [width, height], room());
    } else if (event.key === '0') {
      free.current = false;
      fitted();
    } else if (event.key === '1') {
      free.current = true;
      zoom.value = zoomAbout(zoom.value, 1 / zoom.value.scale, middleOfBox, [width, height], room());
    } else if (event.key === 'Escape' && pinned) {
      store.pin(null);
    } else {
      return;
    }
    event.preventDefault();
  };

  const label = `The picture${store.base.value ? ` of ${store.base.value.name}` : ''}. Arrow keys choose a pixel, plus and minus zoom, 0 fits.`;
  return (
    <div
      ref={box}
      class="picture"
      tabIndex={0}
      role="application"
      aria-roledescription="picture"
      aria-label={label}
      onPointerDown={down}
      onPointerMove={move}
      onPointerUp={up}
      onPointerCancel={up}
      onPointerLeave={() => pointers.current.size === 0 && store.hover(null)}
      onKeyDown={key}
    >
      {store.comparison.value && <ComparisonSlider store={store} comparison={store.comparison.value} zoom={placed} />}
      <ZoomButtons
        zoom={store.revision.value ? zoom.value.scale : 1}
        fits={store.revision.value !== null && zoom.value.scale === fit(size(), room()).scale}
        fit={() => {
          free.current = false;
          fitted();
        }}
        by={(factor) => {
          free.current = true;
          const [width, height] = room();
          zoom.value = zoomAbout(zoom.value, factor, [width / 2, height / 2], size(), room());
        }}
      />
    </div>
  );
}

function ZoomButtons({ zoom, fits, fit, by }: { zoom: number; fits: boolean; fit(): void; by(factor: number): void }) {
  const keep = (event: Event) => event.stopPropagation();
  return (
    <div class="zoom" role="group" aria-label="Zoom" onPointerDown={keep} onPointerUp={keep}>
      <button type="button" aria-label="Zoom out" onClick={() => by(1 / 1.5)}>−</button>
      <button type="button" aria-label={`${Math.round(100 * zoom)} %, ${fits ? 'show pixel for pixel' : 'fit the picture'}`} onClick={fits ? () => by(1 / zoom) : fit}>
        {Math.round(100 * zoom)} %
      </button>
      <button type="button" aria-label="Zoom in" onClick={() => by(1.5)}>+</button>
    </div>
  );
}

function spread(pointers: Map<number, { x: number; y: number }>): number {
  const [a, b] = [...pointers.values()] as [{ x: number; y: number }, { x: number; y: number }];
  return Math.max(1, Math.hypot(a.x - b.x, a.y - b.y));
}

function middle(pointers: Map<number, { x: number; y: number }>): [number, number] {
  const [a, b] = [...pointers.values()] as [{ x: number; y: number }, { x: number; y: number }];
  return [(a.x + b.x) / 2, (a.y + b.y) / 2];
}
