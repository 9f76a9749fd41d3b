/** Scenes come in and go out, and nobody's work is lost. */

import { execFileSync, spawn } from 'node:child_process';
import { existsSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, join } from 'node:path';
import { expect, test } from 'vitest';
import { nativeHash, snell } from './native';
import { begun, DIST, edit, finished, open, openFiles, OUT, studio } from './page';

const host = studio();
const { on } = host;

test('the work survives a reload', () =>
  on('#lecture/default', async (page) => {
    await finished(page);
    await edit(page, ['material.glass.eta', '1.5']);
    const hash = await finished(page);
    await page.goto(host.url);
    await page.reload();
    expect(await finished(page)).toBe(hash);
  }));

test('a scene in another format is opened, changed, and still there after a reload', async () => {
  const folder = mkdtempSync(join(tmpdir(), 'snell-studio-'));
  const file = join(folder, 'balls.nff');
  writeFileSync(file, NFF);
  try {
    await on('#lecture/default', async (page) => {
      await finished(page);
      await openFiles(page, [file]);
      await page.waitForFunction(() => window.snell.base.value?.name === 'balls.nff');
      expect(await finished(page)).toBe(nativeHash(file));
      await edit(page, ['render.max_depth', '1']);
      const hash = await finished(page);
      await page.reload();
      expect(await finished(page)).toBe(hash);
      await edit(page, ['render.max_depth', '2']);
      expect(await finished(page)).not.toBe(hash);
    });
  } finally {
    rmSync(folder, { recursive: true });
  }
});

test('a link holds the whole scene', () =>
  on('#gallery/ball', async (page) => {
    await begun(page);
    await edit(page, ['render.size', '[60, 40]'], ['material."glass".eta', '1.7']);
    const hash = await finished(page);
    await page.getByRole('button', { name: 'Share' }).click();
    await page.getByRole('menuitem', { name: 'Copy a link' }).click();
    await page.getByText('The link is copied').waitFor();
    const link = await page.evaluate(() => navigator.clipboard.readText());
    const other = await open(host.browser, link);
    expect(await finished(other.page)).toBe(hash);
    expect(other.trouble).toEqual([]);
    await other.page.context().close();
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
    await openFiles(page, files);
    await page.waitForFunction((name) => window.snell.base.value?.name === name, basename(driver));
    const hash = await finished(page);
    expect(hash).toBe(nativeHash(driver));
    await page.screenshot({ path: `${OUT}driver.png` });
  });
});

test('a file that is no scene says so, and the scene before stays', () =>
  on('#lecture/default', async (page) => {
    const before = await finished(page);
    await openFiles(page, [{ name: 'broken.toml', mimeType: 'text/plain', buffer: Buffer.from('snell = 1\n[render]\nintegrator = "whitted"\nsize = [0, "a"]\n') }]);
    await page.getByRole('alert').waitFor();
    expect(await page.evaluate(() => [window.snell.base.value!.name, window.snell.outcome.value!.sha256])).toEqual(['lecture/default', before]);
  }));

test('snell studio shows a scene, and again whenever its file changes', async () => {
  const folder = mkdtempSync(join(tmpdir(), 'snell-studio-'));
  const file = join(folder, 'a scene.toml');
  execFileSync(snell, ['scenes', '--save', 'lecture/default', '-o', file]);
  const text = readFileSync(file, 'utf8');
  const source = (eta: string) => text.replace('eta = 2.0', `eta = ${eta}`);
  const command = spawn(snell, ['studio', file, '--no-open', '--port', '0'], { env: { ...process.env, SNELL_STUDIO_DIST: DIST } });
  try {
    const address = await new Promise<string>((done) => command.stdout.on('data', (data: Buffer) => done(String(data).trim())));
    const { page, trouble } = await open(host.browser, address);
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

/** A glass ball and a red one on a floor. */
const NFF = `b 0.4 0.6 0.9
v
from 0 2 7
at 0 0.4 0
up 0 1 0
angle 35
hither 0.1
resolution 60 60
l 4 6 5
f 0.8 0.7 0.5  1 0 1 0 1
p 4
-20 -1 20
20 -1 20
20 -1 -20
-20 -1 -20
f 1 1 1  0 0.2 60 0.9 1.5
s -1.1 0 0 1
f 0.9 0.2 0.1  0.7 0.3 20 0 1
s 1.1 0 0 1
`;
