/** The tour and the exercises. */

import type { Page } from 'playwright-core';
import { expect, test } from 'vitest';
import { STEPS } from '../src/tour/steps';
import { edit, finished, OUT, pin, placeOf, studio } from './page';

const { on } = studio();

const inScene = (page: Page) => page.getByRole('tab', { name: 'Scene' }).click();
const type = async (page: Page, label: string, text: string) => {
  const field = page.getByLabel(label, { exact: true });
  await field.fill(text);
  await field.press('Enter');
};
const chooseGlass = async (page: Page) => {
  await inScene(page);
  const chip = page.getByRole('button', { name: 'glass', exact: true });
  // It may be chosen since the step before.
  if ((await chip.getAttribute('aria-pressed')) === 'false') await chip.click();
};

/** What finds the answer of each step. */
const ANSWERS: ((page: Page) => Promise<void>)[] = [
  (page) => pin(page, [256, 256]),
  async (page) => {
    await inScene(page);
    await type(page, 'Depth', '0');
  },
  async (page) => {
    await inScene(page);
    await type(page, 'Depth', '3');
    await page.waitForFunction(() => window.snell.revision.value!.scene.render.max_depth === 3);
    await page.getByRole('tab', { name: 'Why?' }).click();
    await pin(page, [248, 168]);
  },
  async (page) => {
    await chooseGlass(page);
    await type(page, 'Index', '1.5');
  },
  (page) => pin(page, [300, 300]),
  async (page) => {
    await chooseGlass(page);
    await page.getByLabel('Preset').selectOption('Diamond');
  },
  (page) => pin(page, [188, 164]),
  (page) => page.getByRole('button', { name: 'green', exact: true }).click(),
  (page) => pin(page, [200, 360]),
  (page) => pin(page, [248, 168]),
  async (page) => {
    await inScene(page);
    await page.getByLabel('Model of light').selectOption('whitted');
  },
  (page) => pin(page, [192, 192]),
];

/** The step is there, with its scene and its question. */
async function asked(page: Page, number: number): Promise<void> {
  const { title, scene, edits = [] } = STEPS[number - 1]!;
  await page.getByText(`Step ${number} of 12`).waitFor();
  await page.getByRole('heading', { name: title }).waitFor();
  await page.waitForFunction(
    ([scene, lines]) => {
      const { base, pristine, revision } = window.snell;
      return base.value?.name === scene && (lines.length === 0 ? pristine.value : lines.every((line) => revision.value!.text.includes(line)));
    },
    [scene, edits.map(([key, value]) => `\n${key.split('.').at(-1)} = ${value}\n`)] as const,
  );
  expect(await page.locator('.task').innerText()).toMatch(/^Your turn\. /);
  expect(await page.locator('.answer').count()).toBe(0);
}

test('the tour is walked by its buttons, and each step is found with the tools', () =>
  on('#lecture/quarter', async (page) => {
    const before = await finished(page);
    expect(ANSWERS.length).toBe(12);
    await page.getByRole('button', { name: 'Learn' }).click();
    await page.getByRole('menuitem', { name: /Tour/ }).click();
    for (const [at, answer] of ANSWERS.entries()) {
      await asked(page, at + 1);
      await answer(page);
      await page.getByText('✓ Found.').waitFor();
      expect(await page.locator('.answer').innerText()).toBe(STEPS[at]!.answer);
      if (at === 4) await page.screenshot({ path: `${OUT}tour.png` });
      if (at < 11) await page.getByRole('button', { name: 'Next', exact: true }).click();
    }
    await page.getByRole('button', { name: 'Back' }).click();
    await asked(page, 11);
    await page.getByRole('button', { name: 'Next', exact: true }).click();
    await page.getByRole('button', { name: 'Finish' }).click();
    await page.waitForFunction(() => window.snell.base.value?.name === 'lecture/quarter');
    expect(await finished(page)).toBe(before);
    expect(new URL(page.url()).hash).toBe('');
  }));

test('each step has an address, asks, and shows its answer to those who want it', () =>
  on('#tour/12', async (page) => {
    for (let number = 12; number >= 1; number--) {
      await page.evaluate((number) => (location.hash = `tour/${number}`), number);
      await asked(page, number);
      await page.getByRole('button', { name: 'Show the answer' }).click();
      expect(await page.locator('.answer').innerText()).toBe(STEPS[number - 1]!.answer);
      expect(await page.locator('.task').innerText()).toMatch(/^Your turn\. /);
    }
  }));

test('the own scene is still there after the tour, and after a reload', () =>
  on('#lecture/default', async (page) => {
    await finished(page);
    await edit(page, ['material.glass.eta', '1.77']);
    await page.getByRole('button', { name: 'Learn' }).click();
    await page.getByRole('menuitem', { name: /Tour/ }).click();
    await page.getByRole('heading', { name: 'Four spheres' }).waitFor();
    await page.waitForFunction(() => window.snell.revision.value!.scene.material!.glass!.eta === 2);
    await page.getByRole('button', { name: 'Leave the tour' }).click();
    await page.waitForFunction(() => window.snell.revision.value!.scene.material!.glass!.eta === 1.77);
    await page.reload();
    await page.waitForFunction(() => window.snell?.revision.value?.scene.material!.glass!.eta === 1.77);
  }));

test('exercises tell right from wrong, one after the other', () =>
  on('#exercise/bend', async (page) => {
    await page.getByText('At which angle does it go on?').waitFor();
    const answer = page.getByLabel('Your answer');
    const check = () => page.getByRole('button', { name: 'Check' }).click();
    await answer.fill('a lot');
    await check();
    await page.getByText('A number is expected').waitFor();
    await answer.fill('51.3');
    await check();
    await page.getByText('✗ Not quite.').waitFor();
    await page.getByRole('button', { name: 'Try again' }).click();
    await answer.fill('31');
    await check();
    await page.getByText('✓ Right.').waitFor();

    await page.getByRole('button', { name: 'Next exercise' }).click();
    await page.getByText('Click the place in the picture').waitFor();
    await finished(page);
    // Nothing tells the answer before.
    const there = await placeOf(page, [300, 180]);
    await page.mouse.move(there.x, there.y);
    await page.waitForFunction(() => window.snell.hovered.value !== null);
    expect(await page.evaluate(() => window.snell.tree.value)).toBe(null);
    await check();
    await page.getByText('Choose an answer first.').waitFor();
    await page.mouse.click(there.x, there.y);
    await check();
    // A ray that went straight on would leave at the pixel where it came in.
    await page.getByText('✗ Not quite.').waitFor();
    await page.getByRole('button', { name: 'Try again' }).click();
    const right = await placeOf(page, [356, 227]);
    await page.mouse.click(right.x, right.y);
    await check();
    await page.getByText('✓ Right.').waitFor();

    await page.getByRole('button', { name: 'Next exercise' }).click();
    await page.getByText('What does it meet behind it?').waitFor();
    await answer.selectOption('blue');
    await check();
    await page.getByText('✗ Not quite.').waitFor();
    await page.getByRole('button', { name: 'Try again' }).click();
    await answer.selectOption('red');
    await check();
    await page.getByText('✓ Right.').waitFor();
    expect(await page.getByRole('button', { name: 'Next exercise' }).count()).toBe(0);
    await page.getByRole('button', { name: 'Leave the exercises' }).click();
    await page.getByRole('heading', { name: 'What does it meet?' }).waitFor({ state: 'detached' });
  }));
