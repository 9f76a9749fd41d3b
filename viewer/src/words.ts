/** Numbers and rays in words. */

import type { Ending, RayKind, RayNode } from './data';

export const KIND_NAMES: Record<RayKind | 'shadow', string> = {
  camera: 'Camera ray',
  mirror: 'Mirror ray',
  refracted: 'Refracted ray',
  inside: 'Ray inside a solid',
  shadow: 'Shadow ray',
};

export const ENDINGS: Record<Ending, string> = {
  missed: 'It met nothing and left the scene.',
  depth: 'Not followed further: the limit of bounces was reached.',
  threshold: 'Not followed further: it carried too little light.',
  absorbed: 'Absorbed on its way.',
  rays: 'Not followed further: the limit of rays was reached.',
};

/** For example “Mirror ray hits red”. */
export function rayTitle(node: RayNode): string {
  const kind = node.kind === 'inside' ? `Ray inside ${node.medium}` : KIND_NAMES[node.kind];
  const band = node.band_nm === null ? '' : ` of ${decimal(node.band_nm)} nm`;
  return `${kind}${band} ${rayEnd(node)}`;
}

function rayEnd(node: RayNode): string {
  if (node.hit !== null) return `hits ${node.hit.object}`;
  if (node.ended === 'missed') return 'leaves the scene';
  return node.ended === 'absorbed' ? 'is absorbed' : 'is not followed';
}

/** Four digits, as short as possible. */
export function decimal(value: number): string {
  if (value === 0) return '0';
  const size = Math.abs(value);
  const sign = value < 0 ? '−' : '';
  if (size >= 1e-4 && size < 1e6) return sign + String(Number(size.toPrecision(size < 1000 ? 4 : 6)));
  const [digits, exponent] = size.toExponential(2).split('e');
  return `${sign}${Number(digits)}\u00a0×\u00a010${superscript(Number(exponent))}`;
}

function superscript(exponent: number): string {
  return String(exponent).replace(/./g, (sign) => (sign === '-' ? '⁻' : '⁰¹²³⁴⁵⁶⁷⁸⁹'[Number(sign)]!));
}

export function percent(share: number): string {
  if (share > 0 && share < 0.001) return '< 0.1%';
  return `${(100 * share).toFixed(share < 0.1 && share > 0 ? 1 : 0)}%`;
}

export function triple(values: readonly number[]): string {
  return values.map(decimal).join(', ');
}

export function degrees(angle: number): string {
  return `${decimal(Number(angle.toFixed(2)))}°`;
}
