/** What a picture leaves out: the light that its pixels have lost. */

import { execFileSync } from 'node:child_process';
import type { Page } from 'playwright-core';
import { expect, test } from 'vitest';
import { FROM } from '../src/engine/lost';
import { edit, finished, OUT, placeOf, studio } from './page';

const { on } = studio();
const snell = process.env.SNELL ?? '../target/ci/snell';

const panel = (page: Page) => page.getByRole('region', { name: 'What is left out?' });

/** How thick the veil over a pixel is. */
async function veilAt(page: Page, pixel: [number, number]): Promise<number> {
  const { x, y } = await placeOf(page, pixel);
  return page.evaluate(
    ([x, y]) => {
      const canvas = document.querySelector<HTMLCanvasElement>('.overlay')!;
      const { left, top } = canvas.getBoundingClientRect();
      const ratio = window.devicePixelRatio;
      return canvas.getContext('2d')!.getImageData(Math.floor((x! - left) * ratio), Math.floor((y! - top) * ratio), 1, 1).data[3]!;
    },
    [x, y],
  );
}

test('what pixels have lost is what their rays say, and a bar shows its pixels', () =>
  on('#lecture/default', async (page) => {
    await finished(page);
    await edit(page, ['render.max_depth', '1']);
    await finished(page);
    const { pixels, bins, worst } = await page.evaluate(() => {
      const { lost } = window.snell.outcome.value!;
      return { ...lost!, bins: [...lost!.bins] };
    });
    const said = execFileSync('sh', ['-c', `exec "$@" 2>&1`, 'sh', snell, 'render', 'lecture/default', '--depth', '1', '--progress', 'json', '-o', `${OUT}lost.npy`], { encoding: 'utf8' });
    const { lost } = JSON.parse(said.trim().split('\n').at(-1)!) as { lost: { worst: number; worst_pixel: [number, number] } };
    expect(worst).toEqual({ pixel: lost.worst_pixel, share: lost.worst });

    const counted = FROM.map((_, bin) => bins.filter((of) => of === bin).length);
    expect(pixels).toEqual(counted);
    expect(counted.slice(1).filter((number) => number > 0).length).toBeGreaterThan(0);
    const places = FROM.flatMap((_, bin) => [bins.indexOf(bin), bins.lastIndexOf(bin)]).filter((at) => at >= 0);
    for (const at of places) {
      const share = await page.evaluate(async (pixel) => {
        const { samples } = await window.snell.engine.ask({ ask: 'explain', pixel });
        return samples.reduce((sum, { lost: [r, g, b] }) => sum + (r + g + b) / 3, 0) / samples.length;
      }, [at % 512, Math.floor(at / 512)] as [number, number]);
      const bin = bins[at]!;
      // The engine counts in whole units of 2⁻³², rounded down.
      expect(share + 2 ** -32, `pixel ${at}`).toBeGreaterThanOrEqual(FROM[bin]!);
      expect(share, `pixel ${at}`).toBeLessThanOrEqual(bin === 0 ? 2 ** -32 : (FROM[bin + 1] ?? Infinity));
    }

    // A pixel of the bar and one that has lost nothing, with neighbours of their kind: on the screen pixels may lie between two.
    const bin = bins.find((of) => of > 0)!;
    const sides = [-1, 0, 1];
    const [inside, outside] = [bin, 0].map((wanted): [number, number] => {
      const at = bins.findIndex((_, at) => sides.every((down) => sides.every((across) => bins[at + 512 * down + across] === wanted)));
      return [at % 512, Math.floor(at / 512)];
    });
    const bar = panel(page).getByRole('button', { name: `: ${pixels[bin]!.toLocaleString('en')} pixels` }).first();
    await bar.scrollIntoViewIfNeeded();
    const veils = async () => [await veilAt(page, inside!), await veilAt(page, outside!)].map((veil) => veil > 0);
    await expect.poll(veils).toEqual([false, false]);
    await bar.hover();
    await expect.poll(veils).toEqual([false, true]);
    await page.mouse.move(5, 5);
    await expect.poll(veils).toEqual([false, false]);
    await bar.focus();
    await page.keyboard.press('Enter');
    expect(await bar.getAttribute('aria-pressed')).toBe('true');
    await expect.poll(veils).toEqual([false, true]);
    await page.screenshot({ path: `${OUT}lost.png` });
    await page.keyboard.press('Enter');
    await expect.poll(veils).toEqual([false, false]);

    await panel(page).getByRole('button', { name: 'has lost most' }).click();
    expect(await page.evaluate(() => window.snell.pinned.value)).toEqual(worst.pixel);
  }));

test('another picture beside it changes nothing of what is told, and a picture that loses nothing says so', () =>
  on('#lecture/default', async (page) => {
    await finished(page);
    await edit(page, ['render.max_depth', '1']);
    await finished(page);
    const before = await panel(page).innerText();
    await page.evaluate(() => window.snell.compare('depth 5', { depth: 5 }));
    // Its first pass has come.
    await page.waitForFunction(() => {
      const { canvas } = window.snell.comparison.value!.surface;
      return canvas.width === 512 && canvas.getContext('2d')!.getImageData(256, 256, 1, 1).data[3] === 255;
    });
    expect(await panel(page).innerText()).toBe(before);
    await page.evaluate(() => window.snell.compare(null));
    const dull = ['glass', 'red', 'green', 'blue'].map((name): [string, string] => [`material.${name}.kr`, '0']);
    await edit(page, ['material.glass.ko', '1'], ...dull);
    await finished(page);
    await panel(page).getByText('every ray of this picture was followed to its end').waitFor();
    // Mirrors that mirror next to nothing: their rays are not followed, and weigh less than a unit.
    await edit(page, ...dull.map(([key]): [string, string] => [key, '1e-6']));
    await finished(page);
    await panel(page).getByText('Next to nothing').waitFor();
  }));
