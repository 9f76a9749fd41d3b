/** Folding, the player, angles and names, as they are seen. */

import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, test } from 'vitest';
import { launch, open, OUT, settled } from './browser';
import { glass, rays } from './fixture';

let browser: Browser;
beforeAll(async () => {
  browser = await launch();
});
afterAll(() => browser?.close());

const rowIds = (page: Page) => page.getByRole('treeitem').evaluateAll((items) => items.map((item) => Number((item as HTMLElement).dataset.id)));
const selected = (page: Page) => page.evaluate(() => window.viewer.selected);

/** Of the 100 that the pixel has, 2 and 3 bring less than one each. */
function folded() {
  const data = glass();
  const [first] = data.tree.samples[0]!.nodes as [typeof data.tree.samples[0]['nodes'][0]];
  data.tree.samples[0]!.nodes = rays([null, 0, 0, 0, 3], [100, 97, 0.9, 0.8, 0.8]).map((node, id) => (id === 0 ? { ...node, hit: first.hit, ended: null } : node));
  return data;
}

describe('branches that matter little', () => {
  test('share a row, which the keyboard unfolds and folds', async () => {
    const { page, trouble } = await open(browser, 'fold-keys', folded());
    const others = page.getByRole('treeitem', { name: '2 others, 1.7% of the light' });
    expect(await rowIds(page)).toEqual([0, 1, -1]);
    const attributes = await others.evaluate((row) => ['aria-level', 'aria-posinset', 'aria-setsize', 'aria-expanded', 'aria-selected'].map((name) => row.getAttribute(name)));
    expect(attributes).toEqual(['2', '2', '2', 'false', null]);
    await page.getByRole('treeitem').first().focus();
    for (const key of ['End', 'ArrowRight']) await page.keyboard.press(key);
    expect(await rowIds(page)).toEqual([0, 1, -1, 2, 3]);
    await page.keyboard.press('Enter');
    expect(await rowIds(page)).toEqual([0, 1, -1]);
    await page.keyboard.press('Enter');
    expect(await others.getAttribute('aria-expanded')).toBe('true');
    for (const key of ['ArrowRight', 'ArrowDown', 'Enter']) await page.keyboard.press(key);
    expect(await selected(page)).toBe(3);
    for (const key of ['ArrowLeft', 'ArrowLeft']) await page.keyboard.press(key);
    expect(await rowIds(page)).toEqual([0, 1, -1]);
    expect(trouble).toEqual([]);
    await page.close();
  });

  test('unfold with a click, and when one of them is selected elsewhere', async () => {
    const { page } = await open(browser, 'fold-click', folded());
    await page.getByRole('treeitem', { name: /others/ }).click();
    expect(await selected(page)).toBeNull();
    expect(await rowIds(page)).toEqual([0, 1, -1, 2, 3]);
    await page.getByRole('treeitem', { name: /others/ }).click();
    await page.evaluate(() => window.viewer.select(4));
    expect(await rowIds(page)).toEqual([0, 1, -1, 2, 3, 4]);
    expect(await page.getByRole('treeitem', { selected: true }).getAttribute('data-id')).toBe('4');
    await page.close();
  });
});

describe('the player', () => {
  const text = (page: Page) => page.locator('.player [aria-live]').textContent();
  const swatches = (page: Page) => page.locator('.player .swatch').evaluateAll((all) => all.map((one) => (one as HTMLElement).style.background));

  test('steps through the generations, in the tree and in the drawing', async () => {
    const { page, trouble } = await open(browser, 'player-steps', glass());
    const { nodes } = glass().tree.samples[0]!;
    await page.mouse.move(0, 0);
    await settled(page);
    const whole = await page.locator('.stage').screenshot();
    const [, end] = await swatches(page);
    expect((await swatches(page))[0]).toBe(end);
    const slider = page.getByRole('slider', { name: 'Generation' });
    await slider.focus();
    await page.keyboard.press('Home');
    expect(await text(page)).toMatch(/^Generation 0 of 4: 1 ray, .*%$/);
    expect(await slider.getAttribute('aria-valuetext')).toBe(await text(page));
    expect(await rowIds(page)).toEqual([0]);
    expect((await swatches(page))[0]).not.toBe(end);
    await settled(page);
    const first = await page.locator('.stage').screenshot();
    expect(first.equals(whole)).toBe(false);
    await page.getByRole('button', { name: 'Next generation' }).click();
    expect(await rowIds(page)).toEqual(nodes.filter(({ parent }) => parent === null || parent === 0).map(({ id }) => id));
    await page.getByRole('button', { name: 'Generation before' }).click();
    expect(await rowIds(page)).toEqual([0]);
    // What is selected is shown, whatever generation it belongs to.
    await page.evaluate(() => window.viewer.select(7));
    expect(await text(page)).toContain('Generation 4 of 4');
    expect(await text(page)).toMatch(/ 100%$/);
    expect((await swatches(page))[0]).toBe(end);
    await page.evaluate(() => window.viewer.select(null));
    await slider.blur();
    await page.mouse.move(0, 0);
    await settled(page);
    // A slow machine may need more frames than were waited for.
    await expect.poll(async () => (await page.locator('.stage').screenshot()).equals(whole), { timeout: 10_000 }).toBe(true);
    expect(trouble).toEqual([]);
    await page.close();
  });

  test('plays by itself, pauses, and begins anew', async () => {
    const { page } = await open(browser, 'player-plays', glass(), { reducedMotion: 'no-preference' });
    await page.getByRole('combobox', { name: 'Speed' }).selectOption('4×');
    const seen = new Set<string>();
    await page.exposeFunction('saw', (text: string) => seen.add(text.slice(0, 12)));
    await page.evaluate(() => {
      const text = document.querySelector('#app > div')!.shadowRoot!.querySelector('.player [aria-live]')!;
      new MutationObserver(() => (window as never as { saw(text: string): void }).saw(text.textContent)).observe(text, { childList: true });
    });
    await page.getByRole('button', { name: 'Play' }).click();
    await page.getByRole('button', { name: 'Play' }).waitFor({ timeout: 10_000 });
    expect([...seen]).toEqual([0, 1, 2, 3, 4].map((generation) => `Generation ${generation}`));
    await page.getByRole('button', { name: 'Play' }).click();
    await page.getByRole('button', { name: 'Pause' }).click();
    const paused = await text(page);
    await page.waitForTimeout(700);
    expect(await text(page)).toBe(paused);
    await page.close();
  });

  test('moves nothing by itself for those who want no motion, and is away where there is one ray', async () => {
    const { page } = await open(browser, 'player-calm', glass());
    expect(await page.getByRole('button', { name: 'Next generation' }).isVisible()).toBe(true);
    expect(await page.getByRole('button', { name: /Play|Pause/ }).count()).toBe(0);
    expect(await page.getByRole('combobox', { name: 'Speed' }).count()).toBe(0);
    const one = glass();
    one.tree.samples[0]!.nodes = rays([null], [1]);
    await page.evaluate((tree) => window.viewer.setTree(tree), one.tree);
    expect(await page.getByRole('group', { name: 'Generations of rays' }).count()).toBe(0);
    await page.close();
  });
});

