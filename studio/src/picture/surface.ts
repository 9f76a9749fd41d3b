/** The canvas that the picture is on. What was there stays until the next picture covers it. */

import type { Patch } from '../engine/protocol';

export class Surface {
  readonly canvas = document.createElement('canvas');
  private readonly shown = context(this.canvas);
  private readonly next = context(document.createElement('canvas'));
  private covered = true;

  /** Prepares for another picture. */
  begin(width: number, height: number): void {
    const { canvas } = this.next;
    // A picture that was dropped half way may show through for the first milliseconds: it is nearly the same.
    if (canvas.width !== width || canvas.height !== height) Object.assign(canvas, { width, height });
    this.covered = false;
  }

  /** Takes what has been rendered; says whether something is to be seen of it. */
  put(patches: Patch[], covered: boolean): boolean {
    const target = this.covered ? this.shown : this.next;
    for (const { x, y, width, height, rgba } of patches) target.putImageData(new ImageData(rgba, width, height), x, y);
    if (!this.covered && covered) this.swap();
    return this.covered;
  }

  /** Becomes like another one. */
  copy({ canvas }: Surface): void {
    Object.assign(this.canvas, { width: canvas.width, height: canvas.height });
    this.shown.drawImage(canvas, 0, 0);
  }

  private swap(): void {
    const { canvas } = this.next;
    const { width, height } = canvas;
    if (this.canvas.width !== width || this.canvas.height !== height) Object.assign(this.canvas, { width, height });
    this.shown.drawImage(canvas, 0, 0);
    this.covered = true;
  }
}

function context(canvas: HTMLCanvasElement): CanvasRenderingContext2D {
  // Written again and again, and read for the 3D view: in main memory both are quick.
  return canvas.getContext('2d', { willReadFrequently: true })!;
}
