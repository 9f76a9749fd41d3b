/** Keeps the work in this browser, so that it survives a reload. Nothing leaves the machine.
 *
 *  Each tab has work of its own. Its text is in the local storage, which can be written at the last moment, when a tab is closed; files
 *  are too large for that, and lie in a database, under a key that the text names. */

export interface Work {
  name: string;
  text: string;
  files: [string, Uint8Array][];
  /** What was written last, if it makes no scene. */
  draft?: string;
}

/** Where the work is kept: in this browser, or by Python. */
export interface WorkKeeper {
  /** What was kept before. */
  load(): Promise<Work | null>;
  /** Keeps this instead, a moment later. */
  save(work: Work): void;
  /** Keeps now what would be kept a moment later. */
  flush(): Promise<void>;
  /** Forgets everything, where that is for the page to do. */
  clear?(): Promise<void>;
}

/** What a browser provides, as far as it does. */
export interface Browser {
  /** For all tabs. */
  local?: Storage | undefined;
  /** For one tab, also after a reload. */
  tab?: Storage | undefined;
  database?: IDBFactory | undefined;
  locks?: Pick<LockManager, 'request'> | undefined;
}

interface Kept {
  version: 1;
  name: string;
  text: string;
  draft?: string;
  /** Where the files are in the database, if there are any. */
  files: string | null;
  /** When, in milliseconds. */
  time: number;
}

const PREFIX = 'snell-studio:work:';
const TAB = 'snell-studio:tab';
const TABS_KEPT = 20;
const DAYS_KEPT = 30;
const DAY = 24 * 60 * 60 * 1000;

/** So long, in milliseconds, a page may take to go after the one that it makes way for has come. */
const FAREWELL = 500;

const NO_ROOM = 'This browser has no room to keep the scene: a reload will lose your changes. Save it as a file.';
const UNREADABLE = 'What this browser has kept of your last scene cannot be read, and is left out.';
const NO_FILES = 'This browser has kept your last scene, but not the files that it needs: add them again.';

export class WorkStorage implements WorkKeeper {
  private readonly tab: Promise<string>;
  private id: string | null = null;
  private waiting: Work | null = null;
  private timer: ReturnType<typeof setTimeout> | undefined;
  /** The files that are in the database, and where. */
  private stored: { files: Work['files']; key: string | null } = { files: [], key: null };
  private writing: Promise<void> = Promise.resolve();
  private isFull = false;

  /** `note` is told what a person should know. */
  constructor(
    private readonly note: (words: string) => void,
    private readonly browser: Browser = here(),
    private readonly delay = 500,
  ) {
    this.tab = this.claimTab();
  }

  /** What this tab had before it was loaded again. */
  async load(): Promise<Work | null> {
    const id = await this.tab;
    this.removeOld();
    const kept = this.read(id);
    if (kept === null) return null;
    const files = kept.files === null ? [] : await this.transact('readonly', (store) => store.get(kept.files!)).catch(() => null);
    if (!areFiles(files)) {
      this.note(NO_FILES);
      return { ...workOf(kept), files: [] };
    }
    this.stored = { files, key: kept.files };
    return { ...workOf(kept), files };
  }

  /** Keeps the work a moment later, if nothing newer comes; new files at once, since they come seldom and take their time. */
  save(work: Work): void {
    this.waiting = work;
    clearTimeout(this.timer);
    const wait = sameFiles(work.files, this.stored.files) ? this.delay : 0;
    this.timer = setTimeout(() => void this.flush(), wait);
  }

  /** Keeps what is waiting now: the text at once, since there is no later when a tab is closed. */
  flush(): Promise<void> {
    clearTimeout(this.timer);
    const work = this.waiting;
    if (work === null) return this.writing;
    if (this.id === null) return this.tab.then(() => this.flush());
    this.waiting = null;
    if (!sameFiles(work.files, this.stored.files)) {
      const key = work.files.length > 0 ? randomName() : null;
      this.stored = { files: work.files, key };
      this.writing = this.writing.then(() => this.writeFiles(work.files, key));
    }
    // Before its files: those that no text names are removed.
    this.write(this.id, work, this.stored.key);
    return this.writing;
  }

  /** Removes everything that was kept, of all tabs. */
  async clear(): Promise<void> {
    clearTimeout(this.timer);
    this.waiting = null;
    await this.writing;
    for (const key of this.keys()) this.browser.local!.removeItem(key);
    this.stored = { files: [], key: null };
    await this.transact('readwrite', (store) => store.clear()).catch(() => {});
  }

  /** Is it another tab's, because this one was made as its copy? Then it gets a copy of the work as well. */
  private async claimTab(): Promise<string> {
    const own = attempt(() => this.browser.tab?.getItem(TAB)) ?? null;
    if (own !== null && (await this.claim(own))) return (this.id = own);
    const id = randomName();
    await this.claim(id);
    const text = own === null ? null : attempt(() => this.browser.local?.getItem(PREFIX + own));
    if (text) attempt(() => this.browser.local!.setItem(PREFIX + id, text));
    attempt(() => this.browser.tab?.setItem(TAB, id));
    return (this.id = id);
  }

