import { expect, test } from 'vitest';
import { contextAt, keysOf } from './toml';

/** The context at the sign `¦`. */
function at(marked: string) {
  const offset = marked.indexOf('¦');
  const text = marked.replace('¦', '');
  const { place, path, from, quote } = contextAt(text, offset);
  return { place, path: path.join('.'), word: text.slice(from, offset), quote };
}

const is = (place: string, path: string, word = '', quote = '') => ({ place, path, word, quote });

test('keys and values of tables, lists of tables and dotted keys', () => {
  expect(at('sn¦')).toEqual(is('key', '', 'sn'));
  expect(at('[render]\nint¦')).toEqual(is('key', 'render', 'int'));
  expect(at('[render]\nintegrator = ¦')).toEqual(is('value', 'render.integrator'));
  expect(at('[render]\nintegrator = "lec¦"')).toEqual(is('value', 'render.integrator', 'lec', '"'));
  expect(at('[[sphere]]\nradius = 1\n¦')).toEqual(is('key', 'sphere'));
  expect(at('[render]\nspp = 1\n[material.glass]\nk¦')).toEqual(is('key', 'material.glass', 'k'));
  expect(at('render.int¦')).toEqual(is('key', 'render', 'int'));
  expect(at('render . integrator = l¦')).toEqual(is('value', 'render.integrator', 'l'));
});

test('headers', () => {
  expect(at('[ren¦')).toEqual(is('table', '', 'ren'));
  expect(at('[[sph¦]]')).toEqual(is('element', '', 'sph'));
  expect(at('[material.gl¦]')).toEqual(is('table', 'material', 'gl'));
  expect(at('[render] ¦')).toEqual(is('nothing', 'render'));
});

test('behind a value nothing is to be written, and in comments neither', () => {
  expect(at('[render]\nspp = 1 ¦').place).toBe('nothing');
  expect(at('[render]\nname = "x"¦').place).toBe('nothing');
  expect(at('# [render] integrator = ¦').place).toBe('nothing');
  expect(at('[render] # integrator = ¦\n').place).toBe('nothing');
  expect(at('[render]\n# x = [\n¦')).toEqual(is('key', 'render'));
});

test('signs within strings mean nothing', () => {
  expect(at('[[light]]\nname = "a # [b] = {"\n¦')).toEqual(is('key', 'light'));
  expect(at(`[[light]]\nname = 'a "\n¦`)).toEqual(is('key', 'light'));
  expect(at('[[light]]\nname = "a \\" ] # b"\n¦')).toEqual(is('key', 'light'));
  expect(at('[[light]]\nname = """a\n[render]\n"" x"""\n¦')).toEqual(is('key', 'light'));
  expect(at("[[light]]\nname = '''a\\'''\n¦")).toEqual(is('key', 'light'));
  expect(at('[[light]]\nname = """a""""\n¦')).toEqual(is('key', 'light'));
  expect(at('x = "\\¦')).toEqual(is('value', 'x', '\\', '"'));
  expect(at('[[light]]\nname = """\n¦')).toEqual(is('value', 'light.name', '\n', '"'));
});

test('quoted names', () => {
  expect(at('[material."x.y ]#"]\nk¦')).toEqual({ ...is('key', 'material.x.y ]#', 'k') });
  expect(at(`[material.'a="b']\n"eta" = ¦`).path).toBe('material.a="b.eta');
  expect(at('[material."caf\\u00e9"]\n¦').path).toBe('material.café');
  expect(at('[material."gl¦')).toEqual(is('table', 'material', 'gl', '"'));
});

test('inline tables', () => {
  expect(at('material = { glass = { e¦')).toEqual(is('key', 'material.glass', 'e'));
  expect(at('material = { glass = { eta = 2, k¦ } }')).toEqual(is('key', 'material.glass', 'k'));
  expect(at('material = { glass = { eta = 2 }, ¦ }')).toEqual(is('key', 'material'));
  expect(at('[[mesh]]\ntransform = [{ rotate = { ax¦')).toEqual(is('key', 'mesh.transform.rotate', 'ax'));
  expect(at('[[mesh]]\ntransform = [{ move = [1, 2, 3] }, { ¦')).toEqual(is('key', 'mesh.transform'));
  expect(at('[[mesh]]\nmaterials = { a = "gl¦')).toEqual(is('value', 'mesh.materials.a', 'gl', '"'));
});

