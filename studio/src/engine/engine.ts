/** The engine as the page sees it: a scene that changes, questions about it, and a picture that comes bit by bit. */

import type { ViewScene } from 'snell-viewer';
import type {
  Answers,
  Change,
  CompleteRevision,
  Finding,
  FromDesk,
  FromRenderer,
  Geometry,
  Patch,
  PictureOptions,
  Question,
  Revision,
  ToDesk,
  ToRenderer,
} from './protocol';
import { buffersOf } from './protocol';

/** What the engine is made of: a page of its own and one in a notebook load it in different ways. */
export interface EngineParts {
  /** Address of the module. */
  module: string;
  desk(): Worker;
  /** `number`: from 1. */
  renderer(number: number): Worker;
}

export interface EngineEvents {
  /** Something of the picture has been rendered. `covered`: each pixel has been, or one near it. */
  patches(patches: Patch[], covered: boolean): void;
  progress(pixels: number, rays: number): void;
  finished(outcome: Answers['outcome']): void;
  /** There will be no such picture: it is too large. */
  refused(findings: Finding[]): void;
  /** A worker has failed; all of them are gone, and `restart` makes new ones. */
  broken(message: string): void;
}

/** A scene that is refused, with the reasons. */
export class Refusal extends Error {
  constructor(readonly findings: Finding[]) {
    super(findings.map(({ message }) => message).join('\n'));
  }
}

/** What was asked is not wanted any more. */
export class Cancelled extends Error {}

interface Renderer {
  worker: Worker;
  covered: boolean;
  coveredIn: number;
  finished: boolean;
  collected: boolean;
  pixels: number;
  rays: number;
}

type Waiting = { resolve(answer: Answers[Question['ask']]): void; reject(reason: Error): void };

/** More would wait for each other's memory. */
const MOST_RENDERERS = 16;
/** The coarsest pass of a preview, by how many pixels it leaves out in a row. */
const COARSEST = 16;
/** Milliseconds in which the first pass of a preview should be there, and below which it may be finer: twice as fine takes four times as long. */
const [SLOW, FAST] = [30, 7];

export class Engine {
  private module: Promise<WebAssembly.Module> | null = null;
  private desk!: Worker;
  private renderers: Renderer[] = [];
  private readonly waiting = new Map<number, Waiting>();
  private questions = 0;
  /** The picture that is under way; messages about others are late. */
  private picture = 0;
  private coarsest = 4;
  private geometry = new Map<string, Geometry>();
  private view: ViewScene | null = null;
  private collecting: (() => void) | null = null;
  private started: Promise<void> | null = null;

  constructor(
    private readonly parts: EngineParts,
    private readonly events: EngineEvents,
    readonly threads = Math.max(1, Math.min(MOST_RENDERERS, navigator.hardwareConcurrency || 2)),
  ) {}

  /** Loads the module and starts the workers, unless they are there. */
  start(): Promise<void> {
    this.started ??= this.startWorkers().catch((error: unknown) => {
      this.started = null;
      throw error;
    });
    return this.started;
  }

  private async startWorkers(): Promise<void> {
    // One that could not be loaded is tried again.
    this.module ??= load(this.parts.module).catch((error: unknown) => {
      this.module = null;
      throw error;
    });
    // Their scripts are loaded while the module is compiled.
    const desk = this.parts.desk();
    const workers = Array.from({ length: this.threads }, (_, index) => this.parts.renderer(index + 1));
    for (const worker of [desk, ...workers]) {
      worker.onerror = (event) => this.broken(event.message || 'a part of the page could not be loaded');
    }
    const module = await this.module.catch((error: unknown) => {
      for (const worker of [desk, ...workers]) worker.terminate();
      throw error;
    });
    this.desk = desk;
    desk.onmessage = ({ data }: MessageEvent<FromDesk>) => this.hearDesk(data);
    this.tellDesk({ do: 'start', module });
    this.renderers = workers.map((worker, index) => {
      const renderer: Renderer = { worker, covered: false, coveredIn: 0, finished: false, collected: false, pixels: 0, rays: 0 };
      worker.onmessage = ({ data }: MessageEvent<FromRenderer>) => this.hear(renderer, data);
      worker.postMessage({ do: 'start', module, share: [index, this.threads] } satisfies ToRenderer);
      return renderer;
    });
  }

  /** Ends what is under way, whatever it is; the scene has to be opened again. */
  restart(): Promise<void> {
    this.end();
    return this.start();
  }

  /** Changes the scene. Rejects with a `Refusal`, and then everything is as it was. */
  async change(change: Change): Promise<CompleteRevision> {
    await this.start();
    // Renderers go on with the picture before if this is refused.
    const revision = this.ask({ ask: 'change', change });
    for (const { worker } of this.renderers) worker.postMessage({ do: 'change', change } satisfies ToRenderer);
    return this.complete(await revision);
  }

  /** Renders the scene. What was under way is dropped. After the first pass it waits for `hold` milliseconds. */
  render(options: PictureOptions = {}, hold = 0): void {
    if (this.renderers.length === 0) return;
    this.picture++;
    this.collecting?.();
    this.tellDesk({ do: 'gather', picture: this.picture, options });
    for (const renderer of this.renderers) {
      Object.assign(renderer, { covered: false, finished: false, pixels: 0, rays: 0 });
      const message: ToRenderer = { do: 'render', picture: this.picture, options, coarsest: this.coarsest, hold };
      renderer.worker.postMessage(message);
    }
  }