describe('texts over the drawing', () => {
  const shown = (page: Page) => page.locator('.names span:visible').allTextContents();
  const boxes = (page: Page) => page.locator('.names span:visible').evaluateAll((all) => all.map((one) => one.getBoundingClientRect().toJSON() as DOMRect));

  test('say the angles at the selected ray, and only there', async () => {
    const { page } = await open(browser, 'angles', glass());
    const { hit } = glass().tree.samples[0]!.nodes[0]!;
    const before = await page.locator('.stage').screenshot();
    await page.evaluate(() => window.viewer.select(0));
    await settled(page);
    const angles = [hit!.angle_in, hit!.angle_in, hit!.angle_out!].map((angle) => `${Number(angle.toFixed(1))}°`);
    expect((await shown(page)).filter((text) => text.includes('°'))).toEqual(angles);
    expect((await page.locator('.stage').screenshot({ path: `${OUT}angles.png` })).equals(before)).toBe(false);
    // Angles are no names.
    await page.getByLabel('Names').uncheck();
    await settled(page);
    expect(await shown(page)).toEqual(angles);
    await page.evaluate(() => window.viewer.select(null));
    await settled(page);
    expect(await shown(page)).toEqual([]);
    await page.close();
  });

  test('never lie over each other, and the selected one stays', async () => {
    const data = glass();
    // A crowd at one place.
    const spheres = Array.from({ length: 12 }, (_, n) => ({ ...data.scene.spheres[0]!, name: `ball number ${n}`, radius: 0.1, center: [n / 40, 1, n / 40] as [number, number, number] }));
    const { page, trouble } = await open(browser, 'crowd', { scene: { ...data.scene, spheres } });
    const all = await boxes(page);
    expect(all.length).toBeGreaterThan(3);
    all.forEach((a, i) => all.slice(i + 1).forEach((b) => expect(a.left < b.right - 1 && b.left < a.right - 1 && a.top < b.bottom - 1 && b.top < a.bottom - 1).toBe(false)));
    const names = await shown(page);
    const missing = spheres.findIndex(({ name }) => !names.includes(name));
    expect(missing).toBeGreaterThanOrEqual(0);
    await page.evaluate(([index, name]) => window.viewer.setObjects({ selected: { kind: 'sphere', index, name }, handles: null, snap: null }), [missing, spheres[missing]!.name] as const);
    await settled(page);
    expect(await shown(page)).toContain(spheres[missing]!.name);
    expect(trouble).toEqual([]);
    await page.close();
  });

  test('rays of one wavelength have its colour, in the drawing and in the tree', async () => {
    const data = glass();
    data.tree.samples[0]!.nodes.forEach((node) => (node.band_nm = node.id < 2 ? null : 420 + 40 * (node.id % 7)));
    const { page } = await open(browser, 'bands', data);
    await page.evaluate(() => window.viewer.select(8));
    const colors = await page.locator('.row .stroke.band').evaluateAll((all) => all.map((one) => getComputedStyle(one).color));
    expect(new Set(colors).size).toBeGreaterThan(2);
    expect(colors.every((color) => color.startsWith('oklch(0.56 0.17'))).toBe(true);
    await page.locator('.viewer').screenshot({ path: `${OUT}bands.png` });
    await page.close();
  });
});
