/** Pages as the command writes them, in Debian's Chromium, from disk and offline. */

import { existsSync, mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { type Browser, type BrowserContextOptions, chromium, type Page } from 'playwright-core';
import type { ViewerData } from '../src/data';
import type { Viewer } from '../src/viewer';

const CHROMIUM = '/usr/bin/chromium';
export const OUT = fileURLToPath(new URL('out/', import.meta.url));

declare global {
  interface Window {
    SnellViewer: typeof import('../src/index');
    viewer: Viewer;
  }
}

export function launch(): Promise<Browser> {
  if (!existsSync(CHROMIUM)) throw new Error('Chromium is missing: apt-get install chromium');
  mkdirSync(OUT, { recursive: true });
  // Drawn without a graphics card, so that pictures are much the same on all machines.
  const args = ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'];
  return chromium.launch({ executablePath: CHROMIUM, args });
}

export interface OpenPage {
  page: Page;
  /** Requests other than for the page itself, and errors. There should be none. */
  trouble: string[];
}

export async function open(browser: Browser, name: string, data: ViewerData, options: BrowserContextOptions = {}, before = ''): Promise<OpenPage> {
  const path = `${OUT}${name}.html`;
  writeFileSync(path, pageOf(data, before));
  return openFile(browser, path, options);
}

/** A page that is there already. */
export async function openFile(browser: Browser, path: string, options: BrowserContextOptions = {}): Promise<OpenPage> {
  const url = pathToFileURL(path).href;
  const page = await browser.newPage({ viewport: { width: 1280, height: 800 }, reducedMotion: 'reduce', offline: true, ...options });
  const trouble: string[] = [];
  page.on('request', (request) => request.url() !== url && trouble.push(`request of ${request.url()}`));
  page.on('pageerror', (error) => trouble.push(error.message));
  page.on('console', (message) => message.type() === 'error' && trouble.push(message.text()));
  await page.goto(url);
  await settled(page);
  return { page, trouble };
}

/** After what was asked for is laid out and drawn. */
export async function settled(page: Page): Promise<void> {
  await page.evaluate(async () => {
    for (let frame = 0; frame < 4; frame++) await new Promise(requestAnimationFrame);
  });
}

function pageOf(data: ViewerData, before: string): string {
  const script = readFileSync(new URL('../dist/snell-viewer.js', import.meta.url), 'utf8');
  const json = JSON.stringify(data).replaceAll('<', '\\u003c');
  return `<!doctype html>
<html lang="en">
<meta charset="utf-8">
<meta name="viewport" content="width=device-width">
<title>Snell</title>
<style>body { margin: 0 }</style>
<script>${before}</script>
<script>${script}</script>
<div id="app"></div>
<script>window.viewer = SnellViewer.mount(document.getElementById('app'), ${json})</script>
</html>
`;
}
