/** The command, which the page is compared with. */

import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import { OUT } from './page';

export const snell = process.env.SNELL ?? '../target/ci/snell';

const known = new Map<string, string>();

/** The hash of the film that the command renders. */
export function nativeHash(scene: string, ...args: string[]): string {
  const key = [scene, ...args].join(' ');
  const before = known.get(key);
  if (before !== undefined) return before;
  // What it says comes on the stream that is not read here.
  const line = ['-c', 'exec "$@" 2>&1', 'sh', snell, 'render', scene, ...args, '--progress', 'json', '-o', `${OUT}native.npy`];
  const said = execFileSync('sh', line, { encoding: 'utf8' });
  const { film_sha256 } = JSON.parse(said.trim().split('\n').at(-1)!) as { film_sha256: string };
  known.set(key, film_sha256);
  return film_sha256;
}

/** The file that the command writes. */
export function nativePng(scene: string): Buffer {
  execFileSync(snell, ['render', scene, '-o', `${OUT}native.png`], { stdio: 'pipe' });
  return readFileSync(`${OUT}native.png`);
}

/** The text of a built-in scene, with a picture of another size. */
export function textOf(scene: string, [width, height]: [number, number]): string {
  const text = execFileSync(snell, ['scenes', '--save', scene, '-o', '-'], { encoding: 'utf8', stdio: 'pipe' });
  return text.replace(/^size = \[\d+, \d+\]/m, `size = [${width}, ${height}]`);
}

/** The names of the built-in scenes of a group. */
export function scenesOf(group: string): string[] {
  const listed = execFileSync(snell, ['scenes'], { encoding: 'utf8', stdio: 'pipe' });
  return [...listed.matchAll(/^[a-z]+\/\S+/gm)].map(([name]) => name).filter((name) => name.startsWith(`${group}/`));
}
