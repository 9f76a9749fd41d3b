/** Choosing objects in the drawing, and moving them with the pointer and with keys. */

import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, expect, test } from 'vitest';
import type { Vec3 } from '../src/data';
import type { Editing, Movement, ObjectRef } from '../src/editing';
import type { Handle } from '../src/three/handles';
import type { Stage } from '../src/three/stage';
import { launch, open, settled } from './browser';
import { glass } from './fixture';
import { difference, TOLERANCE } from './pictures';

declare global {
  interface Window {
    heard: [string, Movement | ObjectRef | null][];
  }
}

/** Private parts of the drawing. */
interface Inside {
  stage: Stage;
  editor: { handles: Handle[] };
}

let browser: Browser;
beforeAll(async () => {
  browser = await launch();
});
afterAll(() => browser?.close());

const BALL: ObjectRef = { kind: 'sphere', index: 0, name: 'glass' };
const SLAB: ObjectRef = { kind: 'mesh', index: 0, name: 'slab' };
const LAMP: ObjectRef = { kind: 'light', index: 0, name: 'lamp' };
const CENTER: Vec3 = [0, 1.15, 0];

/** A scene that does what a studio does: it moves the ball as it is told, each time from where it was at the start. */
async function openStudio(name: string, editing: Partial<Editing> = {}) {
  const { scene } = glass();
  const opened = await open(browser, `editing-${name}`, { scene });
  await opened.page.evaluate(([scene, editing]) => {
    const { viewer } = window;
    window.heard = [];
    viewer.on('object', (object) => window.heard.push(['object', object]));
    for (const event of ['move', 'moved'] as const) {
      viewer.on(event, (change) => {
        window.heard.push([event, change]);
        if (change.kind !== 'move' || change.object.kind !== 'sphere') return;
        const spheres = scene.spheres.map((sphere, index) =>
          index === change.object.index ? { ...sphere, center: change.at.map((x, axis) => x + change.by[axis]!) as typeof change.at } : sphere,
        );
        viewer.setScene({ ...scene, spheres });
      });
    }
    viewer.setObjects({ selected: null, handles: null, snap: null, ...editing });
  }, [scene, editing] as const);
  await opened.page.getByLabel('Names').uncheck();
  await settled(opened.page);
  return opened;
}

/** Where a point of the scene is on the page. */
async function placeOf(page: Page, [x, y, z]: Vec3): Promise<[number, number]> {
  const box = (await page.locator('canvas').boundingBox())!;
  const at = await page.evaluate(([x, y, z]) => {
    const { stage, unit } = window.viewer['drawing']!;
    return stage.onScreen(stage.camera.position.clone().set(x, y, z).multiplyScalar(unit))!;
  }, [x, y, z] as const);
  return [box.x + at[0], box.y + at[1]];
}

/** The middle of a handle, on the page. */
async function handle(page: Page, grip: object): Promise<[number, number]> {
  const box = (await page.locator('canvas').boundingBox())!;
  const at = await page.evaluate((grip) => {
    const { stage, editor } = window.viewer['drawing']! as never as Inside;
    const found = editor.handles.find((handle) => JSON.stringify(handle.grip) === JSON.stringify(grip))!;
    return stage.onScreen(stage.camera.position.clone().fromArray(found.lines[0]!.to))!;
  }, grip);
  return [box.x + at[0], box.y + at[1]];
}

async function pull(page: Page, from: [number, number], by: [number, number], release = true): Promise<void> {
  await page.mouse.move(...from);
  await page.mouse.down();
  for (let step = 1; step <= 5; step++) await page.mouse.move(from[0] + (by[0] * step) / 5, from[1] + (by[1] * step) / 5);
  if (release) await page.mouse.up();
  await settled(page);
}

const heard = (page: Page) => page.evaluate(() => window.heard);
const movements = async (page: Page) => (await heard(page)) as [string, Movement][];
const eye = (page: Page) => page.evaluate(() => window.viewer['drawing']!.stage.camera.position.toArray());

