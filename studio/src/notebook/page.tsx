/** The page in a cell of a notebook, in one file: Python gives it the scene, and gets it back after each change. */

import { effect } from '@preact/signals';
import { render } from 'preact';
import { App } from '../app';
import Desk from '../engine/desk.worker?worker&inline';
import Renderer from '../engine/renderer.worker?worker&inline';
import type { Work, WorkKeeper } from '../storage';
import { Store } from '../store';
import { missing, Sorry } from '../support';
import '../style/studio.css';
import type { NotebookHost } from './host';

/** Milliseconds after a change before Python is told, if no other follows. */
const CALM = 100;

/** Python keeps the work, as the text of a scene and its files. */
class NotebookWork implements WorkKeeper {
  private work: Work;
  private timer: ReturnType<typeof setTimeout> | undefined;

  constructor(private readonly host: NotebookHost) {
    this.work = host.scene;
  }

  load(): Promise<Work> {
    return Promise.resolve(this.work);
  }

  save(work: Work): void {
    this.work = work;
    clearTimeout(this.timer);
    this.timer = setTimeout(() => void this.flush(), CALM);
  }

  flush(): Promise<void> {
    clearTimeout(this.timer);
    this.host.changed(this.work);
    return Promise.resolve();
  }
}

const host = window.snellHost!;
const place = document.getElementById('app')!;
const lacks = missing();
if (lacks === null) {
  const store = new Store({
    module: host.module,
    desk: () => new Desk({ name: 'desk' }),
    renderer: (number) => new Renderer({ name: `renderer ${number}` }),
  });
  host.onTheme((theme) => (store.theme.value = theme));
  effect(() => {
    if (store.outcome.value) host.finished(store.surface.canvas);
  });
  render(<App store={store} work={new NotebookWork(host)} />, place);
} else {
  render(<Sorry lacks={lacks} />, place);
}
