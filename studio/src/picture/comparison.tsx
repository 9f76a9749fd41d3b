/** Another picture over the one that is shown, as far as a slider lays it open. */

import type { ReadonlySignal } from '@preact/signals';
import { useSignal } from '@preact/signals';
import { useEffect, useRef } from 'preact/hooks';
import type { Comparison, Store } from '../store';
import { layAlways } from './lay';
import type { Zoom } from './zoom';

export function ComparisonSlider({ store, comparison, zoom }: { store: Store; comparison: Comparison; zoom: ReadonlySignal<Zoom> }) {
  /** How much of the box's width shows the other picture. */
  const share = useSignal(0.5);
  const place = useRef<HTMLDivElement>(null);
  const { canvas } = comparison.surface;
  useEffect(() => {
    place.current!.replaceChildren(canvas);
    return layAlways(canvas, store, zoom);
  }, [canvas]);
  const stop = (event: Event) => event.stopPropagation();
  const drag = (event: PointerEvent) => {
    stop(event);
    if (event.buttons === 0) return;
    const { left, width } = place.current!.getBoundingClientRect();
    share.value = Math.min(1, Math.max(0, (event.clientX - left) / width));
  };
  const percent = `${100 * share.value}%`;
  return (
    <>
      <div class="other" ref={place} style={{ clipPath: `inset(0 calc(100% - ${percent}) 0 0)` }} />
      <div
        class="divider"
        role="slider"
        tabIndex={0}
        aria-label={`Compare: ${comparison.label} on the left, the picture on the right`}
        aria-valuenow={Math.round(100 * share.value)}
        style={{ left: percent }}
        onPointerDown={(event) => {
          stop(event);
          event.currentTarget.setPointerCapture(event.pointerId);
        }}
        onPointerMove={drag}
        onPointerUp={stop}
        onKeyDown={(event) => {
          const step = { ArrowLeft: -0.02, ArrowRight: 0.02 }[event.key];
          if (step === undefined) return;
          stop(event);
          event.preventDefault();
          share.value = Math.min(1, Math.max(0, share.value + step));
        }}
      />
      <div class="compared">
        <span>{comparison.label}</span>
        <button type="button" class="plain" aria-label="Stop comparing" onPointerDown={stop} onPointerUp={stop} onClick={() => store.compare(null)}>
          ✕
        </button>
      </div>
    </>
  );
}
