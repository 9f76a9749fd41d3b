// Snell Studio in a cell of JupyterLab, in Chromium: it renders there, and what is changed in it comes back to Python.
//
//   PYTHON=target/python/bin/python node --test tests/jupyterlab/

import assert from 'node:assert/strict';
import { mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { after, before, test } from 'node:test';
import { launch, PATIENCE, run, save, Server } from './jupyterlab.mjs';

const MODEL = 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n';
const CELLS = [
  `import snell
scene = snell.scenes['gallery/ball'].with_('render.size', [96, 64])
scene = scene.replace(meshes=[*scene.meshes, snell.Mesh(file='models/four.obj', material='glass', name='four')])
studio = scene.studio()
studio`,
  // In Python the film is an array of the same numbers.
  `import hashlib
hashlib.sha256(studio.scene.render(progress=False).array.tobytes()).hexdigest()`,
  "(studio.scene == scene.with_('material.glass.eta', 1.25), studio.scene.folder == str(scene.folder))",
  'studio.scene.spheres[0].center',
  "(studio.scene.meshes[-1].file, studio.scene.render(progress=False).array.max() > 0, repr(studio))",
  '(studio.scene.meshes[-1].file, studio.scene.folder == scene.folder, repr(studio))',
];
const server = new Server();
const trouble = [];
let folder, browser, page, studio;

before(async () => {
  folder = mkdtempSync(join(tmpdir(), 'snell-jupyterlab-studio-'));
  mkdirSync(join(folder, 'models'));
  writeFileSync(join(folder, 'models/four.obj'), MODEL);
  const cells = CELLS.map((source, i) => ({ cell_type: 'code', id: `cell${i}`, metadata: {}, source, outputs: [], execution_count: null }));
  const kernelspec = { name: 'python3', display_name: 'Python 3', language: 'python' };
  writeFileSync(join(folder, 'studio.ipynb'), JSON.stringify({ cells, metadata: { kernelspec }, nbformat: 4, nbformat_minor: 5 }));
  browser = await launch();
  await server.start(folder, join(folder, '.home'));
  page = await server.open(browser, 'studio.ipynb', trouble);
  page.on('pageerror', (error) => trouble.push(error.stack ?? error.message));
}, PATIENCE);

after(async () => {
  await browser?.close();
  await server.stop();
  rmSync(folder, { recursive: true, force: true });
});

test('the studio renders in a cell, with the bits of Python', PATIENCE, async () => {
  await run(page, 0);
  const frame = await page.locator('iframe[title="Snell Studio"]').elementHandle(PATIENCE);
  studio = await frame.contentFrame();
  const hash = await finished();
  assert.equal(await run(page, 1), `'${hash}'`);
  if (process.env.SHOT) await page.screenshot({ path: process.env.SHOT });
});

test('what is changed comes back to Python, and what was dragged', PATIENCE, async () => {
  await edit([['material.glass.eta', '1.25']]);
  assert.equal(await run(page, 2), '(True, True)');
  const picture = await studio.locator('.picture > canvas').first().boundingBox();
  const [x, y] = [picture.x + picture.width / 2, picture.y + picture.height * 0.47];
  const before = await run(page, 3);
  await page.mouse.move(x, y);
  await page.mouse.down();
  for (let step = 1; step <= 6; step++) await page.mouse.move(x + 8 * step, y);
  await page.mouse.up();
  await studio.waitForFunction(() => window.snell.undoLabel.value === 'move ball');
  await finished();
  const [left, right] = [before, await run(page, 3)].map((center) => Number(/^\((.*?),/.exec(center)[1]));
  assert.ok(right > left, `the ball is to the right of ${before}`);
});

test('a lesson is no change of the scene, and leads back to it', PATIENCE, async () => {
  const before = await run(page, 3);
  await studio.getByRole('button', { name: 'Learn' }).click();
  await studio.getByRole('menuitem', { name: 'Tour of the lecture' }).click();
  await studio.waitForFunction(() => window.snell.revision.value.size[0] !== 96);
  assert.equal(await run(page, 3), before);
  await studio.getByRole('button', { name: 'Leave the tour' }).click();
  await studio.waitForFunction(() => window.snell.revision.value.size[0] === 96);
  assert.equal(await run(page, 3), before);
});

test('a scene that was dropped on the page comes to Python with its files', PATIENCE, async () => {
  await studio.evaluate((model) => {
    const [bytes, { text }] = [(words) => new TextEncoder().encode(words), window.snell.revision.value];
    const given = { name: 'b/other.toml', text: bytes(text.replace('models/four.obj', '../a/four.obj')), files: [['a/four.obj', bytes(model)]] };
    return window.snell.open({ name: 'b/other.toml', given });
  }, MODEL);
  await finished();
  assert.equal(await run(page, 4), "('../a/four.obj', np.True_, '<Studio of other>')");
});

test('back by undo, the scene has the files that it had in Python', PATIENCE, async () => {
  await studio.getByRole('button', { name: 'Undo' }).click();
  await studio.waitForFunction(() => window.snell.base.value.name === 'ball.toml');
  await finished();
  assert.equal(await run(page, 5), "('models/four.obj', True, '<Studio of gallery/ball>')");
});

test('a saved notebook keeps the picture', PATIENCE, async () => {
  await save(page);
  const { cells } = JSON.parse(readFileSync(join(folder, 'studio.ipynb'), 'utf8'));
  const pictures = cells[0].outputs.flatMap((output) => output.data?.['image/png'] ?? []);
  assert.equal(pictures.length, 1);
  const width = Buffer.from(pictures[0], 'base64').readUInt32BE(16);
  assert.equal(width, 96, 'of the picture that was rendered last, not of the small one at the start');
});

test('once the kernel has started again, the page says that Python does not hear it any more', PATIENCE, async () => {
  await page.evaluate(() => jupyterapp.shell.currentWidget.sessionContext.session.kernel.restart());
  await studio.evaluate(() => window.snell.edit([['material.glass.eta', '1.4']], { label: 'test' }));
  await page.getByText('The kernel that this page belongs to is gone').waitFor(PATIENCE);
  await finished();
  assert.deepEqual(trouble, []);
});

/** Waits for the picture, and for Python to be told of what it shows; returns its hash. */
async function finished() {
  await studio.waitForFunction(() => window.snell?.outcome.value, null, { timeout: 60_000 });
  await page.waitForTimeout(300);
  return studio.evaluate(() => window.snell.outcome.value.sha256);
}

async function edit(edits) {
  const before = await studio.evaluate(() => window.snell.revision.value.text);
  await studio.evaluate((edits) => window.snell.edit(edits, { label: 'test' }), edits);
  await studio.waitForFunction((before) => window.snell.revision.value.text !== before, before);
  await finished();
}
