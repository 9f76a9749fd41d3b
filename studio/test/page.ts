/** The studio as it is built, served below a path of a plain host, in Debian's Chromium; every other host is blocked. */

import { existsSync, mkdirSync, readFileSync } from 'node:fs';
import { createServer, type Server } from 'node:http';
import type { AddressInfo } from 'node:net';
import { extname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';
import { type Browser, type BrowserContextOptions, chromium, type FileChooser, type Page } from 'playwright-core';
import { PNG } from 'pngjs';
import { afterAll, beforeAll, expect } from 'vitest';
import type { Edit } from '../src/engine/protocol';
import type { Space } from '../src/scene/view';
import type { Pixel, Store } from '../src/store';

const CHROMIUM = '/usr/bin/chromium';
export const DIST = fileURLToPath(new URL('../../target/studio-dist/', import.meta.url));
/** Screenshots, to be looked at. */
export const OUT = fileURLToPath(new URL('out/', import.meta.url));
const PATH = '/some/where/';
const TYPES: Record<string, string> = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm' };

declare global {
  interface Window {
    snell: Store;
    snellSpace: Space | null;
  }
}

export function launch(more: string[] = []): Promise<Browser> {
  if (!existsSync(CHROMIUM)) throw new Error('Chromium is missing: apt-get install chromium');
  if (!existsSync(`${DIST}index.html`)) throw new Error('The studio has not been built: make studio');
  mkdirSync(OUT, { recursive: true });
  // As on a computer without a graphics card: the page is put together in software, and only what is in 3D is drawn by SwiftShader.
  return chromium.launch({ executablePath: CHROMIUM, args: ['--no-sandbox', '--enable-unsafe-swiftshader', ...more] });
}

/** As plain as `python -m http.server`: no headers but the type. */
export async function serve(types = TYPES): Promise<{ url: string; server: Server }> {
  const server = createServer((request, response) => {
    const path = decodeURIComponent(new URL(request.url!, 'http://host').pathname);
    const file = join(DIST, normalize(path.startsWith(PATH) ? path.slice(PATH.length) || 'index.html' : 'missing'));
    if (!file.startsWith(DIST) || !existsSync(file)) {
      response.writeHead(404).end();
      return;
    }
    response.writeHead(200, { 'content-type': types[extname(file)] ?? 'application/octet-stream' }).end(readFileSync(file));
  });
  await new Promise<void>((done) => server.listen(0, '127.0.0.1', done));
  return { url: `http://127.0.0.1:${(server.address() as AddressInfo).port}${PATH}`, server };
}

/** A browser and a host for the tests of a file. */
export function studio() {
  const own = {} as { browser: Browser; server: Server; url: string };
  beforeAll(async () => {
    own.browser = await launch();
    Object.assign(own, await serve());
  });
  afterAll(async () => {
    await own.browser?.close();
    own.server?.close();
  });
  return {
    /** Opens a page, does something in it, and expects no trouble. */
    async on(fragment: string, act: (page: Page) => Promise<void>, options: Options = {}): Promise<void> {
      const { page, trouble } = await open(own.browser, own.url + fragment, options);
      await act(page);
      expect(trouble).toEqual([]);
      await page.context().close();
    },
    get browser() {
      return own.browser;
    },
    get url() {
      return own.url;
    },
  };
}

export interface OpenPage {
  page: Page;
  /** Errors, and requests of other hosts. There should be none. */
  trouble: string[];
}

type Options = BrowserContextOptions & { threads?: number };

export async function open(browser: Browser, url: string, options: Options = {}): Promise<OpenPage> {
  const { threads, ...rest } = options;
  const context = await browser.newContext({ viewport: { width: 1440, height: 860 }, reducedMotion: 'reduce', permissions: ['clipboard-read', 'clipboard-write'], ...rest });
  const trouble: string[] = [];
  const host = new URL(url).host;
  await context.route(
    (address) => address.host !== host && address.protocol.startsWith('http'),
    (route) => {
      trouble.push(`request of ${route.request().url()}`);
      return route.abort();
    },
  );
  const page = await context.newPage();
  if (threads !== undefined) await page.addInitScript((count) => Object.defineProperty(navigator, 'hardwareConcurrency', { value: count }), threads);
  page.on('pageerror', (error) => trouble.push(error.stack ?? error.message));
  page.on('console', (message) => message.type() === 'error' && trouble.push(message.text()));
  await page.goto(url);
  return { page, trouble };
}

/** Waits for a picture, whole or not. */
export async function begun(page: Page): Promise<void> {
  await page.waitForFunction(() => window.snell?.frame.value > 0);
}

/** Waits for the whole picture; returns its hash. */
export async function finished(page: Page): Promise<string> {
  for (;;) {
    await page.waitForFunction(() => window.snell?.outcome.value !== null && window.snell?.outcome.value !== undefined, undefined, { timeout: 60_000 });
    // The next picture may have begun meanwhile.
    const hash = await page.evaluate(() => window.snell.outcome.value?.sha256 ?? null);
    if (hash !== null) return hash;
  }
}

/** Where a pixel of the scene's picture is on the screen, also while the picture before, of another size, is still shown there. */
export async function placeOf(page: Page, [x, y]: Pixel): Promise<{ x: number; y: number }> {
  return page.evaluate(
    ([x, y]) => {
      const { left, top, width, height } = window.snell.surface.canvas.getBoundingClientRect();
      const [columns, rows] = window.snell.revision.value!.size;
      return { x: left + ((x! + 0.5) * width) / columns, y: top + ((y! + 0.5) * height) / rows };
    },
    [x, y],
  );
}

/** Opens a built-in scene with a text that it has been given since. */
export async function openText(page: Page, name: string, text: string): Promise<void> {
  await page.evaluate(([name, text]) => window.snell.open({ name, given: { builtin: name } }, { text }), [name, text] as const);
}

/** Changes values of the scene, and waits until the scene is the changed one. */
export async function edit(page: Page, ...edits: Edit[]): Promise<void> {
  const before = await page.evaluateHandle((edits) => {
    const { value } = window.snell.revision;
    window.snell.edit(edits, { label: 'test' });
    return value;
  }, edits);
  await page.waitForFunction((before) => window.snell.revision.value !== before, before);
}

/** Clicks a pixel, and waits for its rays. */
export async function pin(page: Page, pixel: Pixel): Promise<void> {
  const picture = page.locator('.picture');
  await picture.scrollIntoViewIfNeeded();
  const [{ x, y }, box] = [await placeOf(page, pixel), (await picture.boundingBox())!];
  await picture.click({ position: { x: x - box.x, y: y - box.y } });
  await page.waitForFunction((pixel) => [window.snell.pinned.value, window.snell.tree.value?.pixel].every((at) => at?.join() === pixel.join()), pixel);
}

/** Presses the button, and moves it in steps, as a hand does. */
export async function drag(page: Page, from: { x: number; y: number }, [across, down]: [number, number]): Promise<void> {
  await page.mouse.move(from.x, from.y);
  await page.mouse.down();
  for (let step = 1; step <= 6; step++) await page.mouse.move(from.x + (across * step) / 6, from.y + (down * step) / 6);
  await page.mouse.up();
}

/** Chooses what saves a file; returns its bytes. */
export async function save(page: Page, what: string): Promise<Buffer> {
  await page.getByRole('button', { name: 'File' }).click();
  const [download] = await Promise.all([page.waitForEvent('download'), page.getByRole('menuitem', { name: what }).click()]);
  return readFileSync(await download.path());
}

/** Opens files as a person who chooses them does. */
export async function openFiles(page: Page, files: Parameters<FileChooser['setFiles']>[0]): Promise<void> {
  await page.getByRole('button', { name: 'File' }).click();
  const [chosen] = await Promise.all([page.waitForEvent('filechooser'), page.getByRole('menuitem', { name: 'Open …' }).click()]);
  await chosen.setFiles(files);
}

/** The picture as it is shown, whatever the zoom. */
export async function shown(page: Page): Promise<PNG> {
  const url = await page.evaluate(() => window.snell.surface.canvas.toDataURL());
  return PNG.sync.read(Buffer.from(url.slice(url.indexOf(',') + 1), 'base64'));
}
