/** What is shown at first: what the address asks for, else the work of the last time, else the lecture's scene. */

import type { Finding, Given } from './engine/protocol';
import { SCENES } from './scenes';
import { decode } from './share/link';
import type { Work, WorkKeeper } from './storage';
import type { Base, Store } from './store';

export const FIRST = 'lecture/default';

/** What was found: whether somebody is here for the first time. */
export async function openFirst(store: Store, keeper: WorkKeeper, fragment: string): Promise<{ isNew: boolean }> {
  try {
    const shared = await decode(fragment);
    if (shared !== null) {
      await openWork(store, { files: [], ...shared });
      return { isNew: false };
    }
    const name = nameIn(fragment);
    if (SCENES.some((scene) => scene.name === name)) {
      await store.open(builtin(name));
      return { isNew: false };
    }
    if (name !== '') store.notes.value = [{ message: `There is no built-in scene called “${name}”, as the address has it.` }];
    // An address that is typed later, and means nothing, changes nothing.
    if (store.revision.value !== null) return { isNew: false };
  } catch (error) {
    const finding: Finding = { message: error instanceof Error ? error.message : String(error) };
    store.notes.value = [finding];
    if (store.revision.value === null) await store.open(builtin(FIRST));
    return { isNew: false };
  }
  const work = await keeper.load();
  if (work !== null) {
    try {
      await openWork(store, work);
      return { isNew: false };
    } catch {
      await store.open(builtin(FIRST));
      store.notes.value = [{ message: `The work of the last time, ${work.name}, could not be opened again.` }];
      return { isNew: false };
    }
  }
  await store.open(builtin(FIRST));
  return { isNew: true };
}

/** A scene with its text: a built-in one stays one, so that its bits can be compared. */
export async function openWork(store: Store, { name, text, files, draft }: Work): Promise<void> {
  await store.open(...baseOf(name, text, files));
  if (draft !== undefined) store.write(draft);
}

function baseOf(name: string, text: string, files: Work['files']): Parameters<Store['open']> {
  if (files.length === 0 && SCENES.some((scene) => scene.name === name)) return [builtin(name), { text }];
  // Whatever it was made of: the text is TOML.
  const file = `${name.replace(/\.(toml|nff|json|txt)$/i, '')}.toml`;
  const given: Given = { name: file, text: new TextEncoder().encode(text), files };
  return [{ name: file, given }];
}

function nameIn(fragment: string): string {
  try {
    return decodeURIComponent(fragment.slice(1));
  } catch {
    return fragment.slice(1);
  }
}

function builtin(name: string): Base {
  return { name, given: { builtin: name } };
}

/** Shows what `snell studio` serves, each time that it changes. Returns what ends that. */
export function follow(store: Store, url: string): () => void {
  const source = new EventSource(url);
  source.onmessage = ({ data }: MessageEvent<string>) => {
    const told = JSON.parse(data) as { error: string } | { name: string; text: string; files: [string, string][] };
    if ('error' in told) {
      store.refused.value = [{ message: told.error }];
      return;
    }
    const files = told.files.map(([name, bytes]): [string, Uint8Array] => [name, fromBase64(bytes)]);
    const isBuiltin = SCENES.some((scene) => scene.name === told.name);
    const base = isBuiltin ? builtin(told.name) : { name: told.name, given: { name: told.name, text: fromBase64(told.text), files } };
    store.open(base, { label: `read ${told.name}` }).catch(() => {});
  };
  return () => source.close();
}

function fromBase64(text: string): Uint8Array {
  return Uint8Array.from(atob(text), (sign) => sign.charCodeAt(0));
}
