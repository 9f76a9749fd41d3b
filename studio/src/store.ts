/** What the studio shows, and all that can be done to it. Views read the signals and call the methods; they hold no scene of their own. */

import { batch, computed, effect, signal } from '@preact/signals';
import type { ObjectRef, RayTreeDocument } from 'snell-viewer';
import { Cancelled, Engine, type EngineParts, Refusal } from './engine/engine';
import { maskOf } from './engine/lost';
import type { Answers, Change, CompleteRevision, Edit, Finding, Given, PictureOptions, Sighting } from './engine/protocol';
import { History, type Version } from './history';
import { Surface } from './picture/surface';
import { objectsOf, type SceneObject } from './scene/objects';
import { nearest, shownThings } from './scene/shown';

export type Pixel = [number, number];

/** What was opened. Two of the same name are not the same. */
export interface Base {
  name: string;
  given: Given;
}

export interface Progress {
  pixels: number;
  total: number;
  rays: number;
  /** Milliseconds since the picture was begun. */
  time: number;
}

/** Another picture under the one that is shown, for a slider to lay open: with other options, or as it was. */
export interface Comparison {
  label: string;
  surface: Surface;
  options: PictureOptions | null;
}

/** Where an object is seen: along one of its paths, or along all of them. */
export interface ShownSighting extends Sighting {
  object: string;
  path: string | null;
  /** The mask of all paths. */
  all: Float64Array;
}

/** How an edit stands in the history. */
export interface EditOptions {
  label: string;
  /** Edits of one group are one step: of this drag, of this pull at a slider. No other has its name. */
  group?: string;
}

/** Milliseconds between the first pass of a picture and the next, while something is dragged. */
const HOLD = 40;
/** Milliseconds without a key that begin another step to undo. */
const PAUSE = 2000;
/** Milliseconds without a key before what was written is read. */
const CALM = 250;

interface Step {
  /** Or a step back or forth in the history. */
  change: Change | -1 | 1;
  /** Of what is opened: the text that it had been given since. */
  text?: string;
  label: string;
  group: string | null;
  base: Base | null;
  done(): void;
  failed(error: Error): void;
}

/** Milliseconds after which a change does not wait any longer for the picture of the one before. */
const PATIENCE = 400;

export class Store {
  /** The scene that is shown; nothing before the first one. */
  readonly revision = signal<CompleteRevision | null>(null);
  readonly base = signal<Base | null>(null);
  /** What a person has written and the engine refuses; until it is mended or taken back, the views show the scene before. */
  readonly draft = signal<string | null>(null);
  /** Is the scene as it is built in? */
  readonly pristine = signal(false);
  /** What a person should know, whatever the scene is. */
  readonly notes = signal<Finding[]>([]);
  /** Nothing is said of pixels: somebody is to find out. */
  readonly quiet = signal(false);
  /** Why the last change was refused; the scene is as it was before. */
  readonly refused = signal<Finding[]>([]);
  /** What takes longer than a moment, for people who wait. */
  readonly busy = signal<string | null>('Loading the engine …');
  readonly broken = signal<string | null>(null);
  readonly progress = signal<Progress>({ pixels: 0, total: 0, rays: 0, time: 0 });
  /** Of the finished picture. */
  readonly outcome = signal<Answers['outcome'] | null>(null);
  readonly stopped = signal(false);
  /** Counts up whenever the picture on the surface has changed. */
  readonly frame = signal(0);
  readonly theme = signal<'auto' | 'light' | 'dark'>('auto');
  readonly hovered = signal<Pixel | null>(null);
  readonly pinned = signal<Pixel | null>(null);
  /** Of the pixel that is pinned, or else under the pointer. */
  readonly tree = signal<RayTreeDocument | null>(null);
  /** Where the ray of the tree ends that is pointed at, if it meets something. */
  readonly branch = signal<[number, number, number] | null>(null);
  readonly selectedKey = signal<string | null>(null);
  /** What the handles of the selected object do, and whether they snap to round steps. */
  readonly handles = signal<'move' | 'turn' | 'scale'>('move');
  readonly snaps = signal(false);
  readonly sighting = signal<ShownSighting | null>(null);
  /** Of the light that pixels have lost: the bin whose pixels are shown, and the one that is pointed at. */
  readonly chosenBin = signal<number | null>(null);
  readonly pointedBin = signal<number | null>(null);
  readonly comparison = signal<Comparison | null>(null);
  readonly undoLabel = signal<string | null>(null);
  readonly redoLabel = signal<string | null>(null);

