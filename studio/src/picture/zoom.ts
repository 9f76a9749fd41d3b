/** Where a picture is on the screen: pixel (u, v) at (x + u·scale, y + v·scale), from the upper left corner of its box. */

export interface Zoom {
  /** Pixels of the screen for each of the picture's. */
  scale: number;
  x: number;
  y: number;
}

type Size = readonly [width: number, height: number];

/** A whole picture never gets smaller than this part of what fits; a pixel never gets larger than a button. */
const [LEAST, LARGEST] = [0.5, 160];
/** Around a picture that fits. */
const MARGIN = 16;

/** All of the picture, as large as it may be, in the middle. */
export function fit([width, height]: Size, [boxWidth, boxHeight]: Size): Zoom {
  const room = (length: number) => Math.max(1, length - 2 * MARGIN);
  const scale = Math.min(room(boxWidth) / width, room(boxHeight) / height, LARGEST);
  return { scale, x: (boxWidth - width * scale) / 2, y: (boxHeight - height * scale) / 2 };
}

/** Larger by a factor; what is under a point of the box stays under it. */
export function zoomAbout(zoom: Zoom, factor: number, [x, y]: Size, picture: Size, box: Size): Zoom {
  const least = LEAST * fit(picture, box).scale;
  const scale = Math.min(LARGEST, Math.max(least, zoom.scale * factor));
  const by = scale / zoom.scale;
  return held({ scale, x: x - (x - zoom.x) * by, y: y - (y - zoom.y) * by }, picture, box);
}

export function panBy(zoom: Zoom, dx: number, dy: number, picture: Size, box: Size): Zoom {
  return held({ ...zoom, x: zoom.x + dx, y: zoom.y + dy }, picture, box);
}

/** Begins at a whole pixel of the screen, as its box does: else the first row and column are mixed with what is beside the picture. */
export function aligned({ scale, x, y }: Zoom, ratio: number): Zoom {
  return { scale, x: Math.round(x * ratio) / ratio, y: Math.round(y * ratio) / ratio };
}

export function pixelAt({ scale, x, y }: Zoom, left: number, top: number, [width, height]: Size): [number, number] | null {
  const [column, row] = [Math.floor((left - x) / scale), Math.floor((top - y) / scale)];
  return column >= 0 && row >= 0 && column < width && row < height ? [column, row] : null;
}

/** The middle of the box stays on the picture, or the picture in the box. */
function held(zoom: Zoom, picture: Size, box: Size): Zoom {
  const along = (at: number, length: number, room: number) => {
    const drawn = length * zoom.scale;
    return drawn <= room ? Math.min(room - drawn, Math.max(0, at)) : Math.min(room / 2, Math.max(room / 2 - drawn, at));
  };
  return { ...zoom, x: along(zoom.x, picture[0], box[0]), y: along(zoom.y, picture[1], box[1]) };
}
