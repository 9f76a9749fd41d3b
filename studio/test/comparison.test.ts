/** A picture beside another one that has another size. */

import { expect, test } from 'vitest';
import { edit, finished, OUT, studio } from './page';

const { on } = studio();

test('a picture as it was lies over the same place when the size is changed', () =>
  on('#lecture/default', async (page) => {
    await finished(page);
    await page.getByRole('button', { name: 'Compare' }).click();
    await page.getByRole('menuitem', { name: 'With the picture as it is now' }).click();
    await edit(page, ['render.size', '[200, 150]']);
    await finished(page);
    const lieOverEachOther = () =>
      page.evaluate(() => {
        const canvases = [window.snell.surface.canvas, window.snell.comparison.value!.surface.canvas];
        const places = canvases.map((canvas) => {
          const { left, top, right, bottom } = canvas.getBoundingClientRect();
          return [left, top, right, bottom].map(Math.round).join();
        });
        return places[0] === places[1];
      });
    expect(await page.evaluate(() => window.snell.comparison.value!.surface.canvas.width)).toBe(512);
    await expect.poll(lieOverEachOther).toBe(true);
    await page.screenshot({ path: `${OUT}sizes.png` });
    // Options may have a size, too.
    await page.evaluate(() => window.snell.compare('depth 0', { depth: 0, size: [50, 50] }));
    await page.waitForFunction(() => window.snell.comparison.value!.surface.canvas.width === 50);
    await expect.poll(lieOverEachOther).toBe(true);
  }));
