// Films a short story of the studio, a PNG for each frame: node scripts/film.mjs FRAMES MILLISECONDS [DIST]
// The clock of the page goes on by so many milliseconds from frame to frame, and waits for the engine: the film is the same each time,
// but for the last bit of a shade here and there.

import { existsSync, mkdirSync, readFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { extname, join, resolve } from 'node:path';
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';

const frames = resolve(process.argv[2]);
const STEP = Number(process.argv[3]);
const dist = resolve(process.argv[4] ?? fileURLToPath(new URL('../../target/studio-dist', import.meta.url)));
const SIZE = { width: 1280, height: 720 };
/** The lecture's riddle: nothing in the scene is yellow. */
const YELLOW = [212, 300];
/** Frames in which a title appears. */
const FADE = 5;

const { page, close } = await open();
let pointer = [620, 620];
/** The number of the next frame, and of the one where the title was new. */
let shot = 0;
let shown = 0;

await approach();
await show('Drag the glass');
await pass(0.4);
await glide(await pixel(256, 290), 0.6);
await drag(1.9, ([x, y], part) => [x + 45 * Math.sin(2 * Math.PI * part), y - 10 * (1 - Math.cos(2 * Math.PI * part))]);

await show('Bend the light');
await glide(await middle(page.getByRole('tab', { name: 'Scene' })), 0.5);
await click();
const thumb = await thumbOf(page.getByRole('slider', { name: 'Index, slider' }));
await glide(thumb(2), 0.4);
await drag(0.9, (from, part) => between(from, thumb(1.3), part));
await drag(1.2, (from, part) => between(from, thumb(2.42), part));

await show('Ask a pixel why');
await glide(await middle(page.getByRole('tab', { name: 'Why?' })), 0.4);
await click();
// A click beside all things lets go of the glass.
await glide([730, 250], 0.35);
await click();
await glide(await pixel(...YELLOW), 0.7);
await click();
await pass(0.7);

await show('See its colour grow');
await page.getByRole('combobox', { name: 'Speed' }).selectOption('2');
await glide(await middle(page.getByRole('button', { name: 'Play' })), 0.4);
await click();
await pass(2.6);
const told = await page.evaluate(() => window.snell.tree.value.sentence);
if (!told.startsWith('Yellow')) throw new Error(`The film should end with a yellow pixel, but: ${told}`);
await close();

async function open() {
  const types = { '.html': 'text/html', '.js': 'text/javascript', '.css': 'text/css', '.wasm': 'application/wasm' };
  const server = createServer((request, response) => {
    const { pathname } = new URL(request.url, 'http://host');
    const file = join(dist, pathname === '/' ? 'index.html' : pathname);
    if (!existsSync(file)) response.writeHead(404).end();
    else response.writeHead(200, { 'content-type': types[extname(file)] ?? 'application/octet-stream' }).end(readFileSync(file));
  });
  await new Promise((done) => server.listen(0, '127.0.0.1', done));
  const args = ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'];
  const browser = await chromium.launch({ executablePath: '/usr/bin/chromium', args });
  const page = await browser.newPage({ viewport: SIZE, colorScheme: 'dark' });
  await page.clock.install({ time: 0 });
  await page.goto(`http://127.0.0.1:${server.address().port}/#lecture/default`);
  await page.waitForFunction(() => window.snell?.outcome.value);
  await page.clock.pauseAt(60_000);
  await page.evaluate(dress);
  // The clock stands still while the engine works: how long that takes cannot be told.
  await page.addStyleTag({ content: '.status .line > span:nth-child(2) { display: none }' });
  mkdirSync(frames, { recursive: true });
  return { page, close: () => Promise.all([browser.close(), server.close()]) };
}

/** Puts over the page what a film has besides: the pointer, and a title. */
function dress() {
  const pointer = document.createElement('div');
  pointer.innerHTML = `<svg width="30" height="30" style="overflow: visible">
    <circle r="15" visibility="hidden" fill="#7db1ff" fill-opacity=".35" stroke="#7db1ff" stroke-width="1.5"/>
    <path d="M0 0v21.5l5-4.6 3.4 8 4-1.7-3.4-7.8h6.8z" fill="#fff" stroke="#0e1014" stroke-width="1.4" stroke-linejoin="round"/>
  </svg>`;
  const title = document.createElement('div');
  const { left, width } = document.querySelector('.picture').getBoundingClientRect();
  const over = 'position: fixed; top: 0; z-index: 1000; pointer-events: none;';
  pointer.style.cssText = `${over} left: 0; filter: drop-shadow(0 2px 3px rgb(0 0 0 / 45%))`;
  title.style.cssText = `${over} top: 92px; left: ${left}px; width: ${width}px; text-align: center; color: #fff; font: 600 26px system-ui`;
  document.body.append(pointer, title);
  window.film = { pointer, title, ring: pointer.querySelector('circle') };
}

/** Goes nearer in 3D, so that rays are large. */
async function approach() {
  const canvas = page.locator('.drawing canvas');
  await canvas.focus();
  for (const key of ['+', '+', '+', 'ArrowLeft', 'ArrowLeft', 'ArrowLeft']) await page.keyboard.press(key);
  await canvas.blur();
  const [x, y] = await middle(canvas);
  await page.mouse.move(x, y);
  await page.mouse.down({ button: 'right' });
  await page.mouse.move(x - 15, y - 30);
  await page.mouse.up({ button: 'right' });
  // What it swings on by is not in the film.
  await page.clock.runFor(2000);
  await moveTo(pointer);
}

/** Lets time pass; `act` is told how much of it has. */
async function pass(seconds, act = async () => {}) {
  const count = Math.round((1000 * seconds) / STEP);
  for (let frame = 1; frame <= count; frame++) {
    await act(frame / count);
    await shoot();
  }
}

async function shoot() {
  // Not public, but the only way to know that nothing more is to come.
  await page.waitForFunction(({ snell } = window) => !snell.running && !snell.question.asking && snell.outcome.value);
  await page.clock.runFor(STEP);
  await page.evaluate(
    ([x, y, opacity]) => {
      window.film.pointer.style.transform = `translate(${x}px, ${y}px)`;
      window.film.title.style.opacity = opacity;
    },
    [...pointer, Math.min(1, (shot - shown) / FADE)],
  );
  await page.screenshot({ path: join(frames, `${String(shot++).padStart(3, '0')}.png`) });
}

async function show(title) {
  shown = shot;
  await page.evaluate((title) => (window.film.title.textContent = title), title);
}

async function moveTo(place) {
  pointer = place;
  await page.mouse.move(...place);
}

async function glide(to, seconds) {
  const from = pointer;
  await pass(seconds, (part) => moveTo(between(from, to, eased(part))));
}

/** `path` says where the pointer is, from where it was pressed and how much of the way is done. */
async function drag(seconds, path) {
  const from = pointer;
  await press();
  await pass(seconds, (part) => moveTo(path(from, eased(part))));
  await release();
}

async function click() {
  await press();
  await pass(0.11);
  await release();
  await pass(0.11);
}

async function press() {
  await page.mouse.down();
  await ring(true);
}

async function release() {
  await page.mouse.up();
  await ring(false);
}

async function ring(shown) {
  await page.evaluate((shown) => window.film.ring.setAttribute('visibility', shown ? 'visible' : 'hidden'), shown);
}

/** Where a pixel of the picture is on the screen. */
async function pixel(x, y) {
  const box = await page.locator('.picture > canvas').first().boundingBox();
  // A button is pressed at whole pixels, and only a drag from one can return to where it began.
  return [box.x + ((x + 0.5) * box.width) / 512, box.y + ((y + 0.5) * box.height) / 512].map(Math.round);
}

async function middle(locator) {
  const { x, y, width, height } = await locator.boundingBox();
  return [x + width / 2, y + height / 2];
}

/** Where the thumb of a slider is for a value. */
async function thumbOf(slider) {
  const { x, y, width, height } = await slider.boundingBox();
  const [min, max] = await slider.evaluate(({ min, max }) => [Number(min), Number(max)]);
  return (value) => [x + height / 2 + ((value - min) / (max - min)) * (width - height), y + height / 2];
}

function between([x, y], [toX, toY], part) {
  return [x + (toX - x) * part, y + (toY - y) * part];
}

/** Starts and ends gently. */
function eased(part) {
  return part * part * (3 - 2 * part);
}
