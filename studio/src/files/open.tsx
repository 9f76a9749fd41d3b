/** Files and folders that are dropped on the page, or chosen. */

import { useSignal } from '@preact/signals';
import type { ComponentChildren } from 'preact';
import { useMemo, useRef } from 'preact/hooks';
import { placeOf } from '../scene/objects';
import type { Store } from '../store';
import { choose, chosen, dropped, type Found } from './drop';
import { editsFor, textFor } from './model';

interface Files {
  /** Lets a person choose. */
  ask(): void;
  take(found: Promise<Found>): void;
  candidates: string[];
  choose(name: string | null): void;
}

export function useFiles(store: Store): Files {
  const open = useSignal<{ candidates: string[]; files: [string, Uint8Array][] } | null>(null);
  return useMemo(() => {
    const show = async (found: Found) => {
      if ('candidates' in found) open.value = found;
      else if ('model' in found) await showModel(store, found);
      else await store.open({ name: found.scene.name, given: found.scene });
    };
    const take = (found: Promise<Found>) => {
      found.then(show).catch((error: unknown) => {
        // What the engine refuses the store has told already.
        if (store.refused.value.length === 0) store.refused.value = [{ message: error instanceof Error ? error.message : String(error) }];
      });
    };
    return {
      ask() {
        const input = Object.assign(document.createElement('input'), { type: 'file', multiple: true });
        input.addEventListener('change', () => input.files && input.files.length > 0 && take(chosen(input.files)));
        input.click();
      },
      take,
      get candidates() {
        return open.value?.candidates ?? [];
      },
      choose(name: string | null) {
        const { value } = open;
        open.value = null;
        if (value !== null && name !== null) take(Promise.resolve(choose(value.files, name)));
      },
    };
  }, []);
}

async function showModel(store: Store, { model, files }: { model: string; files: [string, Uint8Array][] }): Promise<void> {
  const text = new TextEncoder().encode(textFor(model));
  const folder = model.includes('/') ? model.slice(0, model.lastIndexOf('/') + 1) : '';
  const name = `${model.split('/').at(-1)!.replace(/\.\w+$/, '')}.toml`;
  await store.open({ name, given: { name: folder + name, text, files } });
  const object = store.objects.value.find(({ kind }) => kind === 'mesh');
  const thing = object && store.things.value.get(object.key)?.[0];
  const { view } = store.revision.value!;
  const place = thing && placeOf(object, thing, view);
  if (!place) return;
  const { vertices } = view.meshes[thing.index]!;
  let low = Infinity;
  for (let at = 1; at < vertices.length; at += 3) low = Math.min(low, vertices[at]!);
  store.edit(editsFor(place.center, place.radius, low), { label: 'look at the model' });
}

function shown(dialog: HTMLDialogElement | null): void {
  if (dialog && !dialog.open) dialog.showModal();
}

export function DropZone({ files, children }: { files: Files; children: ComponentChildren }) {
  const over = useSignal(false);
  const depth = useRef(0);
  const has = (event: DragEvent) => event.dataTransfer?.types.includes('Files') ?? false;
  return (
    <div
      onDragEnter={(event) => {
        if (!has(event)) return;
        event.preventDefault();
        depth.current++;
        over.value = true;
      }}
      onDragLeave={() => {
        if (over.value && --depth.current <= 0) over.value = false;
      }}
      onDragOver={(event) => has(event) && event.preventDefault()}
      onDrop={(event) => {
        if (!has(event)) return;
        event.preventDefault();
        depth.current = 0;
        over.value = false;
        files.take(dropped(event.dataTransfer!));
      }}
    >
      {children}
      {over.value && <div class="drop-here">Drop a scene with its models and textures, or a folder</div>}
      {files.candidates.length > 0 && (
        <dialog ref={shown} class="choose" aria-labelledby="choose" onClose={() => files.choose(null)}>
          <h2 id="choose">Which of these is the scene?</h2>
          <ul>
            {files.candidates.map((name) => (
              <li key={name}>
                <button type="button" onClick={() => files.choose(name)}>
                  {name}
                </button>
              </li>
            ))}
          </ul>
          <button type="button" class="plain" onClick={() => files.choose(null)}>
            None of these
          </button>
        </dialog>
      )}
    </div>
  );
}
