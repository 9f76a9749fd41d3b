/** What people do in the studio, as they do it. Usage: SNELL=../target/ci/snell npx vitest run test */

import { execFileSync, spawn } from 'node:child_process';
import { existsSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import type { Server } from 'node:http';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';
import type { Browser, Page } from 'playwright-core';
import { PNG } from 'pngjs';
import { afterAll, beforeAll, expect, test } from 'vitest';
import { DIST, finished, launch, open, OUT, placeOf, serve } from './page';

const snell = process.env.SNELL ?? '../target/ci/snell';
let browser: Browser;
let server: Server;
let url: string;

beforeAll(async () => {
  browser = await launch();
  ({ url, server } = await serve());
});
afterAll(async () => {
  await browser?.close();
  server?.close();
});

/** Opens a page, does something in it, and expects no trouble. */
async function on(fragment: string, act: (page: Page) => Promise<void>, options: Parameters<typeof open>[2] = {}): Promise<void> {
  const { page, trouble } = await open(browser, url + fragment, options);
  await act(page);
  expect(trouble).toEqual([]);
  await page.context().close();
}

function nativeHash(name: string, ...args: string[]): string {
  const lines = execFileSync('sh', ['-c', `exec "$@" 2>&1`, 'sh', snell, 'render', name, ...args, '--progress', 'json', '-o', `${OUT}native.npy`], { encoding: 'utf8' });
  return (JSON.parse(lines.trim().split('\n').at(-1)!) as { film_sha256: string }).film_sha256;
}

const text = (page: Page) => page.evaluate(() => window.snell.revision.value!.text);
const center = (page: Page) => page.evaluate(() => window.snell.revision.value!.scene.sphere!.find(({ name }) => name === 'glass')!.center);

test('it opens, renders, and has the bits of the command line', () =>
  on('', async (page) => {
    expect(await finished(page)).toBe(nativeHash('lecture/default'));
    await page.getByText('the same bits as the command line').waitFor();
    await page.screenshot({ path: `${OUT}first.png` });
  }));

test('the sphere is dragged in the picture, and the drag is one step to undo', () =>
  on('#lecture/default', async (page) => {
    await finished(page);
    const from = await placeOf(page, [256, 256]);
    await page.mouse.move(from.x, from.y);
    await page.waitForFunction(() => window.snell.tree.value?.pixel[0] === 256);
    await page.mouse.down();
    for (let step = 1; step <= 10; step++) await page.mouse.move(from.x + 6 * step, from.y + 3 * step);
    await page.mouse.up();
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

test('a clicked pixel says why, and its shares sum to all of it', () =>
  on('#lecture/default', async (page) => {
    await finished(page);
    const at = await placeOf(page, [300, 300]);
    await page.mouse.click(at.x, at.y);
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
  }));

test('a text that is broken says where, keeps the picture, and is taken back by undo', () =>
  on('#lecture/default', async (page) => {
    const before = await finished(page);
    await page.getByRole('tab', { name: 'Source' }).click();
    await page.locator('.cm-content').click();
    await page.keyboard.press('Control+Home');
    await page.keyboard.type('nonsense = 5\n');
    await page.getByRole('alert').getByText('nonsense').waitFor();
    await page.waitForTimeout(700);
    await page.goto(url);
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

test('the work survives a reload', () =>
  on('#lecture/default', async (page) => {
    await finished(page);
    await page.evaluate(() => window.snell.edit([['material.glass.eta', '1.5']], { label: 'test' }));
    await page.waitForFunction(() => window.snell.revision.value!.scene.material!.glass!.eta === 1.5);
    const hash = await finished(page);
    await page.goto(url);
    await page.reload();
    expect(await finished(page)).toBe(hash);
  }));

test('a link holds the whole scene', () =>
  on('#gallery/ball', async (page) => {
    await finished(page);
    await page.evaluate(() => window.snell.edit([['render.size', '[60, 40]'], ['material."glass".eta', '1.7']], { label: 'test' }));
    await page.waitForFunction(() => window.snell.revision.value!.size[0] === 60);
    const hash = await finished(page);
    await page.getByRole('button', { name: 'Share' }).click();
    await page.getByRole('menuitem', { name: 'Copy a link' }).click();
    await page.getByText('The link is copied').waitFor();
    const link = await page.evaluate(() => navigator.clipboard.readText());
    const other = await open(browser, link);
    expect(await finished(other.page)).toBe(hash);
    expect(other.trouble).toEqual([]);
    await other.page.context().close();
  }));

test('what is saved is what the command line writes', () =>
  on('#lecture/default', async (page) => {
    await finished(page);
    await page.getByRole('button', { name: 'File' }).click();
    const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('menuitem', { name: 'Save picture' }).click()]);
    const saved = readFileSync(await download.path());
    execFileSync(snell, ['render', 'lecture/default', '-o', `${OUT}native.png`]);
    expect(saved.equals(readFileSync(`${OUT}native.png`))).toBe(true);
  }));

test('a picture that was stopped is saved as far as it had come', () =>
  on('#gallery/ice', async (page) => {
    await page.waitForFunction(() => window.snell?.frame.value > 2 && window.snell.progress.value.pixels > 0);
    await page.getByRole('button', { name: 'Stop' }).click();
    await page.waitForTimeout(500);
    const shown = await page.evaluate(() => {
      const { canvas } = window.snell.surface;
      return [...canvas.getContext('2d')!.getImageData(0, 0, canvas.width, canvas.height).data];
    });
    expect(await page.evaluate(() => window.snell.outcome.value)).toBe(null);
    await page.getByRole('button', { name: 'File' }).click();
    const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('menuitem', { name: 'Save picture' }).click()]);
    const { data, width, height } = PNG.sync.read(readFileSync(await download.path()));
    expect(shown.length).toBe(4 * width * height);
    expect(shown.filter((value, at) => value !== data[at]).length).toBe(0);
    expect(shown.filter((value, at) => at % 4 !== 3 && value > 0).length).toBeGreaterThan(width * height);
  }));

test('the explanation of a pixel is a page that needs nothing else', () =>
  on('#gallery/bubbles', async (page) => {
    await finished(page);
    const at = await placeOf(page, [200, 200]);
    await page.mouse.click(at.x, at.y);
    await page.waitForFunction(() => window.snell.pinned.value && window.snell.tree.value?.pixel[0] === window.snell.pinned.value[0]);
    await page.getByRole('button', { name: 'File' }).click();
    const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('menuitem', { name: 'Save explanation' }).click()]);
    const html = readFileSync(await download.path(), 'utf8');
    const other = await browser.newPage();
    const errors: string[] = [];
    other.on('pageerror', (error) => errors.push(error.message));
    await other.setContent(html);
    await other.getByRole('treeitem').first().waitFor();
    expect(errors).toEqual([]);
    await other.close();
  }));

test('with one worker and with three the film is the same', async () => {
  const expected = nativeHash('gallery/window');
  for (const threads of [1, 3]) {
    await on('#gallery/window', async (page) => expect(await finished(page)).toBe(expected), { threads });
  }
});

test('places of exercises are graded when asked, and nothing tells the answer before', () =>
  on('#exercise/leaves', async (page) => {
    await page.getByText('Click the place in the picture').waitFor();
    await finished(page);
    const asked = await placeOf(page, [300, 180]);
    await page.mouse.move(asked.x, asked.y);
    await page.waitForTimeout(300);
    expect(await page.evaluate(() => window.snell.tree.value)).toBe(null);
    await page.getByRole('button', { name: 'Check' }).click();
    await page.getByText('Choose an answer first.').waitFor();
    await page.mouse.click(asked.x, asked.y);
    await page.getByRole('button', { name: 'Check' }).click();
    // A ray that went straight on would leave at the pixel where it came in.
    await page.getByText('✗ Not quite.').waitFor();
  }));

test('a pinned pixel does not keep things from being dragged', () =>
  on('#lecture/default', async (page) => {
    await finished(page);
    const elsewhere = await placeOf(page, [10, 10]);
    await page.mouse.click(elsewhere.x, elsewhere.y);
    const from = await placeOf(page, [256, 256]);
    await page.mouse.move(from.x, from.y);
    await page.mouse.down();
    for (let step = 1; step <= 8; step++) await page.mouse.move(from.x + 5 * step, from.y);
    await page.waitForFunction(() => window.snell.revision.value!.scene.sphere![0]!.center[0] > 51);
    await page.mouse.up();
  }));

test('the own scene is still there after the tour, and after a reload', () =>
  on('#lecture/default', async (page) => {
    await finished(page);
    await page.evaluate(() => window.snell.edit([['material.glass.eta', '1.77']], { label: 'test' }));
    await page.waitForFunction(() => window.snell.revision.value!.scene.material!.glass!.eta === 1.77);
    await page.getByRole('button', { name: 'Learn' }).click();
    await page.getByRole('menuitem', { name: /Tour/ }).click();
    await page.getByRole('heading', { name: 'Four spheres' }).waitFor();
    await page.waitForFunction(() => window.snell.revision.value!.scene.material!.glass!.eta === 2);
    await page.getByRole('button', { name: 'Leave the tour' }).click();
    await page.waitForFunction(() => window.snell.revision.value!.scene.material!.glass!.eta === 1.77);
    await page.reload();
    await page.waitForFunction(() => window.snell?.revision.value?.scene.material!.glass!.eta === 1.77);
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

test('a step of the tour is found with the tools', () =>
  on('#tour/5', async (page) => {
    await page.getByRole('heading', { name: 'Upside down' }).waitFor();
    await finished(page);
    const at = await placeOf(page, [300, 300]);
    await page.mouse.click(at.x, at.y);
    await page.getByText('✓ Found.').waitFor();
    await page.screenshot({ path: `${OUT}tour.png` });
  }));

test('an exercise tells right from wrong', () =>
  on('#exercise/bend', async (page) => {
    await page.getByText('At which angle does it go on?').waitFor();
    const answer = page.getByLabel('Your answer');
    await answer.fill('51.3');
    await page.getByRole('button', { name: 'Check' }).click();
    await page.getByText('✗ Not quite.').waitFor();
    await page.getByRole('button', { name: 'Try again' }).click();
    await answer.fill('31');
    await page.getByRole('button', { name: 'Check' }).click();
    await page.getByText('✓ Right.').waitFor();
  }));

test('a driver of the course opens with its models', async () => {
  const folder = '../../shared/data/course/2018-p4';
  if (!existsSync(folder)) {
    console.warn('shared/data is absent: no real driver was tried');
    return;
  }
  const files = readdirSync(folder).map((name) => join(folder, name));
  const driver = files.find((name) => name.endsWith('.txt'))!;
  await on('#lecture/default', async (page) => {
    await finished(page);
    await page.getByRole('button', { name: 'File' }).click();
    const [chooser] = await Promise.all([page.waitForEvent('filechooser'), page.getByRole('menuitem', { name: 'Open …' }).click()]);
    await chooser.setFiles(files);
    await page.waitForFunction((name) => window.snell.base.value?.name === name, basename(driver));
    const hash = await finished(page);
    expect(hash).toBe(nativeHash(driver));
    await page.screenshot({ path: `${OUT}driver.png` });
  });
});

test('a file that is no scene says so, and the scene before stays', () =>
  on('#lecture/default', async (page) => {
    const before = await finished(page);
    await page.getByRole('button', { name: 'File' }).click();
    const [chooser] = await Promise.all([page.waitForEvent('filechooser'), page.getByRole('menuitem', { name: 'Open …' }).click()]);
    await chooser.setFiles([{ name: 'broken.toml', mimeType: 'text/plain', buffer: Buffer.from('snell = 1\n[render]\nintegrator = "whitted"\nsize = [0, "a"]\n') }]);
    await page.getByRole('alert').waitFor();
    expect(await page.evaluate(() => [window.snell.base.value!.name, window.snell.outcome.value!.sha256])).toEqual(['lecture/default', before]);
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

test('two models of light are compared', () =>
  on('#lecture/default', async (page) => {
    const hash = await finished(page);
    await page.getByRole('button', { name: 'Compare' }).click();
    await page.getByRole('menuitem', { name: /real optics/ }).click();
    const slider = page.getByRole('slider', { name: /Compare: whitted/ });
    await slider.focus();
    const before = Number(await slider.getAttribute('aria-valuenow'));
    await page.keyboard.press('ArrowRight');
    expect(Number(await slider.getAttribute('aria-valuenow'))).toBe(before + 2);
    await page.waitForFunction(() => {
      const pictures = [window.snell.surface.canvas, window.snell.comparison.value!.surface.canvas].map((canvas) =>
        canvas.width === 512 ? canvas.getContext('2d')!.getImageData(0, 0, 512, 512).data : new Uint8ClampedArray(),
      );
      // Both are there as a whole, and not the same.
      return pictures.every((data) => data.length > 0 && data.every((value, at) => at % 4 !== 3 || value === 255)) && String(pictures[0]) !== String(pictures[1]);
    });
    await page.screenshot({ path: `${OUT}compare.png` });
    await page.getByRole('button', { name: 'Stop comparing' }).click();
    expect(await finished(page)).toBe(hash);
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

test('all of it works by keyboard alone', () =>
  on('#lecture/default', async (page) => {
    await finished(page);
    const focused = () => page.evaluate(() => document.activeElement?.className ?? '');
    for (let count = 0; count < 30 && (await focused()) !== 'picture'; count++) await page.keyboard.press('Tab');
    expect(await focused()).toBe('picture');
    await page.keyboard.press('ArrowRight');
    await page.waitForFunction(() => window.snell.pinned.value !== null && window.snell.tree.value !== null);
    await page.keyboard.press('Shift+ArrowDown');
    await page.waitForFunction(() => window.snell.pinned.value?.[1] === 266);
    await page.keyboard.press('+');
    await page.keyboard.press('0');
    await page.keyboard.press('Escape');
    await page.waitForFunction(() => window.snell.pinned.value === null);
    await page.getByRole('button', { name: 'Learn' }).focus();
    await page.keyboard.press('Enter');
    await page.locator('[role=menuitem]:focus').waitFor();
    await page.keyboard.press('ArrowDown');
    await page.keyboard.press('ArrowUp');
    await page.keyboard.press('Enter');
    await page.getByRole('heading', { name: 'Four spheres' }).waitFor();
  }));

for (const colorScheme of ['light', 'dark'] as const) {
  test(`axe finds nothing on a ${colorScheme} page, whatever is open`, () =>
    on(
      '#lecture/default',
      async (page) => {
        await finished(page);
        await page.addScriptTag({ content: readFileSync('node_modules/axe-core/axe.min.js', 'utf8') });
        const check = async () => {
          const { violations } = await page.evaluate(() => (window as unknown as { axe: typeof import('axe-core') }).axe.run());
          expect(violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ html }) => html).join(' ').slice(0, 300)}`)).toEqual([]);
        };
        await check();
        const at = await placeOf(page, [300, 300]);
        await page.mouse.click(at.x, at.y);
        await page.getByText('seen through').first().waitFor();
        await check();
        for (const tab of ['Scene', 'Source']) {
          await page.getByRole('tab', { name: tab }).click();
          await page.waitForTimeout(500);
          await check();
        }
        await page.getByRole('button', { name: 'lecture/default' }).click();
        await check();
      },
      { colorScheme },
    ));
}

test('a browser without vectors is told what is missing', async () => {
  const page = await browser.newPage();
  await page.addInitScript(() => (WebAssembly.validate = () => false));
  await page.goto(url);
  await page.getByText('SIMD').waitFor();
  await page.close();
});

test('a host that does not know what WebAssembly is serves it all the same', async () => {
  const other = await serve({ '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css' });
  const { page, trouble } = await open(browser, `${other.url}#lecture/default`);
  await finished(page);
  expect(trouble).toEqual([]);
  await page.context().close();
  other.server.close();
});

test('snell studio shows a scene, and again whenever its file changes', async () => {
  const folder = mkdtempSync(join(tmpdir(), 'snell-studio-'));
  const file = join(folder, 'a scene.toml');
  execFileSync(snell, ['scenes', '--save', 'lecture/default', '-o', file]);
  const text = readFileSync(file, 'utf8');
  const source = (eta: string) => text.replace('eta = 2.0', `eta = ${eta}`);
  const command = spawn(snell, ['studio', file, '--no-open', '--port', '0'], { env: { ...process.env, SNELL_STUDIO_DIST: DIST } });
  try {
    const address = await new Promise<string>((done) => command.stdout.on('data', (data: Buffer) => done(String(data).trim())));
    const { page, trouble } = await open(browser, address);
    await page.waitForFunction(() => window.snell.base.value?.name === 'a scene.toml');
    await finished(page);
    writeFileSync(file, source('1.5'));
    await page.waitForFunction(() => window.snell.revision.value!.scene.material!.glass!.eta === 1.5);
    writeFileSync(file, 'snell = 1\nnonsense\n');
    await page.getByRole('alert').waitFor();
    expect(await page.evaluate(() => window.snell.revision.value!.scene.material!.glass!.eta)).toBe(1.5);
    writeFileSync(file, source('1.7'));
    await page.waitForFunction(() => window.snell.revision.value!.scene.material!.glass!.eta === 1.7);
    expect(trouble).toEqual([]);
    await page.context().close();
  } finally {
    command.kill();
    rmSync(folder, { recursive: true });
  }
});
