/** The tour beside the views: one step at a time. Its address is `#tour/5`. */

import { useSignal } from '@preact/signals';
import { useEffect } from 'preact/hooks';
import type { Store } from '../store';
import { STEPS } from './steps';

/** The step that a fragment names, from 1; nothing if it names none. */
export function stepOf(fragment: string): number | null {
  const match = /^#tour(?:\/(\d{1,3}))?$/.exec(fragment);
  if (match === null) return null;
  return Math.min(STEPS.length, Math.max(1, Number(match[1] ?? 1)));
}

export function Tour({ store, step, go, end }: { store: Store; step: number; go(step: number): void; end(): void }) {
  const { title, text, task, answer, scene, edits, found } = STEPS[step - 1]!;
  const shown = useSignal(false);
  const ready = useSignal(false);
  useEffect(() => {
    shown.value = ready.value = false;
    let current = true;
    store.pin(null);
    void store
      .open({ name: scene, given: { builtin: scene } }, { label: `tour: ${title.toLowerCase()}` })
      .then(() => {
        if (!current) return;
        if (edits) store.edit(edits, { label: `tour: ${title.toLowerCase()}` });
        ready.value = true;
      })
      .catch(() => {});
    return () => (current = false);
  }, [step]);
  const isFound = ready.value && found(store);
  if (isFound) shown.value = true;
  return (
    <section class="tour" aria-labelledby="tour-title">
      <p class="quiet">
        Step {step} of {STEPS.length}
      </p>
      <h2 id="tour-title">{title}</h2>
      <p>{text}</p>
      <p class="task">
        <b>{isFound ? '✓ Found. ' : 'Your turn. '}</b>
        {task}
      </p>
      <div role="status">{shown.value && <p class="answer">{answer}</p>}</div>
      <div class="group">
        <button type="button" disabled={step === 1} onClick={() => go(step - 1)}>
          Back
        </button>
        {!shown.value && (
          <button type="button" class="plain" onClick={() => (shown.value = true)}>
            Show the answer
          </button>
        )}
        {step < STEPS.length ? (
          <button type="button" class={shown.value ? 'primary' : ''} onClick={() => go(step + 1)}>
            Next
          </button>
        ) : (
          <button type="button" class="primary" onClick={end}>
            Finish
          </button>
        )}
        <button type="button" class="plain" onClick={end}>
          Leave the tour
        </button>
      </div>
    </section>
  );
}