  /** A lock is held as long as the tab is open, so that it shows which names are taken. */
  private claim(id: string): Promise<boolean> {
    const { locks } = this.browser;
    if (locks === undefined) return Promise.resolve(true);
    return new Promise((resolve) => {
      const hold = () => {
        resolve(true);
        return new Promise(() => {});
      };
      locks.request(TAB + id, { signal: AbortSignal.timeout(FAREWELL) }, hold).catch(() => resolve(false));
    });
  }

  private async writeFiles(files: Work['files'], key: string | null): Promise<void> {
    if (key !== null) await this.transact('readwrite', (store) => store.put(files, key)).catch(() => this.tellFull());
    await this.removeUnused();
  }

  private write(id: string, work: Work, files: string | null): void {
    const kept: Kept = { version: 1, ...workOf(work), files, time: Date.now() };
    const { local } = this.browser;
    try {
      if (local === undefined) throw new Error('there is no storage');
      local.setItem(PREFIX + id, JSON.stringify(kept));
    } catch {
      this.tellFull();
    }
  }

  private tellFull(): void {
    if (!this.isFull) this.note(NO_ROOM);
    this.isFull = true;
  }

  private read(id: string): Kept | null {
    const text = attempt(() => this.browser.local?.getItem(PREFIX + id)) ?? null;
    if (text === null) return null;
    const kept = keptIn(text);
    if (kept === null) {
      attempt(() => this.browser.local!.removeItem(PREFIX + id));
      this.note(UNREADABLE);
    }
    return kept;
  }

  private keys(): string[] {
    const { local } = this.browser;
    const all = attempt(() => Array.from({ length: local!.length }, (_, index) => local!.key(index)!)) ?? [];
    return all.filter((key) => key.startsWith(PREFIX));
  }

  /** A tab that was closed may be opened again, but not for ever. */
  private removeOld(): void {
    const age = (key: string) => Date.now() - (keptIn(this.browser.local!.getItem(key) ?? '')?.time ?? 0);
    const others = this.keys().filter((key) => key !== PREFIX + this.id).map((key) => ({ key, age: age(key) }));
    const old = others.sort((a, b) => a.age - b.age).filter(({ age }, index) => age > DAYS_KEPT * DAY || index >= TABS_KEPT);
    for (const { key } of old) attempt(() => this.browser.local!.removeItem(key));
  }

  /** Removes files that no tab names. */
  private async removeUnused(): Promise<void> {
    const named = new Set(this.keys().map((key) => keptIn(this.browser.local!.getItem(key) ?? '')?.files));
    const keys = await this.transact('readonly', (store) => store.getAllKeys()).catch(() => []);
    for (const key of keys) {
      if (!named.has(String(key))) await this.transact('readwrite', (store) => store.delete(key)).catch(() => {});
    }
  }

  private async transact<T>(mode: IDBTransactionMode, ask: (store: IDBObjectStore) => IDBRequest<T>): Promise<T> {
    const { database: factory } = this.browser;
    if (factory === undefined) throw new Error('there is no database');
    const opening = factory.open('snell-studio', 1);
    opening.onupgradeneeded = () => opening.result.createObjectStore('files');
    const database = await answered(opening);
    try {
      const transaction = database.transaction('files', mode);
      const request = ask(transaction.objectStore('files'));
      await new Promise<void>((resolve, reject) => {
        transaction.oncomplete = () => resolve();
        transaction.onabort = transaction.onerror = () => reject(transaction.error);
      });
      return request.result;
    } finally {
      database.close();
    }
  }
}

/** What this browser provides. A page that may keep nothing gets an error where it asks for a storage. */
function here(): Browser {
  return {
    local: attempt(() => window.localStorage),
    tab: attempt(() => window.sessionStorage),
    database: attempt(() => window.indexedDB),
    locks: navigator.locks,
  };
}

/** `crypto.randomUUID` is missing on pages that come by plain HTTP. */
function randomName(): string {
  return Array.from(crypto.getRandomValues(new Uint8Array(16)), (byte) => byte.toString(16).padStart(2, '0')).join('');
}

function attempt<T>(act: () => T): T | undefined {
  try {
    return act();
  } catch {
    return undefined;
  }
}

function answered<T>(request: IDBOpenDBRequest & IDBRequest<T>): Promise<T> {
  return new Promise((resolve, reject) => {
    request.onsuccess = () => resolve(request.result);
    request.onerror = () => reject(request.error);
    request.onblocked = () => reject(new Error('another tab blocks the database'));
  });
}

function workOf({ name, text, draft }: Omit<Work, 'files'>): Omit<Work, 'files'> {
  return { name, text, ...(typeof draft === 'string' && { draft }) };
}

function keptIn(text: string): Kept | null {
  const kept = attempt(() => JSON.parse(text) as Partial<Kept> | null);
  const isKept =
    kept?.version === 1 && typeof kept.name === 'string' && typeof kept.text === 'string' && typeof kept.time === 'number' &&
    (kept.files === null || typeof kept.files === 'string');
  return isKept ? (kept as Kept) : null;
}

function areFiles(files: unknown): files is Work['files'] {
  const isFile = (file: unknown) => Array.isArray(file) && typeof file[0] === 'string' && file[1] instanceof Uint8Array;
  return Array.isArray(files) && files.every(isFile);
}

/** Files are never changed in place. */
function sameFiles(some: Work['files'], others: Work['files']): boolean {
  return some.length === others.length && some.every(([name, bytes], index) => name === others[index]![0] && bytes === others[index]![1]);
}
