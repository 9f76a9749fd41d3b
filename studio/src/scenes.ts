/** What was found out about the built-in scenes when the studio was built, by the command line. */

import list from '../../target/studio/scenes.json';

export interface BuiltinScene {
  name: string;
  description: string;
  /** Of the film that `snell render` makes of it; `null` where that would have taken too long. */
  film_sha256: string | null;
  /** Address of its picture. */
  thumbnail: string;
}

const thumbnails = import.meta.glob<string>('../../target/studio/thumbnails/*', { eager: true, query: '?url', import: 'default' });

export const SCENES: BuiltinScene[] = (list as BuiltinScene[]).map((scene) => ({
  ...scene,
  thumbnail: thumbnails[`../../target/studio/${scene.thumbnail}`] ?? '',
}));

/** The hash that a picture of this scene has if its bits are those of the command line. */
export function nativeHash(name: string): string | null {
  return SCENES.find((scene) => scene.name === name)?.film_sha256 ?? null;
}
