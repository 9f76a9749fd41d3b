// Small pictures as PNG with a palette, which takes less than true colour does.

import { crc32, deflateSync } from 'node:zlib';

const COLORS = 256;
const ROUNDS = 4;

/** A PNG of a picture of 8 bit: `colors` are red, green and blue of each pixel, row by row. */
export function indexedPng({ width, height, colors }) {
  const { palette, indices } = quantized(colors);
  const rows = Buffer.alloc((width + 1) * height);
  for (let y = 0; y < height; y += 1) indices.copy(rows, y * (width + 1) + 1, y * width, (y + 1) * width);
  const header = Buffer.alloc(13);
  header.writeUInt32BE(width, 0);
  header.writeUInt32BE(height, 4);
  // 8 bit, each the number of a colour.
  header.set([8, 3], 8);
  return Buffer.concat([
    Buffer.from('\x89PNG\r\n\x1a\n', 'latin1'),
    chunk('IHDR', header),
    chunk('PLTE', Buffer.from(palette.flat())),
    chunk('IDAT', deflateSync(rows, { level: 9, memLevel: 9 })),
    chunk('IEND', Buffer.alloc(0)),
  ]);
}

function chunk(name, data) {
  const body = Buffer.concat([Buffer.from(name, 'latin1'), data]);
  const [length, check] = [Buffer.alloc(4), Buffer.alloc(4)];
  length.writeUInt32BE(data.length);
  check.writeUInt32BE(crc32(body));
  return Buffer.concat([length, body, check]);
}

/** Colours by median cut, moved to the middle of what is nearest to them (k-means), and for each pixel the nearest. */
function quantized(colors) {
  const counts = new Map();
  for (let at = 0; at < colors.length; at += 3) {
    const key = (colors[at] << 16) | (colors[at + 1] << 8) | colors[at + 2];
    counts.set(key, (counts.get(key) ?? 0) + 1);
  }
  const points = [...counts].map(([key, count]) => ({ color: [key >> 16, (key >> 8) & 255, key & 255], key, count }));
  let palette = medianCut(points).map(mean);
  for (let round = 0; round < ROUNDS; round += 1) {
    const groups = palette.map(() => []);
    for (const point of points) groups[nearest(palette, point.color)].push(point);
    palette = groups.filter((group) => group.length > 0).map(mean);
  }
  palette = palette.map((color) => color.map(Math.round)).sort((a, b) => lightness(a) - lightness(b));
  const indexOf = new Map(points.map(({ key, color }) => [key, nearest(palette, color)]));
  const indices = Buffer.alloc(colors.length / 3);
  for (let at = 0; at < indices.length; at += 1) {
    indices[at] = indexOf.get((colors[3 * at] << 16) | (colors[3 * at + 1] << 8) | colors[3 * at + 2]);
  }
  return { palette, indices };
}

/** Halves the group that spreads the most, weighted by how many pixels it has, until there are enough. */
function medianCut(points) {
  const groups = [points];
  while (groups.length < COLORS) {
    const spreads = groups.map(widest);
    const at = spreads.reduce((best, spread, index) => (spread.weight > spreads[best].weight ? index : best), 0);
    const { axis, weight } = spreads[at];
    if (weight === 0) break;
    const group = groups[at].toSorted((a, b) => a.color[axis] - b.color[axis]);
    const half = group.reduce((sum, point) => sum + point.count, 0) / 2;
    let [count, cut] = [0, 0];
    while (cut < group.length - 1 && (cut === 0 || count < half)) count += group[cut++].count;
    groups.splice(at, 1, group.slice(0, cut), group.slice(cut));
  }
  return groups;
}

function widest(group) {
  const spreads = [0, 1, 2].map((axis) => {
    const values = group.map((point) => point.color[axis]);
    return values.reduce((a, b) => Math.max(a, b), 0) - values.reduce((a, b) => Math.min(a, b), 255);
  });
  const axis = spreads.indexOf(Math.max(...spreads));
  const count = group.reduce((sum, point) => sum + point.count, 0);
  return { axis, weight: spreads[axis] * Math.sqrt(count) };
}

function mean(group) {
  const count = group.reduce((sum, point) => sum + point.count, 0);
  return [0, 1, 2].map((axis) => group.reduce((sum, point) => sum + point.count * point.color[axis], 0) / count);
}

function nearest(palette, [r, g, b]) {
  let [best, least] = [0, Infinity];
  for (const [index, [pr, pg, pb]] of palette.entries()) {
    const distance = (r - pr) ** 2 + (g - pg) ** 2 + (b - pb) ** 2;
    if (distance < least) [best, least] = [index, distance];
  }
  return best;
}

const lightness = ([r, g, b]) => 2 * r + 5 * g + b;
