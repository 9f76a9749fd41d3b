/** The values of what is selected, its material, and of the picture as a whole. */

import { useSignal } from '@preact/signals';
import type { Edit } from '../engine/protocol';
import type { SceneDocument } from '../generated/scene';
import type { Store } from '../store';
import { type Addable, elementOf, freeName } from './add';
import { Choice, ColorField, NumberField, Slider, useEdit, VectorField } from './controls';
import { quoted, type SceneObject } from './objects';
import { PRESETS } from './presets';

type Material = NonNullable<SceneDocument['material']>[string];

export function Properties({ store }: { store: Store }) {
  const { value: revision } = store.revision;
  if (revision === null) return null;
  const { scene } = revision;
  const selected = store.selected.value;
  return (
    <div class="properties">
      <ObjectPicker store={store} />
      {selected && <ObjectValues store={store} object={selected} scene={scene} key={selected.key} />}
      {selected && 'material' in selected.data && selected.data.material && (
        <MaterialValues store={store} name={selected.data.material} scene={scene} key={selected.data.material} />
      )}
      <PictureValues store={store} scene={scene} />
    </div>
  );
}

const MARKS: Record<SceneObject['kind'], string> = {
  sphere: '●', mesh: '◆', plane: '▱', box: '■', disc: '⬬', lathe: '⧗', light: '✺', camera: '◉', target: '⌖',
};

/** More than these are not shown at once. */
const MANY = 60;

function ObjectPicker({ store }: { store: Store }) {
  const objects = store.objects.value;
  const search = useSignal('');
  const wanted = search.value.toLowerCase();
  const found = objects.filter(({ title, kind }) => `${kind} ${title}`.toLowerCase().includes(wanted));
  return (
    <section aria-labelledby="objects">
      <h2 id="objects">Objects</h2>
      {objects.length > 12 && (
        <input type="search" aria-label="Search objects" placeholder="Search" value={search.value} onInput={(event) => (search.value = event.currentTarget.value)} />
      )}
      <div class="chips">
        {found.slice(0, MANY).map((object) => (
          <button
            type="button"
            class="chip"
            key={object.key}
            aria-pressed={store.selectedKey.value === object.key}
            onClick={() => store.select(store.selectedKey.value === object.key ? null : object.key)}
          >
            <span aria-hidden="true">{MARKS[object.kind]}</span> {object.title}
          </button>
        ))}
        {found.length > MANY && <span class="quiet">and {found.length - MANY} more: search for them</span>}
      </div>
      <AddAndRemove store={store} />
    </section>
  );
}

const ADDABLE: Addable[] = ['sphere', 'box', 'plane', 'disc', 'light'];

function AddAndRemove({ store }: { store: Store }) {
  const { scene } = store.revision.value!;
  const selected = store.selected.value;
  const hasMaterial = Object.keys(scene.material ?? {}).length > 0;
  const add = (kind: Addable) => {
    const name = freeName(kind, new Set(store.objects.value.map((object) => object.name)));
    store.edit([[kind, elementOf(kind, name, scene)]], { label: `add ${name}` });
    store.select(`${kind}.${quoted(name)}`);
  };
  const remove = () => {
    store.edit([[selected!.key, null]], { label: `remove ${selected!.title}` });
    // Its number may be another one's then.
    store.select(null);
  };
  return (
    <div class="group">
      <select
        aria-label="Add an object"
        value=""
        onChange={(event) => {
          add(event.currentTarget.value as Addable);
          event.currentTarget.value = '';
        }}
      >
        <option value="" disabled>
          Add …
        </option>
        {ADDABLE.filter((kind) => hasMaterial || kind === 'light').map((kind) => (
          <option key={kind}>{kind}</option>
        ))}
      </select>
      {selected && selected.kind !== 'camera' && (
        <button type="button" onClick={remove}>
          Remove {selected.title}
        </button>
      )}
    </div>
  );
}

