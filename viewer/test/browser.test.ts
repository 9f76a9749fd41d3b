import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, test } from 'vitest';
import { LIGHT } from '../src/theme';
import { launch, open, settled } from './browser';
import { glass, ray, rays } from './fixture';
import { difference, findColor, TOLERANCE } from './pictures';

let browser: Browser;
beforeAll(async () => {
  browser = await launch();
});
afterAll(() => browser?.close());

const rows = (page: Page) => page.getByRole('treeitem').evaluateAll((items) => items.map((item) => Number((item as HTMLElement).dataset.id)));
const focused = (page: Page) => page.evaluate(() => Number((document.querySelector('#app > div')!.shadowRoot!.activeElement as HTMLElement).dataset.id));
const selected = (page: Page) => page.evaluate(() => window.viewer.selected);

describe('the tree', () => {
  test('is an ARIA tree', async () => {
    const { page, trouble } = await open(browser, 'roles', glass());
    await expect(page.getByRole('tree', { name: 'Ray tree' }).count()).resolves.toBe(1);
    const mirror = page.getByRole('treeitem', { name: 'Mirror ray hits slab, 8.1% of the light' });
    const attribute = (name: string) => mirror.getAttribute(name);
    expect(await attribute('aria-level')).toBe('2');
    expect(await attribute('aria-setsize')).toBe('2');
    expect(await attribute('aria-posinset')).toBe('1');
    expect(await attribute('aria-selected')).toBe('false');
    // A leaf is not something that could be unfolded.
    expect(await attribute('aria-expanded')).toBeNull();
    expect(await page.getByRole('treeitem', { expanded: true }).count()).toBe(1);
    expect(trouble).toEqual([]);
    await page.close();
  });

  test('is worked with the keyboard', async () => {
    const { page, trouble } = await open(browser, 'keyboard', glass());
    await page.getByRole('treeitem').first().focus();
    const press = async (...keys: string[]) => {
      for (const key of keys) await page.keyboard.press(key);
    };
    expect(await rows(page)).toEqual([0, 1, 2]);
    await press('ArrowDown', 'ArrowDown', 'ArrowRight');
    expect(await rows(page)).toEqual([0, 1, 2, 3, 4]);
    expect(await focused(page)).toBe(2);
    await press('ArrowRight', 'ArrowDown', 'Enter');
    expect(await selected(page)).toBe(4);
    expect(await page.getByRole('treeitem', { selected: true }).getAttribute('data-id')).toBe('4');
    expect(await page.getByRole('heading', { name: 'Refracted ray hits red' }).count()).toBe(1);
    await press('ArrowLeft', 'ArrowLeft');
    expect(await rows(page)).toEqual([0, 1, 2]);
    expect(await focused(page)).toBe(2);
    // Just one row is in the order of Tab.
    expect(await page.locator('[role=treeitem][tabindex="0"]').count()).toBe(1);
    expect(trouble).toEqual([]);
    await page.close();
  });

  test('shows what is hovered and selected elsewhere', async () => {
    const { page } = await open(browser, 'select', glass());
    await page.evaluate(() => {
      window.viewer.on('select', (id) => (document.title = `selected ${id}`));
      window.viewer.select(7);
    });
    expect(await page.title()).toBe('selected 7');
    // The rays above it are unfolded.
    expect(await rows(page)).toEqual([0, 1, 2, 3, 4, 7]);
    expect(await page.getByRole('treeitem', { selected: true }).getAttribute('data-id')).toBe('7');
    await page.close();
  });
});

