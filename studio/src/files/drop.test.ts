import { readFileSync } from 'node:fs';
import { expect, test } from 'vitest';
import { choose, chosen, dropped, DropError, type Readable } from './drop';

const repository = (path: string) => readFileSync(new URL(`../../../${path}`, import.meta.url));
const TOML = '# a\nsnell = 1\n';
const DRIVER = repository('fuzz/seeds/driver/2020.txt');

function file(path: string, content: string | Uint8Array = '', size?: number): Readable {
  const bytes = typeof content === 'string' ? new TextEncoder().encode(content) : Uint8Array.from(content);
  return { name: path.split('/').at(-1)!, webkitRelativePath: path.includes('/') ? path : '', size: size ?? bytes.length, arrayBuffer: async () => bytes.buffer };
}

const open = (...files: Readable[]) => chosen(files);
const refusal = async (opened: Promise<unknown>) => {
  const error: unknown = await opened.then(() => null, (error: unknown) => error);
  expect(error).toBeInstanceOf(DropError);
  return (error as DropError).message;
};
/** What was found, without bytes. */
async function kind(...files: Readable[]) {
  const found = await open(...files);
  if ('scene' in found) return { scene: found.scene.name, files: found.scene.files.map(([name]) => name) };
  return 'model' in found ? { model: found.model } : { candidates: found.candidates };
}

test('a scene with its models, in any order and with any case of endings', async () => {
  const found = await open(file('cow.OBJ', 'v 1 2 3'), file('Ball.TOML', TOML), file('map.png', 'x'));
  expect(found).toMatchObject({ scene: { name: 'Ball.TOML', text: new TextEncoder().encode(TOML) } });
  expect(await kind(file('cow.OBJ'), file('Ball.TOML', TOML))).toEqual({ scene: 'Ball.TOML', files: ['cow.OBJ'] });
});

test('scenes of all kinds are recognised by what is in them', async () => {
  const seeds = ['fuzz/seeds/driver/2018.txt', 'fuzz/seeds/driver/2020.txt', 'fuzz/seeds/nff/all.nff', 'fuzz/seeds/scene/default.json', 'fuzz/seeds/scene/mesh.toml'];
  for (const seed of seeds) {
    const others = [file('README.txt', 'See the camera.'), file('package.json', '{ "name": "snell" }'), file('a.obj')];
    expect(await kind(...others, file(seed, repository(seed)))).toMatchObject({ scene: seed });
  }
  expect(await kind(file('driver00', DRIVER), file('a.obj'))).toMatchObject({ scene: 'driver00' });
});

test('names keep their folders, and lose what systems put there', async () => {
  const files = [file('set/drivers/driver00.txt', DRIVER), file('set/models/cow.obj'), file('set/.DS_Store'), file('set/.git/a.toml', TOML), file('__MACOSX/set/b.toml', TOML), file('set/film.mov')];
  expect(await kind(...files)).toEqual({ scene: 'set/drivers/driver00.txt', files: ['set/models/cow.obj'] });
});

test('of several scenes one has to be chosen', async () => {
  const found = await open(file('b.toml', TOML), file('a.toml', TOML), file('x.obj'));
  if (!('candidates' in found)) throw new Error('one was taken');
  expect(found.candidates).toEqual(['a.toml', 'b.toml']);
  expect(choose(found.files, 'b.toml')).toMatchObject({ scene: { name: 'b.toml', files: [['a.toml', {}], ['x.obj', {}]] } });
});

test('a model alone, also with its materials and a text', async () => {
  expect(await kind(file('cow.obj'), file('cow.mtl'), file('README.txt', 'A cow.'))).toEqual({ model: 'cow.obj' });
  expect(await kind(file('a.stl'), file('b.ply'))).toEqual({ candidates: ['a.stl', 'b.ply'] });
});

