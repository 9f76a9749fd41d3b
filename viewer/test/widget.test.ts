/** The widget, with a model as anywidget gives one. */

import { readFileSync } from 'node:fs';
import { PNG } from 'pngjs';
import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, test } from 'vitest';
import type { WidgetTraits } from '../src/widget';
import { launch, open, type OpenPage, settled } from './browser';
import { blockColor, blocks, glass, png } from './fixture';
import { findColor } from './pictures';

interface FakeModel {
  traits: Record<string, unknown>;
  sent: { message: unknown; buffers: ArrayBuffer[] | undefined }[];
  set(trait: string, value: unknown): void;
  emit(event: string, value?: unknown): void;
  listening(): number;
}

declare global {
  interface Window {
    model: FakeModel;
    el: HTMLElement;
    cleanup: () => void;
  }
}

let browser: Browser;
beforeAll(async () => {
  browser = await launch();
});
afterAll(() => browser?.close());

/** A page with a widget, whose element is not in the page before it is rendered: so does JupyterLab. */
async function openWidget(name: string, traits: Partial<WidgetTraits> = {}, options: Parameters<typeof open>[3] = {}, html = '<div id="cell"></div>'): Promise<OpenPage> {
  const opened = await open(browser, `widget-${name}`, { scene: glass().scene }, { viewport: { width: 900, height: 700 }, ...options });
  const script = readFileSync(new URL('../dist/snell-viewer.js', import.meta.url), 'utf8');
  const { picture: _, ...plain } = traits;
  await opened.page.evaluate(
    async ({ script, html, plain, bytes }) => {
      window.viewer.dispose();
      document.getElementById('app')!.innerHTML = html;
      const listeners: [string, (value: unknown) => void][] = [];
      const model: FakeModel & Record<string, unknown> = {
        traits: { tree: null, picture: new DataView(new Uint8Array(bytes).buffer), height: '420px', title: 'test/glass', ...plain },
        sent: [],
        get: (trait: string) => model.traits[trait],
        on: (event: string, listener: (value: unknown) => void) => listeners.push([event, listener]),
        off: (event: string, listener: unknown) => {
          const at = listeners.findIndex(([e, l]) => e === event && l === listener);
          if (at >= 0) listeners.splice(at, 1);
        },
        send: (message: unknown, _callbacks: unknown, buffers: ArrayBuffer[]) => model.sent.push({ message, buffers }),
        emit: (event, value) => listeners.filter(([e]) => e === event).forEach(([, listener]) => listener(value)),
        set: (trait, value) => {
          model.traits[trait] = value;
          model.emit(`change:${trait}`);
        },
        listening: () => listeners.length,
      };
      window.model = model;
      window.el = document.createElement('div');
      // As Python gives the script to anywidget: a module that exports the widget.
      const url = URL.createObjectURL(new Blob([`${script}\nexport default SnellViewer.widget`], { type: 'text/javascript' }));
      // Vitest would rewrite an `import` that stands here itself.
      const { default: widget } = await new Function('url', 'return import(url)')(url);
      window.cleanup = widget.render({ model, el: window.el });
      document.getElementById('cell')!.append(window.el);
    },
    { script, html, plain: { scene: glass().scene, ...plain }, bytes: [...png(blocks(8, 6))] },
  );
  opened.trouble.length = 0;
  await settled(opened.page);
  return opened;
}

const messages = (page: Page, kind: string) =>
  page.evaluate((kind) => window.model.sent.map(({ message }) => message).filter((message) => (message as { kind: string }).kind === kind), kind);
const note = (page: Page) => page.getByRole('status').textContent();
const treeOf = (pixel: [number, number]) => ({ ...glass().tree, pixel, size: [8, 6] as [number, number] });
const setTree = (page: Page, tree: unknown) => page.evaluate((tree) => window.model.set('tree', tree), tree);

