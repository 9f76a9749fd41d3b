/** A pixel says why it has its colour: in words, as a tree, step by step, and in the drawing. */

import type { Locator, Page } from 'playwright-core';
import { expect, test } from 'vitest';
import { project } from '../src/picture/drag';
import { textOf } from './native';
import { begun, edit, finished, openText, OUT, pin, placeOf, save, studio } from './page';

const host = studio();
const { on } = host;

test('a clicked pixel says why, its shares sum to all of it, and nothing stays in the picture once it is let go', () =>
  on('#lecture/default', async (page) => {
    await finished(page);
    const picture = async () => (await page.locator('.picture').screenshot()).toString('base64');
    const before = await picture();
    await pin(page, [300, 300]);
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
    expect(await picture()).not.toBe(before);
    await page.getByRole('button', { name: 'Let go of this pixel' }).click();
    await expect.poll(picture, { timeout: 10_000 }).toBe(before);
  }));

test('the player steps through the generations: the tree grows, and the colour becomes that of the pixel', () =>
  on('#lecture/default', async (page) => {
    await openBubbles(page);
    await pin(page, [56, 40]);
    const player = page.getByRole('group', { name: 'Generations of rays' });
    await player.getByLabel('Generation', { exact: true }).fill('0');
    const states = [await stateOf(page, player)];
    const { last } = states[0]!;
    expect(last).toBeGreaterThan(5);
    for (let generation = 1; generation <= last; generation++) {
      await player.getByRole('button', { name: 'Next generation' }).click();
      states.push(await stateOf(page, player));
    }
    expect(states.map(({ generation }) => generation)).toEqual(states.map((_, at) => at));
    const { nodes, color } = await page.evaluate(() => ({ nodes: window.snell.tree.value!.samples[0]!.nodes, color: window.snell.tree.value!.color }));
    expect(states[0]).toMatchObject({ rays: 1, rows: 1 });
    for (let at = 1; at < states.length; at++) {
      expect(states[at]!.rays).toBeGreaterThan(states[at - 1]!.rays);
      expect(states[at]!.rows).toBeGreaterThanOrEqual(states[at - 1]!.rows);
    }
    expect(states.at(-1)!.rays).toBe(nodes.length);
    expect(states.at(-1)!.rows).toBeGreaterThan(states[1]!.rows);
    expect(states.at(-1)!.color).toEqual(color);
    expect(states.at(-1)!.soFar).toBe(states[0]!.whole);
    expect(states[0]!.soFar).not.toBe(states[0]!.whole);
    await page.screenshot({ path: `${OUT}player.png` });
    await player.getByRole('button', { name: 'Generation before' }).click();
    expect(await stateOf(page, player)).toEqual(states.at(-2));
  }));

test('small shares are folded, and what a row of the tree is about is marked in the picture', () =>
  on('#lecture/default', async (page) => {
    await openBubbles(page);
    await pin(page, [56, 40]);
    const tree = page.getByRole('tree', { name: 'Ray tree' });
    const others = tree.getByRole('treeitem', { name: /^\d+ others, / }).first();
    for (let depth = 0; (await others.count()) === 0 && depth < 12; depth++) {
      await tree.getByRole('treeitem', { expanded: false }).first().locator('.twist').click();
    }
    const count = Number(/^(\d+) others/.exec((await others.getAttribute('aria-label'))!)![1]);
    const level = Number(await others.getAttribute('aria-level'));
    expect(count).toBeGreaterThan(1);
    const rows = () => tree.getByRole('treeitem').count();
    const before = await rows();
    await others.click();
    expect(await rows()).toBe(before + count);
    const inside = tree.locator(`[aria-level="${level + 1}"]`);
    // Each below the hundredth from which on a ray has a row of its own.
    for (const label of (await inside.evaluateAll((rows) => rows.map((row) => row.getAttribute('aria-label')!))).slice(-count)) {
      expect(label).toMatch(/, (0\.\d%|0%|< 0\.1%) of the light$/);
    }
    await others.click();
    expect(await rows()).toBe(before);

    // The ray from the eye ends at the pixel itself.
    await tree.getByRole('treeitem').first().hover();
    const pixel = await placeOf(page, [56, 40]);
    await marked(page, pixel);
    const { row, point, camera, size } = await page.evaluate(() => {
      const { view, size } = window.snell.revision.value!;
      const node = window.snell.tree.value!.samples[0]!.nodes.find(({ parent, kind }) => parent === 0 && kind === 'inside')!;
      return { row: node.id, point: node.hit!.point, camera: view.camera, size };
    });
    await tree.locator(`[data-id="${row}"]`).hover();
    const [x, y] = project(camera, size, point)!;
    const scale = await page.evaluate(() => window.snell.surface.canvas.getBoundingClientRect().width / window.snell.surface.canvas.width);
    const elsewhere = { x: pixel.x + (x - 56.5) * scale, y: pixel.y + (y - 40.5) * scale };
    expect(Math.hypot(elsewhere.x - pixel.x, elsewhere.y - pixel.y)).toBeGreaterThan(5);
    await marked(page, elsewhere);
    await page.screenshot({ path: `${OUT}branch.png` });
    await page.mouse.move(pixel.x + 30, pixel.y);
    await expect.poll(() => markIn(page)).toBe(null);
  }));

