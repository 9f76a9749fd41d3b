// Runs notebooks from top to bottom in JupyterLab, so that what they are kept with has the stills of their views in 3D too:
//   make notebooks      or      node docs/notebooks/run.mjs docs/notebooks/1-the-lecture-retold.ipynb

import { copyFileSync, cpSync, mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { basename, dirname, join, resolve } from 'node:path';
import { launch, root, runAll, save, Server } from '../../tests/jupyterlab/jupyterlab.mjs';

/** Where a picture of the last view goes, if someone wants one. */
const { SHOT } = process.env;
const notebooks = process.argv.slice(2).map((path) => resolve(path));
// In a copy, with the scenes that they read: a run that fails leaves what is there as it was.
const folder = mkdtempSync(join(tmpdir(), 'snell-notebooks-'));
const copies = join(folder, 'docs', 'notebooks');
cpSync(dirname(notebooks[0]), copies, { recursive: true });
symlinkSync(join(root, 'scenes'), join(folder, 'scenes'));
const [server, browser] = [new Server(), await launch()];
try {
  await server.start(folder, join(folder, '.home'));
  for (const path of notebooks) {
    console.error(basename(path));
    const page = await server.open(browser, `docs/notebooks/${basename(path)}`, []);
    await runAll(page);
    await page.waitForTimeout(1000); // JupyterLab goes to the end by itself
    for (const view of await page.locator('.jp-CodeCell canvas').all()) {
      const viewer = await view.evaluateHandle((canvas) => canvas.getRootNode().host);
      await viewer.evaluate((host) => host.scrollIntoView());
      // A view sends its still when it has been quiet for a moment.
      await page.waitForTimeout(4000);
      if (SHOT) await viewer.screenshot({ path: resolve(SHOT) });
    }
    await save(page);
    await page.context().close();
    const kept = tidied(JSON.parse(readFileSync(join(copies, basename(path)), 'utf8')));
    writeFileSync(join(folder, 'kept'), `${JSON.stringify(kept, null, 1)}\n`);
    copyFileSync(join(folder, 'kept'), path);
  }
} finally {
  await browser.close();
  await server.stop();
  rmSync(folder, { recursive: true, force: true });
}

/** Without what differs from run to run: bars that are gone, where texts are cut, addresses, the kernel's exact version. */
function tidied(notebook) {
  for (const cell of notebook.cells.filter(({ cell_type }) => cell_type === 'code')) {
    cell.metadata = {};
    const shown = cell.outputs.filter(({ data }) => data === undefined || Object.keys(data).length > 0);
    const streams = new Map();
    cell.outputs = shown.filter((output) => {
      const before = streams.get(output.name);
      if (output.output_type === 'stream' && before === undefined) streams.set(output.name, output);
      if (before !== undefined) before.text = [before.text, output.text].flat();
      return before === undefined;
    });
    for (const { data } of cell.outputs) {
      if (data?.['text/plain']) data['text/plain'] = [data['text/plain']].flat().map((line) => line.replace(/ at 0x[0-9a-f]+/, ''));
    }
  }
  notebook.metadata = { kernelspec: notebook.metadata.kernelspec, language_info: { name: 'python' } };
  return notebook;
}
