/** What the picture leaves out: how many pixels have lost how much where rays were not followed, and which ones. */

import { FROM, type LostLight } from '../engine/lost';
import type { Store } from '../store';

export function LostLightPanel({ store }: { store: Store }) {
  const { value: outcome } = store.outcome;
  return (
    <section class="lost" aria-labelledby="lost">
      <h2 id="lost">What is left out?</h2>
      {outcome === null && <p class="quiet">This is known once the picture is finished.</p>}
      {outcome?.lost === null && <p class="quiet">Nothing: every ray of this picture was followed to its end.</p>}
      {outcome?.lost && (some(outcome.lost) > 0 ? <Histogram store={store} lost={outcome.lost} /> : <NextToNothing />)}
    </section>
  );
}

/** How many pixels have lost something. */
function some({ pixels, bins }: LostLight): number {
  return bins.length - pixels[0]!;
}

function NextToNothing() {
  return <p class="quiet">Next to nothing: each of the rays that were not followed carries less than a billionth of a pixel.</p>;
}

function Histogram({ store, lost }: { store: Store; lost: LostLight }) {
  const { pixels, bins, worst } = lost;
  const part = some(lost);
  const most = Math.max(...pixels.slice(1));
  const occupied = pixels.flatMap((number, bin) => (bin > 0 && number > 0 ? [bin] : []));
  const [x, y] = worst.pixel;
  const chosen = store.chosenBin.value;
  return (
    <>
      <p class="quiet">
        Rays that bounce too often or carry too little are not followed. In {count(part)} of {count(bins.length)} pixels ({percent(part / bins.length)}) this
        leaves something out. It is measured by what a white thing behind those rays would have added to the pixel.
      </p>
      <ol aria-label="Pixels by how much of them is left out">
        {pixels.map((number, bin) => {
          if (bin < occupied[0]! || bin > occupied.at(-1)!) return null;
          return (
            <li key={bin}>
              <button
                type="button"
                class="plain bin"
                aria-label={`${rangeOf(bin)}: ${count(number)} ${number === 1 ? 'pixel' : 'pixels'}`}
                aria-pressed={chosen === bin}
                disabled={number === 0}
                onPointerEnter={() => (store.pointedBin.value = bin)}
                onPointerLeave={() => (store.pointedBin.value = null)}
                onClick={() => store.chooseBin(chosen === bin ? null : bin)}
              >
                <span>{rangeOf(bin)}</span>
                <span class="bar">
                  <span style={{ width: `${(100 * number) / most}%` }} />
                </span>
                <span>{count(number)}</span>
              </button>
            </li>
          );
        })}
      </ol>
      <button type="button" onClick={() => store.pin([x, y])}>
        Pixel {x}, {y} has lost most: {percent(worst.share)}
      </button>
    </>
  );
}

function rangeOf(bin: number): string {
  const [from, to] = [FROM[bin]!, FROM[bin + 1]];
  if (to === undefined) return `${percent(from)} and more`;
  return from === 0 ? `under ${percent(to)}` : `${TWO_DIGITS.format(100 * from)} to ${percent(to)}`;
}

const TWO_DIGITS = new Intl.NumberFormat('en', { maximumSignificantDigits: 2 });

function percent(share: number): string {
  return `${TWO_DIGITS.format(100 * share)}\u00a0%`;
}

function count(value: number): string {
  return value.toLocaleString('en');
}
