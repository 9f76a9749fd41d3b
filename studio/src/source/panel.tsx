/** The scene's text. What is written there is shown at once, if it makes a scene. */

import { effect } from '@preact/signals';
import { useEffect, useRef } from 'preact/hooks';
import type { Store } from '../store';

export function SourcePanel({ store }: { store: Store }) {
  const place = useRef<HTMLDivElement>(null);
  useEffect(() => {
    let end = () => {};
    let gone = false;
    let glasses: string[] = [];
    store.engine.ask({ ask: 'glasses' }).then(
      (names) => (glasses = names),
      // Without them only their completion is missing.
      () => {},
    );
    const failed = () => place.current?.append('The editor could not be loaded: is this page offline? Everything else works without it.');
    // Only who looks at the text needs its editor, which is as large as the rest of the page.
    void import('./editor').then(({ SourceEditor }) => {
      if (gone) return;
      const editor = new SourceEditor(place.current!, {
        text: textOf(store),
        label: 'Source of the scene, in TOML',
        onChange: (text) => store.write(text),
        onHistory: (step) => (step === 'undo' ? store.undo() : store.redo()),
        known: () => ({ glasses, files: filesOf(store) }),
      });
      const dark = window.matchMedia('(prefers-color-scheme: dark)');
      const ends = [
        effect(() => editor.setText(textOf(store))),
        effect(() => {
          const others = new Set(filesOf(store));
          editor.setFindings([...store.refused.value, ...store.warnings.value].filter(({ place }) => place && !others.has(place.file)));
        }),
        effect(() => editor.setTheme(store.theme.value === 'dark' || (store.theme.value === 'auto' && dark.matches) ? 'dark' : 'light')),
      ];
      end = () => {
        store.readDraft();
        for (const one of ends) one();
        editor.dispose();
      };
    }, failed);
    return () => {
      gone = true;
      end();
    };
  }, []);
  return <div ref={place} class="source" />;
}

/** What is being written, or else the scene. */
function textOf(store: Store): string {
  return store.draft.value ?? store.revision.value?.text ?? '';
}

function filesOf(store: Store): string[] {
  const given = store.base.value?.given;
  return given && 'files' in given ? given.files.map(([name]) => name) : [];
}