test('an object is chosen by a click, and none beside', async () => {
  const { page, trouble } = await openStudio('choose');
  await page.mouse.click(...(await placeOf(page, CENTER)));
  await page.mouse.click(...(await placeOf(page, [3, 0, 2])));
  await page.mouse.click(...(await placeOf(page, [-3, 4.6, 0.4])));
  await page.mouse.click(...(await placeOf(page, [0.6, 2.5, 7.4])));
  await page.mouse.click(30, 400);
  const camera = { kind: 'camera', index: 0, name: 'camera' };
  expect(await heard(page)).toEqual([BALL, SLAB, LAMP, camera, null].map((object) => ['object', object]));
  expect(trouble).toEqual([]);
  await page.close();
});

test('a ball follows the pointer while the scene is shown again and again, and the eye stays', async () => {
  const { page, trouble } = await openStudio('ball', { selected: BALL, handles: 'move' });
  const before = await eye(page);
  const from = await placeOf(page, CENTER);
  await pull(page, from, [60, -25]);
  const events = await movements(page);
  expect(events.map(([event]) => event)).toEqual(['move', 'move', 'move', 'move', 'move', 'moved']);
  const last = events.at(-1)![1];
  expect(last).toMatchObject({ kind: 'move', object: BALL, at: CENTER });
  const now = CENTER.map((x, axis) => x + (last as { by: Vec3 }).by[axis]!) as Vec3;
  const place = await placeOf(page, now);
  expect(Math.hypot(place[0] - from[0] - 60, place[1] - from[1] + 25)).toBeLessThan(1);
  expect(await eye(page)).toEqual(before);
  // The end of a drag is no click.
  expect(await page.evaluate(() => window.heard.some(([event]) => event === 'object'))).toBe(false);
  // Beside the ball, the eye turns again.
  await pull(page, [200, 600], [50, 0]);
  expect(await eye(page)).not.toEqual(before);
  expect(trouble).toEqual([]);
  await page.close();
});

test('a handle moves along its axis, in steps', async () => {
  const { page } = await openStudio('axis', { selected: BALL, handles: 'move', snap: 0.25 });
  const [x, y] = await handle(page, { do: 'move', axis: [0, 1, 0] });
  const [, bottom] = await placeOf(page, CENTER);
  await pull(page, [x, y + (bottom - y) / 2], [3, -60]);
  const { by } = (await movements(page)).at(-1)![1] as { by: Vec3 };
  expect([by[0], by[2]]).toEqual([0, 0]);
  expect(by[1]).toBeGreaterThan(0);
  expect(by[1] % 0.25).toBe(0);
  await page.close();
});

test('a mesh is turned about an axis, and scaled along one', async () => {
  const { page } = await openStudio('mesh', { selected: SLAB, handles: 'turn' });
  await pull(page, await handle(page, { do: 'turn', axis: [0, 1, 0] }), [30, 10]);
  const [turn] = (await movements(page)).at(-1)!.slice(1) as [Movement];
  expect(turn).toMatchObject({ kind: 'turn', axis: [0, 1, 0], object: SLAB, at: [0, -0.125, -0.9].map((x) => expect.closeTo(x, 6)) });
  expect(Math.abs((turn as { degrees: number }).degrees)).toBeGreaterThan(3);
  await page.evaluate((selected) => window.viewer.setObjects({ selected, handles: 'scale', snap: null }), SLAB);
  await settled(page);
  const tip = await handle(page, { do: 'scale', axis: [1, 0, 0] });
  const middle = await placeOf(page, [0, -0.125, -0.9]);
  await pull(page, tip, [(tip[0] - middle[0]) / 2, (tip[1] - middle[1]) / 2]);
  const scale = (await movements(page)).at(-1)![1] as { by: Vec3 };
  expect(scale.by[0]).toBeGreaterThan(1.3);
  expect(scale.by.slice(1)).toEqual([1, 1]);
  await page.close();
});

