// A notebook in JupyterLab, in Chromium: a slider changes the picture, a click on a pixel draws its rays, and what is saved
// shows its pictures when it is opened again without the network and without the kernel that made them.
//
//   PYTHON=target/python/bin/python node --test tests/jupyterlab/

import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { launch, PATIENCE, runAll, save, Server } from './jupyterlab.mjs';

const CELLS = [
  "import snell\nscene = snell.scenes['lecture/default']\nsnell.interact(scene, eta=(1.0, 4.0), width=200)",
  'scene.view(width=256)',
];
const server = new Server();
const trouble = [];
let folder, browser, page;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), 'snell-jupyterlab-'));
  const cells = CELLS.map((source, i) => ({ cell_type: 'code', id: `cell${i}`, metadata: {}, source, outputs: [], execution_count: null }));
  const kernelspec = { name: 'python3', display_name: 'Python 3', language: 'python' };
  writeFileSync(join(folder, 'lecture.ipynb'), JSON.stringify({ cells, metadata: { kernelspec }, nbformat: 4, nbformat_minor: 5 }));
  browser = await launch();
}, PATIENCE);

after(async () => {
  await browser?.close();
  await server.stop();
  rmSync(folder, { recursive: true, force: true });
});

test('a slider renders the scene anew while it moves', PATIENCE, async () => {
  await open();
  await runAll(page);
  const picture = output(0).locator('img');
  await picture.waitFor(PATIENCE);
  const handle = output(0).locator('.noUi-handle');
  await handle.waitFor(PATIENCE);
  const first = await digest(picture);
  await handle.focus();
  for (let step = 0; step < 5; step++) await page.keyboard.press('ArrowRight');
  await page.waitForFunction(() => document.querySelector('.jp-OutputArea .widget-readout')?.textContent === '2.10', null, { timeout: 20_000 });
  await changes(picture, first);
  await output(0).getByText('million rays').waitFor();
});

test('the view shows the scene, from a light as well, and the rays of a pixel that is clicked on', PATIENCE, async () => {
  const canvas = output(1).locator('canvas');
  await canvas.waitFor(PATIENCE);
  assert.equal(await output(1).locator('img').isVisible(), false, 'the still picture hides while the view is alive');
  const seen = await look(canvas);
  await output(1).getByRole('button', { name: 'From light left' }).click();
  await differs(canvas, seen);
  await output(1).getByRole('button', { name: 'Look through the camera' }).click();
  await page.waitForTimeout(1500); // the eye flies there
  // The pointer is told the pixel below it: two of them say where the others are.
  const box = await canvas.boundingBox();
  const [x, y] = [box.x + box.width / 2, box.y + box.height / 2];
  const below = async (dx, dy) => {
    await page.mouse.move(x + dx, y + dy);
    const [column, row] = (await output(1).locator('.target').textContent()).split(', ').map(Number);
    return [column, row];
  };
  const [low, high] = [await below(-80, -80), await below(80, 80)];
  const [dx, dy] = [95, 150].map((pixel, axis) => -80 + (160 * (pixel - low[axis])) / (high[axis] - low[axis]));
  assert.deepEqual(await below(dx, dy), [95, 150]);
  await page.mouse.click(x + dx, y + dy);
  await output(1).getByText('Green because 53 %').waitFor();
  await output(1).getByRole('treeitem', { name: /Refracted ray hits green/ }).waitFor();
});

test('a saved notebook has its pictures without network and kernel', PATIENCE, async () => {
  // The view sends its still picture when it has been quiet for a moment.
  await page.waitForTimeout(2500);
  await save(page);
  const saved = JSON.parse(readFileSync(join(folder, 'lecture.ipynb'), 'utf8'));
  const stills = saved.cells.map((cell) => cell.outputs.flatMap((o) => o.data?.['image/png'] ?? []).map((png) => png.trim()));
  assert.deepEqual(stills.map((pngs) => pngs.length), [1, 1], 'one picture in each cell');
  await server.stop();
  await page.context().close();
  await open();
  for (const [cell, [png]] of stills.entries()) {
    const picture = output(cell).locator('img');
    await picture.waitFor(PATIENCE);
    assert.ok(await picture.isVisible());
    assert.ok(await picture.evaluate((img) => img.complete && img.naturalWidth > 100));
    assert.equal(await digest(picture), createHash('sha256').update(png).digest('hex'), 'the picture that was saved');
  }
  if (process.env.SHOT) await page.screenshot({ path: process.env.SHOT });
  assert.deepEqual(trouble, []);
});

/** A new server, as the same person has it. */
async function open() {
  await server.start(folder, join(folder, '.home'));
  page = await server.open(browser, 'lecture.ipynb', trouble);
}

function output(cell) {
  return page.locator('.jp-CodeCell').nth(cell).locator('.jp-Cell-outputArea');
}

/** Of the bytes that a picture is made of. */
async function digest(picture) {
  const url = await picture.getAttribute('src');
  return createHash('sha256').update(url.slice(url.indexOf(',') + 1).trim()).digest('hex');
}

async function look(element) {
  return createHash('sha256').update(await element.screenshot()).digest('hex');
}

async function changes(picture, before) {
  await until(async () => (await digest(picture)) !== before, 'the picture changes');
}

async function differs(element, before) {
  await until(async () => (await look(element)) !== before, 'the drawing changes');
}

async function until(holds, what) {
  for (let attempt = 0; attempt < 50; attempt++) {
    if (await holds()) return;
    await page.waitForTimeout(200);
  }
  assert.fail(`expected: ${what}`);
}
