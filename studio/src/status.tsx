/** How far the picture is, whether its bits are those of the command line, and what is wrong or odd. */

import { useSignal } from '@preact/signals';
import type { Finding } from './engine/protocol';
import { copy } from './files/save';
import { nativeHash } from './scenes';
import { asCommand } from './share/code';
import type { Store } from './store';

/** The code of a picture that is black all over: its reason should not have to be looked for. */
const BLACK = 'W203 black-picture';

export function Status({ store }: { store: Store }) {
  const { pixels, total, rays, time } = store.progress.value;
  const outcome = store.outcome.value;
  const [width, height] = store.revision.value?.size ?? [0, 0];
  const refused = [...store.notes.value, ...store.refused.value];
  const broken = store.broken.value;
  const warnings = store.warnings.value;
  return (
    <footer class="status">
      {broken !== null && (
        <div class="refused" role="alert">
          <p>
            The engine could not be started: {broken}. <button type="button" onClick={() => location.reload()}>Load the page again</button>
          </p>
        </div>
      )}
      {refused.length > 0 && (
        <div class="refused" role="alert">
          <Findings findings={refused} />
          <button type="button" class="plain" aria-label="Close this message" onClick={() => ([store.refused.value, store.notes.value] = [[], []])}>
            ✕
          </button>
        </div>
      )}
      <div class="line">
        <span>
          {width} × {height}
        </span>
        {outcome === null && total > 0 ? (
          <>
            <progress value={pixels} max={total} aria-label="Progress of the picture" />
            <button type="button" class="plain" onClick={() => (store.stopped.value ? store.render() : store.stop())}>
              {store.stopped.value ? 'Render' : 'Stop'}
            </button>
          </>
        ) : (
          <span>
            {(time / 1000).toFixed(2)} s · {count(rays)} rays
          </span>
        )}
        {outcome && <Bits store={store} sha256={outcome.sha256} />}
        {warnings.length > 0 && (
          <details class="warnings" open={warnings.some(({ code }) => code === BLACK)}>
            <summary>
              {warnings.length} {warnings.length === 1 ? 'note' : 'notes'}
            </summary>
            <Findings findings={warnings} />
          </details>
        )}
        {store.busy.value && (
          <span class="busy" role="status">
            {store.busy.value} <button type="button" class="plain" onClick={() => store.cancel()}>Cancel</button>
          </span>
        )}
      </div>
    </footer>
  );
}

/** Whether the bits are those of the command line, or how to find out. */
function Bits({ store, sha256 }: { store: Store; sha256: string }) {
  const native = store.pristine.value ? nativeHash(store.base.value!.name) : null;
  const told = useSignal('');
  const hash = (
    <>
      SHA-256 <code>{sha256.slice(0, 12)}…</code>
    </>
  );
  if (native !== null) {
    const same = native === sha256;
    return (
      <span class={`hash ${same ? 'same' : 'differs'}`} title={`In this page ${sha256}, on the command line ${native}`}>
        {same ? '✓ the same bits as the command line' : '✗ other bits than the command line'} {hash}
      </span>
    );
  }
  const check = async () => {
    const base = store.base.value!;
    const files = 'files' in base.given ? base.given.files.map(([file]) => file) : [];
    const text = store.pristine.value ? {} : { text: store.revision.value!.text };
    await copy(asCommand({ name: base.name, files, ...text }));
    told.value = 'The command is copied: run it, and compare the number after “film”.';
  };
  return (
    <span class="hash" title={`SHA-256 of the numbers of this picture: ${sha256}`}>
      {hash}{' '}
      <button type="button" class="plain" onClick={() => void check()}>
        Compare with the command line
      </button>{' '}
      <span role="status">{told.value}</span>
    </span>
  );
}

export function Findings({ findings }: { findings: Finding[] }) {
  return (
    <ul class="findings">
      {findings.map(({ message, help, place, code }, at) => (
        <li key={at}>
          {code && <b>{code} </b>}
          {place && `Line ${place.line}: `}
          {message}
          {help && <span class="quiet"> {help}</span>}
        </li>
      ))}
    </ul>
  );
}

function count(value: number): string {
  if (value < 1e4) return String(value);
  return value < 1e6 ? `${(value / 1e3).toFixed(0)} thousand` : `${(value / 1e6).toFixed(1)} million`;
}
