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
  // The ground, as the style sheet has it: an ellipse through the farthest corner.
  const ground = context.createRadialGradient(0, 0, 0, 0, 0, 1);
  ground.addColorStop(0, theme.glow);
  ground.addColorStop(1, theme.rim);
  context.fillStyle = ground;
  context.setTransform(Math.SQRT1_2 * width, 0, 0, Math.SQRT2 * 0.58 * height, 0.5 * width, 0.42 * height);
  context.fillRect(-1, -1, 2, 2);
  context.resetTransform();
  context.drawImage(canvas, 0, 0, width, height);
  names.paint(context, width / canvas.clientWidth);
  return new Promise((resolve, reject) => {
    sheet.toBlob((blob) => (blob === null ? reject(new Error('the browser writes no PNG')) : resolve(blob)), 'image/png');
  });
}
