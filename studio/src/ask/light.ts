/** Why a surface is as bright or as dark as it is: what each light does there. */

import type { RayTreeDocument } from 'snell-viewer';

export interface LightLine {
  light: string;
  text: string;
  reaches: boolean;
}

/** The lights at what is seen first in a pixel; nothing where nothing is met. */
export function lightsAt(tree: RayTreeDocument): { object: string; lines: LightLine[] } | null {
  const first = tree.samples[0]?.nodes[0];
  if (first?.hit == null || first.local === null) return null;
  const lines = first.local.lights.map((light): LightLine => {
    const { name, facing, blocked_by, transmittance } = light;
    const through = Math.max(...transmittance);
    if (!facing) return { light: name, text: 'the surface faces away from it', reaches: false };
    if (through === 0) return { light: name, text: blocked_by === null ? 'none of it comes through' : `${blocked_by} is in the way`, reaches: false };
    if (through < 1 || Math.min(...transmittance) < 1) {
      const by = blocked_by === null ? '' : ` through ${blocked_by}`;
      return { light: name, text: `${Math.round(100 * through)} % comes${by}`, reaches: true };
    }
    return { light: name, text: 'reaches it', reaches: true };
  });
  return { object: first.hit.object, lines };
}

/** One sentence for a pixel that is dark; nothing for one that is not. `threshold` is a mean of linear red, green and blue. */
export function whyDark(tree: RayTreeDocument, threshold = 0.12): string | null {
  const mean = (color: readonly number[]) => color.reduce((sum, value) => sum + value, 0) / 3;
  if (mean(tree.color) > threshold) return null;
  const nodes = tree.samples.flatMap((sample) => sample.nodes);
  const at = lightsAt(tree);
  if (at === null) return nodes[0]?.ended === 'missed' ? 'Nothing is met here, and the background is dark.' : null;
  const unfollowed = nodes.filter(({ ended }) => ended === 'depth').length;
  if (at.lines.length === 0) return `No light shines on ${at.object}: the scene has none.`;
  if (at.lines.every(({ reaches }) => !reaches)) {
    const reasons = at.lines.map(({ light, text }) => `${light}: ${text}`).join('; ');
    return `No light reaches ${at.object} here: ${reasons}.`;
  }
  if (unfollowed > 0) return `${unfollowed === 1 ? 'A ray was' : `${unfollowed} rays were`} not followed further, as the limit of bounces was reached.`;
  return `Light reaches ${at.object}, but hardly any of it goes on towards the eye: look at its diffuse colour and at what its rays meet.`;
}
