// What the studio knows of the built-in scenes before it renders any: the hash that the command has for each, and a small picture.
// Usage: node scenes.mjs SNELL FOLDER [--quick]
// Writes FOLDER/scenes.json and FOLDER/thumbnails. With --quick, what takes long is left without a hash, and its picture is coarse.

import { execFileSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { argv, exit, stderr } from 'node:process';
import { indexedPng } from './png.mjs';

const quick = argv.includes('--quick');
const [command, folder] = argv.slice(2).filter((argument) => argument !== '--quick');
if (!folder) {
  stderr.write('usage: node scenes.mjs SNELL FOLDER [--quick]\n');
  exit(2);
}

const WIDTH = 240;
const SAMPLES = 9;
/** With --quick, in seconds. */
const LONG = 2;

// One build of the command makes the same of a scene every time.
const known = join(folder, '..', 'studio-scenes.json');
const binary = createHash('sha256').update(readFileSync(command)).digest('hex');
const cache = readCache();

function readCache() {
  const empty = { binary, scenes: {} };
  try {
    const cache = JSON.parse(readFileSync(known, 'utf8'));
    return cache.binary === binary ? cache : empty;
  } catch {
    return empty;
  }
}

function run(...args) {
  return execFileSync(command, args, { encoding: 'utf8', maxBuffer: 1 << 26, stdio: ['ignore', 'pipe', 'pipe'] });
}

/** Renders, and returns what the command says at the end. */
function render(name, output, ...args) {
  const script = 'exec "$@" 2>&1 >/dev/null';
  const line = ['-c', script, 'sh', command, 'render', name, ...args, '--progress', 'json', '-o', output];
  const said = execFileSync('sh', line, { encoding: 'utf8', maxBuffer: 1 << 26 });
  return JSON.parse(said.trim().split('\n').at(-1));
}

/** A PPM of 8 bit: its size and its colours. */
function readPpm(path) {
  const bytes = readFileSync(path);
  let at = 0;
  const words = Array.from({ length: 4 }, () => {
    const start = at;
    while (bytes[at] > 32) at += 1;
    at += 1;
    return bytes.toString('latin1', start, at - 1);
  });
  if (words[0] !== 'P6' || words[3] !== '255') throw new Error(`${path} is no binary PPM of 8 bit`);
  return { width: Number(words[1]), height: Number(words[2]), colors: bytes.subarray(at) };
}

/** Draws a small picture, and returns how long it took for each sample of each pixel. */
function thumbnail(name, file, [width, height], samples) {
  const path = join(folder, `${file}.ppm`);
  const size = [width, Math.round(height)];
  const { seconds } = render(name, path, '--size', size.join('x'), '--spp', `${samples}`, '--stretch');
  writeFileSync(join(folder, file), indexedPng(readPpm(path)));
  rmSync(path);
  return seconds / (size[0] * size[1] * samples);
}

function sceneOf(name) {
  const scene = JSON.parse(run('convert', name, '-o', '-')).scene;
  return scene;
}

mkdirSync(join(folder, 'thumbnails'), { recursive: true });
const scenes = [];