describe('the drawing', () => {
  test('selects the ray that is clicked, and none beside', async () => {
    const { page, trouble } = await open(browser, 'click', glass());
    await page.getByLabel('Names').uncheck();
    const stage = page.locator('.stage');
    const box = (await stage.boundingBox())!;
    const color = LIGHT.rays.refracted.match(/\w\w/g)!.map((hex) => parseInt(hex, 16)) as [number, number, number];
    // The strongest refracted ray is the widest one, and the only one that is not paled.
    const place = findColor(await stage.screenshot(), color, 12)!;
    await page.mouse.move(box.x + place.x, box.y + place.y);
    expect(await page.locator('canvas.on-ray').count()).toBe(1);
    await page.mouse.click(box.x + place.x, box.y + place.y);
    expect(await selected(page)).toBe(4);
    await page.mouse.click(box.x + 20, box.y + box.height / 2);
    expect(await selected(page)).toBeNull();
    expect(trouble).toEqual([]);
    await page.close();
  });

  test.each(['light', 'dark'] as const)('looks as it did on a %s page', async (colorScheme) => {
    const { page, trouble } = await open(browser, colorScheme, glass(), { colorScheme });
    // Fonts differ between machines.
    await page.getByLabel('Names').uncheck();
    const hide = () => document.querySelector('#app > div')!.shadowRoot!.append(Object.assign(document.createElement('style'), {
      textContent: '.toolbar, .footer, .names { opacity: 0 }',
    }));
    await page.evaluate(hide);
    const shot = async (name: string) => {
      await page.mouse.move(0, 0);
      await settled(page);
      const screenshot = await page.locator('.stage').screenshot();
      expect.soft(difference(`${colorScheme}-${name}`, screenshot), 'see test/out').toBeLessThanOrEqual(TOLERANCE);
    };
    await shot('overview');
    await page.evaluate(() => window.viewer.select(9));
    await shot('selected');
    await page.getByRole('button', { name: 'Look through the camera' }).click();
    await shot('camera');
    expect(trouble).toEqual([]);
    await page.close();
  });

  test('is turned with the keyboard, and reset', async () => {
    const { page } = await open(browser, 'turn', glass());
    const stage = page.locator('.stage');
    const before = await stage.screenshot();
    await page.getByRole('application', { name: 'The scene and the rays of pixel (190, 145) in 3D' }).focus();
    for (const key of ['ArrowLeft', 'ArrowUp', '+']) await page.keyboard.press(key);
    await settled(page);
    expect((await stage.screenshot()).equals(before)).toBe(false);
    await page.getByRole('button', { name: 'Reset' }).click();
    await page.getByRole('button', { name: 'Reset' }).blur();
    await page.mouse.move(0, 0);
    await settled(page);
    // A slow machine may need more frames than were waited for.
    await expect.poll(async () => (await stage.screenshot()).equals(before), { timeout: 10_000 }).toBe(true);
    await page.close();
  });

  test('says how many rays it leaves out', async () => {
    const data = glass();
    data.tree.samples[0]!.nodes = rays(Array.from({ length: 1500 }, (_, id) => (id === 0 ? null : (id - 1) >> 1)));
    const { page, trouble } = await open(browser, 'many', data);
    expect(await page.getByRole('status').textContent()).toBe('The 1100 weakest rays are not drawn; the tree has them all.');
    expect(await page.getByRole('treeitem').count()).toBe(3);
    expect(trouble).toEqual([]);
    await page.close();
  });
});

describe('the page', () => {
  test.each([
    ['a window of 1280 pixels at 200%', 640, 400],
    ['a narrow one', 320, 640],
  ])('fits into %s', async (_, width, height) => {
    const { page } = await open(browser, 'narrow', glass(), { viewport: { width, height } });
    await page.evaluate(() => window.viewer.select(10));
    expect(await page.evaluate(() => document.documentElement.scrollWidth)).toBeLessThanOrEqual(width);
    const boxes = await Promise.all(['header', '.view', '.tree', '.detail'].map((part) => page.locator(part).boundingBox()));
    // One below the other.
    boxes.slice(1).forEach((box, index) => expect(box!.y).toBeGreaterThanOrEqual(boxes[index]!.y + boxes[index]!.height - 1));
    await page.close();
  });

  test('shows one sample after the other', async () => {
    const data = glass();
    data.tree.samples.push({ color: [0, 0, 0], lost: [0, 0, 0], nodes: [ray({})] });
    const { page, trouble } = await open(browser, 'samples', data);
    await page.evaluate(() => window.viewer.select(2));
    await page.getByLabel('Sample').selectOption('Sample 2 of 2');
    expect(await selected(page)).toBeNull();
    expect(await page.getByRole('treeitem').evaluateAll((items) => items.map((item) => item.ariaLabel))).toEqual([
      'Camera ray leaves the scene, 0% of the light',
    ]);
    expect(trouble).toEqual([]);
    await page.close();
  });

  test('does without WebGL', async () => {
    const { page } = await open(browser, 'no-webgl', glass(), {}, 'HTMLCanvasElement.prototype.getContext = () => null');
    expect(await page.getByRole('status').textContent()).toContain('no WebGL');
    await page.getByRole('treeitem').first().click();
    expect(await page.getByRole('heading', { name: 'Camera ray hits glass' }).count()).toBe(1);
    await page.close();
  });

  test('takes names for text, and can be taken away', async () => {
    const data = glass();
    data.tree.sentence = data.scene.spheres[0]!.name = '</script><img src=x onerror=alert(1)>';
    const { page, trouble } = await open(browser, 'markup', data);
    expect(await page.locator('.sentence').textContent()).toBe(data.tree.sentence);
    await page.evaluate(() => window.viewer.dispose());
    expect(await page.locator('#app').innerHTML()).toBe('');
    expect(trouble).toEqual([]);
    await page.close();
  });

  test('says what is wrong with its data', async () => {
    const { page } = await open(browser, 'wrong', glass());
    const message = await page.evaluate(() => {
      try {
        window.SnellViewer.mount(document.body, { scene: { snell_view: 1 }, tree: { snell_ray_tree: 1 } } as never);
      } catch (error) {
        return String(error);
      }
    });
    expect(message).toBe('ViewerDataError: scene.spheres: expected a list, found nothing');
    await page.close();
  });
});
