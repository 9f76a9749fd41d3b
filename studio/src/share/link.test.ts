import { readFileSync } from 'node:fs';
import { deflateSync } from 'node:zlib';
import { expect, test } from 'vitest';
import { decode, encode, LinkError, MAX_LINK } from './link';

const TEXT = readFileSync(new URL('../../../scenes/lecture/default.toml', import.meta.url), 'utf8');

/** A link of anything. */
const linkOf = (bytes: Uint8Array, version = '1') => `#scene=${version}.${deflateSync(bytes).toString('base64url')}`;

function packed(head: unknown, files = new Uint8Array()): Uint8Array {
  const json = Buffer.from(JSON.stringify(head));
  const length = Buffer.alloc(4);
  length.writeUInt32BE(json.length);
  return Buffer.concat([length, json, files]);
}

const noise = (length: number) => Uint8Array.from({ length }, (_, index) => (Math.sin(index) * 1e6) & 255);
const refused = async (link: string) => {
  const error: unknown = await decode(link).then((scene) => scene, (error: unknown) => error);
  expect(error).toBeInstanceOf(LinkError);
  return (error as LinkError).message;
};

test('a scene comes back as it was, with its files and its view', async () => {
  const scenes = [
    { name: 'lecture/default', text: TEXT, files: [], view: { pixel: [1, 2] } },
    { name: 'a "b" 🔮.toml', text: '\uFEFF# 🔮\r\nsnell = 1\r\n', files: [['models/ü.obj', noise(3000)], ['empty', new Uint8Array()]] as [string, Uint8Array][] },
    { name: '', text: '', files: [] },
  ];
  for (const scene of scenes) {
    const link = await encode(scene);
    expect(link).toMatch(/^#scene=1\.[\w-]+$/);
    expect(await decode(link)).toEqual(scene);
    expect(await decode(link.replace('=', '%3D').replace('.', '%2e'))).toEqual(scene);
  }
});

test('the lecture’s scene fits into a message', async () => {
  expect((await encode({ name: 'lecture/default', text: TEXT })).length).toBeLessThan(1500);
});

test('other fragments are no scenes', async () => {
  for (const fragment of ['', '#', '#tour/5', '#scene', 'scene=1.x']) expect(await decode(fragment)).toBeNull();
});

test('what is too large is refused, with its size', async () => {
  const files: [string, Uint8Array][] = [['noise', noise(40_000)]];
  await expect(encode({ name: 'a', text: TEXT, files })).rejects.toThrow(/\b5\d kB, where 32 kB .* Save it as a file/);
  await expect(encode({ name: 'a', text: TEXT, files: [['zeros', new Uint8Array(9 << 20)]] })).rejects.toThrow(/10 MB, where 32 kB/);
  const most = await encode({ name: 'a', text: '', files: [['noise', noise(24_000)]] });
  expect(most.length).toBeLessThanOrEqual(MAX_LINK);
});

test('a link that was cut off anywhere is damaged', async () => {
  const link = await encode({ name: 'a', text: TEXT });
  for (let end = '#scene='.length; end < link.length; end += 7) expect(await refused(link.slice(0, end))).toContain('damaged');
});

test('a link in which one letter has changed is damaged, never another scene', async () => {
  const scene = { name: 'a', text: 'snell = 1\nambient = 0.2\n', files: [] };
  const link = await encode(scene);
  for (let at = '#scene=1.'.length; at < link.length; at += 1) {
    const changed = link.slice(0, at) + (link[at] === 'A' ? 'B' : 'A') + link.slice(at + 1);
    // Some bits mean nothing, like how hard it was to compress.
    const read = await decode(changed).catch((error: unknown) => error);
    if (!(read instanceof LinkError)) expect(read).toEqual(scene);
  }
});

test('what is no scene is damaged', async () => {
  const head = { name: 'a', text: 'b', files: [['c', 3]] };
  expect(await decode(linkOf(packed(head, noise(3))))).toMatchObject({ name: 'a' });
  const wrong = [
    packed(head, noise(2)), packed(head, noise(4)), packed({ ...head, files: [['c', -1], ['d', 4]] }, noise(3)),
    packed({ ...head, files: [['c', 1e300]] }), packed({ ...head, files: {} }), packed({ ...head, name: 1 }), packed(null), packed([]),
    new Uint8Array(), new Uint8Array([0, 0]), new Uint8Array([255, 255, 255, 255, 123]), new Uint8Array([0, 0, 0, 1, 255]),
  ];
  for (const bytes of wrong) expect(await refused(linkOf(bytes))).toContain('damaged');
  for (const link of ['#scene=', '#scene=1', '#scene=1.', '#scene=1.%%', '#scene=1.ä', '#scene=1.A', '#scene=x.AAAA']) {
    expect(await refused(link)).toContain('damaged');
  }
});

test('a bomb does not go off', async () => {
  expect(await refused(linkOf(new Uint8Array(20 << 20)))).toContain('more than 8 MB');
  expect(await refused(linkOf(new Uint8Array(200 << 20)))).toMatch(/This link has 2\d\d kB/);
});

test('a newer version says so', async () => {
  expect(await refused('#scene=2.abc')).toContain('newer version');
});
