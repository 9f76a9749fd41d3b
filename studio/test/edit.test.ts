/** The scene is changed: in the picture, in the drawing, in numbers, as text; and all of it is taken back. */

import type { Page } from 'playwright-core';
import type { Handle } from '../../viewer/src/three/handles';
import { expect, test } from 'vitest';
import { nativeHash } from './native';
import { begun, drag, edit, finished, pin, placeOf, studio } from './page';

const host = studio();
const { on } = host;

const text = (page: Page) => page.evaluate(() => window.snell.revision.value!.text);
const glass = (page: Page) => page.evaluate(() => window.snell.revision.value!.scene.sphere!.find(({ name }) => name === 'glass')!);
const center = async (page: Page) => (await glass(page)).center;

test('the sphere is dragged in the picture, and the drag is one step to undo', () =>
  on('#lecture/default', async (page) => {
    await finished(page);
    const from = await placeOf(page, [256, 256]);
    await page.mouse.move(from.x, from.y);
    await page.waitForFunction(() => window.snell.tree.value?.pixel[0] === 256);
    await drag(page, from, [60, 30]);
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

test('the sphere is moved and scaled by its handles in the drawing, each in one step to undo', () =>
  on('#lecture/default', async (page) => {
    const before = await finished(page);
    await page.waitForFunction(() => window.snellSpace != null);
    const at = await inDrawing(page, [50, 50, 50]);
    await page.mouse.click(at.x, at.y);
    await page.waitForFunction(() => window.snell.selected.value?.name === 'glass');
    // The arrow along y goes up; half way it belongs to nothing else.
    const tip = await tipOf(page, { do: 'move', axis: [0, 1, 0] });
    await drag(page, { x: (at.x + tip.x) / 2, y: (at.y + tip.y) / 2 }, [4, -40]);
    await page.waitForFunction(() => window.snell.revision.value!.scene.sphere![0]!.center[1] > 52);
    const moved = await center(page);
    expect([moved[0], moved[2]]).toEqual([50, 50]);
    expect(await finished(page)).not.toBe(before);
    await page.getByRole('button', { name: 'Undo' }).click();
    await page.waitForFunction(() => window.snell.revision.value!.scene.sphere![0]!.center[1] === 50);
    expect(await finished(page)).toBe(before);
    expect(await page.evaluate(() => window.snell.undoLabel.value)).toBe(null);

    await page.getByRole('button', { name: 'Scale' }).click();
    const ring = await tipOf(page, { do: 'scale', axis: null });
    await drag(page, ring, [(ring.x - at.x) / 2, (ring.y - at.y) / 2]);
    await page.waitForFunction(() => window.snell.revision.value!.scene.sphere![0]!.radius > 9);
    const { radius, ...rest } = await glass(page);
    expect(radius).toBeGreaterThan(12);
    expect(radius).toBeLessThan(15);
    expect(rest.center).toEqual([50, 50, 50]);
    await page.getByRole('button', { name: 'Undo' }).click();
    await page.waitForFunction(() => window.snell.revision.value!.scene.sphere![0]!.radius === 9);
    expect(await finished(page)).toBe(before);
  }));

test('a prism is turned by its handle', () =>
  on('#gallery/prism', async (page) => {
    await page.waitForFunction(() => window.snellSpace != null);
    // Many rays for each pixel: few pixels.
    await edit(page, ['render.size', '[64, 48]']);
    const before = await text(page);
    await page.evaluate(() => window.snell.select(window.snell.objects.value.find(({ name }) => name === 'prism')!.key));
    await page.getByRole('button', { name: 'Turn' }).click();
    const { x, y } = await tipOf(page, { do: 'turn', axis: [0, 1, 0] });
    await drag(page, { x, y }, [40, 10]);
    await page.waitForFunction((before) => window.snell.revision.value!.text !== before, before);
    expect(await text(page)).toMatch(/rotate = \{ axis = \[0, 1, 0\], degrees = -?\d/);
    await page.getByRole('button', { name: 'Undo' }).click();
    await page.waitForFunction((before) => window.snell.revision.value!.text === before, before);
  }));

test('a text that is broken says where, keeps the picture, and is taken back by undo', () =>
  on('#lecture/default', async (page) => {
    const before = await finished(page);
    await page.getByRole('tab', { name: 'Source' }).click();
    await page.locator('.cm-content').click();
    await page.keyboard.press('Control+Home');
    await page.keyboard.type('nonsense = 5\n');
    await page.getByRole('alert').getByText('nonsense').waitFor();
    await page.goto(host.url);
    await page.reload();
    await page.getByRole('alert').getByText('nonsense').waitFor();
    expect(await finished(page)).toBe(before);
    await page.getByRole('tab', { name: 'Source' }).click();
    await page.locator('.cm-content').getByText('nonsense').waitFor();
    expect(await page.evaluate(() => window.snell.outcome.value!.sha256)).toBe(before);
    await page.keyboard.press('Control+z');
    await page.waitForFunction(() => window.snell.draft.value === null);
    expect(await page.locator('.cm-content').innerText()).not.toMatch('nonsense');
  }));

test('what is typed last counts, whatever is done right after it', () =>
  on('#lecture/default', async (page) => {
    await finished(page);
    await page.getByRole('tab', { name: 'Source' }).click();
    await page.locator('.cm-content').click();
    await page.keyboard.press('Control+Home');
    await page.keyboard.type('# mine');
    await page.keyboard.press('Enter');
    await page.getByRole('tab', { name: 'Scene' }).click();
    await page.waitForFunction(() => window.snell.revision.value!.text.startsWith('# mine') && window.snell.draft.value === null);
    for (const name of ['Undo', 'Redo']) await page.getByRole('button', { name }).click();
    await page.waitForFunction(() => window.snell.undoLabel.value === 'edit the text');
    expect(await text(page)).toMatch(/^# mine\n/);
  }));

test('a drag counts though a pixel is pinned, and though it is over before it is known what is dragged', () =>
  on('#lecture/default', async (page) => {
    await finished(page);
    await pin(page, [10, 10]);
    await page.evaluate(() => {
      const { snell } = window;
      const seenAt = snell.seenAt.bind(snell);
      snell.seenAt = async (pixel) => {
        await new Promise((done) => addEventListener('pointerup', done, { once: true }));
        return seenAt(pixel);
      };
    });
    await drag(page, await placeOf(page, [256, 256]), [40, 0]);
    await page.waitForFunction(() => window.snell.revision.value!.scene.sphere![0]!.center[0] > 51);
    await page.getByRole('button', { name: 'Undo' }).click();
    await page.waitForFunction(() => window.snell.revision.value!.scene.sphere![0]!.center[0] === 50);
    expect(await page.evaluate(() => window.snell.undoLabel.value)).toBe(null);
  }));

test('things are added and removed, each in one step', () =>
  on('#lecture/default', async (page) => {
    const before = await finished(page);
    await page.getByRole('tab', { name: 'Scene' }).click();
    for (const kind of ['sphere', 'box', 'plane', 'disc', 'light']) {
      await page.getByLabel('Add an object').selectOption(kind);
      await page.waitForFunction((kind) => window.snell.selected.value?.name === kind, kind);
      await page.getByRole('button', { name: `Remove ${kind}` }).click();
      await page.waitForFunction((kind) => window.snell.objects.value.every(({ name }) => name !== kind), kind);
      await page.getByRole('button', { name: 'Undo' }).click();
      await page.waitForFunction((kind) => window.snell.objects.value.some(({ name }) => name === kind), kind);
      await page.getByRole('button', { name: 'Undo' }).click();
      await page.waitForFunction((kind) => window.snell.objects.value.every(({ name }) => name !== kind), kind);
    }
    expect(await finished(page)).toBe(before);
  }));

test('a picture too large for the memory is refused, and undo brings the one before', () =>
  on('#lecture/default', async (page) => {
    const before = await finished(page);
    await page.evaluate(() => window.snell.edit([['render.size', '[60000, 60000]']], { label: 'test' }));
    await page.getByRole('alert').waitFor();
    await page.getByRole('button', { name: 'Undo' }).click();
    await page.waitForFunction(() => window.snell.revision.value!.size[0] === 512);
    expect(await finished(page)).toBe(before);
  }));

test('an empty scene and a huge picture leave a page that goes on', () =>
  on('#lecture/default', async (page) => {
    await finished(page);
    const opened = async (body: string) =>
      page.evaluate(async (body) => {
        const text = new TextEncoder().encode(body);
        await window.snell.open({ name: 'x.toml', given: { name: 'x.toml', text, files: [] } }).catch(() => {});
        return [window.snell.refused.value.length, window.snell.revision.value!.size];
      }, body);
    const head = (size: string) => `snell = 1\n[render]\nintegrator = "whitted"\nsize = ${size}\n[camera]\neye = [0, 0, 5]\nlook_at = [0, 0, 0]\nup = [0, 1, 0]\nfov = 40\n`;
    expect(await opened(head('[32, 32]'))).toEqual([0, [32, 32]]);
    await finished(page);
    // More than the memory of an instance: refused, or rendered for ever and stopped by the next scene; never a dead page.
    await opened(head('[60000, 60000]'));
    expect(await opened(head('[16, 16]'))).toEqual([0, [16, 16]]);
    await finished(page);
  }));

test('a search that takes long is cancelled, and the changes that waited for it come', () =>
  on('#lecture/default', async (page) => {
    await begun(page);
    // Every pixel of it, many times: far longer than this test.
    await edit(page, ['render.spp', '1000']);
    await page.getByRole('button', { name: 'green', exact: true }).click();
    await page.getByText('Looking for green').waitFor();
    await page.evaluate(() => {
      window.snell.edit([['material.glass.eta', '1.4']], { label: 'first' });
      window.snell.edit([['render.spp', '1'], ['render.size', '[48, 48]']], { label: 'second' });
    });
    await page.getByRole('button', { name: 'Cancel' }).click();
    await page.waitForFunction(() => window.snell.undoLabel.value === 'second');
    const { eta, size } = await page.evaluate(() => {
      const { scene, size } = window.snell.revision.value!;
      return { eta: scene.material!.glass!.eta, size };
    });
    expect([eta, size]).toEqual([1.4, [48, 48]]);
    expect(await finished(page)).toMatch(/^[0-9a-f]{64}$/);
    await page.getByRole('button', { name: 'green', exact: true }).click();
    await page.waitForFunction(() => window.snell.sighting.value?.object === 'green');
  }));

/** Where a point of the scene is on the page, as the drawing shows it. */
async function inDrawing(page: Page, point: [number, number, number]): Promise<{ x: number; y: number }> {
  return page.evaluate((point) => {
    const { stage, unit } = window.snellSpace!.viewer['drawing']!;
    const { left, top } = stage.canvas.getBoundingClientRect();
    const [x, y] = stage.onScreen(stage.camera.position.clone().fromArray(point).multiplyScalar(unit))!;
    return { x: left + x, y: top + y };
  }, point);
}

/** The end of a handle, on the page, once it is drawn. */
async function tipOf(page: Page, grip: Handle['grip']): Promise<{ x: number; y: number }> {
  const found = await page.waitForFunction((grip) => {
    const drawing = window.snellSpace!.viewer['drawing']!;
    const { stage } = drawing;
    const handle = drawing['editor']['handles'].find((handle) => JSON.stringify(handle.grip) === JSON.stringify(grip));
    if (handle === undefined) return null;
    const { left, top } = stage.canvas.getBoundingClientRect();
    const [x, y] = stage.onScreen(stage.camera.position.clone().fromArray(handle.lines[0]!.to))!;
    return { x: left + x, y: top + y };
  }, grip);
  return (await found.jsonValue())!;
}