function ObjectValues({ store, object, scene }: { store: Store; object: SceneObject; scene: SceneDocument }) {
  const { key } = object;
  const materials = Object.keys(scene.material ?? {});
  const transfer = scene.render.transfer ?? 'srgb';
  return (
    <section aria-label={`Values of ${object.title}`}>
      <h2>
        {object.title} <span class="quiet">{object.kind}</span>
      </h2>
      {object.kind === 'sphere' && (
        <>
          <VectorField store={store} of={`${key}.center`} label="Centre" value={object.data.center} />
          <NumberField store={store} of={`${key}.radius`} label="Radius" value={object.data.radius} min={0} />
        </>
      )}
      {(object.kind === 'plane' || object.kind === 'disc') && (
        <>
          <VectorField store={store} of={`${key}.center`} label="Centre" value={object.data.center ?? [0, 0, 0]} />
          <VectorField store={store} of={`${key}.normal`} label="Normal" value={object.data.normal ?? [0, 1, 0]} />
        </>
      )}
      {object.kind === 'plane' && <VectorField store={store} of={`${key}.size`} label="Size" value={object.data.size} names={['width', 'height']} />}
      {object.kind === 'disc' && <NumberField store={store} of={`${key}.radius`} label="Radius" value={object.data.radius} min={0} />}
      {object.kind === 'box' && (
        <>
          <VectorField store={store} of={`${key}.min`} label="From" value={object.data.min} />
          <VectorField store={store} of={`${key}.max`} label="To" value={object.data.max} />
        </>
      )}
      {object.kind === 'light' && (
        <>
          {object.data.position && <VectorField store={store} of={`${key}.position`} label="Position" value={object.data.position} />}
          {object.data.direction && <VectorField store={store} of={`${key}.direction`} label="Direction" value={object.data.direction} />}
          <ColorField store={store} of={`${key}.color`} label="Colour" value={object.data.color} transfer={transfer} />
        </>
      )}
      {object.kind === 'camera' && <CameraValues store={store} camera={object.data} />}
      {'material' in object.data && object.data.material && (
        <Choice store={store} of={`${key}.material`} label="Material" value={object.data.material} options={materials.map((name) => [name, name])} />
      )}
    </section>
  );
}

function CameraValues({ store, camera }: { store: Store; camera: SceneDocument['camera'] }) {
  return (
    <>
      <VectorField store={store} of="camera.eye" label="Eye" value={camera.eye} />
      <VectorField store={store} of="camera.look_at" label="Looks at" value={camera.look_at} />
      {camera.fov != null && <Slider store={store} of="camera.fov" label="Angle of view" value={camera.fov} min={1} max={120} step={0.5} />}
      {camera.bounds != null && (
        <VectorField store={store} of="camera.bounds" label="Bounds" value={camera.bounds} names={['left', 'right', 'bottom', 'top']} />
      )}
      {camera.near != null && <NumberField store={store} of="camera.near" label="Image plane" value={camera.near} />}
    </>
  );
}

/** What says the index of refraction, one instead of the other. */
const INDEX = ['eta', 'glass', 'abbe', 'cauchy', 'sellmeier'];

function MaterialValues({ store, name, scene }: { store: Store; name: string; scene: SceneDocument }) {
  const material = scene.material?.[name];
  if (material === undefined) return null;
  const key = `material.${quoted(name)}`;
  const transfer = scene.render.transfer ?? 'srgb';
  const optics = scene.render.integrator === 'whitted';
  const clear = whiteOf(material.ko ?? 1) < 1;
  return (
    <section aria-label={`Material ${name}`}>
      <h2>
        {name} <span class="quiet">material</span>
      </h2>
      <Presets store={store} of={key} label="Preset" material={material} optics={optics} />
      <Index store={store} of={key} material={material} optics={optics} />
      <ColorField store={store} of={`${key}.ka`} label="Ambient" value={material.ka ?? 0} transfer={transfer} />
      <ColorField store={store} of={`${key}.kd`} label="Diffuse" value={material.kd ?? 0} transfer={transfer} />
      <GraySlider store={store} of={`${key}.ks`} label="Highlight" value={material.ks ?? 0} />
      <Slider store={store} of={`${key}.spow`} label="Sharpness" value={material.spow ?? 16} min={1} max={256} step={1} />
      <GraySlider store={store} of={`${key}.kr`} label="Mirror" value={material.kr ?? 0} />
      <GraySlider store={store} of={`${key}.ko`} label="Opacity" value={material.ko ?? 1} />
      {optics && clear && material.sigma_a == null && (
        <>
          <ColorField
            store={store}
            of={`${key}.attenuation_color`}
            label="Tint"
            value={material.attenuation_color ?? 1}
            transfer={transfer}
            // One means nothing without the other.
            more={material.attenuation_distance == null ? [[`${key}.attenuation_distance`, '1']] : []}
          />
          {material.attenuation_distance != null && (
            <NumberField store={store} of={`${key}.attenuation_distance`} label="at thickness" value={material.attenuation_distance} min={0} />
          )}
        </>
      )}
    </section>
  );
}