test('the scene is seen from a light, through the camera, and as a whole again', () =>
  on('#lecture/default', async (page) => {
    await page.waitForFunction(() => window.snellSpace != null);
    const start = await eye(page);
    await page.getByLabel('Look from a light').selectOption({ label: 'right' });
    const right = await eye(page);
    expect(right.at).toEqual([80, 100, 100].map((value) => expect.closeTo(value, 6)));
    // The spheres are before it.
    expect(right.sees).toEqual(['glass', 'red', 'green', 'blue']);
    await page.screenshot({ path: `${OUT}from-light.png` });
    await page.getByLabel('Look from a light').selectOption({ label: 'left' });
    expect((await eye(page)).at).toEqual([20, 100, 100].map((value) => expect.closeTo(value, 6)));
    await page.getByRole('button', { name: 'Through the camera' }).click();
    expect((await eye(page)).at).toEqual([50, 50, 100].map((value) => expect.closeTo(value, 6)));
    await page.getByRole('button', { name: 'Overview' }).click();
    expect(await eye(page)).toEqual({ ...start, at: start.at.map((value) => expect.closeTo(value, 6)) });
  }));

test('where green is seen is found, and by which path', () =>
  on('#study/quarter-view', async (page) => {
    await finished(page);
    await page.getByRole('button', { name: 'green', exact: true }).click();
    const rarest = page.locator('.paths button').last();
    await rarest.waitFor({ timeout: 60_000 });
    const share = () => page.evaluate(() => window.snell.sighting.value!.mask.reduce((sum, value) => sum + Number(value > 0), 0));
    const all = await share();
    await rarest.click();
    await page.waitForFunction(() => window.snell.sighting.value!.path !== null, undefined, { timeout: 60_000 });
    const one = await share();
    expect(one).toBeGreaterThan(0);
    expect(one).toBeLessThan(all);
    const told = Number((await rarest.locator('.quiet').innerText()).replace(/\D/g, ''));
    expect(one).toBe(told);
    await page.screenshot({ path: `${OUT}find.png` });
  }));

test('the explanation of a pixel is a page that needs nothing else', () =>
  on('#lecture/default', async (page) => {
    await openBubbles(page);
    await pin(page, [56, 40]);
    const html = (await save(page, 'Save explanation')).toString();
    const other = await host.browser.newPage();
    const errors: string[] = [];
    other.on('pageerror', (error) => errors.push(error.message));
    await other.setContent(html);
    await other.getByRole('treeitem').first().waitFor();
    expect(errors).toEqual([]);
    await other.close();
  }));

/** Many rays for each pixel: few pixels. */
async function openBubbles(page: Page): Promise<void> {
  await begun(page);
  await openText(page, 'gallery/bubbles', textOf('gallery/bubbles', [80, 80]));
}

/** What the player says and shows. */
async function stateOf(page: Page, player: Locator) {
  const [, generation, last, rays] = /Generation (\d+) of (\d+): (\d+) rays?/.exec(await player.innerText())!.map(Number) as [number, number, number, number];
  const color = await page.evaluate((generation) => window.snellSpace!.viewer['panel'].model!.colorUntil(generation), generation);
  const background = (title: string) => player.getByTitle(title).evaluate((swatch) => getComputedStyle(swatch).backgroundColor);
  const rows = await page.getByRole('treeitem').count();
  return { generation, last, rays, color, rows, soFar: await background('Colour so far'), whole: await background('Colour in the end') };
}

/** Waits until a ring is around a place, as exactly as its pixels can be counted. */
async function marked(page: Page, { x, y }: { x: number; y: number }): Promise<void> {
  const away = async () => {
    const mark = await markIn(page);
    return mark === null ? Infinity : Math.hypot(mark.x - x, mark.y - y);
  };
  await expect.poll(away, { timeout: 10_000 }).toBeLessThan(2);
}

/** The middle of the ring over the picture, in pixels of the page; nothing where there is none. */
function markIn(page: Page): Promise<{ x: number; y: number } | null> {
  return page.evaluate(() => {
    const canvas = document.querySelector<HTMLCanvasElement>('.overlay')!;
    const { data, width, height } = canvas.getContext('2d')!.getImageData(0, 0, canvas.width, canvas.height);
    const { left, top } = canvas.getBoundingClientRect();
    let [count, across, down] = [0, 0, 0];
    for (let at = 0; at < width * height; at++) {
      const [red, green, blue] = data.subarray(4 * at, 4 * at + 3) as unknown as [number, number, number];
      if (red < 230 || Math.abs(green - 214) > 25 || Math.abs(blue - 107) > 40) continue;
      count++;
      across += at % width;
      down += Math.floor(at / width);
    }
    return count === 0 ? null : { x: left + across / count + 0.5, y: top + down / count + 0.5 };
  });
}

/** From where the drawing is seen, in units of the scene, and which spheres are in it. */
function eye(page: Page): Promise<{ at: number[]; sees: string[] }> {
  return page.evaluate(() => {
    const { stage, unit } = window.snellSpace!.viewer['drawing']!;
    const { position } = stage.camera;
    const { x: width, y: height } = stage.uniforms.size.value;
    stage.camera.updateMatrixWorld();
    const sees = window.snell.revision.value!.view.spheres.filter(({ center }) => {
      const place = stage.onScreen(position.clone().fromArray(center).multiplyScalar(unit));
      return place !== null && place[0] > 0 && place[0] < width && place[1] > 0 && place[1] < height;
    });
    return { at: position.toArray().map((value) => value / unit), sees: sees.map(({ name }) => name) };
  });
}

test('a picture that is black all over says why, and nobody has to look for it', () =>
  on('#lecture/default', async (page) => {
    await finished(page);
    await edit(page, ['ambient', '0'], ['light.left.color', '0'], ['light.right.color', '0']);
    await page.getByText('nothing sends out light: its lights are black').waitFor();
    await edit(page, ['light.left.color', '0.5']);
    await page.getByText('nothing sends out light').waitFor({ state: 'detached' });
  }));
