/** Renders a share of the picture, a few milliseconds at a time, so that a change is never far away. */

import type { Session } from 'snell-wasm';
import { buffersOf, type FromRenderer, type Part, type Patch, type PictureOptions, type ToRenderer } from './protocol';
import { brokenBy, changed, findingsOf, hasLostLight, start } from './session';

/** Milliseconds that a slice takes. */
const SLICE = 12;
/** Milliseconds between two looks at whether the first pass is complete. */
const GLIMPSE = 1;
/** Patches that the page is handed at once: of a large picture all of them would keep it from everything else. */
const MOST_PATCHES = 64;
/** Side of the pieces in which shares are dealt out, in pixels: that of the engine. */
const PIECE = 64;

let session: Session | null = null;
let share: [number, number] = [0, 1];
let work: Work | null = null;
let waiting = false;

/** Comes back to the next slice after all messages that have arrived. */
const turn = new MessageChannel();
turn.port1.onmessage = () => {
  waiting = false;
  guarded(() => work?.slice());
};

self.onmessage = ({ data }: MessageEvent<ToRenderer>) => guarded(() => hear(data));

function hear(message: ToRenderer): void {
  switch (message.do) {
    case 'start':
      start(message.module);
      share = message.share;
      break;
    case 'change':
      change(message.change);
      break;
    case 'render':
      render(message.picture, message.options, message.coarsest, message.hold);
      break;
    case 'stop':
      work?.stop();
      break;
    case 'collect':
      if (work?.picture === message.picture) work.handOver();
      tell({ tell: 'collected', picture: message.picture });
  }
}

function render(picture: number, options: PictureOptions, coarsest: number, hold: number): void {
  work = null;
  try {
    work = new Work(picture, options, coarsest, hold);
    work.goOn();
  } catch (error) {
    const findings = findingsOf(error);
    if (findings === null) throw error;
    tell({ tell: 'refused', picture, findings });
  }
}

/** What is refused the desk tells, in the same words. */
function change(change: Parameters<typeof changed>[1]): void {
  try {
    session = changed(session, change);
    work = null;
  } catch (error) {
    if (findingsOf(error) === null) throw error;
  }
}

class Work {
  private stopped = false;
  private covered = false;
  /** Pixels of the share, and those of them that the first pass has been over. */
  private readonly total: number;
  private seen = 0;
  private isCoverTold = false;
  private coveredIn = 0;
  private readonly pieces = new Map<string, { rect: Rect; finished: boolean }>();

  constructor(
    readonly picture: number,
    options: PictureOptions,
    private readonly coarsest: number,
    private hold: number,
  ) {
    session!.begin(JSON.stringify({ ...options, coarsest, share }));
    this.total = (JSON.parse(session!.progress()) as { total_pixels: number }).total_pixels;
  }

  slice(): void {
    if (this.stopped) return;
    const start = performance.now();
    const touched = new Map<string, Rect>();
    // The first pass is shown as soon as it is there, and alone: how long it took says how fine the next one may be.
    const budget = this.covered ? SLICE : GLIMPSE;
    do {
      const steps = session!.step(budget);
      for (let at = 0; at < steps.length; at += 5) {
        const [x, y, width, height, step] = steps.subarray(at, at + 5) as unknown as [number, number, number, number, number];
        const piece = this.pieceAt(x, y);
        touched.set(`${piece.x},${piece.y}`, piece);
        if (step === this.coarsest) this.seen += width * height;
      }
      this.covered ||= this.seen >= this.total || session!.is_finished;
    } while (!this.covered && performance.now() - start < SLICE);
    for (const [key, rect] of touched) this.pieces.set(key, { rect, finished: false });
    this.show([...touched.values()], start);
    if (session!.is_finished) {
      this.handOver();
      tell({ tell: 'finished', picture: this.picture, statistics: session!.statistics() });
    } else if (this.covered && this.hold > 0) {
      setTimeout(() => work === this && this.goOn(), this.hold);
      this.hold = 0;
    } else {
      this.goOn();
    }
  }

  /** What has been rendered can still be handed over. */
  stop(): void {
    this.stopped = true;
  }

  goOn(): void {
    if (waiting) return;
    waiting = true;
    turn.port2.postMessage(null);
  }

  handOver(): void {
    const finished = session!.is_finished;
    const isLightLost = hasLostLight(session!);
    for (const { rect } of this.pieces.values()) {
      const of = [rect.x, rect.y, rect.width, rect.height] as const;
      const part: Part = { ...rect, values: session!.values(...of), lost: isLightLost ? session!.lost(...of) : null, finished };
      tell({ tell: 'part', picture: this.picture, part }, buffersOf(part));
    }
  }

  private show(rects: Rect[], start: number): void {
    const patches = rects.map((rect): Patch => {
      const bytes = session!.rgba(rect.x, rect.y, rect.width, rect.height) as Uint8ClampedArray<ArrayBuffer>;
      return { ...rect, rgba: bytes };
    });
    const { pixels, rays } = JSON.parse(session!.progress()) as { pixels: number; rays: number };
    if (!this.isCoverTold) this.coveredIn += performance.now() - start;
    const { picture, coveredIn } = this;
    // A share without any pieces is told as well.
    do {
      const some = patches.splice(0, MOST_PATCHES);
      this.isCoverTold ||= this.covered && patches.length === 0;
      const told: FromRenderer = { tell: 'patches', picture, patches: some, covered: this.isCoverTold, coveredIn, pixels, rays };
      tell(told, some.map(({ rgba }) => rgba.buffer));
    } while (patches.length > 0);
  }

  private pieceAt(x: number, y: number): Rect {
    const [width, height] = session!.size as unknown as [number, number];
    const [left, top] = [x - (x % PIECE), y - (y % PIECE)];
    return { x: left, y: top, width: Math.min(PIECE, width - left), height: Math.min(PIECE, height - top) };
  }
}

interface Rect {
  x: number;
  y: number;
  width: number;
  height: number;
}

function guarded(act: () => void): void {
  try {
    act();
  } catch (error) {
    work = null;
    tell({ tell: 'broken', message: brokenBy(error) });
  }
}

function tell(message: FromRenderer, moved: Transferable[] = []): void {
  self.postMessage(message, { transfer: moved });
}
