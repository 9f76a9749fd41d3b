/** Pixels of the picture: column and row, counted from the left and from the top. */

export type Pixel = [number, number];

const STEPS: Record<string, Pixel> = { ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, -1], ArrowDown: [0, 1] };

/** Where an arrow key leads from a pixel, or from the middle of the picture; `null` for other keys. */
export function nextPixel(key: string, from: Pixel | null, [width, height]: Pixel): Pixel | null {
  const step = STEPS[key];
  if (step === undefined) return null;
  if (from === null) return [width >> 1, height >> 1];
  return [Math.min(width - 1, Math.max(0, from[0] + step[0])), Math.min(height - 1, Math.max(0, from[1] + step[1]))];
}

/** The middle of a pixel, as parts of the width and of the height. */
export function middleOf([x, y]: Pixel, [width, height]: Pixel): [number, number] {
  return [(x + 0.5) / width, (y + 0.5) / height];
}

/** Longer pictures are shown smaller: a graphics card has limits. */
const MAX_SIDE = 4096;

/** Reads a PNG, as it is: the drawing does not change its colours either. */
export async function decodePicture(png: BufferSource): Promise<{ bitmap: ImageBitmap; size: Pixel }> {
  const bitmap = await createImageBitmap(new Blob([png as BlobPart], { type: 'image/png' }));
  const size: Pixel = [bitmap.width, bitmap.height];
  const scale = MAX_SIDE / Math.max(...size);
  if (scale >= 1) return { bitmap, size };
  const resizeWidth = Math.max(1, Math.round(scale * size[0]));
  const resizeHeight = Math.max(1, Math.round(scale * size[1]));
  const smaller = await createImageBitmap(bitmap, { resizeWidth, resizeHeight, resizeQuality: 'high' });
  bitmap.close();
  return { bitmap: smaller, size };
}
