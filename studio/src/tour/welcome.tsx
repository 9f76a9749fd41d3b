/** What somebody sees who comes for the first time. */

export function Welcome({ steps, start, close }: { steps: number; start(): void; close(): void }) {
  return (
    <section class="tour" aria-labelledby="welcome">
      <h2 id="welcome">Light, and why</h2>
      <p>Snell follows light through glass and mirrors, and can say of any pixel why it has its colour. Drag the glass sphere. Click a pixel.</p>
      <div class="group">
        <button type="button" class="primary" onClick={start}>
          Take the tour, {steps} steps
        </button>
        <button type="button" class="plain" onClick={close}>
          Look around first
        </button>
      </div>
    </section>
  );
}
