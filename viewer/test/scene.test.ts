/** The scene without a tree, with the picture on the image plane, and with one tree after the other. */

import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, test } from 'vitest';
import { launch, open, type OpenPage, settled } from './browser';
import { blocks, blockColor, glass, png, ray } from './fixture';
import { difference, findColor, TOLERANCE } from './pictures';

let browser: Browser;
beforeAll(async () => {
  browser = await launch();
});
afterAll(() => browser?.close());

const [COLUMNS, ROWS] = [8, 6];

/** With the picture, and `pixel` events written into the title. */
async function openPicture(name: string, data: Parameters<typeof open>[2]): Promise<OpenPage> {
  const opened = await open(browser, name, data);
  await opened.page.evaluate(async (bytes) => {
    window.viewer.on('pixel', (x, y) => (document.title = `pixel ${x}, ${y}`));
    await window.viewer.setPicture(new Uint8Array(bytes));
  }, [...png(blocks(COLUMNS, ROWS))]);
  return opened;
}

async function lookThroughCamera(page: Page): Promise<void> {
  await page.getByRole('button', { name: 'Look through the camera' }).click();
  await page.getByLabel('Names').uncheck();
  await settled(page);
}

describe('the scene alone', () => {
  test('has a title, no panel, and the whole width', async () => {
    const { page, trouble } = await open(browser, 'alone', { scene: glass().scene, title: '<b>glass</b>' });
    expect(await page.locator('header').innerText()).toBe('<b>glass</b>\n\n3 spheres · 1 mesh · 2 lights');
    expect(await page.locator('.panel:visible').count()).toBe(0);
    expect((await page.locator('canvas').boundingBox())!.width).toBe(1280);
    await expect(page.getByRole('application', { name: 'The scene in 3D' }).count()).resolves.toBe(1);
    // Neither does anything without rays or a picture.
    expect(await page.getByLabel('All shadow rays').isVisible()).toBe(false);
    expect(await page.getByLabel('Picture').isVisible()).toBe(false);
    await page.mouse.click(640, 400);
    expect(await page.evaluate(() => window.viewer.selected)).toBeNull();
    expect(trouble).toEqual([]);
    await page.close();
  });

  test('gets one tree after the other in the same canvas, and loses it', async () => {
    const { page, trouble } = await open(browser, 'trees', { scene: glass().scene });
    await page.getByLabel('Names').uncheck();
    const before = await page.locator('canvas').elementHandle();
    const { tree } = glass();
    await page.evaluate((first) => window.viewer.setTree(first), tree);
    await page.evaluate(() => window.viewer.select(4));
    const other = { ...tree, pixel: [3, 4] as [number, number], samples: [{ color: [0, 0, 0], lost: [0, 0, 0], nodes: [ray({})] }] };
    await page.evaluate((second) => window.viewer.setTree(second as never), other);
    expect(await page.evaluate(() => window.viewer.selected)).toBeNull();
    expect(await page.getByRole('treeitem').count()).toBe(1);
    expect(await page.getByRole('application', { name: 'The scene and the rays of pixel (3, 4) in 3D' }).count()).toBe(1);
    await page.evaluate(() => window.viewer.setTree(null));
    await settled(page);
    expect(await page.locator('.panel:visible').count()).toBe(0);
    expect(await page.getByLabel('Names').isChecked()).toBe(false);
    expect(await page.evaluate((canvas) => canvas === document.querySelector('#app > div')!.shadowRoot!.querySelector('canvas'), before)).toBe(true);
    expect(trouble).toEqual([]);
    await page.close();
  });

  test('keeps the eye where somebody has put it', async () => {
    const data = glass();
    const { page } = await open(browser, 'eye', data);
    await page.getByRole('application').focus();
    for (const key of ['ArrowLeft', 'ArrowUp', '+']) await page.keyboard.press(key);
    await settled(page);
    const stage = page.locator('.stage');
    const before = await stage.screenshot();
    await page.evaluate((tree) => window.viewer.setTree(tree), data.tree);
    await settled(page);
    // A slow machine may need more frames than were waited for.
    await expect.poll(async () => (await stage.screenshot()).equals(before), { timeout: 10_000 }).toBe(true);
    await page.close();
  });

  test('refuses a wrong tree and keeps the right one', async () => {
    const { page } = await open(browser, 'refuses', glass());
    const message = await page.evaluate(() => {
      try {
        window.viewer.setTree({ snell_ray_tree: 1 } as never);
      } catch (error) {
        return String(error);
      }
    });
    expect(message).toBe('ViewerDataError: tree.scene: expected a text, found nothing');
    expect(await page.getByRole('treeitem').count()).toBe(3);
    await page.close();
  });

  test('with 40000 triangles is there in less than a second', async () => {
    const { page } = await open(browser, 'large', { scene: glass().scene });
    const milliseconds = await page.evaluate((scene) => {
      const side = 142;
      const vertices: number[] = [];
      for (let y = 0; y < side; y++) for (let x = 0; x < side; x++) vertices.push(x, Math.sin(x / 9) * Math.cos(y / 7), y);
      const faces: number[] = [];
      for (let y = 0; y < side - 1; y++) {
        for (let x = 0; x < side - 1; x++) {
          const at = y * side + x;
          faces.push(at, at + 1, at + side, at + 1, at + side + 1, at + side);
        }
      }
      const mesh = { name: 'waves', vertices, faces, color: [0.4, 0.5, 0.6], opacity: 1 };
      const start = performance.now();
      window.SnellViewer.mount(document.body, { scene: { ...scene, meshes: [mesh] } } as never);
      return performance.now() - start;
    }, glass().scene);
    expect(milliseconds).toBeLessThan(1000);
    await page.close();
  });
});

