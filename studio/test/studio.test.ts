/** What people do in the studio, as they do it. Usage: SNELL=../target/ci/snell npx vitest run test */

import { execFileSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import type { Server } from 'node:http';
import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, expect, test } from 'vitest';
import { finished, launch, open, OUT, placeOf, serve } from './page';

const snell = process.env.SNELL ?? '../target/ci/snell';
let browser: Browser;
let server: Server;
let url: string;

beforeAll(async () => {
  browser = await launch();
  ({ url, server } = await serve());
});
afterAll(async () => {
  await browser?.close();
  server?.close();
});

/** Opens a page, does something in it, and expects no trouble. */
async function on(fragment: string, act: (page: Page) => Promise<void>, options: Parameters<typeof open>[2] = {}): Promise<void> {
  const { page, trouble } = await open(browser, url + fragment, options);
  await act(page);
  expect(trouble).toEqual([]);
  await page.context().close();
}

function nativeHash(name: string, ...args: string[]): string {
  const lines = execFileSync('sh', ['-c', `exec "$@" 2>&1`, 'sh', snell, 'render', name, ...args, '--progress', 'json', '-o', `${OUT}native.npy`], { encoding: 'utf8' });
  return (JSON.parse(lines.trim().split('\n').at(-1)!) as { film_sha256: string }).film_sha256;
}

const text = (page: Page) => page.evaluate(() => window.snell.revision.value!.text);
const center = (page: Page) => page.evaluate(() => window.snell.revision.value!.scene.sphere!.find(({ name }) => name === 'glass')!.center);

test('it opens, renders, and has the bits of the command line', () =>
  on('', async (page) => {
    expect(await finished(page)).toBe(nativeHash('lecture/default'));
    await page.getByText('the same bits as the command line').waitFor();
    await page.screenshot({ path: `${OUT}first.png` });
  }));

test('the sphere is dragged in the picture, and the drag is one step to undo', () =>
  on('#lecture/default', async (page) => {
    await finished(page);
    const from = await placeOf(page, [256, 256]);
    await page.mouse.move(from.x, from.y);
    await page.waitForFunction(() => window.snell.tree.value?.pixel[0] === 256);
    await page.mouse.down();
    for (let step = 1; step <= 10; step++) await page.mouse.move(from.x + 6 * step, from.y + 3 * step);
    await page.mouse.up();
    await page.waitForFunction(() => window.snell.revision.value!.scene.sphere![0]!.center[0] > 53);
    await finished(page);
    const moved = await center(page);
    expect(moved[1]).toBeLessThan(50);
    expect(moved[2]).toBe(50);
    // The place under the pointer is still the sphere's: it has followed.
    expect(await text(page)).toMatch('# left, right, bottom, top');
    await page.keyboard.press('Control+z');
    await page.waitForFunction(() => window.snell.revision.value!.scene.sphere![0]!.center[0] === 50);
    expect(await finished(page)).toBe(nativeHash('lecture/default'));
  }));

test('a clicked pixel says why, and its shares sum to all of it', () =>
  on('#lecture/default', async (page) => {
    await finished(page);
    const at = await placeOf(page, [300, 300]);
    await page.mouse.click(at.x, at.y);
    await page.getByText('seen through').first().waitFor();
    const shares = await page.evaluate(() => {
      const { samples, color } = window.snell.tree.value!;
      const sum = samples.flatMap(({ nodes }) => nodes).reduce((sum, { contribution }) => sum.map((value, at) => value + contribution[at]!), [0, 0, 0]);
      return { sum, color };
    });
    // Of one sample, in the order of the nodes: the same bits.
    expect(shares.sum).toEqual(shares.color);
    await page.screenshot({ path: `${OUT}pixel.png` });
    await page.keyboard.press('ArrowRight');
    await page.waitForFunction(() => window.snell.tree.value?.pixel[0] === 301);
  }));

test('a text that is broken says where, keeps the picture, and is taken back by undo', () =>
  on('#lecture/default', async (page) => {
    const before = await finished(page);
    await page.getByRole('tab', { name: 'Source' }).click();
    await page.locator('.cm-content').click();
    await page.keyboard.press('Control+Home');
    await page.keyboard.type('nonsense = 5\n');
    await page.getByRole('alert').getByText('nonsense').waitFor();
    expect(await page.evaluate(() => window.snell.outcome.value!.sha256)).toBe(before);
    await page.keyboard.press('Control+z');
    await page.waitForFunction(() => window.snell.draft.value === null);
    expect(await page.locator('.cm-content').innerText()).not.toMatch('nonsense');
  }));

test('the work survives a reload', () =>
  on('#lecture/default', async (page) => {
    await finished(page);
    await page.evaluate(() => window.snell.edit([['material.glass.eta', '1.5']], { label: 'test' }));
    await page.waitForFunction(() => window.snell.revision.value!.scene.material!.glass!.eta === 1.5);
    const hash = await finished(page);
    await page.goto(url);
    await page.reload();
    expect(await finished(page)).toBe(hash);
  }));

test('a link holds the whole scene', () =>
  on('#gallery/ball', async (page) => {
    await finished(page);
    await page.evaluate(() => window.snell.edit([['render.size', '[60, 40]'], ['material."glass".eta', '1.7']], { label: 'test' }));
    await page.waitForFunction(() => window.snell.revision.value!.size[0] === 60);
    const hash = await finished(page);
    await page.getByRole('button', { name: 'Share' }).click();
    await page.getByRole('menuitem', { name: 'Copy a link' }).click();
    await page.getByText('The link is copied').waitFor();
    const link = await page.evaluate(() => navigator.clipboard.readText());
    const other = await open(browser, link);
    expect(await finished(other.page)).toBe(hash);
    expect(other.trouble).toEqual([]);
    await other.page.context().close();
  }));

test('what is saved is what the command line writes', () =>
  on('#lecture/default', async (page) => {
    await finished(page);
    await page.getByRole('button', { name: 'File' }).click();
    const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('menuitem', { name: 'Save picture' }).click()]);
    const saved = readFileSync(await download.path());
    execFileSync(snell, ['render', 'lecture/default', '-o', `${OUT}native.png`]);
    expect(saved.equals(readFileSync(`${OUT}native.png`))).toBe(true);
  }));

test('with one worker and with three the film is the same', async () => {
  const expected = nativeHash('gallery/window');
  for (const threads of [1, 3]) {
    await on('#gallery/window', async (page) => expect(await finished(page)).toBe(expected), { threads });
  }
});

test('a step of the tour is found with the tools', () =>
  on('#tour/5', async (page) => {
    await page.getByRole('heading', { name: 'Upside down' }).waitFor();
    await finished(page);
    const at = await placeOf(page, [300, 300]);
    await page.mouse.click(at.x, at.y);
    await page.getByText('✓ Found.').waitFor();
    await page.screenshot({ path: `${OUT}tour.png` });
  }));

test('an exercise tells right from wrong', () =>
  on('#exercise/bend', async (page) => {
    await page.getByText('At which angle does it go on?').waitFor();
    const answer = page.getByLabel('Your answer');
    await answer.fill('51.3');
    await page.getByRole('button', { name: 'Check' }).click();
    await page.getByText('✗ Not quite.').waitFor();
    await page.getByRole('button', { name: 'Try again' }).click();
    await answer.fill('31');
    await page.getByRole('button', { name: 'Check' }).click();
    await page.getByText('✓ Right.').waitFor();
  }));
