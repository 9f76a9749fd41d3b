// What the studio knows of the built-in scenes before it renders any: the hash that the command has for each, and a small picture.
// Usage: node scenes.mjs SNELL FOLDER [--quick]
// Writes FOLDER/scenes.json and FOLDER/thumbnails. With --quick, what takes long is left without a hash, and its picture is coarse.

import { execFileSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
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
  // What it says comes on the stream that is not read here.
  const line = ['-c', 'exec "$@" 2>&1', 'sh', command, 'render', name, ...args, '--progress', 'json', '-o', output];
  const said = execFileSync('sh', line, { encoding: 'utf8', maxBuffer: 1 << 26 });
  return JSON.parse(said.trim().split('\n').at(-1));
}

/** A PPM as the command writes it, in words: its size and its colours. */
function readPpm(path) {
  const [kind, width, height, most, ...numbers] = readFileSync(path, 'latin1').trim().split(/\s+/);
  if (kind !== 'P3' || most !== '255') throw new Error(`${path} is no PPM in words, of 8 bit`);
  return { width: Number(width), height: Number(height), colors: Uint8Array.from(numbers) };
}

/** Draws a small picture; returns the seconds that a sample of a pixel takes. */
function thumbnail(name, file, [width, height], samples) {
  const path = join(folder, 'thumbnail.ppm');
  const size = [width, height].map(Math.round);
  const args = ['--size', size.join('x'), '--stretch', '--spp', `${samples}`];
  const { seconds } = render(name, path, ...args);
  writeFileSync(join(folder, file), indexedPng(readPpm(path)));
  rmSync(path);
  return seconds / (size[0] * size[1] * samples);
}

/** The hash of a scene as it is. */
function filmOf(name) {
  const path = join(folder, 'film.npy');
  const { film_sha256 } = render(name, path);
  rmSync(path);
  return film_sha256;
}

/** What the text of a scene says of itself, and of its picture. */
function read(name) {
  const text = run('scenes', '--save', name, '-o', '-');
  const description = /^(?:#.*\n)+/.exec(text)?.[0].replaceAll(/^# ?/gm, '').replaceAll('\n', ' ').trim() ?? '';
  const render = /^\[render\]$([^[]*(?:\[[\d, ]+\][^[]*)*)/m.exec(text)?.[1] ?? '';
  const size = /^size = \[(\d+), (\d+)\]/m.exec(render)?.slice(1).map(Number);
  if (!size) throw new Error(`${name} does not say how large its picture is`);
  return { name, description, size, spp: Number(/^spp = (\d+)/m.exec(render)?.[1] ?? 1) };
}

function made(name) {
  const { description, size, spp } = read(name);
  const file = `thumbnails/${name.replaceAll('/', '-')}.png`;
  const [width, height] = size;
  const scene = { name, description, size, spp, film_sha256: null, thumbnail: file };
  // A coarse picture first: it tells how long the others take.
  const perSample = thumbnail(name, file, [WIDTH / 4, (WIDTH / 4 / width) * height], 1);
  const isLong = perSample * width * height * spp > LONG;
  if (quick && isLong) return { ...scene, isCoarse: true };
  thumbnail(name, file, [WIDTH, (WIDTH / width) * height], SAMPLES);
  return { ...scene, film_sha256: filmOf(name) };
}

mkdirSync(join(folder, 'thumbnails'), { recursive: true });
const names = run('scenes').match(/^[a-z]+\/\S+/gm);
const scenes = names.map((name, number) => {
  const before = cache.scenes[name];
  const isThere = before && existsSync(join(folder, before.thumbnail)) && (quick || !before.isCoarse);
  if (!isThere) {
    stderr.write(`scene ${number + 1} of ${names.length}: ${name}\n`);
    cache.scenes[name] = made(name);
    writeFileSync(known, JSON.stringify(cache));
  }
  const { isCoarse, ...scene } = cache.scenes[name];
  return scene;
});
writeFileSync(join(folder, 'scenes.json'), `${JSON.stringify(scenes, undefined, 2)}\n`);