  readonly objects = computed(() => (this.revision.value ? objectsOf(this.revision.value.scene) : []));
  readonly selected = computed(() => this.objects.value.find(({ key }) => key === this.selectedKey.value) ?? null);
  /** What each object is in the drawing, by its key. */
  readonly things = computed(() => (this.revision.value ? shownThings(this.objects.value, this.revision.value.view) : new Map<string, ObjectRef[]>()));
  readonly warnings = computed(() => this.outcome.value?.warnings ?? this.revision.value?.warnings ?? []);
  readonly asked = computed(() => this.pinned.value ?? this.hovered.value);
  /** For each pixel how much of it stays to be seen, while something is looked for in the picture. */
  readonly mask = computed<ArrayLike<number> | null>(() => {
    const bin = this.pointedBin.value ?? this.chosenBin.value;
    const lost = this.outcome.value?.lost;
    return bin !== null && lost ? maskOf(lost, bin) : (this.sighting.value?.mask ?? null);
  });

  readonly surface = new Surface();
  /** Where what is rendered goes. */
  private target = this.surface;
  readonly engine: Engine;
  private readonly history = new History<Base>();
  private readonly steps: Step[] = [];
  /** While the engine starts again. */
  private recovery: Promise<void> | null = null;
  /** The version with which it last had to. */
  private failed: Version<Base> | undefined;
  /** Does it have a scene? */
  private isOpen = false;
  private running = false;
  /** When a key was pressed last in the text, and which step that belongs to. */
  private readonly written = { at: -Infinity, step: 0 };
  private calm: ReturnType<typeof setTimeout> | undefined;
  private covered: (() => void) | null = null;
  private begun = 0;
  /** Searches in every pixel, for which changes wait. */
  private searches = 0;
  /** Are those changes still wanted, though what they wait for is cancelled? */
  private spares = false;
  /** Files that are being made. */
  private saving = 0;
  private openedText = '';
  private readonly question = { number: 0, asking: false };

  constructor(parts: EngineParts) {
    this.engine = new Engine(parts, {
      patches: (patches, covered) => {
        if (this.target.put(patches, covered)) this.frame.value++;
        if (covered) this.covered?.();
      },
      progress: (pixels, rays) => {
        if (this.target !== this.surface) return;
        const [width, height] = this.revision.value!.size;
        this.progress.value = { pixels, rays, total: width * height, time: performance.now() - this.begun };
      },
      finished: (outcome) => {
        if (this.target !== this.surface) return;
        this.outcome.value = outcome;
        this.renderComparison();
      },
      refused: (findings) => {
        this.refused.value = findings;
        this.stopped.value = true;
        this.covered?.();
      },
      broken: (message) => void this.recover(message),
    });
  }

  /** Starts the engine. */
  async start(): Promise<void> {
    await this.engine.start();
    this.busy.value = null;
  }

  /** Tells something that does not depend on the scene. */
  note(words: string): void {
    this.notes.value = [...this.notes.value, { message: words }];
  }

  /**
   * Opens a scene in place of the one that is shown, with a text that it has been given since. Undo brings back that one, and what was
   * being written there. Rejects with a `Refusal`.
   */
  open(base: Base, { label = `open ${base.name}`, text }: { label?: string; text?: string } = {}): Promise<void> {
    this.readDraft();
    return this.enqueue({ change: { open: base.given }, label, group: null, base, ...(text === undefined ? {} : { text }) });
  }

  /** Changes values of the scene. What is refused is told by `refused`. */
  edit(edits: Edit[], { label, group = undefined }: EditOptions): void {
    this.readDraft();
    const last = this.steps.at(-1);
    // Of a drag only the newest place counts.
    if (last && group !== undefined && last.group === group && typeof last.change === 'object' && 'edit' in last.change) {
      const changed = new Map([...last.change.edit, ...edits]);
      last.change = { edit: [...changed] };
      return;
    }
    if (edits.length > 0) this.enqueue({ change: { edit: edits }, label, group: group ?? null, base: null }).catch(() => {});
  }

