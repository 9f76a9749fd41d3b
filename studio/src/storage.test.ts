import { IDBFactory } from 'fake-indexeddb';
import { beforeEach, expect, test, vi } from 'vitest';
import { type Browser, type Work, WorkStorage } from './storage';

/** A storage that holds so many characters. */
function storage(room = Infinity): Storage {
  const map = new Map<string, string>();
  return {
    get length() {
      return map.size;
    },
    key: (index) => [...map.keys()][index] ?? null,
    getItem: (key) => map.get(key) ?? null,
    setItem: (key, value) => {
      if (value.length > room) throw new DOMException('full', 'QuotaExceededError');
      map.set(key, value);
    },
    removeItem: (key) => void map.delete(key),
    clear: () => map.clear(),
  };
}

/** Locks, as one tab after the other asks for them. */
class Locks {
  private readonly held = new Map<string, object>();

  of(tab: object): NonNullable<Browser['locks']> {
    const request = async (name: string, _options: LockOptions, act: () => unknown) => {
      // As if the time to wait for it were over.
      if (this.held.has(name)) throw new DOMException('signal timed out', 'TimeoutError');
      this.held.set(name, tab);
      return act();
    };
    return { request } as NonNullable<Browser['locks']>;
  }

  close(tab: object): void {
    for (const [name, holder] of this.held) if (holder === tab) this.held.delete(name);
  }
}

let shared: { local: Storage; database: IDBFactory; locks: Locks };
let notes: string[];
beforeEach(() => {
  shared = { local: storage(), database: new IDBFactory(), locks: new Locks() };
  notes = [];
});

/** A tab of the browser, which may be loaded again. */
class Tab {
  work: WorkStorage;
  constructor(readonly session: Storage = storage(), readonly browser: Partial<Browser> = {}) {
    this.work = this.open();
  }
  private open(): WorkStorage {
    const { local, database, locks } = shared;
    return new WorkStorage((words) => notes.push(words), { local, database, tab: this.session, locks: locks.of(this), ...this.browser }, 1);
  }
  reload(): Promise<Work | null> {
    shared.locks.close(this);
    this.work = this.open();
    return this.work.load();
  }
  async keep(work: Work): Promise<void> {
    this.work.save(work);
    await this.work.flush();
  }
}

const work = (text: string, files: Work['files'] = []): Work => ({ name: `${text}.toml`, text, files });
const bytes = (...numbers: number[]) => Uint8Array.from(numbers);

async function filesKept(): Promise<number> {
  const opening = shared.database.open('snell-studio', 1);
  opening.onupgradeneeded = () => opening.result.createObjectStore('files');
  await new Promise((resolve) => (opening.onsuccess = resolve));
  const count = opening.result.transaction('files').objectStore('files').count();
  await new Promise((resolve) => (count.onsuccess = resolve));
  opening.result.close();
  return count.result;
}

test('work survives a reload, with its files', async () => {
  const tab = new Tab();
  expect(await tab.work.load()).toBeNull();
  const kept = work('🔮\r\n', [['models/a.obj', bytes(1, 2)], ['b', bytes()]]);
  await tab.keep(kept);
  expect(await tab.reload()).toEqual(kept);
  await tab.keep({ ...kept, text: 'other' });
  expect(await tab.reload()).toEqual({ ...kept, text: 'other' });
  expect(notes).toEqual([]);
});

test('a text that makes no scene is kept beside the one that did', async () => {
  const tab = new Tab();
  tab.work.save({ name: 'a.toml', text: 'snell = 1', files: [], draft: 'snell =' });
  await tab.work.flush();
  expect(await tab.reload()).toEqual({ name: 'a.toml', text: 'snell = 1', files: [], draft: 'snell =' });
});

test('a new text is kept before flush returns, since the tab may be closing', async () => {
  const tab = new Tab();
  await tab.work.load();
  tab.work.save(work('a'));
  void tab.work.flush();
  expect(Object.values(shared.local.getItem(shared.local.key(0)!)!).join('')).toContain('"text":"a"');
});

test('only the last of many changes is written, a moment later', async () => {
  const tab = new Tab();
  await tab.work.load();
  const set = vi.spyOn(shared.local, 'setItem');
  for (let index = 0; index < 50; index += 1) tab.work.save(work(String(index)));
  expect(set).not.toHaveBeenCalled();
  await expect.poll(() => set.mock.calls.length).toBe(1);
  expect((await tab.reload())?.text).toBe('49');
});

test('what is saved before the tab has its name is not lost', async () => {
  const tab = new Tab();
  tab.work.save(work('early'));
  await tab.work.flush();
  expect((await tab.reload())?.text).toBe('early');
});

