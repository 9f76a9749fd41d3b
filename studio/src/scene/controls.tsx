/** Controls for single values of the scene. Each change of one is a step to undo, a whole pull at a slider too. */

import type { ComponentChildren } from 'preact';
import { useId, useRef } from 'preact/hooks';
import { displayed } from '../../../viewer/src/color';
import type { Edit } from '../engine/protocol';
import type { Store } from '../store';
import { numberText, type Vec3, vectorText } from './objects';

interface Of {
  store: Store;
  /** The key of the value, as in the scene's text. */
  of: string;
  label: string;
}

/** Changes one value, and what has to change with it. */
export function useEdit({ store, of, label }: Of): { set(text: string | null, ...more: Edit[]): void; done(): void } {
  const group = useRef('');
  return {
    set(text, ...more) {
      group.current ||= `${of} ${performance.now()}`;
      store.edit([...more, [of, text]], { label: `change ${label.toLowerCase()}`, group: group.current });
    },
    done() {
      group.current = '';
    },
  };
}

export function Row({ label, id, children }: { label: string; id?: string; children: ComponentChildren }) {
  return (
    <div class="field">
      {id === undefined ? <span class="field-label">{label}</span> : <label for={id}>{label}</label>}
      {children}
    </div>
  );
}

interface NumberOf extends Of {
  value: number;
  min?: number;
  max?: number;
  step?: number;
  /** Keys that say the same in another way, and go when this one is set. */
  instead?: string[];
}

/** With a decimal comma, too; `NaN` for what is none. */
export function parsed(text: string): number {
  const number = text.trim().replace(',', '.').replace('−', '-');
  return number === '' ? NaN : Number(number);
}

/** A field that goes back to what the scene has when it is left: what was refused does not stay in it. */
function NumberInput({ value, set, done, ...rest }: { value: number; set(value: number): void; done(): void; [attribute: string]: unknown }) {
  return (
    <input
      class="number"
      inputMode="decimal"
      autocomplete="off"
      value={numberText(value)}
      onChange={(event) => {
        const number = parsed(event.currentTarget.value);
        if (Number.isFinite(number)) set(number);
        done();
      }}
      onBlur={(event) => (event.currentTarget.value = numberText(value))}
      {...rest}
    />
  );
}

/** A number with a slider. What is typed may lie beyond its ends; the engine says what it refuses. */
export function Slider(of: NumberOf) {
  const id = useId();
  const { value, min = 0, max = 1, step = 0.01, instead = [] } = of;
  const edit = useEdit(of);
  const set = (number: number) => edit.set(numberText(number), ...instead.map((key): Edit => [key, null]));
  return (
    <Row label={of.label} id={id}>
      <input
        type="range"
        aria-label={`${of.label}, slider`}
        min={Math.min(min, value)}
        max={Math.max(max, value)}
        step={step}
        value={value}
        onInput={(event) => set(event.currentTarget.valueAsNumber)}
        onChange={edit.done}
        onBlur={(event) => (event.currentTarget.value = String(value))}
      />
      <NumberInput id={id} value={value} set={set} done={edit.done} />
    </Row>
  );
}

export function NumberField(of: NumberOf) {
  const id = useId();
  const edit = useEdit(of);
  return (
    <Row label={of.label} id={id}>
      <NumberInput id={id} value={of.value} set={(number) => edit.set(numberText(number))} done={edit.done} />
    </Row>
  );
}

const AXES = ['x', 'y', 'z'];

export function VectorField(of: Of & { value: readonly number[]; names?: string[] }) {
  const edit = useEdit(of);
  const fields = useRef<HTMLDivElement>(null);
  const names = of.names ?? AXES;
  const set = (at: number, number: number) => {
    // What stands in the other fields may be newer than the scene.
    const written = [...fields.current!.querySelectorAll('input')].map(({ value }) => parsed(value));
    edit.set(vectorText(of.value.map((old, other) => (other === at ? number : Number.isFinite(written[other]) ? written[other]! : old))));
  };
  return (
    <div class="field vector" role="group" aria-label={of.label} ref={fields}>
      <span class="field-label">{of.label}</span>
      {of.value.map((value, at) => (
        <NumberInput key={at} aria-label={`${of.label}, ${names[at]}`} title={names[at]} value={value} set={(number) => set(at, number)} done={edit.done} />
      ))}
    </div>
  );
}

type Rgb = number | readonly number[];

/** A colour, linear; the numbers may be above 1. */
export function ColorField(of: Of & { value: Rgb; transfer: 'linear' | 'srgb'; more?: Edit[] }) {
  const id = useId();
  const edit = useEdit(of);
  const channels: Vec3 = typeof of.value === 'number' ? [of.value, of.value, of.value] : ([...of.value] as Vec3);
  const write = (color: Vec3) => edit.set(color.every((value) => value === color[0]) ? numberText(color[0]) : vectorText(color), ...(of.more ?? []));
  return (
    <div class="field color" role="group" aria-label={of.label}>
      <label for={id}>{of.label}</label>
      <input
        id={id}
        type="color"
        value={toHex(channels, of.transfer)}
        onInput={(event) => write(fromHex(event.currentTarget.value, of.transfer))}
        onChange={edit.done}
      />
      {channels.map((value, at) => (
        <NumberInput
          key={at}
          aria-label={`${of.label}, ${['red', 'green', 'blue'][at]}`}
          value={value}
          set={(number) => write(channels.map((old, other) => (other === at ? number : old)) as Vec3)}
          done={edit.done}
        />
      ))}
    </div>
  );
}

export function Choice(of: Of & { value: string; options: readonly (readonly [value: string, text: string])[]; more?: Edit[] }) {
  const id = useId();
  const edit = useEdit(of);
  return (
    <Row label={of.label} id={id}>
      <select
        id={id}
        value={of.value}
        onChange={(event) => {
          edit.set(JSON.stringify(event.currentTarget.value), ...(of.more ?? []));
          edit.done();
        }}
      >
        {of.options.map(([value, text]) => (
          <option key={value} value={value}>
            {text}
          </option>
        ))}
      </select>
    </Row>
  );
}

/** To eight bits: what a colour field can show. */
export function toHex(color: readonly number[], transfer: 'linear' | 'srgb'): string {
  const bytes = displayed([...color] as Vec3, transfer).map((value) => Math.round(255 * value).toString(16).padStart(2, '0'));
  return `#${bytes.join('')}`;
}

/** The other way: the curve of IEC 61966-2-1 backwards. */
export function fromHex(hex: string, transfer: 'linear' | 'srgb'): Vec3 {
  const bytes = [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255);
  return bytes.map((shown) => {
    const light = transfer === 'linear' ? shown : shown <= 0.04045 ? shown / 12.92 : ((shown + 0.055) / 1.055) ** 2.4;
    return Number(light.toFixed(4));
  }) as Vec3;
}
