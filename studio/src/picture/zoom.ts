/** How the picture lies in its frame: enlarged, and moved. Points and sizes are in CSS pixels. */

export type Point = readonly [x: number, y: number];
export type Size = readonly [width: number, height: number];

/** A point of the picture is drawn at `origin` plus `scale` times that point. */
export interface Placement {
  scale: number;
  origin: Point;
}

/** A pixel of the picture is then large enough to have its values written in it. */
const MAX_SCALE = 64;
/** Small pictures become no smaller, and even on a dense screen each of their pixels can have one of the screen. */
const MIN_SCALE = 0.25;
/** So much of the frame the picture covers at least, on each axis, unless it is smaller. */
const COVERED = 0.5;
const STEP = 1.25;
/** So far an arrow key moves it, in parts of the frame. */
const PAN = 0.1;

/** The whole picture, as large as it can be, in the middle. Small pictures are enlarged by whole numbers, so that their pixels are equal. */
export function fit(picture: Size, frame: Size): Placement {
  const most = Math.min(frame[0] / picture[0], frame[1] / picture[1]);
  return centered(most >= 2 ? Math.min(MAX_SCALE, Math.floor(most)) : most, picture, frame);
}

/** One pixel of the picture for each of the screen, of which `density` lie on a CSS pixel. The middle of the frame stays. */
export function actualSize(placement: Placement, picture: Size, frame: Size, density = 1): Placement {
  return zoomAt(placement, middle(frame), 1 / density / placement.scale, picture, frame);
}

/** Enlarges by a factor; what is under the point stays there. */
export function zoomAt(placement: Placement, point: Point, factor: number, picture: Size, frame: Size): Placement {
  const scale = clamp(placement.scale * factor, leastScale(picture, frame), MAX_SCALE);
  const ratio = scale / placement.scale;
  return within({ scale, origin: map2((axis) => point[axis] - ratio * (point[axis] - placement.origin[axis])) }, picture, frame);
}

export function pan({ scale, origin }: Placement, [x, y]: Point, picture: Size, frame: Size): Placement {
  return within({ scale, origin: [origin[0] + x, origin[1] + y] }, picture, frame);
}

/** Two fingers have moved: what is under them stays under them, as far as it does not turn. */
export function pinch(placement: Placement, before: readonly [Point, Point], after: readonly [Point, Point], picture: Size, frame: Size): Placement {
  const [from, to] = [between(before), between(after)];
  const distance = apart(before);
  const factor = distance > 0 ? apart(after) / distance : 1;
  const moved = { ...placement, origin: map2((axis) => placement.origin[axis] + to[axis] - from[axis]) };
  return zoomAt(moved, to, factor, picture, frame);
}

/** By what a turn of the wheel enlarges. Browsers tell a pinch on a touch pad as a turn with the control key, in small steps. */
export function wheelFactor({ deltaY, deltaMode, ctrlKey }: Pick<WheelEvent, 'deltaY' | 'deltaMode' | 'ctrlKey'>): number {
  const pixels = deltaY * ([1, 16, 400][deltaMode] ?? 1);
  return clamp(Math.exp(-pixels * (ctrlKey ? 0.01 : 0.002)), 1 / 2, 2);
}

/** What a key does; nothing for other keys. Arrows move the view, not the picture. */
export function keyPlacement(key: string, placement: Placement, picture: Size, frame: Size, density = 1): Placement | null {
  const step = (x: number, y: number) => pan(placement, [-x * PAN * frame[0], -y * PAN * frame[1]], picture, frame);
  switch (key) {
    case '+':
    case '=':
      return zoomAt(placement, middle(frame), STEP, picture, frame);
    case '-':
      return zoomAt(placement, middle(frame), 1 / STEP, picture, frame);
    case '0':
      return fit(picture, frame);
    case '1':
      return actualSize(placement, picture, frame, density);
    case 'ArrowLeft':
      return step(-1, 0);
    case 'ArrowRight':
      return step(1, 0);
    case 'ArrowUp':
      return step(0, -1);
    case 'ArrowDown':
      return step(0, 1);
    default:
      return null;
  }
}

/** The pixel at a point of the frame; nothing beside the picture. */
export function pixelAt(placement: Placement, point: Point, picture: Size): [number, number] | null {
  const [x, y] = map2((axis) => Math.floor((point[axis] - placement.origin[axis]) / placement.scale));
  return x >= 0 && y >= 0 && x < picture[0] && y < picture[1] ? [x, y] : null;
}

/** Where a pixel lies in the frame: its left and top edge, and how long its sides are. */
export function placeOf({ scale, origin }: Placement, [x, y]: Point): { x: number; y: number; side: number } {
  return { x: origin[0] + scale * x, y: origin[1] + scale * y, side: scale };
}

/** Moves the view just so far that a pixel and its neighbours are seen. */
export function showPixel(placement: Placement, pixel: Point, picture: Size, frame: Size): Placement {
  const { x, y, side } = placeOf(placement, pixel);
  const [left, top] = [x, y];
  const move = (start: number, length: number) => {
    const margin = Math.min(2 * side, (length - side) / 2);
    return clamp(start, margin, Math.max(margin, length - side - margin)) - start;
  };
  return pan(placement, [move(left, frame[0]), move(top, frame[1])], picture, frame);
}

/** The same view after the frame has got another size: the middle stays, and a picture that fitted fits again. */
export function resized(placement: Placement, picture: Size, before: Size, after: Size): Placement {
  const fitted = fit(picture, before);
  const isFitted = Math.abs(placement.scale - fitted.scale) < 1e-9 && apart([placement.origin, fitted.origin]) < 0.5;
  if (isFitted) return fit(picture, after);
  return pan(placement, map2((axis) => (after[axis] - before[axis]) / 2), picture, after);
}

/** Keeps the picture in sight: a small one within the frame, of a large one so much that it covers its part of the frame. */
function within({ scale, origin }: Placement, picture: Size, frame: Size): Placement {
  const at = (axis: 0 | 1) => {
    const [length, room] = [scale * picture[axis], frame[axis]];
    const slack = length <= room ? 0 : (1 - COVERED) * room;
    return clamp(origin[axis], Math.min(0, room - length) - slack, Math.max(0, room - length) + slack);
  };
  return { scale, origin: map2(at) };
}

/** Far enough away to see the whole picture. */
function leastScale(picture: Size, frame: Size): number {
  return Math.min(MIN_SCALE, fit(picture, frame).scale);
}

function centered(scale: number, picture: Size, frame: Size): Placement {
  return { scale, origin: map2((axis) => (frame[axis] - scale * picture[axis]) / 2) };
}

function middle(frame: Size): Point {
  return [frame[0] / 2, frame[1] / 2];
}

function between([a, b]: readonly [Point, Point]): Point {
  return [(a[0] + b[0]) / 2, (a[1] + b[1]) / 2];
}

function apart([a, b]: readonly [Point, Point]): number {
  return Math.hypot(a[0] - b[0], a[1] - b[1]);
}

function map2(of: (axis: 0 | 1) => number): [number, number] {
  return [of(0), of(1)];
}

function clamp(value: number, low: number, high: number): number {
  return Math.min(high, Math.max(low, value));
}