describe('the picture', () => {
  test('covers what the camera sees, the right way round, in its own colours', async () => {
    const { page, trouble } = await openPicture('picture', { scene: glass().scene });
    await lookThroughCamera(page);
    const stage = page.locator('.stage');
    const box = (await stage.boundingBox())!;
    const picture = await stage.screenshot();
    for (const [x, y] of [[0, 0], [7, 0], [0, 5], [7, 5], [2, 3]] as const) {
      const place = findColor(picture, blockColor(x, y), 0)!;
      await page.mouse.click(box.x + place.x, box.y + place.y);
      expect(await page.title()).toBe(`pixel ${x}, ${y}`);
    }
    expect(await page.locator('canvas.on-pixel').count()).toBe(1);
    expect(await page.locator('.target').innerText()).toBe('2, 3');
    await page.mouse.move(box.x + 20, box.y + box.height / 2);
    expect(await page.locator('canvas.on-pixel').count()).toBe(0);
    await page.getByLabel('Picture').uncheck();
    await settled(page);
    expect(findColor(await stage.screenshot(), blockColor(2, 3), 0)).toBeNull();
    expect(trouble).toEqual([]);
    await page.close();
  });

  test('gives way to rays', async () => {
    const { page } = await openPicture('precedence', glass());
    await lookThroughCamera(page);
    // The camera ray is seen end on, where its pixel is marked.
    const stage = page.locator('.stage');
    const box = (await stage.boundingBox())!;
    const corners = [findColor(await stage.screenshot(), blockColor(0, 0), 0)!, findColor(await stage.screenshot(), blockColor(7, 5), 0)!];
    const { pixel, size } = glass().tree;
    const along = (axis: 'x' | 'y', at: number) => {
      const [first, last] = corners.map((corner) => corner[axis]) as [number, number];
      // `findColor` gives the middles of the first and of the last block.
      const blocks = axis === 'x' ? COLUMNS : ROWS;
      return first + ((at * blocks - 0.5) / (blocks - 1)) * (last - first);
    };
    const [x, y] = [along('x', (pixel[0] + 0.5) / size[0]), along('y', (pixel[1] + 0.5) / size[1])];
    await page.mouse.click(box.x + x, box.y + y);
    expect(await page.evaluate(() => window.viewer.selected)).not.toBeNull();
    expect(await page.title()).toBe('Snell');
    await page.close();
  });

  test('is gone through with Shift and the arrows', async () => {
    const { page } = await openPicture('arrows', { scene: glass().scene });
    await page.getByRole('application').focus();
    const press = async (key: string) => {
      await page.keyboard.press(key);
      return page.title();
    };
    expect(await press('Shift+ArrowLeft')).toBe('pixel 4, 3');
    expect(await press('Shift+ArrowLeft')).toBe('pixel 3, 3');
    expect(await press('Shift+ArrowUp')).toBe('pixel 3, 2');
    expect(await page.locator('#alternative').textContent()).toContain('Shift with an arrow key');
    await page.close();
  });

  test('that is none is told of', async () => {
    const { page, trouble } = await open(browser, 'no-picture', glass());
    await page.evaluate(() => window.viewer.setPicture(new TextEncoder().encode('not a picture')));
    expect(await page.getByRole('status').textContent()).toContain('The picture is not shown: its bytes are no PNG');
    expect(trouble).toEqual([]);
    await page.close();
  });

  test.each(['light', 'dark'] as const)('looks as it did on a %s page', async (colorScheme) => {
    const { page } = await open(browser, `scene-${colorScheme}`, { scene: glass().scene }, { colorScheme });
    await page.getByLabel('Names').uncheck();
    await page.evaluate(() => {
      const style = Object.assign(document.createElement('style'), { textContent: '.toolbar, .footer { opacity: 0 }' });
      document.querySelector('#app > div')!.shadowRoot!.append(style);
    });
    const shot = async (name: string) => {
      await page.mouse.move(0, 0);
      await settled(page);
      expect.soft(difference(`${colorScheme}-${name}`, await page.locator('.stage').screenshot()), 'see test/out').toBeLessThanOrEqual(TOLERANCE);
    };
    await shot('scene');
    await page.evaluate((bytes) => window.viewer.setPicture(new Uint8Array(bytes)), [...png(blocks(COLUMNS, ROWS))]);
    await shot('scene-picture');
    await page.evaluate((tree) => window.viewer.setTree(tree), glass().tree);
    await page.getByRole('button', { name: 'Look through the camera' }).click();
    await shot('scene-camera');
    await page.close();
  });
});
