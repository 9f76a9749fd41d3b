/** What it means to choose something in the scene and to move it. Nothing is moved here: whoever owns the scene does it. */

import type { Vec3 } from './data';

export interface ObjectRef {
  kind: 'sphere' | 'mesh' | 'light' | 'camera';
  /** Its place in the scene's list of this kind. Of the camera, 0 is the eye and 1 is what it looks at. */
  index: number;
  name: string;
}

export type Handles = 'move' | 'turn' | 'scale';

/** Since the start of a drag, in units of the scene. */
export type Change =
  | { kind: 'move'; by: Vec3 }
  | { kind: 'turn'; axis: Vec3; degrees: number }
  | { kind: 'scale'; by: number | Vec3 };

export type Movement = Change & {
  object: ObjectRef;
  /** Where its middle was at the start: what it is turned and scaled about. */
  at: Vec3;
};

export interface Editing {
  selected: ObjectRef | null;
  /** Without them, nothing can be dragged. */
  handles: Handles | null;
  /** Moves are multiples of this length; turns are of 15°, and scales of a tenth, if there is one. */
  snap: number | null;
  /** What the camera looks at, if it can be moved. */
  target?: Vec3;
}

/** The change that changes nothing. */
export function undone(change: Change): Change {
  switch (change.kind) {
    case 'move':
      return { kind: 'move', by: [0, 0, 0] };
    case 'turn':
      return { ...change, degrees: 0 };
    case 'scale':
      return { kind: 'scale', by: typeof change.by === 'number' ? 1 : [1, 1, 1] };
  }
}

export function snapped(value: number, step: number | null): number {
  // Without the rounding errors of a product: 0.3, not 0.30000000000000004.
  return step === null ? value : Number((Math.round(value / step) * step).toPrecision(12));
}
