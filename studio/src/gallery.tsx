/** The built-in scenes, as pictures to choose from. */

import { useEffect, useRef } from 'preact/hooks';
import { SCENES } from './scenes';
import type { Store } from './store';

export function Gallery({ store, close, openFiles }: { store: Store; close(): void; openFiles(): void }) {
  const dialog = useRef<HTMLDialogElement>(null);
  useEffect(() => dialog.current!.showModal(), []);
  const choose = (name: string) => {
    store.open({ name, given: { builtin: name } }).catch(() => {});
    close();
  };
  // What is beautiful first.
  const groups = [...new Set(['gallery', ...SCENES.map(({ name }) => name.split('/')[0]!)])];
  return (
    <dialog ref={dialog} class="gallery" aria-labelledby="gallery-title" onClose={close} onClick={(event) => event.target === dialog.current && close()}>
      <header>
        <h2 id="gallery-title">Scenes</h2>
        <button type="button" onClick={openFiles}>
          Open a file …
        </button>
        <button type="button" class="plain" aria-label="Close" onClick={close}>
          ✕
        </button>
      </header>
      {groups.map((group) => (
        <section key={group} aria-label={group}>
          <h3>{group}</h3>
          <div class="cards">
            {SCENES.filter(({ name }) => name.startsWith(`${group}/`)).map(({ name, description, thumbnail }) => (
              <button type="button" class="card" key={name} aria-current={store.base.value?.name === name} onClick={() => choose(name)}>
                <img src={thumbnail} alt="" loading="lazy" />
                <b>{name.split('/')[1]}</b>
                <span title={description}>{/^.*?[.?!](?= |$)/.exec(description)?.[0] ?? description}</span>
              </button>
            ))}
          </div>
        </section>
      ))}
    </dialog>
  );
}
