// Takes a picture of a page that `snell explain --html` wrote, with one of its rays selected:
//   node test/screenshot.mjs why.html why.png "Refracted ray hits green"

import { pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';

const [page, picture, ray] = process.argv.slice(2);
const args = ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'];
const browser = await chromium.launch({ executablePath: '/usr/bin/chromium', args });
const shown = await browser.newPage({ viewport: { width: 1300, height: 760 }, reducedMotion: 'reduce', offline: true });
await shown.goto(pathToFileURL(page).href);
await shown.getByRole('treeitem', { name: ray }).click();
await shown.mouse.move(0, 0);
await shown.screenshot({ path: picture });
await browser.close();
