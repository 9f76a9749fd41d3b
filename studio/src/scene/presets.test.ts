import { readFileSync } from 'node:fs';
import { expect, test } from 'vitest';
import { PRESETS } from './presets';

test('presets have the index that the catalogue has', () => {
  const table = readFileSync(new URL('../../../docs/glasses.md', import.meta.url), 'utf8');
  const rows = table.split('\n').map((line) => line.split('|').map((cell) => cell.trim()));
  for (const { glass, eta } of PRESETS) {
    if (glass === null) continue;
    const row = rows.find((cells) => cells[1] === glass);
    expect(row, glass).toBeDefined();
    // The table has five decimals.
    expect(eta, glass).toBeCloseTo(Number(row![3]), 4);
  }
});