function Presets({ store, of, label, material, optics }: { store: Store; of: string; label: string; material: Material; optics: boolean }) {
  const edit = useEdit({ store, of, label: 'preset' });
  // What the text leaves out cannot be taken away, but what has just been written can.
  const taken = (keys: string[]): Edit[] =>
    keys.flatMap((key): Edit[] => (key === 'eta' ? [[`${of}.eta`, '1'], [`${of}.eta`, null]] : key in material ? [[`${of}.${key}`, null]] : []));
  const chosen = PRESETS.find(({ glass, eta }) => (material.glass != null ? glass === material.glass : Math.abs(eta - (material.eta ?? 1)) < 1e-9));
  const choose = (name: string) => {
    const preset = PRESETS.find((one) => one.name === name);
    if (preset === undefined) return;
    const { glass, eta } = preset;
    const [key, text] = optics && glass !== null ? ['glass', JSON.stringify(glass)] : ['eta', String(eta)];
    store.edit([...taken(INDEX.filter((other) => other !== key)), [`${of}.${key}`, text]], { label: `make it ${name.toLowerCase()}` });
    edit.done();
  };
  return (
    <div class="field">
      <label for={`${of}-preset`}>{label}</label>
      <select id={`${of}-preset`} value={chosen?.name ?? ''} onChange={(event) => choose(event.currentTarget.value)}>
        <option value="">{material.glass ?? 'custom'}</option>
        {PRESETS.map(({ name }) => (
          <option key={name}>{name}</option>
        ))}
      </select>
    </div>
  );
}

function Index({ store, of, material, optics }: { store: Store; of: string; material: Material; optics: boolean }) {
  const preset = PRESETS.find(({ glass }) => glass === material.glass);
  const formula = material.cauchy != null || material.sellmeier != null;
  if (formula) return <p class="quiet">Its index is computed from the wavelength: see the source.</p>;
  const instead = INDEX.filter((key) => key !== 'eta' && key !== 'abbe' && key in material).map((key) => `${of}.${key}`);
  const eta = material.glass != null ? (preset?.eta ?? 1.5) : (material.eta ?? 1);
  return (
    <>
      <Slider store={store} of={`${of}.eta`} label="Index" value={eta} min={1} max={4} step={0.01} instead={instead} />
      {optics && material.glass == null && material.eta != null && (
        <Slider store={store} of={`${of}.abbe`} label="Abbe number" value={material.abbe ?? 60} min={15} max={95} step={1} />
      )}
    </>
  );
}

/** A slider for a value that is mostly gray. One of a colour keeps its hue. */
function GraySlider({ store, of, label, value }: { store: Store; of: string; label: string; value: Material['kr'] }) {
  if (typeof value === 'number' || value === undefined) return <Slider store={store} of={of} label={label} value={value ?? 0} />;
  return <VectorField store={store} of={of} label={label} value={value} names={['red', 'green', 'blue']} />;
}

function whiteOf(value: NonNullable<Material['ko']>): number {
  return typeof value === 'number' ? value : Math.min(...value);
}

const MODELS = [
  ['lecture', 'Lecture'],
  ['course2018', 'Course 2018'],
  ['course2020', 'Course 2020'],
  ['whitted', 'Whitted: real optics'],
] as const;

function PictureValues({ store, scene }: { store: Store; scene: SceneDocument }) {
  const { render, camera } = scene;
  const optics = render.integrator === 'whitted';
  const shadows = [['off', 'none'], ['opaque', 'opaque'], ...(optics ? [['tinted', 'tinted']] : [])] as [string, string][];
  // A kind of shadow that the other model does not have.
  const more: Edit[] = render.shadows === 'tinted' ? [['render.shadows', null]] : [];
  return (
    <section aria-label="The picture">
      <h2>Picture</h2>
      <Choice store={store} of="render.integrator" label="Model of light" value={render.integrator} options={MODELS} more={more} />
      <Slider store={store} of="render.max_depth" label="Depth" value={render.max_depth ?? 32} min={0} max={32} step={1} />
      <Choice store={store} of="render.shadows" label="Shadows" value={render.shadows ?? (optics ? 'tinted' : 'opaque')} options={shadows} />
      <NumberField store={store} of="render.spp" label="Samples per pixel" value={render.spp ?? 1} min={1} step={1} />
      <VectorField store={store} of="render.size" label="Size" value={render.size} names={['width', 'height']} />
      {camera.near != null && store.selected.value?.kind !== 'camera' && (
        <NumberField store={store} of="camera.near" label="Image plane" value={camera.near} />
      )}
      {camera.bounds != null && store.selected.value?.kind !== 'camera' && (
        <VectorField store={store} of="camera.bounds" label="Bounds" value={camera.bounds} names={['left', 'right', 'bottom', 'top']} />
      )}
      <Slider store={store} of="eta_outside" label="Index outside" value={scene.eta_outside ?? 1} min={1} max={2.5} />
    </section>
  );
}
