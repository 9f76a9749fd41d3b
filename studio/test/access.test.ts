/** By keyboard, and for screen readers. */

import { readFileSync } from 'node:fs';
import { expect, test } from 'vitest';
import { finished, pin, studio } from './page';

const { on } = studio();

test('all of it works by keyboard alone', () =>
  on('#lecture/default', async (page) => {
    await finished(page);
    const focused = () => page.evaluate(() => document.activeElement?.className ?? '');
    for (let count = 0; count < 30 && (await focused()) !== 'picture'; count++) await page.keyboard.press('Tab');
    expect(await focused()).toBe('picture');
    await page.keyboard.press('ArrowRight');
    await page.waitForFunction(() => window.snell.pinned.value !== null && window.snell.tree.value !== null);
    await page.keyboard.press('Shift+ArrowDown');
    await page.waitForFunction(() => window.snell.pinned.value?.[1] === 266);
    await page.keyboard.press('+');
    await page.keyboard.press('0');
    await page.keyboard.press('Escape');
    await page.waitForFunction(() => window.snell.pinned.value === null);
    await page.getByRole('button', { name: 'Learn' }).focus();
    await page.keyboard.press('Enter');
    await page.locator('[role=menuitem]:focus').waitFor();
    await page.keyboard.press('ArrowDown');
    await page.keyboard.press('ArrowUp');
    await page.keyboard.press('Enter');
    await page.getByRole('heading', { name: 'Four spheres' }).waitFor();
  }));

for (const colorScheme of ['light', 'dark'] as const) {
  test(`axe finds nothing on a ${colorScheme} page, whatever is open`, () =>
    on(
      '#lecture/default',
      async (page) => {
        await finished(page);
        await page.addScriptTag({ content: readFileSync('node_modules/axe-core/axe.min.js', 'utf8') });
        const check = async () => {
          const { violations } = await page.evaluate(() => (window as unknown as { axe: typeof import('axe-core') }).axe.run());
          expect(violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html).join(' ').slice(0, 300)}`)).toEqual([]);
        };
        await check();
        await pin(page, [300, 300]);
        await page.getByText('seen through').first().waitFor();
        await check();
        for (const [tab, content] of [['Scene', '.properties'], ['Source', '.cm-content']] as const) {
          await page.getByRole('tab', { name: tab }).click();
          await page.locator(content).waitFor();
          await check();
        }
        await page.getByRole('button', { name: 'lecture/default' }).click();
        await check();
      },
      { colorScheme },
    ));
}
