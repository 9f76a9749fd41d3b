/** The editor in Debian's Chromium: what only a browser can show. */

import { readFileSync } from 'node:fs';
import { fileURLToPath } from 'node:url';
import { type Browser, chromium, type Page } from 'playwright-core';
import { build, type Rollup } from 'vite';
import { afterAll, afterEach, beforeAll, beforeEach, expect, test, vi } from 'vitest';
import type { SourceEditor } from './editor';

declare global {
  interface Window {
    Editor: typeof import('./editor');
    editor: SourceEditor;
    changes: string[];
    steps: string[];
  }
}

vi.setConfig({ testTimeout: 30_000 });

const path = (relative: string) => fileURLToPath(new URL(relative, import.meta.url));
const SCENE = readFileSync(path('../../../scenes/lecture/default.toml'), 'utf8');

let browser: Browser;
let script: string;
let page: Page;
const trouble: string[] = [];

beforeAll(async () => {
  const lib = { entry: path('./editor.ts'), name: 'Editor', formats: ['iife' as const] };
  const output = (await build({ configFile: false, logLevel: 'error', build: { lib, write: false, minify: false } })) as Rollup.RollupOutput[];
  script = output[0]!.output[0].code;
  browser = await chromium.launch({ executablePath: '/usr/bin/chromium', args: ['--no-sandbox'] });
}, 120_000);

afterAll(() => browser?.close());

beforeEach(async () => {
  page = await browser.newPage({ viewport: { width: 700, height: 500 } });
  page.on('pageerror', (error) => trouble.push(error.message));
  page.setDefaultTimeout(10_000);
  await page.setContent(`<!doctype html><html lang="en"><title>Editor</title><style>
    :root { --paper: #fbfaf8; --ink: #22262e; --quiet: #5d636e; --line: #d9d6cf; --accent: #1d5fd1; --tint: #f0eee9; --bulb: #d79a00;
      --ray-refracted: #0a7d8c; --ray-inside: #7048d6 }
    body { margin: 0; background: var(--paper) } #place { height: 440px }</style>
    <button id="before">before</button><div id="place"></div><button id="after">after</button>`);
  await page.addScriptTag({ content: script });
  await open(SCENE);
});

afterEach(async () => {
  await page.close();
  expect(trouble.splice(0)).toEqual([]);
});

async function open(text: string): Promise<void> {
  await page.evaluate((text) => {
    window.editor?.dispose();
    window.changes = [];
    window.steps = [];
    window.editor = new window.Editor.SourceEditor(document.getElementById('place')!, {
      text,
      label: 'Source of the scene',
      known: () => ({ glasses: ['N-BK7', 'water'] }),
      onChange: (text) => window.changes.push(text),
      onHistory: (step) => window.steps.push(step),
    });
  }, text);
}

const text = () => page.evaluate(() => window.editor.text);
const changes = () => page.evaluate(() => window.changes);
const reveal = (line: number, column: number) => page.evaluate(([line, column]) => (window.editor.reveal(line!, column!), window.editor.focus()), [line, column]);
const focused = () => page.evaluate(() => document.activeElement!.id);
const lineOf = (sign: string) => SCENE.slice(0, SCENE.indexOf(sign)).split('\n').length;

test('what is typed is told, what comes from outside is not, and the cursor stays', async () => {
  await reveal(1, 1);
  await page.keyboard.type('# x');
  expect(await changes()).toEqual(['#', '# ', '# x'].map((start) => start + SCENE));
  const edited = `# x${SCENE}`.replace('eta = 2.0', 'eta = 2.42');
  await page.evaluate((text) => window.editor.setText(text), edited);
  await page.keyboard.type('y');
  expect((await changes()).slice(3)).toEqual([edited.replace('# x', '# xy')]);
});

test('a change from outside keeps scroll and folds', async () => {
  await page.click('.cm-foldGutter .cm-gutterElement:not(:empty) >> nth=1');
  await expect.poll(() => page.locator('.cm-foldPlaceholder').count()).toBe(1);
  await page.locator('.cm-scroller').evaluate((scroller) => (scroller.scrollTop = 120));
  await page.evaluate((text) => window.editor.setText(text), SCENE.replace('radius = 9\nmaterial = "blue"', 'radius = 9.5\nmaterial = "blue"'));
  expect(await page.locator('.cm-scroller').evaluate((scroller) => scroller.scrollTop)).toBe(120);
  expect(await page.locator('.cm-foldPlaceholder').count()).toBe(1);
  expect(await changes()).toEqual([]);
});

test('a file of Windows stays one', async () => {
  await open('snell = 1\r\nambient = 0.2\r\n');
  await reveal(3, 1);
  await page.keyboard.type('\n#');
  expect((await changes()).at(-1)).toBe('snell = 1\r\nambient = 0.2\r\n\r\n#');
});

