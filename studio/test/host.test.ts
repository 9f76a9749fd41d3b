/** Where the page is served from, and what it says when a part of it is missing. */

import { test, expect } from 'vitest';
import { edit, finished, open, pin, save, serve, studio } from './page';
import { nativeHash } from './native';

const host = studio();

test('a browser without vectors is told what is missing', async () => {
  const page = await host.browser.newPage();
  await page.addInitScript(() => (WebAssembly.validate = () => false));
  await page.goto(host.url);
  await page.getByText('SIMD').waitFor();
  await page.close();
});

test('a host that does not know what WebAssembly is serves it all the same', async () => {
  const other = await serve({ '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css' });
  const { page, trouble } = await open(host.browser, `${other.url}#lecture/default`);
  await finished(page);
  expect(trouble).toEqual([]);
  await page.context().close();
  other.server.close();
});

for (const [part, files] of [
  ['a worker', '**/*.worker-*.js'],
  ['the engine', '**/*.wasm'],
] as const) {
  test(`where ${part} cannot be loaded, the page says so, and starts once it can`, async () => {
    const page = await host.browser.newPage();
    await page.route(files, (route) => route.abort());
    await page.goto(`${host.url}#lecture/default`);
    await page.getByRole('alert').getByText('The engine could not be started').waitFor();
    // It has a head, and does not turn round and round.
    await page.getByRole('heading', { name: 'Snell Studio' }).waitFor();
    expect(await page.evaluate(() => window.snell.busy.value)).toBe(null);
    await page.unroute(files);
    await page.getByRole('button', { name: 'Load the page again' }).click();
    expect(await finished(page)).toBe(nativeHash('lecture/default'));
    await page.close();
  });
}

test('without a network, the page goes on as it is', async () => {
  const other = await serve();
  const { page, trouble } = await open(host.browser, `${other.url}#lecture/default`);
  const before = await finished(page);
  await page.context().setOffline(true);
  other.server.close();
  other.server.closeAllConnections();
  await edit(page, ['material.glass.eta', '1.4']);
  const after = await finished(page);
  expect(after).not.toBe(before);
  await pin(page, [256, 256]);
  expect((await save(page, 'Save picture')).length).toBeGreaterThan(1000);
  await page.getByRole('button', { name: 'Undo' }).click();
  await page.waitForFunction(() => window.snell.revision.value!.scene.material!.glass!.eta === 2);
  expect(await finished(page)).toBe(before);
  // The workers of a new engine are parts of the page: it says that they are missing, and goes on once they are not.
  await page.evaluate(() => window.snell.cancel());
  await page.getByRole('alert').getByText('a part of the page could not be loaded').waitFor();
  await page.context().setOffline(false);
  await new Promise<void>((done) => other.server.listen(Number(new URL(other.url).port), '127.0.0.1', done));
  await edit(page, ['material.glass.eta', '1.4']);
  expect(await finished(page)).toBe(after);
  expect(await page.getByRole('alert').count()).toBe(0);
  expect(trouble).toEqual([]);
  await page.context().close();
  other.server.close();
});