test('the camera is moved by its eye, and by what it looks at', async () => {
  const camera = { kind: 'camera', index: 0, name: 'camera' } as const;
  const { page } = await openStudio('camera', { selected: camera, handles: 'move', target: [0, 0.85, 0] });
  await pull(page, await placeOf(page, [0.6, 2.5, 7.4]), [0, -40]);
  const [eye] = (await movements(page)).at(-1)!.slice(1) as [Movement];
  expect(eye).toMatchObject({ kind: 'move', object: camera, at: [0.6, 2.5, 7.4] });
  await page.mouse.click(...(await placeOf(page, [0, 0.85, 0])));
  const target = { ...camera, index: 1 };
  expect((await heard(page)).at(-1)).toEqual(['object', target]);
  await page.evaluate((selected) => window.viewer.setObjects({ selected, handles: 'move', snap: 0.5, target: [0, 0.85, 0] }), target);
  await settled(page);
  await pull(page, await placeOf(page, [0, 0.85, 0]), [0, -80]);
  expect((await movements(page)).at(-1)![1]).toMatchObject({ object: target, at: [0, 0.85, 0] });
  await page.close();
});

test('Escape takes a drag back', async () => {
  const { page } = await openStudio('escape', { selected: BALL, handles: 'move' });
  const calm = async () => {
    await page.mouse.move(0, 0);
    await page.evaluate(() => (document.querySelector('#app > div')!.shadowRoot!.activeElement as HTMLElement | null)?.blur());
    await settled(page);
    return page.locator('.stage').screenshot();
  };
  const before = await calm();
  await pull(page, await placeOf(page, CENTER), [60, -25], false);
  await page.keyboard.press('Escape');
  await page.mouse.move(500, 500);
  await page.mouse.up();
  const last = (await movements(page)).slice(-2);
  expect(last.map(([event, change]) => [event, (change as { by: Vec3 }).by])).toEqual([['move', [0, 0, 0]], ['moved', [0, 0, 0]]]);
  expect((await calm()).equals(before)).toBe(true);
  await page.close();
});

test('Alt and arrows move it, and a held key is one step to undo', async () => {
  const { page } = await openStudio('keys', { selected: BALL, handles: 'move', snap: 0.5 });
  const canvas = page.getByRole('application', { name: 'The scene in 3D; the sphere glass is selected' });
  await canvas.focus();
  const before = await eye(page);
  await page.keyboard.down('Alt');
  await page.keyboard.down('ArrowUp');
  await page.keyboard.down('ArrowUp');
  await page.keyboard.up('ArrowUp');
  await page.keyboard.press('PageUp');
  await page.keyboard.up('Alt');
  const events = (await movements(page)).map(([event, change]) => [event, (change as { by: Vec3 }).by] as const);
  expect(events.map(([event]) => event)).toEqual(['move', 'move', 'moved', 'move', 'moved']);
  expect(events[2]![1]).toEqual([0, 1, 0]);
  // Away from the eye, along the axis nearest to that.
  expect(events[4]![1].filter((part) => part !== 0)).toHaveLength(1);
  expect(events[4]![1].reduce((sum, part, axis) => sum + part * before[axis]!, 0)).toBeLessThan(0);
  expect(await eye(page)).toEqual(before);
  await page.close();
});

test.each([
  ['a ball', 'move', BALL],
  ['a ball', 'scale', BALL],
  ['a mesh', 'turn', SLAB],
] as const)('the handles of %s to %s it look as they did', async (_, handles, selected) => {
  const { page } = await openStudio(`${selected.name}-${handles}`, { selected, handles });
  await page.evaluate(() => {
    const style = Object.assign(document.createElement('style'), { textContent: '.toolbar, .footer { opacity: 0 }' });
    document.querySelector('#app > div')!.shadowRoot!.append(style);
  });
  await settled(page);
  const picture = await page.locator('.stage').screenshot();
  expect(difference(`handles-${selected.name}-${handles}`, picture), 'see test/out').toBeLessThanOrEqual(TOLERANCE);
  await page.close();
});
