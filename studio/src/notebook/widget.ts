/**
 * The studio as a widget of a notebook, made with anywidget. The kernel has the page and is asked for it piece by piece, as a notebook's
 * server drops what is sent too fast.
 */

import { hideStillBefore, jupyterScheme, onJupyterTheme } from 'snell-viewer';
import type { Work } from '../storage';
import type { NotebookHost } from './host';

interface Traits {
  /** The scene, the names of its files, and by which name Python knows what was opened. */
  scene: { name: string; text: string; files: string[]; opened: string };
  /** As a length of CSS. */
  height: string;
}

/** What the widget tells Python; the bytes of files, and a PNG, are buffers. */
type Message =
  | { kind: 'read'; file: string; from: number }
  | { kind: 'scene'; name: string; text: string; opened: string; files: string[] | null }
  | { kind: 'still' };

/** The part of anywidget's model that is used here. */
interface Model {
  get<T extends keyof Traits>(trait: T): Traits[T];
  on(event: string, listener: (message: unknown, buffers: DataView[]) => void): void;
  off(event: string, listener: (message: unknown, buffers: DataView[]) => void): void;
  send(message: Message, callbacks?: undefined, buffers?: ArrayBuffer[]): void;
}

/** Milliseconds after which a piece that has not come is asked for again. */
const PATIENCE = 4000;
const STILL_WIDTH = 1200;
const PAGE = '<!doctype html><html lang="en"><meta charset="utf-8"><title>Snell Studio</title><body><div id="app"></div></body></html>';

/** What anywidget calls for each view of the widget. */
export default {
  render({ model, el }: { model: Model; el: HTMLElement }): () => void {
    const cell = new StudioCell(model, el);
    return () => cell.dispose();
  },
};

class StudioCell {
  private readonly frame = document.createElement('iframe');
  private readonly note = document.createElement('p');
  private readonly ends: (() => void)[] = [];
  private readonly addresses: string[] = [];
  /** What Python knows, and by which names: what was opened is told apart by its files, which are never changed in place. */
  private readonly known = new Map<Work['files'] | string, string>();

  constructor(
    private readonly model: Model,
    el: HTMLElement,
  ) {
    this.note.setAttribute('role', 'status');
    this.note.textContent = 'Loading Snell Studio …';
    Object.assign(this.frame, { title: 'Snell Studio', allow: 'fullscreen; clipboard-write', allowFullscreen: true, srcdoc: PAGE });
    Object.assign(this.frame.style, { border: '0', width: '100%', height: model.get('height') || '44rem', display: 'block' });
    el.replaceChildren(this.note, this.frame);
    this.ends.push(hideStillBefore(el));
    const hear = (message: unknown) => {
      const { kind, message: text } = Object(message) as { kind?: unknown; message?: unknown };
      if (kind === 'error') this.say(String(text));
    };
    model.on('msg:custom', hear);
    this.ends.push(() => model.off('msg:custom', hear));
    const loaded = new Promise((done) => this.frame.addEventListener('load', done, { once: true }));
    this.open(loaded).catch((error: unknown) => this.say(`Snell Studio could not be loaded: ${String(error)}`));
  }

  dispose(): void {
    for (const end of this.ends) end();
    for (const address of this.addresses) URL.revokeObjectURL(address);
  }

  private async open(loaded: Promise<unknown>): Promise<void> {
    const { name, text, files, opened } = this.model.get('scene');
    const all: Work['files'] = [];
    const [script, style, module] = [await this.packed('studio.js'), await this.packed('studio.css'), await this.packed('snell.wasm')];
    for (const file of files) all.push([file, new Uint8Array(await (await this.read(`scene/${file}`)).arrayBuffer())]);
    await loaded;
    const page = this.frame.contentWindow!;
    const scene: Work = { name, text, files: all };
    this.known.set(keyOf(scene), opened);
    page.snellHost = this.hostFor(scene, this.address(module, 'application/wasm'));
    const sheet = page.document.createElement('style');
    sheet.textContent = await style.text();
    page.document.head.append(sheet);
    const code = page.document.createElement('script');
    Object.assign(code, { type: 'module', src: this.address(script, 'text/javascript') });
    page.document.head.append(code);
    this.note.remove();
  }

