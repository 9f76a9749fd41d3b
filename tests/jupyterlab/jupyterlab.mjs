// JupyterLab, which nobody has set up, and a page of it in Chromium.

import { spawn } from 'node:child_process';
import { mkdirSync } from 'node:fs';
import { createRequire } from 'node:module';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';

export const root = fileURLToPath(new URL('../..', import.meta.url));
const { chromium } = createRequire(join(root, 'viewer/package.json'))('playwright-core');
const python = process.env.PYTHON ?? join(root, 'target/python/bin/python');

// A machine with other work may take this long to start a kernel.
export const PATIENCE = { timeout: 120_000 };

/** Drawn without a graphics card, so that pictures are much the same on all machines. */
export function launch() {
  const args = ['--no-sandbox', '--use-gl=angle', '--use-angle=swiftshader', '--enable-unsafe-swiftshader'];
  return chromium.launch({ executablePath: '/usr/bin/chromium', args });
}

/** A server for a folder, with settings and kernels' files in `home`. */
export class Server {
  #child;

  /** Starts it. */
  async start(folder, home) {
    const env = { ...process.env, HOME: home, JUPYTER_PREFER_ENV_PATH: '1' };
    for (const name of ['JUPYTER_DATA_DIR', 'JUPYTER_CONFIG_DIR', 'JUPYTER_RUNTIME_DIR', 'IPYTHONDIR']) {
      env[name] = join(home, name);
      mkdirSync(env[name], { recursive: true });
    }
    const where = ['--no-browser', '--allow-root', '--ip=127.0.0.1', '--port=0', `--notebook-dir=${folder}`];
    const options = ['--IdentityProvider.token=snell', '--LabApp.expose_app_in_browser=True'];
    const child = spawn(python, ['-m', 'jupyterlab', ...where, ...options], { env });
    this.#child = child;
    this.port = await new Promise((resolve, reject) => {
      let said = '';
      const hear = (text) => {
        said += text;
        const found = /127\.0\.0\.1:(\d+)\/lab/.exec(said);
        if (found) resolve(found[1]);
      };
      child.stdout.on('data', hear);
      child.stderr.on('data', hear);
      child.on('error', reject);
      child.on('exit', () => reject(new Error(`JupyterLab did not start:\n${said}`)));
    });
  }

  async stop() {
    const child = this.#child;
    if (child === undefined || child.exitCode !== null) return;
    const gone = new Promise((resolve) => child.once('exit', resolve));
    child.kill('SIGTERM');
    const kill = setTimeout(() => child.kill('SIGKILL'), 10_000);
    await gone;
    clearTimeout(kill);
  }

  /**
   * Opens a notebook and waits for its kernel. As without a network, nothing but the server can be reached; `trouble` is told who
   * tries.
   */
  async open(browser, name, trouble) {
    const context = await browser.newContext({ viewport: { width: 1400, height: 1200 }, reducedMotion: 'reduce' });
    await context.route(/^https?:/, (route) => {
      const url = route.request().url();
      if (url.startsWith(`http://127.0.0.1:${this.port}/`)) return route.continue();
      trouble.push(`request of ${url}`);
      return route.abort();
    });
    const page = await context.newPage();
    await page.goto(`http://127.0.0.1:${this.port}/lab/tree/${name}?token=snell`);
    const idle = () => window.jupyterapp?.shell.currentWidget?.sessionContext?.session?.kernel?.status === 'idle';
    await page.waitForFunction(idle, null, PATIENCE);
    return page;
  }
}

/** Runs all cells, and throws what went wrong in one of them. */
export async function runAll(page) {
  await page.evaluate(() => jupyterapp.commands.execute('notebook:run-all-cells'));
  const errors = await page.evaluate(() => {
    const cells = jupyterapp.shell.currentWidget.content.widgets.filter(({ model }) => model.type === 'code');
    const outputs = cells.flatMap(({ model }) => model.outputs.toJSON());
    return outputs.filter(({ output_type }) => output_type === 'error').map(({ ename, evalue }) => `${ename}: ${evalue}`);
  });
  if (errors.length > 0) throw new Error(errors.join('\n'));
}

/** Runs a cell, and returns what it says. */
export async function run(page, number) {
  return page.evaluate(async (number) => {
    const { content } = jupyterapp.shell.currentWidget;
    content.deselectAll();
    content.activeCellIndex = number;
    await jupyterapp.commands.execute('notebook:run-cell');
    const outputs = content.widgets[number].model.outputs.toJSON();
    const error = outputs.find(({ output_type }) => output_type === 'error');
    if (error) throw new Error(`${error.ename}: ${error.evalue}`);
    return outputs.map(({ data }) => data?.['text/plain'] ?? '').join('');
  }, number);
}

export async function save(page) {
  await page.evaluate(() => jupyterapp.commands.execute('docmanager:save'));
}
