/** Controls for single values of the scene. Each change of one is a step to undo, a whole pull at a slider too. */

import type { ComponentChildren } from 'preact';
import { useId, useRef } from 'preact/hooks';
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
      store.endGroup();
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

/** A number with a slider. What is typed may lie beyond its ends; the engine says what it refuses. */
export function Slider(of: NumberOf) {
  const id = useId();
  const { value, min = 0, max = 1, step = 0.01, instead = [] } = of;
  const edit = useEdit(of);
  const change = (text: string) => {
    if (text.trim() === '' || Number.isNaN(Number(text))) return;
    edit.set(numberText(Number(text)), ...instead.map((key): Edit => [key, null]));
  };
  return (
    <Row label={of.label} id={id}>
      <input
        type="range"
        aria-label={`${of.label}, slider`}
        min={Math.min(min, value)}
        max={Math.max(max, value)}
        step={step}
        value={value}
        onInput={(event) => change(event.currentTarget.value)}
        onChange={edit.done}
      />
      <input id={id} class="number" inputMode="decimal" value={numberText(value)} onChange={(event) => (change(event.currentTarget.value), edit.done())} />
    </Row>
  );
}

export function NumberField(of: NumberOf) {
  const id = useId();
  const edit = useEdit(of);
  return (
    <Row label={of.label} id={id}>
      <input
        id={id}
        class="number"
        type="number"
        step={of.step ?? 'any'}
        {...(of.min === undefined ? {} : { min: of.min })}
        value={numberText(of.value)}
        onInput={(event) => {
          if (Number.isFinite(event.currentTarget.valueAsNumber)) edit.set(numberText(event.currentTarget.valueAsNumber));
        }}
        onChange={edit.done}
      />
    </Row>
  );
}

const AXES = ['x', 'y', 'z'];

export function VectorField(of: Of & { value: readonly number[]; names?: string[]; step?: number; whole?: boolean }) {
  const edit = useEdit(of);
  const names = of.names ?? AXES;
  return (
    <div class="field vector" role="group" aria-label={of.label}>
      <span class="field-label">{of.label}</span>
      {of.value.map((value, at) => (
        <input
          key={at}
          class="number"
          type="number"
          step={of.step ?? 'any'}
          aria-label={`${of.label}, ${names[at]}`}
          title={names[at]}
          value={numberText(value)}
          onInput={(event) => {
            const number = event.currentTarget.valueAsNumber;
            if (!Number.isFinite(number)) return;
            edit.set(vectorText(of.value.map((old, other) => (other === at ? number : old))));
          }}
          onChange={edit.done}
        />
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
        <input
          key={at}
          class="number"
          inputMode="decimal"
          aria-label={`${of.label}, ${['red', 'green', 'blue'][at]}`}
          value={numberText(value)}
          onChange={(event) => {
            const number = Number(event.currentTarget.value);
            if (event.currentTarget.value.trim() === '' || !Number.isFinite(number)) return;
            write(channels.map((old, other) => (other === at ? number : old)) as Vec3);
            edit.done();
          }}
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

/** IEC 61966-2-1, to eight bits: what a colour field can show. */
export function toHex(color: readonly number[], transfer: 'linear' | 'srgb'): string {
  const bytes = color.map((value) => {
    const light = Math.min(1, Math.max(0, value));
    const shown = transfer === 'linear' ? light : light <= 0.0031308 ? 12.92 * light : 1.055 * light ** (1 / 2.4) - 0.055;
    return Math.round(255 * shown).toString(16).padStart(2, '0');
  });
  return `#${bytes.join('')}`;
}

export function fromHex(hex: string, transfer: 'linear' | 'srgb'): Vec3 {
  const bytes = [1, 3, 5].map((at) => parseInt(hex.slice(at, at + 2), 16) / 255);
  return bytes.map((shown) => {
    const light = transfer === 'linear' ? shown : shown <= 0.04045 ? shown / 12.92 : ((shown + 0.055) / 1.055) ** 2.4;
    return Number(light.toFixed(4));
  }) as Vec3;
}