  /** Takes the text that a person is writing, and reads it when there is a pause. */
  write(text: string): void {
    // At once: an earlier text that is read meanwhile must not take the place of this one.
    this.draft.value = text;
    const now = performance.now();
    // After a pause it is another step to undo.
    if (now - this.written.at > PAUSE) this.written.step++;
    this.written.at = now;
    clearTimeout(this.calm);
    this.calm = setTimeout(() => this.readDraft(), CALM);
  }

  /** Reads what has been written and was not read yet. */
  readDraft(): void {
    if (this.calm === undefined) return;
    clearTimeout(this.calm);
    this.calm = undefined;
    const text = this.draft.value;
    if (text === null) return;
    const step = this.steps.at(-1);
    if (step && typeof step.change === 'object' && 'revise' in step.change) step.change = { revise: text };
    else this.enqueue({ change: { revise: text }, label: 'edit the text', group: `text ${this.written.step}`, base: null }).catch(() => {});
  }

  undo(): void {
    if (this.draft.value !== null) {
      clearTimeout(this.calm);
      this.calm = undefined;
      batch(() => {
        this.draft.value = null;
        this.refused.value = [];
      });
      return;
    }
    this.travel(-1);
  }

  redo(): void {
    this.readDraft();
    this.travel(1);
  }

  /** Ends the picture as it is. */
  stop(): void {
    this.engine.stop();
    this.stopped.value = true;
  }

  /** Renders the picture that is shown from the start. */
  render(hold = 0): void {
    const { revision } = this;
    if (revision.value === null) return;
    this.target = this.surface;
    this.surface.begin(...revision.value.size);
    this.outcome.value = null;
    this.pointedBin.value = null;
    this.stopped.value = false;
    this.begun = performance.now();
    this.engine.render({}, hold);
  }

  /** Lays the picture beside itself with other options, beside itself as it is now, or beside nothing. */
  compare(label: string | null, options: PictureOptions | null = null): void {
    if (label === null) {
      this.comparison.value = null;
      if (this.target !== this.surface) this.render();
      return;
    }
    const surface = new Surface();
    if (options === null) surface.copy(this.surface);
    this.comparison.value = { label, surface, options };
    if (this.outcome.value !== null || this.stopped.value) this.renderComparison();
  }

  private renderComparison(): void {
    const { value: comparison } = this.comparison;
    if (comparison?.options == null || this.saving > 0) return;
    this.target = comparison.surface;
    comparison.surface.begin(...(comparison.options.size ?? this.revision.value!.size));
    this.engine.render(comparison.options);
  }

  /** Why a pixel has its colour: pinned, until another one is or none. */
  pin(pixel: Pixel | null): void {
    this.pinned.value = pixel;
    this.explain();
  }

  hover(pixel: Pixel | null): void {
    const before = this.hovered.value;
    if (pixel === before || (pixel && before && pixel[0] === before[0] && pixel[1] === before[1])) return;
    this.hovered.value = pixel;
    if (this.pinned.value === null) this.explain();
  }

  /** Selects an object by its key. */
  select(key: string | null): void {
    this.selectedKey.value = key;
  }

  /** The object that something in the drawing is. */
  objectOf({ kind, index }: ObjectRef): SceneObject | null {
    const isIt = (thing: ObjectRef) => thing.kind === kind && thing.index === index;
    return this.objects.value.find(({ key }) => this.things.value.get(key)?.some(isIt)) ?? null;
  }

  /** The object that is seen first at a pixel. */
  async seenAt(pixel: Pixel | null): Promise<SceneObject | null> {
    try {
      const tree = pixel && (await this.engine.ask({ ask: 'explain', pixel }));
      const hit = tree?.samples[0]?.nodes[0]?.hit;
      const called = [...this.things.value.values()].flat().filter(({ kind, name }) => name === hit?.object && kind !== 'light' && kind !== 'camera');
      const thing = hit && nearest(called, hit.point, this.revision.value!.view);
      return thing ? this.objectOf(thing) : null;
    } catch {
      // Then it cannot be dragged, and a click on it says why.
      return null;
    }
  }

  async find(object: string | null): Promise<void> {
    this.sighting.value = null;
    this.chosenBin.value = null;
    if (object === null) return;
    await this.search(`Looking for ${object} in every pixel …`, async () => {
      const found = await this.engine.ask({ ask: 'find', object });
      this.sighting.value = { ...found, object, path: null, all: found.mask };
    });
  }

