/** What lies over the picture: the pixel that is asked for, its value and those around it, and what is looked for. */

import type { Pixel, Store } from '../store';
import { project } from './drag';
import type { Zoom } from './zoom';

/** Pixels of the screen for each of the picture's, from which on numbers fit into it. */
const LEGIBLE = 54;
/** Of the mask over what is not looked for. */
const VEIL = 205;

export class Overlay {
  private readonly canvas = document.createElement('canvas');
  private readonly label = document.createElement('output');
  private readonly mask = document.createElement('canvas');
  private masked: object | null = null;
  private values: { key: string; rect: [number, number, number, number]; numbers: Float64Array } | null = null;
  private wanted = '';

  constructor(
    private readonly box: HTMLElement,
    private readonly store: Store,
  ) {
    this.canvas.className = 'overlay';
    this.canvas.setAttribute('aria-hidden', 'true');
    this.label.className = 'pixel-label';
    this.label.setAttribute('aria-hidden', 'true');
    box.append(this.canvas, this.label);
  }

  dispose(): void {
    this.canvas.remove();
    this.label.remove();
  }

  draw(zoom: Zoom): void {
    const { clientWidth: width, clientHeight: height } = this.box;
    const ratio = window.devicePixelRatio || 1;
    const [wide, high] = [Math.round(width * ratio), Math.round(height * ratio)];
    if (this.canvas.width !== wide || this.canvas.height !== high) Object.assign(this.canvas, { width: wide, height: high });
    const paint = this.canvas.getContext('2d')!;
    paint.setTransform(ratio, 0, 0, ratio, 0, 0);
    // In halves: Chromium goes on showing what was there before if a canvas is cleared as a whole and nothing is drawn on it.
    paint.clearRect(0, 0, width, height / 2);
    paint.clearRect(0, height / 2, width, height / 2);
    this.drawMask(paint, zoom);
    if (zoom.scale >= LEGIBLE) this.drawValues(paint, zoom, width, height);
    const { pinned, hovered } = this.store;
    if (hovered.value && hovered.value !== pinned.value) frame(paint, zoom, hovered.value, 'rgb(255 255 255 / 70%)', 1);
    if (pinned.value) {
      cross(paint, zoom, pinned.value, width, height);
      frame(paint, zoom, pinned.value, '#fff', 2);
    }
    this.drawBranch(paint, zoom);
    this.showLabel(zoom, hovered.value ?? pinned.value);
  }

  private drawMask(paint: CanvasRenderingContext2D, { scale, x, y }: Zoom): void {
    const mask = this.store.mask.value;
    if (mask === null) return;
    const [width, height] = this.store.revision.value!.size;
    if (this.masked !== mask) {
      Object.assign(this.mask, { width, height });
      const veil = new ImageData(width, height);
      // All zero is black: only how thick the veil is has to be said.
      for (let pixel = 0; pixel < mask.length; pixel++) veil.data[4 * pixel + 3] = VEIL * (1 - mask[pixel]!);
      this.mask.getContext('2d')!.putImageData(veil, 0, 0);
      this.masked = mask;
    }
    paint.imageSmoothingEnabled = false;
    paint.drawImage(this.mask, x, y, width * scale, height * scale);
  }

  /** Linear red, green and blue in each pixel that can be seen, once they have come. */
  private drawValues(paint: CanvasRenderingContext2D, { scale, x, y }: Zoom, width: number, height: number): void {
    const [columns, rows] = this.store.revision.value?.size ?? [0, 0];
    const left = Math.max(0, Math.floor(-x / scale));
    const top = Math.max(0, Math.floor(-y / scale));
    const right = Math.min(columns, Math.ceil((width - x) / scale));
    const bottom = Math.min(rows, Math.ceil((height - y) / scale));
    if (right <= left || bottom <= top || this.store.outcome.value === null) return;
    const rect: [number, number, number, number] = [left, top, right - left, bottom - top];
    const key = `${rect.join()} ${this.store.outcome.value.sha256}`;
    if (this.values?.key !== key) {
      this.ask(key, rect, { scale, x, y });
      return;
    }
    paint.textAlign = 'center';
    paint.textBaseline = 'middle';
    paint.font = `${Math.min(13, scale / 5)}px ui-monospace, monospace`;
    const line = scale / 4.2;
    for (let row = 0; row < rect[3]; row++) {
      for (let column = 0; column < rect[2]; column++) {
        const at = 3 * (row * rect[2] + column);
        const color = this.values.numbers.subarray(at, at + 3);
        paint.fillStyle = color[0]! + color[1]! + color[2]! > 1.2 ? '#000' : '#fff';
        color.forEach((value, channel) => {
          paint.fillText(value.toPrecision(3), x + (left + column + 0.5) * scale, y + (top + row + 0.5) * scale + (channel - 1) * line);
        });
      }
    }
  }

