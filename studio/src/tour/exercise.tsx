/** An exercise beside the views: its rays are shown once there is an answer. */

import { useSignal } from '@preact/signals';
import type { RayTreeDocument } from 'snell-viewer';
import { useEffect } from 'preact/hooks';
import type { Pixel, Store } from '../store';
import { type Exercise, EXERCISES, isRight, numberIn } from './exercises';

/** The exercise that a fragment names. */
export function exerciseOf(fragment: string): Exercise | null {
  const match = /^#exercise\/([a-z]+)$/.exec(fragment);
  return EXERCISES.find(({ id }) => id === match?.[1]) ?? null;
}

export function ExerciseView({ store, exercise, go, end }: { store: Store; exercise: Exercise; go(exercise: Exercise): void; end(): void }) {
  const tree = useSignal<RayTreeDocument | null>(null);
  const given = useSignal('');
  const verdict = useSignal<boolean | null>(null);
  const unclear = useSignal(false);
  useEffect(() => {
    let current = true;
    [tree.value, given.value, verdict.value] = [null, '', null];
    store.pin(null);
    // Pointing at the picture would tell the answer.
    store.quiet.value = true;
    const base = { name: exercise.scene, given: { builtin: exercise.scene } };
    void store
      .open(base, { label: `exercise: ${exercise.title.toLowerCase()}` })
      .then(() => store.engine.ask({ ask: 'explain', pixel: exercise.pixel }))
      .then((answer) => {
        if (current) tree.value = answer;
      })
      .catch(() => {});
    return () => {
      current = false;
      store.quiet.value = false;
    };
  }, [exercise]);

  const guess = store.pinned.value;
  const grade = () => {
    const { kind } = exercise.answer;
    const answer: string | Pixel | null = kind === 'place' ? guess : given.value;
    unclear.value = answer === null || answer === '' || (kind === 'number' && Number.isNaN(numberIn(String(answer))));
    if (unclear.value) return;
    verdict.value = isRight(exercise, tree.value!, store.revision.value!.view.camera, answer!);
    store.quiet.value = false;
    store.pin(exercise.pixel);
  };
  const { value: asked } = tree;
  const next = EXERCISES[EXERCISES.indexOf(exercise) + 1];
  return (
    <section class="tour" aria-labelledby="exercise-title">
      <p class="quiet">
        Exercise {EXERCISES.indexOf(exercise) + 1} of {EXERCISES.length}
      </p>
      <h2 id="exercise-title">{exercise.title}</h2>
      {asked && <p>{exercise.question(asked)}</p>}
      {asked && verdict.value === null && (
        <form
          class="group"
          onSubmit={(event) => {
            event.preventDefault();
            grade();
          }}
        >
          {exercise.answer.kind === 'number' ? (
            <input
              aria-label={`Your answer in ${exercise.answer.unit}`}
              inputMode="decimal"
              size={8}
              value={given.value}
              onInput={(event) => (given.value = event.currentTarget.value)}
            />
          ) : exercise.answer.kind === 'place' ? (
            <output>{guess ? `Pixel ${guess.join(', ')}` : 'No place chosen yet'}</output>
          ) : (
            <select aria-label="Your answer" value={given.value} onChange={(event) => (given.value = event.currentTarget.value)}>
              <option value="">choose</option>
              {exercise.answer.options(asked).map((name) => (
                <option key={name}>{name}</option>
              ))}
            </select>
          )}
          <button type="submit" class="primary">
            Check
          </button>
        </form>
      )}
      <div role="status">
        {unclear.value && <p>{exercise.answer.kind === 'number' ? 'A number is expected, like 12.5.' : 'Choose an answer first.'}</p>}
        {verdict.value !== null && asked && (
          <p class="answer">
            <b>{verdict.value ? '✓ Right. ' : '✗ Not quite. '}</b>
            {exercise.explain(asked)} The rays of the pixel are in the scene now.
          </p>
        )}
      </div>
      <div class="group">
        {verdict.value === false && (
          <button
            type="button"
            onClick={() => {
              store.quiet.value = true;
              store.pin(null);
              verdict.value = null;
            }}
          >
            Try again
          </button>
        )}
        {next && (
          <button type="button" class={verdict.value ? 'primary' : ''} onClick={() => go(next)}>
            Next exercise
          </button>
        )}
        <button type="button" class="plain" onClick={end}>
          Leave the exercises
        </button>
      </div>
    </section>
  );
}