  /** Ends the picture as it is. */
  stop(): void {
    for (const { worker } of this.renderers) worker.postMessage({ do: 'stop' } satisfies ToRenderer);
  }

  /** Asks the desk. Rejects with a `Refusal`. */
  ask<Q extends Question>(question: Q): Promise<Answers[Q['ask']]> {
    if (this.renderers.length === 0) return Promise.reject(new Cancelled('the engine is not running'));
    const id = ++this.questions;
    return new Promise((resolve, reject) => {
      this.waiting.set(id, { resolve: resolve as Waiting['resolve'], reject });
      this.tellDesk({ do: 'ask', id, question });
    });
  }

  /** A file with the picture as far as it has come. */
  async save(format: 'png' | 'exr'): Promise<Uint8Array<ArrayBuffer>> {
    let picture: number;
    do {
      picture = this.picture;
      if (this.renderers.some(({ finished }) => !finished)) await this.collect();
      // If another picture was begun meanwhile, it is that one.
    } while (picture !== this.picture);
    return this.ask({ ask: format });
  }

  /** Brings the desk all pixels, finished or not. */
  private collect(): Promise<void> {
    return new Promise((resolve) => {
      this.collecting = resolve;
      for (const renderer of this.renderers) {
        renderer.collected = false;
        renderer.worker.postMessage({ do: 'collect', picture: this.picture } satisfies ToRenderer);
      }
    });
  }

  private hear(renderer: Renderer, message: FromRenderer): void {
    if (message.tell === 'broken') return this.broken(message.message);
    if (message.picture !== this.picture) return;
    if (message.tell === 'refused') return this.refuse(message.findings);
    switch (message.tell) {
      case 'patches': {
        const covered = this.covered;
        Object.assign(renderer, { covered: message.covered, coveredIn: message.coveredIn, pixels: message.pixels, rays: message.rays });
        if (this.covered && !covered) this.adapt();
        this.events.patches(message.patches, this.covered);
        this.events.progress(this.sum('pixels'), this.sum('rays'));
        break;
      }
      case 'part':
        this.tellDesk({ do: 'part', picture: message.picture, part: message.part }, buffersOf(message.part));
        break;
      case 'finished':
        renderer.finished = true;
        this.tellDesk({ do: 'statistics', picture: message.picture, statistics: message.statistics });
        if (this.renderers.every(({ finished }) => finished)) void this.finish(message.picture);
        break;
      case 'collected':
        renderer.collected = true;
        if (this.renderers.every(({ collected }) => collected)) this.collecting?.();
    }
  }

  private get covered(): boolean {
    return this.renderers.every(({ covered }) => covered);
  }

  private sum(what: 'pixels' | 'rays'): number {
    return this.renderers.reduce((sum, renderer) => sum + renderer[what], 0);
  }

  /** The next preview is finer if this one took no time, and coarser if one had to wait for it. Time that others took does not count. */
  private adapt(): void {
    const took = Math.max(...this.renderers.map(({ coveredIn }) => coveredIn));
    if (took > SLOW) this.coarsest = Math.min(COARSEST, 2 * this.coarsest);
    else if (took < FAST) this.coarsest = Math.max(1, this.coarsest / 2);
  }

  private async finish(picture: number): Promise<void> {
    try {
      const outcome = await this.ask({ ask: 'outcome' });
      if (picture === this.picture) this.events.finished(outcome);
    } catch (error) {
      if (!(error instanceof Cancelled)) throw error;
    }
  }

  private hearDesk(message: FromDesk): void {
    if (message.tell === 'broken') return this.broken(message.message);
    if (message.tell === 'refused') return message.picture === this.picture ? this.refuse(message.findings) : undefined;
    const waiting = this.waiting.get(message.id);
    this.waiting.delete(message.id);
    if (message.tell === 'answer') waiting?.resolve(message.answer);
    else waiting?.reject(new Refusal(message.findings));
  }

  private complete({ view, geometry, ...revision }: Revision): CompleteRevision {
    if (view === null) return { ...revision, view: this.view! };
    const all = new Map<string, Geometry>();
    for (const mesh of view.meshes) {
      const parts = geometry.get(mesh.geometry) ?? this.geometry.get(mesh.geometry)!;
      all.set(mesh.geometry, parts);
      Object.assign(mesh, parts);
    }
    this.geometry = all;
    this.view = view;
    return { ...revision, view };
  }

  private refuse(findings: Finding[]): void {
    // All workers say the same.
    this.picture++;
    this.stop();
    this.events.refused(findings);
  }

  private broken(message: string): void {
    this.end();
    this.events.broken(message);
  }

  private end(): void {
    this.picture++;
    this.started = null;
    this.collecting?.();
    this.collecting = null;
    this.desk?.terminate();
    for (const { worker } of this.renderers) worker.terminate();
    this.renderers = [];
    this.geometry.clear();
    const waiting = [...this.waiting.values()];
    this.waiting.clear();
    for (const { reject } of waiting) reject(new Cancelled('the engine was stopped'));
  }

  private tellDesk(message: ToDesk, moved: Transferable[] = []): void {
    this.desk.postMessage(message, moved);
  }
}

/** Compiled once for all workers. */
async function load(url: string): Promise<WebAssembly.Module> {
  const response = await fetch(url);
  if (!response.ok) throw new Error(`the engine could not be loaded: ${url} answers ${response.status}`);
  // A host that does not know the type of the file serves it all the same.
  if (response.headers.get('content-type')?.startsWith('application/wasm')) return WebAssembly.compileStreaming(response);
  return WebAssembly.compile(await response.arrayBuffer());
}