  private hostFor(scene: Work, module: string): NotebookHost {
    return {
      module,
      scene,
      changed: (work) => this.tell(work),
      finished: (canvas) => void this.makeStill(canvas),
      onTheme: (act) => {
        act(jupyterScheme());
        this.ends.push(onJupyterTheme(() => act(jupyterScheme())));
      },
    };
  }

  private tell(work: Work): void {
    const { name, text, files } = work;
    const before = this.known.get(keyOf(work));
    const opened = before ?? crypto.getRandomValues(new Uint32Array(4)).join('-');
    this.known.set(keyOf(work), opened);
    // Copies made in this window, since arrays of another window are not recognised as such.
    const bytes = before === undefined ? files.map(([, bytes]) => new Uint8Array(bytes).buffer) : [];
    this.send({ kind: 'scene', name, text, opened, files: before === undefined ? files.map(([file]) => file) : null }, bytes);
  }

  private send(message: Message, buffers?: ArrayBuffer[]): void {
    try {
      this.model.send(message, undefined, buffers);
    } catch {
      this.say('The kernel that this page belongs to is gone: what is changed here does not come back to Python. Save the scene, or run the cell again.');
    }
  }

  /** Above the page. */
  private say(words: string): void {
    this.note.textContent = words;
    this.frame.before(this.note);
  }

  private async makeStill(canvas: HTMLCanvasElement): Promise<void> {
    const scale = Math.min(1, STILL_WIDTH / canvas.width);
    const still = new OffscreenCanvas(Math.ceil(canvas.width * scale), Math.ceil(canvas.height * scale));
    still.getContext('2d')!.drawImage(canvas, 0, 0, still.width, still.height);
    const png = await still.convertToBlob({ type: 'image/png' });
    this.send({ kind: 'still' }, [await png.arrayBuffer()]);
  }

  private address(file: Blob, type: string): string {
    const address = URL.createObjectURL(new Blob([file], { type }));
    this.addresses.push(address);
    return address;
  }

  private async packed(file: string): Promise<Blob> {
    const stream = (await this.read(`page/${file}.gz`)).stream().pipeThrough(new DecompressionStream('gzip'));
    return new Response(stream).blob();
  }

  /** A file of the kernel's, piece by piece. */
  private async read(file: string): Promise<Blob> {
    const pieces: DataView<ArrayBuffer>[] = [];
    for (let from = 0, size = 1; from < size; ) {
      const piece = await this.piece(file, from);
      size = piece.size;
      pieces.push(piece.bytes);
      from += piece.bytes.byteLength;
      if (piece.bytes.byteLength === 0) break;
    }
    return new Blob(pieces);
  }

  private piece(file: string, from: number): Promise<{ size: number; bytes: DataView<ArrayBuffer> }> {
    return new Promise((resolve, reject) => {
      const ask = () => this.send({ kind: 'read', file, from });
      const again = setInterval(ask, PATIENCE);
      const hear = (message: unknown, buffers: DataView[]) => {
        const told = Object(message) as { kind?: string; file?: string; from?: number; size?: number };
        if (told.kind !== 'bytes' || told.file !== file || told.from !== from) return;
        clearInterval(again);
        this.model.off('msg:custom', hear);
        if (told.size === undefined) reject(new Error(`the kernel has no ${file}`));
        else resolve({ size: told.size, bytes: buffers[0] as DataView<ArrayBuffer> });
      };
      this.model.on('msg:custom', hear);
      ask();
    });
  }
}

/** A built-in scene has no files, and is known by its name. */
function keyOf({ name, files }: Work): Work['files'] | string {
  return files.length > 0 ? files : name;
}
