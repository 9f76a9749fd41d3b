/** Fingers instead of a mouse. */

import type { Page } from 'playwright-core';
import { expect, test } from 'vitest';
import { finished, placeOf, studio } from './page';

const { on } = studio();

type Place = { x: number; y: number };

test('a tap asks, a finger that rests shows rays, one that moves drags, two fingers zoom, and a finger moves what was zoomed', () =>
  on(
    '#lecture/default',
    async (page) => {
      const before = await finished(page);
      const { fingers, client } = await touching(page);
      const rests = await placeOf(page, [300, 300]);
      await client.send('Input.dispatchTouchEvent', { type: 'touchStart', touchPoints: [rests] });
      await page.waitForFunction(() => window.snell.tree.value?.pixel.join() === '300,300');
      expect(await page.evaluate(() => window.snell.pinned.value)).toBe(null);
      await client.send('Input.dispatchTouchEvent', { type: 'touchEnd', touchPoints: [] });
      await page.waitForFunction(() => window.snell.pinned.value?.join() === '300,300');
      const tapped = await placeOf(page, [280, 320]);
      await page.touchscreen.tap(tapped.x, tapped.y);
      await page.waitForFunction(() => window.snell.pinned.value?.join() === '280,320' && window.snell.tree.value?.pixel.join() === '280,320');

      const ball = await placeOf(page, [256, 256]);
      await fingers([[ball, { x: ball.x + 60, y: ball.y }]]);
      await page.waitForFunction(() => window.snell.revision.value!.scene.sphere![0]!.center[0] > 52);
      await page.getByRole('button', { name: 'Undo' }).tap();
      await page.waitForFunction(() => window.snell.revision.value!.scene.sphere![0]!.center[0] === 50);
      expect(await finished(page)).toBe(before);
      expect(await page.evaluate(() => window.snell.undoLabel.value)).toBe(null);

      // Twice as far apart, and a little to the right.
      const about = await placeOf(page, [256, 256]);
      const fitted = await zoomOf(page);
      const beside = (distance: number): Place => ({ x: about.x + distance, y: about.y });
      await fingers([[beside(-30), beside(-50)], [beside(30), beside(70)]]);
      expect((await zoomOf(page)) / fitted).toBeCloseTo(2, 5);
      // Pictures lie on whole pixels: half a one before, which is twice as large now, and half a one again.
      const zoomed = await placeOf(page, [256, 256]);
      expect(Math.abs(zoomed.x - about.x - 10)).toBeLessThanOrEqual(1.5);
      expect(Math.abs(zoomed.y - about.y)).toBeLessThanOrEqual(1.5);
      // The fingers have pinned nothing, and moved nothing.
      expect(await page.evaluate(() => window.snell.pinned.value)).toEqual([280, 320]);
      expect(await page.evaluate(() => window.snell.undoLabel.value)).toBe(null);

      // Nothing is met there that could be dragged instead.
      const nothing = await placeOf(page, [140, 440]);
      await fingers([[nothing, { x: nothing.x + 30, y: nothing.y - 20 }]]);
      const moved = await placeOf(page, [140, 440]);
      expect(moved.x - nothing.x).toBeGreaterThan(20);
      expect(moved.y - nothing.y).toBeLessThan(-10);
    },
    { hasTouch: true },
  ));

test('a finger turns the drawing', () =>
  on(
    '#lecture/default',
    async (page) => {
      await page.waitForFunction(() => window.snellSpace != null);
      const eye = () => page.evaluate(() => window.snellSpace!.viewer['drawing']!.stage.camera.position.toArray());
      const before = await eye();
      const { x, y, height } = (await page.locator('.drawing canvas').first().boundingBox())!;
      const { fingers } = await touching(page);
      await fingers([[{ x: x + 40, y: y + 0.7 * height }, { x: x + 140, y: y + 0.7 * height }]]);
      const after = await eye();
      expect(Math.hypot(...after.map((value, at) => value - before[at]!))).toBeGreaterThan(0.1 * Math.hypot(...before));
    },
    { hasTouch: true },
  ));

/** What moves fingers over the page, each from one place to another, in steps. */
async function touching(page: Page) {
  const client = await page.context().newCDPSession(page);
  const fingers = async (ways: [from: Place, to: Place][]): Promise<void> => {
    const at = (part: number) => ways.map(([from, to], id) => ({ x: from.x + part * (to.x - from.x), y: from.y + part * (to.y - from.y), id }));
    await client.send('Input.dispatchTouchEvent', { type: 'touchStart', touchPoints: at(0) });
    for (let step = 1; step <= 5; step++) {
      await client.send('Input.dispatchTouchEvent', { type: 'touchMove', touchPoints: at(step / 5) });
      // A hand is not faster than the screen.
      await page.evaluate(() => new Promise(requestAnimationFrame));
    }
    await client.send('Input.dispatchTouchEvent', { type: 'touchEnd', touchPoints: [] });
  };
  return { fingers, client };
}

/** Pixels of the page for each of the picture's. */
function zoomOf(page: Page): Promise<number> {
  return page.evaluate(() => window.snell.surface.canvas.getBoundingClientRect().width / window.snell.surface.canvas.width);
}
