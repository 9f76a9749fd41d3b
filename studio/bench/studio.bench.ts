/** How fast the studio is, in Chromium, as a person would feel it: `make bench-studio`. Figures, not tests: nothing fails by being slow. */

import { readdirSync, readFileSync } from 'node:fs';
import type { Server } from 'node:http';
import { fileURLToPath } from 'node:url';
import { brotliCompressSync, gzipSync } from 'node:zlib';
import type { Browser, Page } from 'playwright-core';
import { afterAll, beforeAll, test } from 'vitest';
import { finished, launch, serve } from '../test/page';

const DIST = fileURLToPath(new URL('../../target/studio-dist/', import.meta.url));
const ROUNDS = 5;

let browser: Browser;
let server: Server;
let url: string;
const lines: string[] = [];
const report = (what: string, figure: string) => lines.push(`${what.padEnd(62)} ${figure}`);
const middle = (values: number[]) => [...values].sort((a, b) => a - b)[values.length >> 1]!;

beforeAll(async () => {
  browser = await launch(['--js-flags=--expose-gc']);
  ({ url, server } = await serve());
});
afterAll(async () => {
  await browser?.close();
  server?.close();
  process.stdout.write(`\n${lines.join('\n')}\n\n`);
});

declare global {
  interface Window {
    times: { first?: number; complete?: number; blocked: number; covered: number[] };
  }
}

/** A page that notes when its picture comes, from the start of navigation, and how long its thread is blocked. */
async function timed(fragment = '#lecture/default'): Promise<Page> {
  const page = await browser.newPage({ viewport: { width: 1440, height: 860 } });
  await page.addInitScript(() => {
    const times: Window['times'] = (window.times = { blocked: 0, covered: [] });
    new PerformanceObserver((list) => {
      for (const { duration } of list.getEntries()) times.blocked = Math.max(times.blocked, duration);
    }).observe({ type: 'longtask' });
    let store: Window['snell'];
    Object.defineProperty(window, 'snell', {
      get: () => store,
      set(value: Window['snell']) {
        store = value;
        let shown: unknown = null;
        store.frame.subscribe((count) => {
          if (count === 0) return;
          times.first ??= performance.now();
          if (store.revision.peek() === shown) return;
          shown = store.revision.peek();
          times.covered.push(performance.now());
        });
        store.outcome.subscribe((outcome) => outcome && (times.complete ??= performance.now()));
      },
    });
  });
  await page.goto(url + fragment);
  return page;
}

test('from nothing to the picture', async () => {
  const [first, complete]: [number[], number[]] = [[], []];
  for (let round = 0; round < ROUNDS; round++) {
    const page = await timed();
    await finished(page);
    const times = await page.evaluate(() => window.times);
    first.push(times.first!);
    complete.push(times.complete!);
    await page.close();
  }
  report('lecture/default, from navigation to the first preview', `${middle(first).toFixed(0)} ms (goal 500)`);
  report('lecture/default 512x512, from navigation to all of it', `${middle(complete).toFixed(0)} ms (goal 1000)`);
});

test('dragging', async () => {
  for (const [what, edit] of [
    ['the index', (step: number) => ['material.glass.eta', String(1.2 + (step % 120) / 100)]],
    ['the glass sphere', (step: number) => ['sphere.glass.center', `[${(50 + 6 * Math.sin(step / 10)).toFixed(3)}, 50, 50]`.replace(/0+,/, ',').replace('.,', ',')]],
  ] as const) {
    const page = await timed();
    await finished(page);
    const edits = Array.from({ length: 400 }, (_, step) => edit(step) as [string, string]);
    const { frames, seconds, rest } = await page.evaluate(async (edits) => {
      const { snell: store, times } = window;
      times.covered.length = 0;
      const start = performance.now();
      let count = 0;
      for (const change of edits) {
        count++;
        store.edit([change], { label: 'drag', group: 'drag' });
        await new Promise(requestAnimationFrame);
        if (performance.now() - start > 4000) break;
      }
      const end = performance.now();
      const [, last] = edits[Math.min(edits.length, count) - 1]!;
      const complete = await new Promise<number>((done) => {
        const look = () => {
          const { scene } = store.revision.peek()!;
          const shown = [String(scene.material!.glass!.eta), `[${scene.sphere![0]!.center.join(', ')}]`];
          if (shown.includes(last.replace('.0', '')) && store.outcome.peek() !== null) done(performance.now());
          else setTimeout(look, 2);
        };
        look();
      });
      return { frames: times.covered.filter((time) => time <= end).length, seconds: (end - start) / 1000, rest: complete - end };
    }, edits);
    report(`dragging ${what}, 512x512`, `${(frames / seconds).toFixed(1)} pictures a second (goal 24), whole ${rest.toFixed(0)} ms after (goal 100)`);
    if (what !== 'the index') {
      await page.close();
      continue;
    }
    // Without a graphics card the browser itself draws for longer than the engine computes.
    await page.addStyleTag({ content: '.drawing, .picture > canvas { display: none !important }' });
    const computed = await page.evaluate(async (edits) => {
      const { snell: store, times } = window;
      times.covered.length = 0;
      const start = performance.now();
      for (const change of edits) {
        store.edit([change], { label: 'drag', group: 'again' });
        await new Promise(requestAnimationFrame);
      }
      return (1000 * times.covered.length) / (performance.now() - start);
    }, edits.slice(0, 200));
    report('  the same with nothing to draw', `${computed.toFixed(1)} pictures a second`);
    await page.close();
  }
});

