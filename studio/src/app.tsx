/** The page: the picture and the scene side by side, and a panel that says why, what and from which text. */

import { useSignal } from '@preact/signals';
import { useEffect, useMemo, useState } from 'preact/hooks';
import { AskPanel } from './ask/panel';
import { Header } from './header';
import { PictureView } from './picture/view';
import { Properties } from './scene/properties';
import { type Space, SpaceView } from './scene/view';
import { Status } from './status';
import { Store } from './store';
import { Tabs } from './tabs';

export function App() {
  const store = useMemo(() => new Store(), []);
  const [space, setSpace] = useState<Space | null>(null);
  const tab = useSignal('why');

  useEffect(() => {
    // For tests and for the curious: the page itself does not read it.
    Object.assign(window, { snell: store });
    void store.start().then(() => store.open({ name: 'lecture/default', given: { builtin: 'lecture/default' } }));
  }, []);
  useEffect(() => {
    const keys = (event: KeyboardEvent) => shortcut(event, store);
    window.addEventListener('keydown', keys);
    return () => window.removeEventListener('keydown', keys);
  }, []);

  return (
    <div class="studio">
      <Header store={store} />
      <main>
        <section class="pane" aria-label="Picture">
          <PictureView store={store} />
        </section>
        <section class="pane" aria-label="Scene in 3D">
          <SpaceView store={store} onSpace={setSpace} />
        </section>
        <aside class="side">
          <Tabs
            chosen={tab}
            tabs={[
              { id: 'why', title: 'Why?', content: <AskPanel store={store} space={space} /> },
              { id: 'scene', title: 'Scene', content: <Properties store={store} /> },
            ]}
          />
        </aside>
      </main>
      <Status store={store} />
    </div>
  );
}

function shortcut(event: KeyboardEvent, store: Store): void {
  if (!(event.ctrlKey || event.metaKey) || event.altKey) return;
  const key = event.key.toLowerCase();
  // Fields of text have an undo of their own, which is that of the scene once they are left.
  if (event.target instanceof HTMLInputElement && ['text', 'search', ''].includes(event.target.type) && event.target.inputMode === '') return;
  if (key === 'z') event.shiftKey ? store.redo() : store.undo();
  else if (key === 'y') store.redo();
  else return;
  event.preventDefault();
}
