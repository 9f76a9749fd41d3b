/** A text that makes no scene stays with its scene, whatever is opened meanwhile. */

import type { Page } from 'playwright-core';
import { expect, test } from 'vitest';
import { finished, studio } from './page';

const { on } = studio();

async function openBuiltin(page: Page, name: string): Promise<void> {
  await page.evaluate((name) => window.snell.open({ name, given: { builtin: name } }), name);
}

async function type(page: Page, text: string): Promise<void> {
  await page.getByRole('tab', { name: 'Source' }).click();
  await page.locator('.cm-content').click();
  await page.keyboard.press('Control+Home');
  await page.keyboard.type(text);
}

const draft = (page: Page) => page.evaluate(() => window.snell.draft.value);

test('undo brings back the scene before with the text that was being written', () =>
  on('#lecture/default', async (page) => {
    const before = await finished(page);
    await type(page, 'nonsense = 5\n');
    await page.getByRole('alert').getByText('nonsense').waitFor();
    const written = await draft(page);
    await openBuiltin(page, 'gallery/ball');
    expect(await draft(page)).toBe(null);
    expect(await page.getByRole('alert').count()).toBe(0);
    await page.locator('.cm-content').getByText('nonsense').waitFor({ state: 'detached' });

    await page.getByRole('button', { name: 'Undo' }).click();
    await page.getByRole('alert').getByText('nonsense').waitFor();
    expect(await draft(page)).toBe(written);
    await page.locator('.cm-content').getByText('nonsense').waitFor();
    expect(await finished(page)).toBe(before);

    // There and back again, and then it is mended.
    await page.getByRole('button', { name: 'Redo' }).click();
    await page.waitForFunction(() => window.snell.base.value!.name === 'gallery/ball');
    await page.getByRole('button', { name: 'Undo' }).click();
    await page.waitForFunction(() => window.snell.base.value!.name === 'lecture/default' && window.snell.draft.value !== null);
    await page.getByRole('button', { name: 'Undo' }).click();
    expect(await draft(page)).toBe(null);
    expect(await page.locator('.cm-content').innerText()).not.toMatch('nonsense');
    expect(await page.evaluate(() => window.snell.undoLabel.value)).toBe(null);
  }));

test('what was written at the last moment is not read into the scene that is opened', () =>
  on('#lecture/default', async (page) => {
    await finished(page);
    await type(page, '# Mine.\n');
    await openBuiltin(page, 'gallery/ball');
    await page.waitForFunction(() => window.snell.draft.value === null && window.snell.base.value!.name === 'gallery/ball');
    const text = () => page.evaluate(() => window.snell.revision.value!.text);
    expect(await text()).not.toMatch('Mine');
    await page.keyboard.press('Control+z');
    await page.waitForFunction(() => window.snell.base.value!.name === 'lecture/default');
    expect(await text()).toMatch('# Mine.');
  }));
