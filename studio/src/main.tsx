/** A page of its own. */

import { render } from 'preact';
import wasmUrl from '../../target/studio/snell_wasm_bg.wasm?url';
import { App } from './app';
import { WorkStorage } from './storage';
import { Store } from './store';
import { Sorry, missing } from './support';
import './style/studio.css';

const place = document.getElementById('app')!;
const lacks = missing();
if (lacks === null) {
  const store = new Store({
    module: new URL(wasmUrl, document.baseURI).href,
    desk: () => new Worker(new URL('./engine/desk.worker.ts', import.meta.url), { type: 'module', name: 'desk' }),
    renderer: (number) => new Worker(new URL('./engine/renderer.worker.ts', import.meta.url), { type: 'module', name: `renderer ${number}` }),
  });
  render(<App store={store} work={new WorkStorage((words) => store.note(words))} />, place);
} else {
  render(<Sorry lacks={lacks} />, place);
}
