/** The studio as it is built, served below a path of a plain host, in Debian's Chromium; every other host is blocked. */

import { existsSync, mkdirSync, readFileSync } from 'node:fs';
import { createServer, type Server } from 'node:http';
import type { AddressInfo } from 'node:net';
import { extname, join, normalize } from 'node:path';
import { fileURLToPath } from 'node:url';
import { type Browser, type BrowserContextOptions, chromium, type Page } from 'playwright-core';
import type { Store } from '../src/store';

const CHROMIUM = '/usr/bin/chromium';
export const DIST = fileURLToPath(new URL('../../target/studio-dist/', import.meta.url));
/** Screenshots, to be looked at. */
export const OUT = fileURLToPath(new URL('out/', import.meta.url));
const PATH = '/some/where/';
const TYPES: Record<string, string> = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm' };

declare global {
  interface Window {
    snell: Store;
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

export interface OpenPage {
  page: Page;
  /** Errors, and requests of other hosts. There should be none. */
  trouble: string[];
}

export async function open(browser: Browser, url: string, options: BrowserContextOptions & { threads?: number } = {}): Promise<OpenPage> {
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

/** Waits for the whole picture; returns its hash. */
export async function finished(page: Page): Promise<string> {
  await page.waitForFunction(() => window.snell?.outcome.value !== null && window.snell?.outcome.value !== undefined, undefined, { timeout: 60_000 });
  return page.evaluate(() => window.snell.outcome.value!.sha256);
}

/** Where a pixel of the picture is on the screen. */
export async function placeOf(page: Page, [x, y]: [number, number]): Promise<{ x: number; y: number }> {
  return page.evaluate(
    ([x, y]) => {
      const canvas = window.snell.surface.canvas;
      const { left, top, width, height } = canvas.getBoundingClientRect();
      return { x: left + ((x! + 0.5) * width) / canvas.width, y: top + ((y! + 0.5) * height) / canvas.height };
    },
    [x, y],
  );
}
