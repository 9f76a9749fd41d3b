/** Why a pixel has its colour. */

import { useEffect, useRef } from 'preact/hooks';
import { useComputed } from '@preact/signals';
import type { RayTreeDocument } from 'snell-viewer';
import { toHex } from '../scene/controls';
import type { Space } from '../scene/view';
import type { Store } from '../store';
import { lightsAt, whyDark } from './light';
import { LostLightPanel } from './lost';

export function AskPanel({ store, space }: { store: Store; space: Space | null }) {
  const tree = store.tree.value;
  const pinned = store.pinned.value;
  return (
    <div class="ask">
      {tree === null ? <Invitation /> : <Headline tree={tree} pinned={pinned !== null} unpin={() => store.pin(null)} />}
      {tree !== null && pinned !== null && <LightHere tree={tree} />}
      <div class="tree-place" hidden={pinned === null}>
        {space && <Tree space={space} />}
      </div>
      <Find store={store} tree={pinned === null ? null : tree} />
      <LostLightPanel store={store} />
    </div>
  );
}

function Invitation() {
  return (
    <div class="invitation">
      <h2>Why is this pixel that colour?</h2>
      <p>
        Point at the picture to see the rays of a pixel. Click to keep them, then follow each one: where it goes, what it meets, what it adds. The
        parts add up to the pixel, bit for bit.
      </p>
      <p class="quiet">Drag a thing in the picture to move it. Arrow keys go from pixel to pixel.</p>
    </div>
  );
}

function Headline({ tree, pinned, unpin }: { tree: RayTreeDocument; pinned: boolean; unpin(): void }) {
  const [x, y] = tree.pixel;
  return (
    <header class="headline">
      <span class="swatch" style={{ background: toHex(tree.color, tree.transfer) }} aria-hidden="true" />
      <div>
        <p class="sentence">{prose(tree.sentence)}</p>
        <p class="quiet">
          Pixel {x}, {y}
          {tree.spp > 1 && ` · ${tree.spp} samples`} · {tree.color.map((value) => value.toPrecision(3)).join(', ')}
        </p>
      </div>
      {pinned && (
        <button type="button" class="plain" aria-label="Let go of this pixel" onClick={unpin}>
          ✕
        </button>
      )}
    </header>
  );
}

/** What stands between backticks are names; a number stays with its sign. */
function prose(sentence: string) {
  return sentence
    .replaceAll(' %', '\u00a0%')
    .split('`')
    .map((part, at) => (at % 2 === 1 ? <b key={at}>{part}</b> : part));
}

function LightHere({ tree }: { tree: RayTreeDocument }) {
  const at = lightsAt(tree);
  const dark = whyDark(tree);
  if (at === null && dark === null) return null;
  return (
    <details class="light-here" open={dark !== null}>
      <summary>{dark === null ? `Light on ${at!.object}` : 'Why is it dark here?'}</summary>
      {dark && <p>{dark}</p>}
      {at && (
        <ul>
          {at.lines.map(({ light, text, reaches }) => (
            <li key={light} class={reaches ? '' : 'blocked'}>
              <b>{light}</b>: {text}
            </li>
          ))}
        </ul>
      )}
    </details>
  );
}

function Tree({ space }: { space: Space }) {
  const place = useRef<HTMLDivElement>(null);
  useEffect(() => space.placeTree(place.current!), [space]);
  return <div ref={place} />;
}

function Find({ store, tree }: { store: Store; tree: RayTreeDocument | null }) {
  const sighting = store.sighting.value;
  const names = useComputed(() => {
    const nodes = store.tree.value?.samples.flatMap((sample) => sample.nodes) ?? [];
    const met = new Set(nodes.map(({ hit }) => hit?.object).filter((name): name is string => name !== undefined));
    const { spheres = [], meshes = [] } = store.revision.value?.view ?? {};
    return tree === null ? [...new Set([...spheres, ...meshes].map(({ name }) => name))].slice(0, 12) : [...met];
  }).value;
  if (names.length === 0) return null;
  return (
    <section class="find" aria-labelledby="find">
      <h2 id="find">Where is it seen?</h2>
      <p class="quiet">All pixels that show an object, directly, in mirrors or through glass.</p>
      <div class="chips">
        {names.map((name) => (
          <button type="button" class="chip" key={name} aria-pressed={sighting?.object === name} onClick={() => store.find(sighting?.object === name ? null : name)}>
            {name}
          </button>
        ))}
      </div>
      {sighting && (
        <ol class="paths" aria-label={`Ways by which ${sighting.object} is seen`}>
          {sighting.paths.slice(0, 8).map(({ path, pixels }) => (
            <li key={path}>
              <button type="button" class="plain path" aria-pressed={sighting.path === path} onClick={() => store.findPath(sighting.path === path ? null : path)}>
                {path} <span class="quiet">{pixels.toLocaleString('en')} pixels</span>
              </button>
            </li>
          ))}
          {sighting.paths.length === 0 && <li>Nowhere in this picture.</li>}
        </ol>
      )}
    </section>
  );
}
