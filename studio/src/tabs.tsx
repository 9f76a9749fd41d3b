/** Tabs after the practice of WAI-ARIA: arrows move between them, only the chosen one is reached by Tab. */

import type { Signal } from '@preact/signals';
import type { ComponentChildren } from 'preact';

interface Tab {
  id: string;
  title: string;
  content: ComponentChildren;
}

export function Tabs({ tabs, chosen }: { tabs: Tab[]; chosen: Signal<string> }) {
  const key = (event: KeyboardEvent) => {
    const at = tabs.findIndex(({ id }) => id === chosen.value);
    const to = { ArrowRight: at + 1, ArrowLeft: at - 1, Home: 0, End: tabs.length - 1 }[event.key];
    if (to === undefined) return;
    event.preventDefault();
    chosen.value = tabs[(to + tabs.length) % tabs.length]!.id;
    document.getElementById(`tab-${chosen.value}`)?.focus();
  };
  return (
    <>
      <div role="tablist" class="tabs" aria-label="Panel" onKeyDown={key}>
        {tabs.map(({ id, title }) => (
          <button
            key={id}
            type="button"
            role="tab"
            id={`tab-${id}`}
            aria-selected={id === chosen.value}
            aria-controls={`panel-${id}`}
            tabIndex={id === chosen.value ? 0 : -1}
            onClick={() => (chosen.value = id)}
          >
            {title}
          </button>
        ))}
      </div>
      {tabs.map(({ id, content }) => (
        <div key={id} role="tabpanel" class="panel" id={`panel-${id}`} aria-labelledby={`tab-${id}`} hidden={id !== chosen.value} tabIndex={0}>
          {content}
        </div>
      ))}
    </>
  );
}
