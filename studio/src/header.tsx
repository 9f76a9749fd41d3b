/** What is done with the scene as a whole. */

import type { Store } from './store';

export function Header({ store }: { store: Store }) {
  const { value: undo } = store.undoLabel;
  const { value: redo } = store.redoLabel;
  return (
    <header class="head">
      <h1>
        <Logo /> Snell <span>Studio</span>
      </h1>
      <span class="scene-name">{store.base.value?.name}</span>
      <div class="group" role="group" aria-label="History">
        <button type="button" disabled={undo === null} title={undo === null ? 'Nothing to undo' : `Undo: ${undo}`} onClick={() => store.undo()}>
          <span aria-hidden="true">↶</span> Undo
        </button>
        <button type="button" disabled={redo === null} title={redo === null ? 'Nothing to redo' : `Redo: ${redo}`} onClick={() => store.redo()}>
          <span aria-hidden="true">↷</span> Redo
        </button>
      </div>
    </header>
  );
}

/** A ray that bends where it enters glass. */
function Logo() {
  return (
    <svg viewBox="0 0 32 32" width="26" height="26" aria-hidden="true">
      <circle cx="18" cy="17" r="11" class="logo-glass" />
      <path d="M1 6 L10 10.5 L24 26 L31 30" class="logo-ray" />
    </svg>
  );
}
