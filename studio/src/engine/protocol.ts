/**
 * What the page and its workers tell each other. One worker, the desk, answers questions and puts the picture together;
 * the others render a share of it each. All of them have the same scene, since all get the same changes.
 */

import type { RayTreeDocument, ViewMesh, ViewScene } from 'snell-viewer';
import type { SceneDocument } from '../generated/scene';
import type { LostLight } from './lost';

/** Something that is wrong with a scene, or odd. */
export interface Finding {
  /** Of a warning, like `W009`. */
  code?: string;
  message: string;
  help?: string;
  place?: Place;
}

/** Lines and columns count from 1, columns in characters; the end is behind the last one. */
export interface Place {
  file: string;
  line: number;
  column: number;
  end_line: number;
  end_column: number;
}

/** A scene as it is opened: a file with those it names, or one that is built in. */
export type Given = { name: string; text: Uint8Array; files: [string, Uint8Array][] } | { builtin: string };

/** Keys with their new values in TOML; `null` takes a key away. */
export type Edit = [key: string, value: string | null];

/** How the scene is to change. */
export type Change = { open: Given } | { revise: string } | { edit: Edit[] };

/** A scene that has been read. */
export interface Revision {
  text: string;
  scene: SceneDocument;
  /** Without corners and faces, which `geometry` has under the mesh's key, or had when they were new; `null`: as it was. */
  view: DistributedView | null;
  geometry: Map<string, Geometry>;
  /** What is odd about it. */
  warnings: Finding[];
  size: [number, number];
}

export interface DistributedView extends ViewScene {
  meshes: (ViewMesh & { geometry: string })[];
}

export type Geometry = Pick<ViewMesh, 'vertices' | 'faces'>;

/** The same, with everything in its place. */
export type CompleteRevision = Omit<Revision, 'view' | 'geometry'> & { view: ViewScene };

/** What of a picture is not as the scene has it. */
export interface PictureOptions {
  size?: [number, number];
  spp?: number;
  depth?: number;
  integrator?: string;
  shadows?: string;
}

/** Where an object is seen: by which paths, and for each pixel the share of it that is the object. */
export interface Sighting {
  paths: { path: string; pixels: number }[];
  mask: Float64Array;
}

/** A rectangle of the picture as a canvas shows it. */
export interface Patch {
  x: number;
  y: number;
  width: number;
  height: number;
  rgba: Uint8ClampedArray<ArrayBuffer>;
}

/** A rectangle of the picture in numbers. */
export interface Part {
  x: number;
  y: number;
  width: number;
  height: number;
  values: Float64Array;
  /** The light that the pixels have lost, in the engine's units; `null` if there is none in the whole share. */
  lost: Float64Array | null;
  /** With all samples? */
  finished: boolean;
}

/** What is moved with a part, not copied. */
export function buffersOf({ values, lost }: Part): ArrayBufferLike[] {
  return lost === null ? [values.buffer] : [values.buffer, lost.buffer];
}

/** Of what the page tells a worker, the number says which scene or picture it is about. */
export type ToRenderer =
  | { do: 'start'; module: WebAssembly.Module; share: [index: number, count: number] }
  | { do: 'change'; change: Change }
  /** `hold`: milliseconds to wait after the coarsest pass, as another picture may be asked for at once. */
  | { do: 'render'; picture: number; options: PictureOptions; coarsest: number; hold: number }
  | { do: 'stop' }
  /** Hand over what is not finished, too. */
  | { do: 'collect'; picture: number };

export type FromRenderer =
  /** What was rendered lately; `covered` once each pixel has been, or one near it, and how many milliseconds that took. */
  | { tell: 'patches'; picture: number; patches: Patch[]; covered: boolean; coveredIn: number; pixels: number; rays: number }
  | { tell: 'part'; picture: number; part: Part }
  /** With what was traced, for the desk alone. */
  | { tell: 'finished'; picture: number; statistics: string }
  | { tell: 'collected'; picture: number }
  /** There will be no such picture. */
  | { tell: 'refused'; picture: number; findings: Finding[] }
  /** The instance is of no use any more. */
  | { tell: 'broken'; message: string };

export type ToDesk =
  | { do: 'start'; module: WebAssembly.Module }
  | { do: 'gather'; picture: number; options: PictureOptions }
  | { do: 'part'; picture: number; part: Part }
  | { do: 'statistics'; picture: number; statistics: string }
  | { do: 'ask'; id: number; question: Question };

/** What only the desk answers. */
export type Question =
  | { ask: 'change'; change: Change }
  | { ask: 'explain'; pixel: [number, number] }
  | { ask: 'find'; object: string }
  | { ask: 'path'; path: string }
  | { ask: 'values'; x: number; y: number; width: number; height: number }
  | { ask: 'outcome' }
  | { ask: 'glasses' }
  | { ask: 'json' }
  | { ask: 'png' | 'exr' };

export interface Answers {
  change: Revision;
  explain: RayTreeDocument;
  find: Sighting;
  /** For each pixel 1 where something is seen by this path, else 0. */
  path: Float64Array;
  values: Float64Array;
  /** Of a finished picture; `lost` is `null` if nothing was. */
  outcome: { sha256: string; warnings: Finding[]; lost: LostLight | null };
  /** The names of the catalogue. */
  glasses: string[];
  /** The scene as text. */
  json: string;
  png: Uint8Array<ArrayBuffer>;
  exr: Uint8Array<ArrayBuffer>;
}

export type FromDesk =
  | { tell: 'answer'; id: number; answer: Answers[Question['ask']] }
  | { tell: 'refusal'; id: number; findings: Finding[] }
  | { tell: 'refused'; picture: number; findings: Finding[] }
  | { tell: 'broken'; message: string };
