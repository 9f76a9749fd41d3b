import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { afterEach, beforeEach, expect, test } from 'vitest';
import { asCommand, asPython, stem } from './code';

const path = (relative: string) => fileURLToPath(new URL(`../../../${relative}`, import.meta.url));
const TEXT = readFileSync(path('scenes/lecture/default.toml'), 'utf8');
const TOOLS = { snell: path('target/ci/snell'), python: path('target/python/bin/python') };

let folder: string;
beforeEach(() => {
  folder = mkdtempSync(join(tmpdir(), 'snell-'));
});
afterEach(() => rmSync(folder, { recursive: true }));

/** Runs what was copied, where nothing else is, and returns the name of the only file that it makes. */
function run(tool: string, args: string[], path?: string): string {
  const env = { ...process.env, PATH: `${path ?? ''}:${process.env.PATH}` };
  execFileSync(tool, args, { cwd: folder, env, stdio: ['ignore', 'ignore', 'pipe'], timeout: 60_000 });
  const made = readdirSync(folder).filter((name) => !name.startsWith('given'));
  expect(made.length).toBe(1);
  return made[0]!;
}

/** Says what it was asked, instead of rendering. */
function withEcho(command: string): { args: string[]; input: string } {
  writeFileSync(join(folder, 'given-snell'), '#!/bin/sh\nfor word; do printf \'%s\\0\' "$word"; done > asked\n[ "$2" = - ] && cat > given-input || :\n', { mode: 0o755 });
  run('sh', ['-c', command.replace('snell', './given-snell')]);
  const input = join(folder, 'given-input');
  const args = readFileSync(join(folder, 'asked'), 'utf8').split('\0').slice(0, -1);
  return { args, input: existsSync(input) ? readFileSync(input, 'utf8') : '' };
}

test('a built-in scene has a short command', () => {
  expect(asCommand({ name: 'lecture/default' })).toBe('snell render lecture/default -o default.png\n');
  expect(asPython({ name: 'lecture/default' })).toBe('import snell\n\npicture = snell.scenes["lecture/default"].render()\npicture.save("default.png")\n');
});

const NAMES = ["it's", '$(touch oops) `x`', 'a b', '-rf', '🔮', '!x', '~', '#', "'", 'a&b;c', '*'];

test.each(NAMES)('the shell takes the name %j as it is', (name) => {
  const { args } = withEcho(asCommand({ name: `${name}.toml`, text: 'snell = 1' }));
  expect(args.slice(0, 3)).toEqual(['render', '-', '-o']);
  expect(args[3]!.replace('./', '')).toBe(`${stem(name)}.png`);
});

const TEXTS = ['a = "$HOME `x` \\\\ \\" \' \'\'\' \\"\\"\\""\n', 'SNELL\nSNELL_\n', "'''\n\"\"\"\n\\\n", 'x = "\\u00e9"', '# 🔮\n\n\n', '"'];

test.each(TEXTS)('the shell takes the text %j as it is', (text) => {
  expect(withEcho(asCommand({ name: 'a', text })).input).toBe(text.endsWith('\n') ? text : `${text}\n`);
});

test.each(TEXTS)('Python takes the text %j as it is', (text) => {
  const code = asPython({ name: 'a', text }).replaceAll(/^import.*$|^picture.*$/gm, '');
  const fake = 'class snell:\n  class Scene:\n    of = staticmethod(lambda text, name: open("made", "w").write(text))\nclass tomllib:\n  loads = str\n';
  run('python3', ['-c', fake + code]);
  expect(readFileSync(join(folder, 'made'), 'utf8')).toBe(text.endsWith('\n') ? text : `${text}\n`);
});

test('line ends of Windows do not matter', () => {
  expect(asCommand({ name: 'a', text: '\uFEFFa = 1\r\nb = 2' })).toContain("'SNELL'\na = 1\nb = 2\nSNELL\n");
});

test('files are named, and a name cannot end the comment', () => {
  const copied = { name: 'a', text: 'x', files: ['a\nrm -rf', 'b', 'c', 'd'] };
  for (const code of [asCommand(copied), asPython(copied)]) expect(code.split('\n')[0]).toBe('# Run it where the files of the scene are: a rm -rf, b, c and 1 more.');
});

test('stems are names of files everywhere', () => {
  expect(stem('lecture/default')).toBe('default');
  expect(stem('C:\\x\\Ball.TOML')).toBe('Ball');
  expect(stem('../..')).toBe('scene');
  expect(stem('.toml')).toBe('scene');
  expect(stem('a\u0000:b?.json')).toBe('a__b_');
});

test.runIf(existsSync(TOOLS.snell))('the command renders', () => {
  const small = TEXT.replace('[512, 512]', '[16, 16]');
  expect(run('sh', ['-c', asCommand({ name: "it's mine.toml", text: small })], path('target/ci'))).toBe("it's mine.png");
});

test.runIf(existsSync(TOOLS.python))('Python renders', () => {
  const small = TEXT.replace('[512, 512]', '[16, 16]');
  expect(run(TOOLS.python, ['-c', asPython({ name: '"a" 🔮.toml', text: small })])).toBe('_a_ 🔮.png');
  rmSync(join(folder, '_a_ 🔮.png'));
  expect(run(TOOLS.python, ['-c', asPython({ name: 'lecture/default' })])).toBe('default.png');
});
