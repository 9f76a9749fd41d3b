/** The page on screens of many sizes: all of it can be reached, and nothing lies on anything else. */

import type { Page } from 'playwright-core';
import { expect, test } from 'vitest';
import { finished, OUT, pin, studio } from './page';

const { on } = studio();

const SCREENS: [what: string, width: number, height: number][] = [
  ['a laptop', 1280, 720],
  ['a tablet, wide', 1024, 768],
  ['a tablet, upright', 768, 1024],
];

test('nothing overlaps, and nobody scrolls sideways', () =>
  on('#lecture/default', async (page) => {
    await ready(page);
    for (const screen of SCREENS) await look(page, ...screen);
  }));

test('at 200 % it is the same', () =>
  on(
    '#lecture/default',
    async (page) => {
      await ready(page);
      await look(page, 'a laptop at 200 %', 640, 360);
    },
    { deviceScaleFactor: 2 },
  ));

async function ready(page: Page): Promise<void> {
  await finished(page);
  await page.waitForFunction(() => window.snellSpace != null);
}

/** All that the panel shows, on a screen of some size. */
async function look(page: Page, what: string, width: number, height: number): Promise<void> {
  await page.setViewportSize({ width, height });
  await pin(page, [300, 300]);
  for (const [tab, content] of [['Why?', '.ask'], ['Scene', '.properties'], ['Source', '.cm-content']] as const) {
    await page.getByRole('tab', { name: tab }).click();
    await page.locator(content).waitFor();
    expect(await faults(page), `${what}, ${tab}`).toEqual([]);
  }
  await page.getByRole('tab', { name: 'Why?' }).click();
  await page.evaluate(() => (location.hash = 'tour/5'));
  await page.getByRole('heading', { name: 'Upside down' }).waitFor();
  expect(await faults(page), `${what}, tour`).toEqual([]);
  await page.screenshot({ path: `${OUT}${width}x${height}.png`, fullPage: true });
  await page.getByRole('button', { name: 'Leave the tour' }).click();
}

/** Parts that overlap, or lie outside of the page. */
function faults(page: Page): Promise<string[]> {
  return page.evaluate(() => {
    const { scrollWidth, clientWidth, scrollHeight } = document.documentElement;
    const found: string[] = scrollWidth > clientWidth ? [`the page is ${scrollWidth} pixels wide`] : [];
    const visible = (selector: string) => [...document.querySelectorAll(selector)].filter((part) => part.getClientRects().length > 0);
    const apart = (selector: string) => {
      const boxes = visible(selector).map((part) => ({ name: part.className || part.textContent!.trim(), box: part.getBoundingClientRect() }));
      boxes.forEach(({ name, box }, at) => {
        // Half a pixel is a rounded one.
        if (box.left < -0.5 || box.right > clientWidth + 0.5) found.push(`${name} goes from ${box.left} to ${box.right}`);
        if (box.top + scrollY < -0.5 || box.bottom + scrollY > scrollHeight + 0.5) found.push(`${name} goes from ${box.top} down to ${box.bottom}`);
        if (box.width < 20 || box.height < 20) found.push(`${name} is ${box.width} x ${box.height}`);
        for (const other of boxes.slice(at + 1)) {
          const across = Math.min(box.right, other.box.right) - Math.max(box.left, other.box.left);
          const down = Math.min(box.bottom, other.box.bottom) - Math.max(box.top, other.box.top);
          if (across > 0.5 && down > 0.5) found.push(`${name} and ${other.name} overlap`);
        }
      });
    };
    apart('.head, .picture, .space, .side, .status');
    apart('.space-tools, .drawing');
    apart('.tour, .tabs, .panel');
    apart('.head button, .head h1');
    apart('.space-tools button, .space-tools select, .space-tools label');
    return found;
  });
}