test('findings are shown at their place, with their help, and to the keyboard', async () => {
  const line = lineOf('eta = 2.0');
  const place = { file: 'default.toml', line, column: 7, end_line: line, end_column: 10 };
  const findings = [
    { message: '`eta` must be positive', help: 'like 1.5', place },
    { code: 'W009', message: 'elsewhere', place: { ...place, file: 'cow.obj' } },
  ];
  await page.evaluate((findings) => window.editor.setFindings(findings, 'default.toml'), findings);
  await reveal(line, 1);
  await page.locator('.cm-lintRange-error').hover();
  await expect.poll(() => page.locator('.cm-tooltip-lint').innerText()).toMatch(/eta must be positive\s+like 1\.5/);
  expect(await page.locator('.cm-lintRange').count()).toBe(1);
  expect(await page.locator('.cm-lintRange-error').innerText()).toBe('2.0');
  await page.keyboard.press('Control+Shift+M');
  await expect.poll(() => page.locator('.cm-panel-lint').innerText()).toContain('like 1.5');
  await page.evaluate(() => window.editor.setFindings([]));
  expect(await page.locator('.cm-lintRange').count()).toBe(0);
});

test('keys and values are completed by keyboard', async () => {
  await reveal(lineOf('max_depth'), 1);
  await page.keyboard.press('Enter');
  await page.keyboard.press('ArrowUp');
  await page.keyboard.type('ban');
  await expect.poll(() => page.locator('.cm-tooltip-autocomplete li').allInnerTexts()).toEqual(['bands']);
  await expect.poll(() => page.locator('.cm-completionInfo').innerText()).toContain('into how many wavelengths a ray splits');
  // Enter is taken as an answer only after a moment, lest it is meant as a line.
  await page.waitForTimeout(100);
  await page.keyboard.press('Enter');
  await page.keyboard.type('8');
  expect(await text()).toContain('\nbands = 8\nmax_depth = 6\n');

  await open(SCENE);
  await reveal(lineOf('integrator'), 'integrator = "lec'.length + 1);
  await page.keyboard.press('Control+Space');
  await expect.poll(() => page.locator('.cm-tooltip-autocomplete li').count()).toBe(4);
  await page.waitForTimeout(100);
  await page.keyboard.press('ArrowUp');
  await page.keyboard.press('Enter');
  expect(await text()).toContain('\nintegrator = "whitted"\nsize');
});

test('Tab leaves in both directions, also while completions are shown', async () => {
  await page.focus('#before');
  await page.keyboard.press('Tab');
  await page.keyboard.type('back');
  await expect.poll(() => page.locator('.cm-tooltip-autocomplete').count()).toBe(1);
  await page.keyboard.press('Tab');
  expect(await focused()).toBe('after');
  await page.keyboard.press('Shift+Tab');
  await page.keyboard.press('Shift+Tab');
  expect(await focused()).toBe('before');
});

test('undo is the page’s', async () => {
  await page.evaluate(() => document.addEventListener('keydown', (event) => event.key === 'z' && event.ctrlKey && window.steps.push('key')));
  await reveal(1, 1);
  await page.keyboard.type('#');
  await page.keyboard.press('Control+z');
  await page.evaluate(() => document.execCommand('undo'));
  expect(await text()).toBe(`#${SCENE}`);
  expect(await page.evaluate(() => window.steps)).toContain('key');
  // What a menu of the browser does.
  await page.locator('.cm-content').evaluate((content) => {
    const event = new InputEvent('beforeinput', { inputType: 'historyUndo', cancelable: true, bubbles: true });
    window.steps.push(content.dispatchEvent(event) ? 'lost' : 'taken');
  });
  expect((await page.evaluate(() => window.steps)).slice(-2)).toEqual(['undo', 'taken']);
});

test('a key says what it means', async () => {
  await page.locator('.cm-line', { hasText: 'max_depth' }).hover({ position: { x: 30, y: 8 } });
  await expect.poll(() => page.locator('.cm-explanation').innerText()).toContain('How many bounces may follow the camera ray. Left out, it is 32.');
});

test.each(['light', 'dark'] as const)('axe finds nothing wrong with it, %s', async (theme) => {
  const dark = { paper: '#15181e', ink: '#e8eaee', quiet: '#9ea6b3', line: '#323945', accent: '#7db1ff', tint: '#1f242d', 'ray-refracted': '#4fd3e0', 'ray-inside': '#b59cff' };
  await page.evaluate(([theme, dark]) => {
    for (const [name, color] of Object.entries(theme === 'dark' ? dark : {})) document.documentElement.style.setProperty(`--${name}`, color);
    window.editor.setTheme(theme);
  }, [theme, dark] as const);
  const line = lineOf('max_depth');
  const findings = [{ code: 'W001', message: 'odd', place: { file: '', line, column: 1, end_line: line, end_column: 4 } }];
  await page.evaluate((findings) => window.editor.setFindings(findings), findings);
  await reveal(line, 1);
  await page.keyboard.press('Enter');
  await page.keyboard.press('ArrowUp');
  await page.keyboard.press('Control+Space');
  await page.locator('.cm-completionInfo').waitFor();
  await page.addScriptTag({ path: path('../../node_modules/axe-core/axe.min.js') });
  const violations = await page.locator('#place').evaluate(async (place) => {
    const axe = (window as unknown as { axe: typeof import('axe-core') }).axe;
    const { violations } = await axe.run(place);
    return violations.map(({ id, nodes }) => `${id}: ${nodes.map(({ html, failureSummary }) => html + failureSummary).join('; ')}`);
  });
  expect(violations).toEqual([]);
});