  /** Shows the pixels of one of the paths that were found, or those of all. */
  async findPath(path: string | null): Promise<void> {
    const found = this.sighting.value;
    if (found === null) return;
    const { all } = found;
    if (path === null) {
      this.sighting.value = { ...found, mask: all, path };
      return;
    }
    await this.search('Looking along this path in every pixel …', async () => {
      const mask = await this.engine.ask({ ask: 'path', path });
      if (this.sighting.value === found) this.sighting.value = { ...found, mask, path };
    });
  }

  private async search(words: string, act: () => Promise<void>): Promise<void> {
    this.busy.value = words;
    this.searches++;
    try {
      await act();
    } catch (error) {
      this.tell(error);
    } finally {
      this.searches--;
      this.busy.value = null;
    }
  }

  /** Shows the pixels that have lost so much light, or all. */
  chooseBin(bin: number | null): void {
    this.sighting.value = null;
    this.chosenBin.value = bin;
  }

  /** A file with the picture as far as it has come. */
  async save(format: 'png' | 'exr'): Promise<Uint8Array<ArrayBuffer>> {
    this.saving++;
    try {
      // The desk has the numbers of what was rendered last.
      if (this.target !== this.surface) {
        this.render();
        await this.ended();
      }
      return await this.engine.save(format);
    } finally {
      this.saving--;
      if (this.outcome.value !== null) this.renderComparison();
    }
  }

  /** The numbers of a part of the picture, as far as they are at hand. */
  async values(x: number, y: number, width: number, height: number): Promise<Float64Array | null> {
    return this.target === this.surface ? this.engine.ask({ ask: 'values', x, y, width, height }) : null;
  }

  /** When the picture is finished or stopped. */
  private ended(): Promise<void> {
    return new Promise((done) => {
      const end = effect(() => {
        if (this.outcome.value === null && !this.stopped.value) return;
        done();
        queueMicrotask(() => end());
      });
    });
  }

  /** Ends whatever takes long: the engine is started anew with the scene as it was. */
  async cancel(): Promise<void> {
    this.spares = this.searches > 0;
    await this.recover(null);
    this.spares = false;
  }

  private enqueue(step: Omit<Step, 'done' | 'failed'>): Promise<void> {
    return new Promise((done, failed) => {
      this.steps.push({ ...step, done, failed });
      if (!this.running) void this.run();
    });
  }

  private async run(): Promise<void> {
    this.running = true;
    for (let step = this.steps.shift(); step !== undefined; step = this.steps.shift()) {
      await this.recovery;
      const slow = setTimeout(() => (this.busy.value = 'Reading the scene …'), 150);
      try {
        await this.take(step);
        step.done();
        await this.firstPass();
      } catch (error) {
        if (error instanceof Cancelled && this.spares) {
          this.steps.unshift(step);
          continue;
        }
        step.failed(error as Error);
        this.tell(error);
      } finally {
        clearTimeout(slow);
        if (this.recovery === null) this.busy.value = null;
      }
    }
    this.running = false;
  }

  private async take(step: Step): Promise<void> {
    const { change } = step;
    if (typeof change === 'number') {
      const version = this.history.peek(change);
      if (version === undefined) return;
      const { base, text, label } = version;
      const revision = await this.read({ change: base === this.base.value ? { revise: text } : { open: base.given }, text });
      this.history.keepDraft(this.draft.value);
      this.history.move(change);
      const draft = this.history.takeDraft();
      this.show(revision, { base, label, group: null, draft });
      // It is read once more, to say what is wrong with it.
      if (draft !== null) this.write(draft);
      return;
    }
    // Or what was written would be lost.
    if ('edit' in change && this.draft.value !== null) {
      const help = 'Mend it under “Source”, or undo what was written there.';
      throw new Refusal([{ message: 'The text of the scene has an error, so that nothing else can be changed.', help }]);
    }
    const revision = await this.read({ ...step, change });
    if (step.base) this.history.keepDraft(this.draft.value);
    this.show(revision, step);
  }

  private async read({ change, text }: { change: Change; text?: string }): Promise<CompleteRevision> {
    const before = this.history.current;
    // After a failure the engine is empty.
    if (!this.isOpen && !('open' in change) && before) {
      await this.read({ change: { open: before.base.given }, text: before.text });
    }
    const revision = await this.engine.change(change);
    this.isOpen = true;
    if ('open' in change) this.openedText = revision.text;
    return text === undefined || text === revision.text ? revision : this.engine.change({ revise: text });
  }