describe('the widget', () => {
  test('asks for the rays of a pixel that is clicked, and shows them', async () => {
    const { page, trouble } = await openWidget('asks');
    expect((await page.locator('.viewer').boundingBox())!.height).toBe(420);
    expect(await page.locator('.sentence').textContent()).toBe('test/glass');
    expect(await note(page)).toBe('Look through the camera and click a pixel to see its rays.');
    await page.getByLabel('Names').uncheck();
    await page.getByRole('button', { name: 'Look through the camera' }).click();
    await settled(page);
    const box = (await page.locator('.stage').boundingBox())!;
    const place = findColor(await page.locator('.stage').screenshot(), blockColor(6, 1), 0)!;
    await page.mouse.click(box.x + place.x, box.y + place.y);
    expect(await messages(page, 'explain')).toEqual([{ kind: 'explain', pixel: [6, 1] }]);
    expect(await note(page)).toBe('Following the rays of pixel (6, 1) …');
    await setTree(page, treeOf([6, 1]));
    expect(await note(page)).toBe('');
    expect(await page.getByRole('treeitem').count()).toBe(3);
    await setTree(page, null);
    expect(await page.getByRole('treeitem').count()).toBe(0);
    expect(trouble).toEqual([]);
    await page.close();
  });

  test('waits for the answer to the last question', async () => {
    const { page } = await openWidget('last');
    await page.getByRole('application').focus();
    await page.keyboard.press('Shift+ArrowRight');
    await page.keyboard.press('Shift+ArrowRight');
    expect(await messages(page, 'explain')).toEqual([{ kind: 'explain', pixel: [4, 3] }, { kind: 'explain', pixel: [5, 3] }]);
    await setTree(page, treeOf([4, 3]));
    expect(await page.getByRole('treeitem').count()).toBe(0);
    await setTree(page, treeOf([5, 3]));
    expect(await page.getByRole('treeitem').count()).toBe(3);
    // The canvas has kept the focus.
    await page.keyboard.press('Shift+ArrowDown');
    expect((await messages(page, 'explain')).at(-1)).toEqual({ kind: 'explain', pixel: [5, 4] });
    await page.evaluate(() => window.model.emit('msg:custom', { kind: 'error', message: 'pixel 5,4: no.' }));
    expect(await note(page)).toBe('pixel 5,4: no.');
    await page.close();
  });

  test('shows another scene, picture and height', async () => {
    const { page, trouble } = await openWidget('changes');
    await page.evaluate(() => {
      window.model.set('height', '300px');
      window.model.set('scene', { ...(window.model.traits.scene as object), spheres: [] });
      window.model.set('picture', new DataView(new ArrayBuffer(0)));
    });
    await settled(page);
    expect((await page.locator('.viewer').boundingBox())!.height).toBe(300);
    expect(await page.locator('header .quiet').textContent()).toBe('1 mesh · 2 lights');
    expect(await page.locator('canvas').count()).toBe(1);
    expect(await page.getByLabel('Picture').isVisible()).toBe(false);
    expect(trouble).toEqual([]);
    await page.close();
  });

  test('says in the notebook what is wrong with the data', async () => {
    const { page, trouble } = await openWidget('wrong', { scene: { snell_view: 2 } as never });
    expect(await page.getByRole('alert').textContent()).toContain('The scene is not shown. scene.snell_view: expected version 1');
    // Nothing to put a tree into, and no error thrown at that.
    await setTree(page, null);
    await page.evaluate((scene) => window.model.set('scene', scene), glass().scene as unknown);
    await settled(page);
    expect(await page.getByRole('alert').count()).toBe(0);
    await setTree(page, { snell_ray_tree: 1 });
    expect(await note(page)).toContain('tree.scene: expected a text, found nothing');
    expect(trouble).toEqual([]);
    await page.close();
  });

  test('sends a still picture after each change', async () => {
    const { page } = await openWidget('still', {}, { deviceScaleFactor: 2 });
    const count = async () => (await messages(page, 'still')).length;
    // Twice as long as it waits.
    const calm = () => page.waitForTimeout(1500);
    await calm();
    expect(await count()).toBe(1);
    const bytes = await page.evaluate(() => [...new Uint8Array(window.model.sent[0]!.buffers![0]!)]);
    const picture = PNG.sync.read(Buffer.from(bytes));
    // The drawing is 900 wide, of twice as many pixels; its ground is opaque up to the corners.
    expect(picture.width).toBe(1200);
    expect(picture.data.every((value, index) => index % 4 < 3 || value === 255)).toBe(true);
    expect(new Set(new Uint32Array(Uint8Array.from(picture.data).buffer)).size).toBeGreaterThan(1000);
    await page.evaluate(() => window.dispatchEvent(new Event('resize')));
    await page.mouse.move(450, 300);
    await calm();
    expect(await count()).toBe(1);
    await setTree(page, glass().tree);
    await calm();
    expect(await count()).toBe(2);
    await page.close();
  });

  test('follows the theme of JupyterLab', async () => {
    const { page } = await openWidget('theme', {}, { colorScheme: 'light' });
    const scheme = () => page.locator('.viewer').evaluate((viewer) => viewer.style.colorScheme);
    expect(await scheme()).toBe('light');
    await page.evaluate(() => (document.body.dataset.jpThemeLight = 'false'));
    expect(await scheme()).toBe('dark');
    await page.evaluate(() => (document.body.dataset.jpThemeLight = 'true'));
    expect(await scheme()).toBe('light');
    expect(await page.evaluate(() => window.el.getAttribute('data-lm-suppress-shortcuts'))).toBe('true');
    await page.close();
  });

  test('hides the still picture before it while it lives', async () => {
    const output = (id: string, content: string) => `<div class="jp-OutputArea-child" id="${id}" style="display: flex"><div class="jp-OutputArea-output">${content}</div></div>`;
    const html = `<div class="jp-OutputArea">${output('figure', '<img>')}${output('still', '')}${output('cell', '')}</div>`;
    const { page } = await openWidget('jupyter', {}, {}, html);
    const shown = () => page.evaluate(() => ['figure', 'still'].map((id) => document.getElementById(id)!.style.display));
    expect(await shown()).toEqual(['flex', 'flex']);
    // It comes when the widget has made one.
    await page.evaluate(() => document.querySelector('#still > div')!.append(new Image()));
    expect(await shown()).toEqual(['flex', 'none']);
    await page.evaluate(() => window.cleanup());
    expect(await shown()).toEqual(['flex', 'flex']);
    expect(await page.evaluate(() => [window.el.childElementCount, window.model.listening()])).toEqual([0, 0]);
    await page.close();
  });
});
