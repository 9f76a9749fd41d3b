/** Two pictures, one over the other. */

import { expect, test } from 'vitest';
import { edit, finished, OUT, save, studio } from './page';
import { nativePng } from './native';

const { on } = studio();

test('two models of light are compared, by pointer and by keyboard', () =>
  on('#lecture/default', async (page) => {
    const hash = await finished(page);
    await page.getByRole('button', { name: 'Compare' }).click();
    await page.getByRole('menuitem', { name: /real optics/ }).click();
    const slider = page.getByRole('slider', { name: /Compare: whitted/ });
    const value = async () => Number(await slider.getAttribute('aria-valuenow'));
    await slider.focus();
    const before = await value();
    await page.keyboard.press('ArrowRight');
    expect(await value()).toBe(before + 2);
    await page.waitForFunction(() => {
      const pictures = [window.snell.surface.canvas, window.snell.comparison.value!.surface.canvas].map((canvas) =>
        canvas.width === 512 ? canvas.getContext('2d')!.getImageData(0, 0, 512, 512).data : new Uint8ClampedArray(),
      );
      // Both are there as a whole, and not the same.
      return pictures.every((data) => data.length > 0 && data.every((value, at) => at % 4 !== 3 || value === 255)) && String(pictures[0]) !== String(pictures[1]);
    });
    await page.screenshot({ path: `${OUT}compare.png` });

    const { left, top, width, height } = await page.locator('.picture').evaluate((box) => box.getBoundingClientRect().toJSON() as DOMRect);
    await page.mouse.move(left + ((before + 2) / 100) * width, top + height / 2);
    await page.mouse.down();
    await page.mouse.move(left + 0.8 * width, top + height / 2);
    expect(await value()).toBe(80);
    // As far as it goes, though the pointer goes on.
    await page.mouse.move(left + 2 * width, top + height / 2);
    expect(await value()).toBe(100);
    await page.mouse.move(left + 0.25 * width, top + height / 2);
    await page.mouse.up();
    await page.mouse.move(left + 0.6 * width, top + height / 2);
    expect(await value()).toBe(25);
    // What lies open ends at the slider.
    const open = await page.locator('.other').evaluate((other) => getComputedStyle(other).clipPath);
    expect(open).toBe('inset(0px 75% 0px 0px)');

    await page.getByRole('button', { name: 'Stop comparing' }).click();
    expect(await finished(page)).toBe(hash);
  }));

test('what is saved beside a comparison is the picture', () =>
  on('#lecture/default', async (page) => {
    await finished(page);
    await page.getByRole('button', { name: 'Compare' }).click();
    await page.getByRole('menuitem', { name: 'With no bounce' }).click();
    await page.waitForFunction(() => window.snell.comparison.value!.surface.canvas.width === 512);
    expect((await save(page, 'Save picture')).equals(nativePng('lecture/default'))).toBe(true);
    await page.getByRole('slider', { name: /Compare: depth 0/ }).waitFor();
  }));

test('the picture as it was stays beside what becomes of it', () =>
  on('#lecture/default', async (page) => {
    await finished(page);
    const other = () => page.evaluate(() => window.snell.comparison.value!.surface.canvas.toDataURL());
    const before = await page.evaluate(() => window.snell.surface.canvas.toDataURL());
    await page.getByRole('button', { name: 'Compare' }).click();
    await page.getByRole('menuitem', { name: 'With the picture as it is now' }).click();
    await edit(page, ['material.glass.eta', '1.3']);
    await finished(page);
    expect(await other()).toBe(before);
    expect(await page.evaluate(() => window.snell.surface.canvas.toDataURL())).not.toBe(before);
  }));
