/** What both kinds of workers do with a session of the engine. */

import { initSync, Session } from 'snell-wasm';
import type { Change, Finding } from './protocol';

export function start(module: WebAssembly.Module): void {
  initSync({ module });
}

/** The session after a change: another one if a scene was opened. Throws what the engine refuses, and then nothing has changed. */
export function changed(session: Session | null, change: Change): Session {
  if ('open' in change) {
    const { open } = change;
    const opened = 'builtin' in open ? Session.builtin(open.builtin) : Session.load(open.name, open.text, open.files);
    session?.free();
    return opened;
  }
  if (session === null) throw new Error('no scene has been opened');
  if ('revise' in change) session.revise(change.revise);
  else session.edit(JSON.stringify(change.edit));
  return session;
}

/** Were there rays of the picture that were not followed? */
export function hasLostLight(session: Session): boolean {
  return (JSON.parse(session.statistics()) as { lost: { rays: number } }).lost.rays > 0;
}

/** What the engine refuses says why; anything else is a fault, after which the instance is of no use. */
export function findingsOf(error: unknown): Finding[] | null {
  const { findings } = Object(error) as { findings?: string };
  return typeof findings === 'string' ? (JSON.parse(findings) as Finding[]) : null;
}

export function brokenBy(error: unknown): string {
  const memory = error instanceof RangeError || /memory/i.test(String(error));
  return memory ? 'there is not enough memory for this' : error instanceof Error ? error.message : String(error);
}