test('a scene with a mistake is opened, so that the engine says what is wrong', async () => {
  expect(await kind(file('a.toml', 'snel = 1'), file('cow.obj'))).toMatchObject({ scene: 'a.toml' });
  expect(await kind(file('driver07.txt', 'nothing'), file('cow.obj'))).toMatchObject({ scene: 'driver07.txt' });
  expect(await kind(file('a.txt', 'nothing'))).toMatchObject({ scene: 'a.txt' });
  expect(await kind(file('scene', TOML))).toMatchObject({ scene: 'scene' });
});

test('what is no scene is refused in words', async () => {
  expect(await refusal(open())).toContain('There is no scene among these files');
  expect(await refusal(open(file('cat.png')))).toContain('There is no scene');
  expect(await refusal(open(file('a.mov'), file('b.pdf')))).toContain('There is no scene');
});

test('too much is refused before it is read', async () => {
  const large = { ...file('a.obj', '', 1.2e9), arrayBuffer: () => Promise.reject(new Error('was read')) };
  expect(await refusal(open(file('a.toml', TOML), large))).toMatch(/1200 MB, .* 1000 MB .* snell render/);
  expect(await kind(file('a.toml', TOML), file('film.mov', '', 5e9))).toEqual({ scene: 'a.toml', files: [] });
});

test('two files of one name, and files that cannot be read', async () => {
  expect(await refusal(open(file('a.toml', TOML), file('a.toml', TOML)))).toContain('two files a.toml');
  const lost = { ...file('a.toml'), arrayBuffer: () => Promise.reject(new DOMException('gone', 'NotFoundError')) };
  expect(await refusal(open(lost))).toContain('a.toml cannot be read');
});

test('names as a Mac writes them are those that people type', async () => {
  expect(await kind(file('a.toml', TOML), file('mo\u0308bel.obj'))).toEqual({ scene: 'a.toml', files: ['m\u00f6bel.obj'] });
});

/** An entry of a drop; a folder gives two of its entries at a time. */
function entry(path: string, inner?: () => FileSystemEntry[]): FileSystemEntry {
  const isFile = inner === undefined;
  const createReader = () => {
    const rest = [...inner!()];
    return { readEntries: (take: (entries: FileSystemEntry[]) => void) => take(rest.splice(0, 2)) };
  };
  const give = (take: (file: Readable) => void) => take(file(path.split('/').at(-1)!, path.endsWith('.toml') ? TOML : ''));
  return { fullPath: path, isFile, isDirectory: !isFile, createReader, file: give } as unknown as FileSystemEntry;
}

const drop = (...entries: FileSystemEntry[]) =>
  dropped({ items: entries.map((entry) => ({ webkitGetAsEntry: () => entry })) as unknown as DataTransferItemList, files: [] as unknown as FileList });

test('a folder is read to its end, with the folders in it', async () => {
  const models = entry('/set/models', () => ['a', 'b', 'c', 'd', 'e'].map((name) => entry(`/set/models/${name}.obj`)));
  const found = await drop(entry('/set', () => [entry('/set/scene.toml'), models, entry('/set/.git', () => [entry('/set/.git/x.toml')])]));
  expect(found).toMatchObject({ scene: { name: 'set/scene.toml' } });
  expect('scene' in found && found.scene.files.map(([name]) => name)).toEqual(['a', 'b', 'c', 'd', 'e'].map((name) => `set/models/${name}.obj`));
});

test('a folder without an end is not read for ever', async () => {
  const deep = (path: string): FileSystemEntry => entry(path, () => [deep(`${path}/a`)]);
  expect(await refusal(drop(deep('/a')))).toContain('deeper than 16');
  const wide = entry('/a', () => Array.from({ length: 20_001 }, (_, index) => entry(`/a/${index}.obj`)));
  expect(await refusal(drop(wide))).toContain('more than 20000 files');
});

test('without entries, files are taken', async () => {
  const transfer = { items: [{ webkitGetAsEntry: () => null }] as unknown as DataTransferItemList, files: [file('a.toml', TOML)] as unknown as FileList };
  expect(await dropped(transfer)).toMatchObject({ scene: { name: 'a.toml' } });
});
