/** Exercises: say first what a ray will do, then see. The engine's own tree of rays says what is right, for whatever scene it is. */

import type { RayNode, RayTreeDocument, ViewCamera } from 'snell-viewer';
import { project } from '../picture/drag';

export interface Exercise {
  id: string;
  title: string;
  /** Scene and pixel that it is about. */
  scene: string;
  pixel: [number, number];
  question(tree: RayTreeDocument): string;
  answer:
    | { kind: 'number'; unit: string; tolerance: number }
    | { kind: 'choice'; options(tree: RayTreeDocument): string[] }
    /** A pixel to be clicked; the tolerance is a part of the picture's width. */
    | { kind: 'place'; tolerance: number };
  /** What is right, from the tree; `null` if the scene is another one, to which the question does not belong. */
  right(tree: RayTreeDocument, camera: ViewCamera): number | string | [number, number] | null;
  explain(tree: RayTreeDocument): string;
}

/** The first time that a ray enters something clear. */
function entry(tree: RayTreeDocument): RayNode | undefined {
  return tree.samples[0]?.nodes.find(({ hit }) => hit !== null && hit.angle_out !== null && hit.eta_behind !== hit.eta_before);
}

/** The ray inside that comes from there, if it reaches a surface. */
function inside(tree: RayTreeDocument): RayNode | undefined {
  const first = entry(tree);
  return first && tree.samples[0]!.nodes.find(({ parent, kind, hit }) => parent === first.id && (kind === 'inside' || kind === 'refracted') && hit !== null);
}

const degrees = (angle: number) => `${angle.toFixed(1)}°`;

export const EXERCISES: Exercise[] = [
  {
    id: 'bend',
    title: 'How much does it bend?',
    scene: 'gallery/ball',
    pixel: [300, 180],
    question(tree) {
      const { hit } = entry(tree)!;
      return `A ray meets ${hit!.object} at ${degrees(hit!.angle_in)} to the normal. The index is ${hit!.eta_before.toPrecision(3)} before the surface and ${hit!.eta_behind.toPrecision(3)} behind it. At which angle does it go on?`;
    },
    answer: { kind: 'number', unit: '°', tolerance: 0.5 },
    right: (tree) => entry(tree)?.hit?.angle_out ?? null,
    explain(tree) {
      const hit = entry(tree)!.hit!;
      return `sin θ₂ = ${hit.eta_before.toPrecision(3)} / ${hit.eta_behind.toPrecision(3)} · sin ${degrees(hit.angle_in)}, so θ₂ = ${degrees(hit.angle_out!)}.`;
    },
  },
  {
    id: 'leaves',
    title: 'Where does it leave?',
    scene: 'gallery/ball',
    pixel: [300, 180],
    question(tree) {
      const first = entry(tree)!;
      return `The ray through pixel ${tree.pixel.join(', ')} goes into ${first.hit!.object} and bends towards the normal, from ${degrees(first.hit!.angle_in)} to ${degrees(first.hit!.angle_out!)}. Click the place in the picture at which it comes out on the far side, as if you could look straight through.`;
    },
    answer: { kind: 'place', tolerance: 0.03 },
    right(tree, camera) {
      const point = inside(tree)?.hit?.point;
      return point === undefined ? null : project(camera, tree.size, point);
    },
    explain(tree) {
      const { angle_in, angle_out } = inside(tree)!.hit!;
      const leaves = angle_out === null ? 'it is mirrored there' : `it leaves at ${degrees(angle_out)}, the angle at which it came`;
      return `It meets the far side at ${degrees(angle_in)} to the normal, as the two normals and the ray make a triangle with two equal sides; ${leaves}.`;
    },
  },
  {
    id: 'meets',
    title: 'What does it meet?',
    scene: 'lecture/default',
    pixel: [300, 300],
    question: (tree) => `The ray through pixel ${tree.pixel.join(', ')} goes through the glass sphere. What does it meet behind it?`,
    answer: {
      kind: 'choice',
      options: (tree) => [...new Set([...['red', 'green', 'blue'], ...tree.samples[0]!.nodes.map(({ hit }) => hit?.object ?? 'nothing')])].filter((name) => name !== 'glass'),
    },
    right(tree) {
      const first = tree.samples[0]!.nodes[0]!;
      const through = tree.samples[0]!.nodes.find(({ parent, kind }) => parent === first.id && kind === 'refracted');
      return through === undefined ? null : (through.hit?.object ?? 'nothing');
    },
    explain: () => 'The rays cross inside the sphere: what is seen at its lower right comes from the upper left.',
  },
];

/** Is this the answer? A place comes as a pixel, anything else as what was typed or chosen. */
export function isRight(exercise: Exercise, tree: RayTreeDocument, camera: ViewCamera, given: string | readonly [number, number]): boolean {
  const right = exercise.right(tree, camera);
  const { answer } = exercise;
  if (right === null) return false;
  if (answer.kind === 'choice') return given === right;
  if (answer.kind === 'place') {
    const [[x, y], [rightX, rightY]] = [given as [number, number], right as [number, number]];
    return Math.hypot(x + 0.5 - rightX, y + 0.5 - rightY) <= answer.tolerance * tree.size[0];
  }
  return Math.abs(numberIn(String(given)) - Number(right)) <= answer.tolerance;
}

/** With a decimal comma and a unit, too; `NaN` for what is none. */
export function numberIn(text: string): number {
  const match = /^([-+]?(?:\d+(?:[.,]\d*)?|[.,]\d+))\s*(?:°|degrees?|deg)?$/.exec(text.trim());
  return match ? Number(match[1]!.replace(',', '.')) : NaN;
}
