/** Drawing again and again, without taking most of the time. */

/** The least time between two drawings, in milliseconds. */
const LEAST = 120;
/** The same, as a multiple of the time that one drawing takes. */
const TIMES = 6;
/** Milliseconds between two frames of a screen that has nothing to do. */
const FRAME = 17;

export class Pace {
  private cost = 0;
  private last = -Infinity;
  private waiting: ReturnType<typeof setTimeout> | null = null;

  /** `draw` changes something that is drawn with the next frame. */
  constructor(private readonly draw: () => void) {}

  /** Draws at once if nothing was drawn lately, else when it is time. */
  request(): void {
    if (this.waiting !== null) return;
    const wait = this.last + Math.max(LEAST, TIMES * this.cost) - performance.now();
    if (wait <= 0) this.flush();
    else this.waiting = setTimeout(() => this.flush(), wait);
  }

  /** Draws now. */
  flush(): void {
    this.cancel();
    this.last = performance.now();
    this.draw();
    // How long the graphics card takes, or what stands in for one, shows only in how late the frame after it comes.
    requestAnimationFrame((drawn) => requestAnimationFrame((next) => (this.cost = Math.max(0, next - drawn - FRAME))));
  }

  cancel(): void {
    if (this.waiting !== null) clearTimeout(this.waiting);
    this.waiting = null;
  }
}
