/** Two things of the same name, which are not the same thing. */

import type { Page } from 'playwright-core';
import { expect, test } from 'vitest';
import { drag, finished, OUT, placeOf, studio } from './page';

const { on } = studio();

const SCENE = `snell = 1
ambient = 0.6

[render]
integrator = "lecture"
size = [240, 160]

[camera]
eye = [0, 0, 10]
look_at = [0, 0, 0]
up = [0, 1, 0]
fov = 45

[[light]]
name = "lamp"
position = [0, 9, 9]
color = 0.6

[[light]]
name = "lamp"
position = [9, 9, 0]
color = 0.2

[material.paint]
kd = [0.8, 0.4, 0.2]
ka = 0.4

[[sphere]]
name = "ball"
center = [-2.5, 0, 0]
radius = 1
material = "paint"

[[sphere]]
name = "ball"
center = [2.5, 0, 0]
radius = 1
material = "paint"
`;

async function openScene(page: Page): Promise<void> {
  await finished(page);
  await page.evaluate((text) => window.snell.open({ name: 'balls.toml', given: { name: 'balls.toml', text: new TextEncoder().encode(text), files: [] } }), SCENE);
  await finished(page);
}

const centers = (page: Page) => page.evaluate(() => window.snell.revision.value!.scene.sphere!.map(({ center }) => center));

test('the second of them is dragged in the picture, changed by its numbers, and removed, and the first stays', () =>
  on('#lecture/default', async (page) => {
    await openScene(page);
    await page.getByRole('tab', { name: 'Scene' }).click();
    await drag(page, await placeOf(page, [168, 80]), [0, -60]);
    await page.waitForFunction(() => window.snell.revision.value!.scene.sphere![1]!.center[1] > 1);
    const [first, second] = await centers(page);
    expect([first, second![0], second![2]]).toEqual([[-2.5, 0, 0], 2.5, 0]);
    await page.getByRole('button', { name: 'ball (2)', exact: true, pressed: true }).waitFor();
    await page.screenshot({ path: `${OUT}names.png` });

    const values = page.getByRole('region', { name: 'Values of ball (2)' });
    await values.getByRole('textbox', { name: 'Radius' }).fill('0.5');
    await page.keyboard.press('Enter');
    await page.waitForFunction(() => window.snell.revision.value!.scene.sphere![1]!.radius === 0.5);
    await page.getByRole('button', { name: 'Remove ball (2)' }).click();
    await page.waitForFunction(() => window.snell.revision.value!.scene.sphere!.length === 1);
    expect(await centers(page)).toEqual([[-2.5, 0, 0]]);
    expect(await page.evaluate(() => window.snell.selected.value)).toBe(null);
  }));

test('each is itself in the drawing', () =>
  on('#lecture/default', async (page) => {
    await openScene(page);
    const keys = await page.evaluate(() => {
      const { snell } = window;
      const keyOf = (kind: 'sphere' | 'light', index: number) => snell.objectOf({ kind, index, name: '' })?.key;
      return [keyOf('sphere', 0), keyOf('sphere', 1), keyOf('light', 0), keyOf('light', 1)];
    });
    expect(keys).toEqual(['sphere.1', 'sphere.2', 'light.1', 'light.2']);
    expect(await page.getByLabel('Look from a light').locator('option').allInnerTexts()).toEqual(['From a light', 'lamp', 'lamp (2)']);
  }));
