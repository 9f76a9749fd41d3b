/** Where a canvas is: over the whole of the picture, whatever its own size. */

import { effect, type ReadonlySignal } from '@preact/signals';
import type { Store } from '../store';
import type { Zoom } from './zoom';

/** Keeps it there; returns what ends that. */
export function layAlways(canvas: HTMLCanvasElement, store: Store, zoom: ReadonlySignal<Zoom>): () => void {
  return effect(() => {
    // It has the size of the picture before until the next one covers that.
    void store.frame.value;
    const [width, height] = store.revision.value?.size ?? [canvas.width, canvas.height];
    const { scale, x, y } = zoom.value;
    const [across, down] = [(scale * width) / canvas.width, (scale * height) / canvas.height];
    canvas.style.transform = `translate(${x}px, ${y}px) scale(${across}, ${down})`;
    // Large pixels are there to be seen. Where there are fewer than the picture has, leaving some out would only make its edges ragged.
    canvas.style.imageRendering = Math.min(across, down) < 1 ? 'auto' : 'pixelated';
  });
}
