/** The picture for the drawing in 3D: where it is larger than can be seen there, a smaller copy, as a graphics card takes long for large ones. */

/** Side of the largest picture that is shown as it is, in pixels. */
const MOST = 1024;

export class SmallCopy {
  private readonly small = document.createElement('canvas');
  // The graphics card reads it, which is quick from main memory.
  private readonly paint = this.small.getContext('2d', { willReadFrequently: true })!;

  /** The picture itself, or a copy that is made anew. */
  of(picture: HTMLCanvasElement): HTMLCanvasElement {
    const scale = MOST / Math.max(picture.width, picture.height);
    if (scale >= 1) return picture;
    const [width, height] = [picture.width, picture.height].map((side) => Math.max(1, Math.round(side * scale))) as [number, number];
    if (this.small.width !== width || this.small.height !== height) Object.assign(this.small, { width, height });
    this.paint.drawImage(picture, 0, 0, width, height);
    return this.small;
  }
}