  private ask(key: string, rect: [number, number, number, number], zoom: Zoom): void {
    if (this.wanted === key) return;
    this.wanted = key;
    const [x, y, width, height] = rect;
    this.store.values(x, y, width, height).then(
      (numbers) => {
        if (this.wanted !== key || numbers === null) return;
        this.values = { key, rect, numbers };
        this.draw(zoom);
      },
      // The picture has gone on meanwhile: the next frame asks again.
      () => (this.wanted = ''),
    );
  }

  /** Where the ray that is pointed at meets something, as the camera would see that place. */
  private drawBranch(paint: CanvasRenderingContext2D, { scale, x, y }: Zoom): void {
    const { branch, revision } = this.store;
    const at = branch.value && revision.value && project(revision.value.view.camera, revision.value.size, branch.value);
    if (!at) return;
    for (const [color, width] of [['rgb(0 0 0 / 65%)', 4], ['#ffd66b', 2]] as const) {
      paint.strokeStyle = color;
      paint.lineWidth = width;
      paint.beginPath();
      paint.arc(x + at[0] * scale, y + at[1] * scale, 8, 0, 2 * Math.PI);
      paint.stroke();
    }
  }

  private showLabel({ scale, x, y }: Zoom, pixel: Pixel | null): void {
    this.label.hidden = pixel === null;
    if (pixel === null) return;
    const tree = this.store.tree.value;
    const met = tree && tree.pixel[0] === pixel[0] && tree.pixel[1] === pixel[1] ? tree.samples[0]?.nodes[0]?.hit?.object : null;
    this.label.textContent = met ? `${pixel.join(', ')} · ${met}` : pixel.join(', ');
    const { clientWidth, clientHeight } = this.box;
    const left = Math.min(x + (pixel[0] + 1) * scale + 8, clientWidth - this.label.offsetWidth - 6);
    const top = Math.min(Math.max(y + pixel[1] * scale - 30, 6), clientHeight - 30);
    this.label.style.transform = `translate(${left}px, ${top}px)`;
  }
}

function frame(paint: CanvasRenderingContext2D, { scale, x, y }: Zoom, [column, row]: Pixel, color: string, width: number): void {
  const side = Math.max(scale, 7);
  const [left, top] = [x + (column + 0.5) * scale - side / 2, y + (row + 0.5) * scale - side / 2];
  // Dark around light: to be seen on any picture.
  paint.strokeStyle = 'rgb(0 0 0 / 65%)';
  paint.lineWidth = width + 2;
  paint.strokeRect(left, top, side, side);
  paint.strokeStyle = color;
  paint.lineWidth = width;
  paint.strokeRect(left, top, side, side);
}

function cross(paint: CanvasRenderingContext2D, { scale, x, y }: Zoom, [column, row]: Pixel, width: number, height: number): void {
  const [across, down] = [x + (column + 0.5) * scale, y + (row + 0.5) * scale];
  const gap = Math.max(scale / 2, 3.5) + 4;
  paint.strokeStyle = 'rgb(255 255 255 / 45%)';
  paint.lineWidth = 1;
  paint.beginPath();
  for (const [from, to] of [[0, across - gap], [across + gap, width]] as const) {
    paint.moveTo(from, down);
    paint.lineTo(to, down);
  }
  for (const [from, to] of [[0, down - gap], [down + gap, height]] as const) {
    paint.moveTo(across, from);
    paint.lineTo(across, to);
  }
  paint.stroke();
}
