/** A button that opens a list of actions, after the practice for menu buttons of WAI-ARIA. */

import { useSignal } from '@preact/signals';
import { useEffect, useId, useRef } from 'preact/hooks';

export interface Action {
  title: string;
  hint?: string;
  act(): void;
}

export function Menu({ title, label = title, actions }: { title: string; label?: string; actions: Action[] }) {
  const open = useSignal(false);
  const root = useRef<HTMLDivElement>(null);
  const id = useId();
  const items = () => [...root.current!.querySelectorAll<HTMLElement>('[role=menuitem]')];
  const close = (focus: boolean) => {
    open.value = false;
    if (focus) root.current!.querySelector('button')!.focus();
  };
  useEffect(() => {
    if (!open.value) return;
    items()[0]?.focus();
    const outside = (event: Event) => root.current!.contains(event.target as Node) || close(false);
    document.addEventListener('pointerdown', outside);
    return () => document.removeEventListener('pointerdown', outside);
  }, [open.value]);
  const key = (event: KeyboardEvent) => {
    if (event.key === 'ArrowDown' && !open.value) open.value = true;
    else if (!open.value) return;
    else if (event.key === 'Escape') close(true);
    else if (event.key === 'Tab') return close(false);
    else {
      const all = items();
      const at = all.indexOf(document.activeElement as HTMLElement);
      const to = { ArrowDown: at + 1, ArrowUp: at - 1, Home: 0, End: all.length - 1 }[event.key];
      if (to === undefined) return;
      all[(to + all.length) % all.length]?.focus();
    }
    event.preventDefault();
  };
  return (
    <div class="menu" ref={root} onKeyDown={key}>
      <button type="button" aria-haspopup="menu" aria-expanded={open.value} aria-controls={id} aria-label={label} onClick={() => (open.value = !open.value)}>
        {title} <span aria-hidden="true">▾</span>
      </button>
      {open.value && (
        <div role="menu" id={id} aria-label={label}>
          {actions.map(({ title, hint, act }) => (
            <button
              type="button"
              role="menuitem"
              tabIndex={-1}
              key={title}
              onClick={() => {
                close(true);
                act();
              }}
            >
              {title}
              {hint && <span class="quiet">{hint}</span>}
            </button>
          ))}
        </div>
      )}
    </div>
  );
}