test('tabs do not destroy each other’s work', async () => {
  const [one, other] = [new Tab(), new Tab()];
  await one.keep(work('one', [['a', bytes(1)]]));
  await other.keep(work('other', [['a', bytes(2)]]));
  await one.keep(work('one again', [['a', bytes(3)]]));
  expect(await other.reload()).toEqual(work('other', [['a', bytes(2)]]));
  expect(await one.reload()).toEqual(work('one again', [['a', bytes(3)]]));
});

test('a copy of a tab has the work, and goes its own way', async () => {
  const one = new Tab();
  await one.keep(work('one', [['a', bytes(1)]]));
  const session = storage();
  session.setItem(one.session.key(0)!, one.session.getItem(one.session.key(0)!)!);
  const copy = new Tab(session);
  expect(await copy.work.load()).toEqual(work('one', [['a', bytes(1)]]));
  await copy.keep(work('copy', [['a', bytes(2)]]));
  expect(await one.reload()).toEqual(work('one', [['a', bytes(1)]]));
  expect(await copy.reload()).toEqual(work('copy', [['a', bytes(2)]]));
});

test('files that nobody needs any more are removed', async () => {
  const tab = new Tab();
  for (let index = 0; index < 5; index += 1) await tab.keep(work('a', [['a', bytes(index)]]));
  expect(await filesKept()).toBe(1);
  await tab.keep(work('a'));
  expect(await filesKept()).toBe(0);
});

test('work of long ago is removed, work of another tab of yesterday is not', async () => {
  const [old, young, tab] = [new Tab(), new Tab(), new Tab()];
  vi.useFakeTimers({ toFake: ['Date'], now: Date.now() - 31 * 24 * 3600e3 });
  await old.keep(work('old'));
  vi.setSystemTime(Date.now() + 30 * 24 * 3600e3);
  await young.keep(work('young'));
  vi.useRealTimers();
  await tab.work.load();
  expect(await old.reload()).toBeNull();
  expect((await young.reload())?.text).toBe('young');
});

test('the work of the latest twenty other tabs is kept', async () => {
  vi.useFakeTimers({ toFake: ['Date'] });
  const tabs = Array.from({ length: 25 }, () => new Tab());
  for (const [index, tab] of tabs.entries()) {
    vi.setSystemTime(index * 1000);
    await tab.keep(work(String(index)));
  }
  const first = tabs[0]!;
  expect((await first.reload())?.text).toBe('0');
  expect(shared.local.length).toBe(21);
  expect(await tabs[4]!.reload()).toBeNull();
  expect((await tabs[5]!.reload())?.text).toBe('5');
  vi.useRealTimers();
});

test('clear leaves nothing of any tab, and what comes later is kept again', async () => {
  const [one, other] = [new Tab(), new Tab()];
  const files: Work['files'] = [['a', bytes(1)]];
  await one.keep(work('one', files));
  await other.keep(work('other'));
  shared.local.setItem('of somebody else', 'x');
  other.work.save(work('waiting'));
  await other.work.clear();
  await new Promise((resolve) => setTimeout(resolve, 5));
  expect([shared.local.length, await filesKept()]).toEqual([1, 0]);
  expect(await other.reload()).toBeNull();
  await one.work.clear();
  await one.keep(work('one', files));
  expect(await one.reload()).toEqual(work('one', files));
});

test('a full storage is told once, and in words', async () => {
  shared.local = storage(200);
  const tab = new Tab();
  await tab.keep(work('a'.repeat(300)));
  await tab.keep(work('b'.repeat(300)));
  expect(notes).toEqual([expect.stringContaining('no room')]);
  await tab.keep(work('small'));
  expect((await tab.reload())?.text).toBe('small');
});

test('a browser that keeps nothing does not stop the studio', async () => {
  const tab = new Tab(storage(), { local: undefined, tab: undefined, database: undefined, locks: undefined });
  expect(await tab.work.load()).toBeNull();
  await tab.keep(work('a', [['a', bytes(1)]]));
  await tab.work.clear();
  expect(notes).toEqual([expect.stringContaining('no room')]);
});

test.each(['', '{', 'null', '[]', '{"version":2}', '{"version":1,"name":"a","text":3,"files":null,"time":0}', '\u0000'])('damaged work %j is left out, and told', async (text) => {
  const tab = new Tab();
  await tab.keep(work('a'));
  shared.local.setItem(shared.local.key(0)!, text);
  expect(await tab.reload()).toBeNull();
  expect(notes).toEqual([expect.stringContaining('cannot be read')]);
  expect(await tab.reload()).toBeNull();
  expect(notes.length).toBe(1);
});

test('a text whose files are gone comes without them, and tells', async () => {
  const tab = new Tab();
  await tab.keep(work('a', [['a', bytes(1)]]));
  shared.database = new IDBFactory();
  expect(await tab.reload()).toEqual(work('a'));
  expect(notes).toEqual([expect.stringContaining('add them again')]);
});
