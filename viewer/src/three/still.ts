/** A picture of the drawing as it stands, for where nothing moves. */

import { element } from '../dom';
import type { Theme } from '../theme';
import type { Names } from './names';

/** A PNG in the resolution of the screen, but not wider than `maxWidth`. The canvas must just have been drawn. */
export function stillOf(canvas: HTMLCanvasElement, names: Names, theme: Theme, maxWidth: number): Promise<Blob> {
  const scale = Math.min(1, maxWidth / canvas.width);
  const [width, height] = [Math.round(scale * canvas.width), Math.round(scale * canvas.height)];
  const sheet = element('canvas', { width, height });
  const context = sheet.getContext('2d')!;
  // Not the gradient of the page: it would make the file many times as large, and notebooks are kept under version control.
  context.fillStyle = theme.paper;
  context.fillRect(0, 0, width, height);
  context.drawImage(canvas, 0, 0, width, height);
  names.paint(context, width / canvas.clientWidth);
  return new Promise((resolve, reject) => {
    sheet.toBlob((blob) => (blob === null ? reject(new Error('the browser writes no PNG')) : resolve(blob)), 'image/png');
  });
}
