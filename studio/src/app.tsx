/** The page: the picture and the scene side by side, and a panel that says why, what and from which text. */

import { effect, useSignal } from '@preact/signals';
import { useEffect, useState } from 'preact/hooks';
import { AskPanel } from './ask/panel';
import { DropZone, useFiles } from './files/open';
import { Gallery } from './gallery';
import { Header } from './header';
import { PictureView } from './picture/view';
import { Properties } from './scene/properties';
import { type Space, SpaceView } from './scene/view';
import { SourcePanel } from './source/panel';
import { follow, openFirst, openWork } from './start';
import { Status } from './status';
import type { WorkKeeper } from './storage';
import type { Store } from './store';
import { Tabs } from './tabs';
import { ExerciseView, exerciseOf } from './tour/exercise';
import { EXERCISES } from './tour/exercises';
import { STEPS } from './tour/steps';
import { stepOf, Tour } from './tour/tour';
import { Welcome } from './tour/welcome';

export function App({ store, work }: { store: Store; work: WorkKeeper }) {
  const [space, setSpace] = useState<Space | null>(null);
  const tab = useSignal('why');
  const gallery = useSignal(false);
  const welcome = useSignal(false);
  const fragment = useSignal(location.hash);
  const files = useFiles(store);

  useEffect(() => {
    // For tests, and for the curious.
    Object.assign(window, { snell: store });
    void begin(store, work).then((isNew) => (welcome.value = isNew));
    const moved = () => {
      fragment.value = location.hash;
      if (location.hash.length > 1 && !isLesson(location.hash)) void openFirst(store, work, location.hash);
    };
    window.addEventListener('hashchange', moved);
    const keys = (event: KeyboardEvent) => shortcut(event, store);
    window.addEventListener('keydown', keys);
    const leave = () => void work.flush();
    window.addEventListener('pagehide', leave);
    const theme = effect(() => {
      const { value } = store.theme;
      if (value === 'auto') delete document.documentElement.dataset.theme;
      else document.documentElement.dataset.theme = value;
    });
    return () => {
      window.removeEventListener('hashchange', moved);
      window.removeEventListener('keydown', keys);
      window.removeEventListener('pagehide', leave);
      theme();
    };
  }, []);

  // For the same, the drawing.
  useEffect(() => void Object.assign(window, { snellSpace: space }), [space]);

  const step = stepOf(fragment.value);
  const exercise = exerciseOf(fragment.value);
  const go = (to: string) => {
    // The scene of a lesson is not one's work, which is kept for afterwards.
    void work.flush();
    location.hash = to;
    welcome.value = false;
    tab.value = 'why';
  };
  const end = () => {
    plainAddress();
    fragment.value = '';
    void work.load().then((kept) => (kept ? openWork(store, kept) : undefined));
  };

  return (
    <DropZone files={files}>
      <div class="studio">
        <Header
          store={store}
          work={work}
          openGallery={() => (gallery.value = true)}
          openFiles={files.ask}
          startTour={() => go('tour/1')}
          startExercises={() => go(`exercise/${EXERCISES[0]!.id}`)}
        />
        <main>
          <section class="pane" aria-label="Picture">
            <PictureView store={store} />
          </section>
          <section class="pane" aria-label="Scene in 3D">
            <SpaceView store={store} onSpace={setSpace} />
          </section>
          <aside class="side" aria-label="Panel">
            {welcome.value && <Welcome steps={STEPS.length} start={() => go('tour/1')} close={() => (welcome.value = false)} />}
            {step !== null && <Tour store={store} step={step} go={(to) => go(`tour/${to}`)} end={end} />}
            {exercise !== null && <ExerciseView store={store} exercise={exercise} go={({ id }) => go(`exercise/${id}`)} end={end} />}
            <Tabs
              chosen={tab}
              tabs={[
                { id: 'why', title: 'Why?', content: <AskPanel store={store} space={space} /> },
                { id: 'scene', title: 'Scene', content: <Properties store={store} /> },
                { id: 'source', title: 'Source', content: tab.value === 'source' ? <SourcePanel store={store} /> : null },
              ]}
            />
          </aside>
        </main>
        <Status store={store} />
        {gallery.value && <Gallery store={store} close={() => (gallery.value = false)} openFiles={files.ask} />}
      </div>
    </DropZone>
  );
}

async function begin(store: Store, work: WorkKeeper): Promise<boolean> {
  try {
    await store.start();
  } catch (error) {
    store.broken.value = error instanceof Error ? error.message : String(error);
    store.busy.value = null;
    return false;
  }
  if (new URLSearchParams(location.search).has('live')) {
    follow(store, 'live');
    return false;
  }
  // A lesson opens its scenes itself.
  const { isNew } = isLesson(location.hash) ? { isNew: false } : await openFirst(store, work, location.hash);
  let opened = { base: store.base.value, text: store.revision.value?.text };
  effect(() => {
    const [base, revision] = [store.base.value, store.revision.value];
    if (base === null || revision === null || isLesson(location.hash)) return;
    if (base !== opened.base) opened = { base, text: revision.text };
    // Once it is changed, the scene is not that of the address any more: a reload must not bring that one back.
    if (revision.text !== opened.text && location.hash !== '') plainAddress();
    const draft = store.draft.value;
    work.save({ name: base.name, text: revision.text, files: 'files' in base.given ? base.given.files : [], ...(draft !== null && { draft }) });
  });
  return isNew;
}

function isLesson(fragment: string): boolean {
  return stepOf(fragment) !== null || exerciseOf(fragment) !== null;
}

function plainAddress(): void {
  history.replaceState(null, '', location.href.split('#')[0]);
}

function shortcut(event: KeyboardEvent, store: Store): void {
  if (!(event.ctrlKey || event.metaKey) || event.altKey) return;
  // A field has an undo of its own, but for the source, whose history is the scene's.
  const { target } = event;
  if (target instanceof HTMLInputElement && ['search', 'text'].includes(target.type)) return;
  const key = event.key.toLowerCase();
  if (key === 'z') (event.shiftKey ? store.redo() : store.undo());
  else if (key === 'y') store.redo();
  else return;
  event.preventDefault();
}
