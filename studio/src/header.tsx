/** What is done with the scene as a whole. */

import { useSignal } from '@preact/signals';
import { explanationPage } from './files/explanation';
import { copy, download } from './files/save';
import { Menu } from './menu';
import { asCommand, asPython, type Copied, stem } from './share/code';
import { encode, isLinkable } from './share/link';
import type { WorkKeeper } from './storage';
import type { Store } from './store';

interface Props {
  store: Store;
  work: WorkKeeper;
  openGallery(): void;
  openFiles(): void;
  startTour(): void;
  startExercises(): void;
}

export function Header({ store, work, openGallery, openFiles, startTour, startExercises }: Props) {
  const undo = store.draft.value === null ? store.undoLabel.value : 'what was written';
  const { value: redo } = store.redoLabel;
  const said = useSignal('');
  const say = (words: string) => {
    said.value = words;
    setTimeout(() => (said.value = ''), 4000);
  };
  const attempt = (act: () => Promise<void>) => {
    act().catch((error: unknown) => (store.refused.value = [{ message: error instanceof Error ? error.message : String(error) }]));
  };
  const copied = (what: string, text: () => string | Promise<string>) => ({
    title: `Copy as ${what}`,
    act: () =>
      attempt(async () => {
        await copy(await text());
        say(`Copied as ${what}`);
      }),
  });
  const name = () => stem(store.base.value?.name ?? 'scene');
  const scene = (): Copied => {
    const base = store.base.value!;
    const files = 'files' in base.given ? base.given.files.map(([file]) => file) : [];
    return { name: base.name, files, ...(store.pristine.value ? {} : { text: store.revision.value!.text }) };
  };
  const link = {
    title: 'Copy a link',
    hint: 'with the whole scene',
    act: () =>
      attempt(async () => {
        const base = store.base.value!;
        const files = 'files' in base.given ? base.given.files : [];
        const fragment = await encode({ name: base.name, text: store.revision.value!.text, files });
        await copy(new URL(fragment, location.href).href);
        say('The link is copied');
      }),
  };
  return (
    <header class="head">
      <h1>
        <Logo /> Snell <span>Studio</span>
      </h1>
      <button type="button" onClick={openGallery}>
        {store.base.value?.name ?? 'Scenes'} <span aria-hidden="true">▾</span>
      </button>
      <div class="group" role="group" aria-label="History">
        <button type="button" disabled={undo === null} title={undo === null ? 'Nothing to undo' : `Undo: ${undo}`} onClick={() => store.undo()}>
          <span aria-hidden="true">↶</span> Undo
        </button>
        <button type="button" disabled={redo === null} title={redo === null ? 'Nothing to redo' : `Redo: ${redo}`} onClick={() => store.redo()}>
          <span aria-hidden="true">↷</span> Redo
        </button>
      </div>
      <span class="spacer" />
      <span class="quiet" role="status">
        {said.value}
      </span>
      <Menu
        title="Learn"
        actions={[
          { title: 'Tour of the lecture', act: startTour },
          { title: 'Exercises', act: startExercises },
        ]}
      />
      <Menu
        title="Compare"
        actions={[
          { title: 'With the picture as it is now', act: () => store.compare('before') },
          { title: 'With real optics (whitted)', act: () => store.compare('whitted', { integrator: 'whitted' }) },
          { title: 'With the lecture’s model', act: () => store.compare('lecture', { integrator: 'lecture' }) },
          { title: 'Without shadows', act: () => store.compare('no shadows', { shadows: 'off' }) },
          { title: 'With no bounce', act: () => store.compare('depth 0', { depth: 0 }) },
          { title: 'Stop comparing', act: () => store.compare(null) },
        ]}
      />
      <Menu
        title="Share"
        actions={[
          ...(isLinkable() ? [link] : []),
          copied('command', () => asCommand(scene())),
          copied('Python', () => asPython(scene())),
        ]}
      />
      <Menu
        title="File"
        actions={[
          { title: 'Open …', act: openFiles },
          { title: 'Save scene', hint: 'TOML', act: () => download(`${name()}.toml`, store.revision.value!.text, 'application/toml') },
          { title: 'Save scene', hint: 'JSON', act: () => attempt(async () => download(`${name()}.json`, await store.engine.ask({ ask: 'json' }), 'application/json')) },
          { title: 'Save picture', hint: 'PNG', act: () => attempt(async () => download(`${name()}.png`, await store.save('png'), 'image/png')) },
          { title: 'Save numbers', hint: 'EXR', act: () => attempt(async () => download(`${name()}.exr`, await store.save('exr'), 'image/x-exr')) },
          {
            title: 'Save explanation',
            hint: 'HTML',
            act: () =>
              attempt(async () => {
                const tree = store.pinned.value && store.tree.value;
                if (!tree) throw new Error('Click a pixel first: the page explains that one.');
                const page = await explanationPage(tree, store.revision.value!.view);
                download(`${name()}-${tree.pixel.join('-')}.html`, page, 'text/html');
              }),
          },
          ...(work.clear ? [{ title: 'Forget my work in this browser', act: () => attempt(async () => (await work.clear!(), say('Nothing is kept any more'))) }] : []),
        ]}
      />
      <button
        type="button"
        class="plain"
        aria-label={`Colours: ${store.theme.value}`}
        title="Light, dark, or as the system has it"
        onClick={() => (store.theme.value = ({ auto: 'light', light: 'dark', dark: 'auto' } as const)[store.theme.value])}
      >
        <span aria-hidden="true">{{ auto: '◐', light: '☀', dark: '☾' }[store.theme.value]}</span>
      </button>
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