test('memory after 500 edits', async () => {
  const page = await timed();
  await finished(page);
  // What is garbage is collected first: browsers put that off until some hundred megabytes have come together.
  const resident = async () => {
    await page.evaluate(collect);
    for (const worker of page.workers()) await worker.evaluate(collect);
    await page.waitForTimeout(300);
    // All processes of this Chromium: workers have their memory in that of the page.
    let sum = 0;
    for (const id of readdirSync('/proc').filter((name) => /^\d+$/.test(name))) {
      try {
        if (!readFileSync(`/proc/${id}/cmdline`, 'utf8').includes('--type=renderer')) continue;
        sum += Number(/VmRSS:\s+(\d+)/.exec(readFileSync(`/proc/${id}/status`, 'utf8'))?.[1] ?? 0) / 1024;
      } catch {
        // It has ended meanwhile.
      }
    }
    return sum;
  };
  const edits = async (count: number) => {
    await page.evaluate(async (count) => {
      for (let step = 0; step < count; step++) {
        const eta = 1.2 + (step % 97) / 80;
        window.snell.edit([['material.glass.eta', String(eta)]], { label: 'edit' });
        while (window.snell.revision.peek()!.scene.material!.glass!.eta !== eta) await new Promise((done) => setTimeout(done, 5));
      }
    }, count);
    await finished(page);
  };
  await edits(50);
  const before = await resident();
  await edits(500);
  const after = await resident();
  await edits(500);
  report('memory after 50 edits, after 500 more, and after 500 more', `${before.toFixed(0)} MiB, ${after.toFixed(0)} MiB, ${(await resident()).toFixed(0)} MiB`);
  await page.close();
}, 400_000);

test('a mesh of 100 000 triangles', async () => {
  const page = await timed();
  await finished(page);
  await page.evaluate(async () => {
    const side = 224;
    const rows: string[] = [];
    const wave = (u: number, v: number) => 0.2 * Math.sin(9 * u) * Math.cos(7 * v);
    for (let v = 0; v <= side; v++) for (let u = 0; u <= side; u++) rows.push(`v ${(4 * u) / side - 2} ${wave(u / side, v / side)} ${(4 * v) / side - 2}`);
    for (let v = 0; v < side; v++)
      for (let u = 0; u < side; u++) {
        const at = v * (side + 1) + u + 1;
        rows.push(`f ${at} ${at + 1} ${at + side + 2}`, `f ${at} ${at + side + 2} ${at + side + 1}`);
      }
    const model = new TextEncoder().encode(rows.join('\n'));
    const text = new TextEncoder().encode(`snell = 1
background = 0.6
[render]
integrator = "whitted"
size = [512, 512]
[camera]
eye = [0, 3, 5]
look_at = [0, 0, 0]
up = [0, 1, 0]
fov = 40
[[light]]
direction = [1, 2, 1]
color = 0.8
[material.m]
kd = 0.7
[[mesh]]
file = "wave.obj"
material = "m"
`);
    await new Promise((done) => setTimeout(done, 300));
    window.times.blocked = 0;
    const start = performance.now();
    await window.snell.open({ name: 'wave.toml', given: { name: 'wave.toml', text, files: [['wave.obj', model]] } });
    Object.assign(window, { opened: performance.now() - start });
  });
  await finished(page);
  await page.waitForTimeout(1000);
  const { blocked, opened } = await page.evaluate(() => ({ blocked: window.times.blocked, opened: (window as unknown as { opened: number }).opened }));
  report('a mesh of 100 000 triangles: until it is open', `${opened.toFixed(0)} ms`);
  report('  the longest time that the page was blocked', `${blocked.toFixed(0)} ms (goal 50; times below 50 are not told)`);
  await page.close();
});

test('a picture of 2000 x 2000 pixels', async () => {
  const page = await timed();
  await finished(page);
  await page.waitForTimeout(1000);
  await page.evaluate(() => {
    window.times.blocked = 0;
    window.snell.edit([['render.size', '[2000, 2000]']], { label: 'bench' });
  });
  await page.waitForFunction(() => window.snell.revision.value!.size[0] === 2000);
  await finished(page);
  await page.evaluate(() => window.snell.save('png'));
  await page.waitForTimeout(500);
  const blocked = await page.evaluate(() => window.times.blocked);
  report('a picture of 2000 x 2000 pixels, rendered and saved: the longest time that the page was blocked', `${blocked.toFixed(0)} ms (goal 50)`);
  await page.close();
});

test('sizes', () => {
  const files = readdirSync(DIST, { recursive: true, withFileTypes: true }).filter((entry) => entry.isFile());
  let [plain, gzip, brotli] = [0, 0, 0];
  for (const { parentPath, name } of files) {
    const bytes = readFileSync(`${parentPath}/${name}`);
    const packed = /\.(png|webp|jpg)$/.test(name);
    const [zipped, brotlied] = packed ? [bytes.length, bytes.length] : [gzipSync(bytes, { level: 9 }).length, brotliCompressSync(bytes).length];
    if (/\.(wasm)$/.test(name)) report(`${name}`, `${kB(bytes.length)}, gzip ${kB(zipped)}, brotli ${kB(brotlied)} (goal 1000 kB)`);
    [plain, gzip, brotli] = [plain + bytes.length, gzip + zipped, brotli + brotlied];
  }
  report('the whole page, with thumbnails', `${kB(plain)}, gzip ${kB(gzip)}, brotli ${kB(brotli)} (goal 1500 kB)`);
});

function collect(): void {
  (globalThis as unknown as { gc(): void }).gc();
}

function kB(bytes: number): string {
  return `${(bytes / 1000).toFixed(0)} kB`;
}