test('lists over several lines', () => {
  expect(at('[render]\nsize = [\n  512, # wide\n  ¦')).toEqual(is('value', 'render.size'));
  expect(at('[render]\nsize = [\n  512,\n  512,\n]\n¦')).toEqual(is('key', 'render'));
  expect(at('[[mesh]]\nvertices = [\n[1, 2, 3],\n[4, 5, 6]]\nfa¦')).toEqual(is('key', 'mesh', 'fa'));
  expect(at('[[light]]\nname = ["a",\n["b"],\n[true],\n¦')).toEqual(is('value', 'light.name'));
  expect(at('[[mesh]]\ntransform = [\n  { move = [1, 2, 3] },\n  { sc¦')).toEqual(is('key', 'mesh.transform', 'sc'));
});

test('what was not closed does not swallow the rest', () => {
  expect(at('[render]\nsize = [512,\nspp = ¦')).toEqual(is('value', 'render.spp'));
  expect(at('[render]\nsize = [512,\n\n[camera]\ne¦')).toEqual(is('key', 'camera', 'e'));
  expect(at('[[box]]\ntransform = [{ move = [1, 2, 3]\n[[sphere]] # next\nr¦')).toEqual(is('key', 'sphere', 'r'));
  expect(at('[[light]]\nname = "left\ncol¦')).toEqual(is('key', 'light', 'col'));
  expect(at('[render\nspp = ¦')).toEqual(is('value', 'spp'));
  expect(at('[[mesh]]\ntransform = [{ move = [1, 2, 3 ], }\n, ]\n¦')).toEqual(is('key', 'mesh'));
});

test('line ends of Windows, and characters of two units', () => {
  expect(at('[render]\r\nsize = [\r\n512,\r\n512]\r\nint¦')).toEqual(is('key', 'render', 'int'));
  expect(at('[render]\r\nsize = [512,\r\n[camera]\r\ne¦')).toEqual(is('key', 'camera', 'e'));
  expect(at('# 🔮🔮\n[material."🔮"]\neta = ¦')).toEqual(is('value', 'material.🔮.eta'));
  expect(at('[[sphere]]\nname = "🔮¦"')).toEqual(is('value', 'sphere.name', '🔮', '"'));
});

test('junk does no harm', () => {
  for (const junk of [']]]', '}}}', '= = =', ',,,', '...', '[[[', '{', '"', '[.]', '\u0000', '[a]]\n[b\n[[']) {
    expect(at(`${junk}\n[render]\nspp¦`)).toEqual(is('key', 'render', 'spp'));
    expect(keysOf(`${junk}\n[render]\nspp`).at(-1)?.path).toEqual(['render', 'spp']);
  }
});

test('a context at every offset has the word that ends there', () => {
  const text = '[material."a b"]\nka = [0.1, 2]\n[[sphere]] # s\nname = "x\\"y"\ntransform = [{ move = [1, 2, 3] }]\n';
  for (let offset = 0; offset <= text.length; offset += 1) {
    const { from } = contextAt(text, offset);
    expect(from).toBeLessThanOrEqual(offset);
    expect(from).toBeGreaterThanOrEqual(0);
  }
});

test('all keys, with the tables that they stand in', () => {
  const text = '[[sphere]]\nname = "a"\n[[sphere]]\nname = "b"\ntransform = [{ move = [1, 2, 3] }, { scale = [1, 1, 1] }]\n';
  const keys = keysOf(text);
  const named = keys.map((key) => [key.path.join('.'), text.slice(key.from, key.to)]);
  expect(named).toEqual([
    ['sphere', 'sphere'], ['sphere.name', 'name'], ['sphere', 'sphere'], ['sphere.name', 'name'],
    ['sphere.transform', 'transform'], ['sphere.transform.move', 'move'], ['sphere.transform.scale', 'scale'],
  ]);
  const tables = keys.filter((key) => key.path.length > 1).map((key) => key.table);
  expect(tables[0]).not.toBe(tables[1]);
  expect(tables[1]).toBe(tables[2]);
  expect(new Set(tables).size).toBe(4);
});

test('a key at the cursor has the table of its neighbours', () => {
  const text = '[[light]]\ncolor = 1\n[[light]]\nposition = [1, 2, 3]\n\ncolor = 2\n';
  const { table } = contextAt(text, text.indexOf('\n\n') + 1);
  expect(keysOf(text).filter((key) => key.table === table).map((key) => key.path[1])).toEqual(['position', 'color']);
});

test('a megabyte is read in no time', () => {
  const text = `[[mesh]]\nvertices = [${'[1.25, 2.5, -3e-7],\n'.repeat(50_000)}]\nma`;
  const start = performance.now();
  expect(contextAt(text, text.length)).toMatchObject({ place: 'key', path: ['mesh'] });
  expect(performance.now() - start).toBeLessThan(1000);
});
