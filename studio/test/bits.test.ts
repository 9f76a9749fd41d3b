/** The page shows and saves the bits of the command line. Usage: SNELL=../target/ci/snell npx vitest run test */

import { PNG } from 'pngjs';
import { expect, test } from 'vitest';
import { begun, edit, finished, openText, OUT, save, shown, studio } from './page';
import { nativeHash, nativePng, scenesOf, textOf } from './native';

const { on } = studio();

/** Meshes, one within the other; diamond with its dispersion; lathes and textures; three clear things with priorities; many plates. */
const GALLERY = ['bubbles', 'brilliant', 'lens', 'pencil', 'plates'].map((name) => `gallery/${name}`);

test('it opens, renders, and shows and saves what the command line does', () =>
  on('', async (page) => {
    expect(await finished(page)).toBe(nativeHash('lecture/default'));
    await page.getByText('the same bits as the command line').waitFor();
    await page.screenshot({ path: `${OUT}first.png` });
    expect((await save(page, 'Save picture')).equals(nativePng('lecture/default'))).toBe(true);
  }));

for (const threads of [1, 2]) {
  test(`with ${threads === 1 ? 'one worker' : 'two workers'} each film is that of the command line`, () =>
    on(
      '#lecture/default',
      async (page) => {
        const films: Record<string, string> = { default: await finished(page) };
        // With the desk.
        expect(page.workers().length).toBe(threads + 1);
        const expected: Record<string, string> = { default: nativeHash('lecture/default') };
        for (const name of [...scenesOf('lecture'), ...GALLERY]) {
          const size: [number, number] = name === 'gallery/brilliant' ? [32, 24] : [64, 64];
          await openText(page, name, textOf(name, size));
          films[name] = await finished(page);
          expected[name] = nativeHash(name, '--set', `render.size=[${size.join()}]`);
        }
        expect(films).toEqual(expected);
      },
      { threads },
    ));
}

test('at 100 % the screen shows the pixels of the file', () =>
  on(
    '#lecture/default',
    async (page) => {
      await finished(page);
      // The picture fits with a margin of 16 pixels: so high that it is as large as it is.
      const { height } = (await page.locator('.picture').boundingBox())!;
      const viewport = page.viewportSize()!;
      await page.setViewportSize({ ...viewport, height: viewport.height + 512 + 2 * 16 - Math.round(height) });
      await page.getByRole('button', { name: /^100 %/ }).waitFor();
      const { x, y } = (await page.locator('.picture > canvas').first().boundingBox())!;
      // Browsers lay boxes on whole pixels.
      const clip = { x: Math.round(x), y: Math.round(y), width: 512, height: 512 };
      const screen = PNG.sync.read(await page.screenshot({ path: `${OUT}pixels.png`, clip, style: '.zoom { visibility: hidden }' }));
      const file = PNG.sync.read(nativePng('lecture/default'));
      expect(differences(screen, file)).toBe(0);
    },
    { viewport: { width: 1920, height: 700 } },
  ));

test('a picture that was stopped is saved as it is shown, black and all', () =>
  on('#lecture/default', async (page) => {
    await begun(page);
    // Each pixel takes long: of most there is only a coarse picture then.
    await edit(page, ['render.spp', '1000'], ['render.size', '[300, 200]']);
    await page.waitForFunction(() => window.snell.surface.canvas.width === 300 && window.snell.progress.value.pixels > 0);
    await page.getByRole('button', { name: 'Stop' }).click();
    const file = PNG.sync.read(await save(page, 'Save picture'));
    expect(await page.evaluate(() => window.snell.outcome.value)).toBe(null);
    // All that was under way when it was stopped has come before the file.
    expect(differences(await shown(page), file)).toBe(0);
    // It is the picture, not the black that there was before.
    expect(file.data.filter((value, at) => at % 4 !== 3 && value > 0).length).toBeGreaterThan((file.width * file.height) / 2);
  }));

/** How many pixels differ. */
function differences(one: PNG, other: PNG): number {
  expect([one.width, one.height]).toEqual([other.width, other.height]);
  const [before, after] = [one, other].map(({ data }) => new Uint32Array(new Uint8Array(data).buffer)) as [Uint32Array, Uint32Array];
  return before.reduce((count, pixel, at) => count + Number(pixel !== after[at]), 0);
}