  private show(revision: CompleteRevision, step: Pick<Step, 'base' | 'label' | 'group'> & { draft?: string | null }): void {
    batch(() => {
      const base = step.base ?? this.base.value!;
      if (step.base) this.draft.value = step.draft ?? null;
      // More may have been written meanwhile.
      else if (this.draft.value === revision.text) this.draft.value = null;
      this.pristine.value = 'builtin' in base.given && revision.text === this.openedText;
      this.refused.value = [];
      this.sighting.value = null;
      this.chosenBin.value = null;
      this.base.value = base;
      this.revision.value = revision;
      this.history.record({ base, text: revision.text, label: step.label }, step.group);
      this.labels();
      const [width, height] = revision.size;
      for (const pixel of [this.pinned, this.hovered]) if (pixel.value && (pixel.value[0] >= width || pixel.value[1] >= height)) pixel.value = null;
      // In the middle of a drag the next picture is near, and the page needs the time.
      this.render(step.group === null ? 0 : HOLD);
    });
    this.explain();
  }

  /** One picture after the other: a drag that is faster than they come waits for each, so that it is seen to move. */
  private firstPass(): Promise<void> {
    return new Promise((done) => {
      const late = setTimeout(done, PATIENCE);
      this.covered = () => {
        clearTimeout(late);
        this.covered = null;
        done();
      };
    });
  }

  private travel(steps: -1 | 1): void {
    this.enqueue({ change: steps, label: '', group: null, base: null }).catch(() => {});
  }

  private labels(): void {
    this.undoLabel.value = this.history.undoLabel;
    this.redoLabel.value = this.history.redoLabel;
  }

  /** The newest question wins; while one is answered only the last of the others is kept. */
  private explain(): void {
    this.question.number++;
    if (!this.question.asking) void this.answer();
  }

  private async answer(): Promise<void> {
    const { question } = this;
    question.asking = true;
    for (let answered = 0; answered !== question.number; ) {
      answered = question.number;
      const pixel = this.asked.value;
      try {
        const tree = pixel && this.revision.value && !this.quiet.value ? await this.engine.ask({ ask: 'explain', pixel }) : null;
        if (answered === question.number || tree !== null) this.tree.value = tree;
      } catch (error) {
        this.tree.value = null;
        this.tell(error);
      }
    }
    question.asking = false;
  }

  private tell(error: unknown): void {
    if (error instanceof Refusal) this.refused.value = error.findings;
    else if (!(error instanceof Cancelled)) this.refused.value = [{ message: error instanceof Error ? error.message : String(error) }];
  }

  /** Starts the engine anew, with the last scene that worked. One that fails twice stays closed until it is changed. */
  private recover(message: string | null): Promise<void> {
    if (this.recovery !== null && message !== null) {
      this.refused.value = [{ message: `The engine could not be started again: ${message}.`, help: 'The next change tries once more.' }];
    }
    this.recovery ??= this.startAgain(message).finally(() => (this.recovery = null));
    return this.recovery;
  }

  private async startAgain(message: string | null): Promise<void> {
    this.busy.value = 'Starting the engine again …';
    const version = this.history.current;
    if (message !== null && version === undefined) {
      // Not even the first scene could be opened: what is missing is a part of the page.
      this.broken.value = message;
      this.busy.value = null;
      return;
    }
    const again = message !== null && version === this.failed;
    this.failed = message === null ? undefined : version;
    try {
      this.isOpen = false;
      if (!again) await this.engine.restart();
      if (version !== undefined && !again) {
        const revision = await this.read({ change: { open: version.base.given }, text: version.text });
        // What is being written may be what failed: it is not read again before it is changed.
        this.show(revision, { base: version.base, label: version.label, group: null, draft: this.draft.value });
      }
      if (message !== null) {
        const help = again ? 'Undo, or change the scene.' : 'It goes on with the scene as it was.';
        this.refused.value = [{ message: `The engine had to start again: ${message}.`, help }];
      }
      this.stopped.value = again;
    } catch (error) {
      this.tell(error);
    }
    this.busy.value = null;
  }
}
