/** The pages that `snell explain --html` writes, where the command has been built: `SNELL` is its path. */

import { execFileSync } from 'node:child_process';
import { existsSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import type { Browser } from 'playwright-core';
import { afterAll, beforeAll, describe, expect, test } from 'vitest';
import type { RayTreeDocument } from '../src/data';
import { TreeModel } from '../src/model';
import { launch, openFile, OUT } from './browser';

const SNELL = process.env.SNELL ?? fileURLToPath(new URL('../../target/ci/snell', import.meta.url));
if (!existsSync(SNELL)) console.warn(`SKIPPED: ${SNELL} has not been built; name it with SNELL`);

describe.runIf(existsSync(SNELL))('a page of the command', () => {
  let browser: Browser;
  beforeAll(async () => {
    browser = await launch();
  });
  afterAll(() => browser?.close());

  const page = async (scene: string, pixel: string) => {
    const path = `${OUT}explain-${scene.replace('/', '-')}.html`;
    execFileSync(SNELL, ['explain', scene, pixel, '--html', path], { stdio: 'ignore' });
    return openFile(browser, path);
  };

  test('shows the tree of the lecture, offline', async () => {
    const { page: shown, trouble } = await page('lecture/default', '190,300');
    await expect(shown.title()).resolves.toBe('lecture/default 190,300');
    await expect(shown.getByRole('treeitem').count()).resolves.toBeGreaterThan(1);
    await expect(shown.getByText('seen through').count()).resolves.toBeGreaterThan(0);
    await shown.getByRole('treeitem').first().focus();
    await shown.keyboard.press('Enter');
    await expect(shown.getByRole('treeitem', { selected: true }).count()).resolves.toBe(1);
    // The drawing is not empty: glass, mirrors and rays are of many colours.
    const canvas = await shown.locator('canvas').first().screenshot();
    expect(canvas.length).toBeGreaterThan(10_000);
    expect(trouble).toEqual([]);
    await shown.close();
  });

  test('builds up to the colour of the pixel, bit for bit', () => {
    for (const [scene, pixel] of [['lecture/default', '190,300'], ['gallery/prism', '300,230'], ['gallery/plates', '500,200']] as const) {
      const { samples } = JSON.parse(execFileSync(SNELL, ['explain', scene, pixel, '--json'], { encoding: 'utf8' })) as RayTreeDocument;
      for (const { nodes, color } of samples) {
        const model = new TreeModel(nodes);
        expect(model.colorUntil(model.last)).toEqual(color);
        expect(model.colorUntil(model.last).some((value) => value > 0)).toBe(true);
      }
    }
  });

  test('shows panes, media and colours of light', async () => {
    for (const [scene, pixel] of [['gallery/prism', '300,230'], ['gallery/ice', '300,300'], ['gallery/plates', '500,200']] as const) {
      const { page: shown, trouble } = await page(scene, pixel);
      await expect(shown.getByRole('tree').count()).resolves.toBe(1);
      expect(trouble).toEqual([]);
      await shown.close();
    }
  });
});
