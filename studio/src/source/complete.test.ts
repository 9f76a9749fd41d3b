import { expect, test } from 'vitest';
import schema from '../../../docs/scene.schema.json';
import { type KnownNames, type Suggestion, suggestionsAt } from './complete';
import { entriesAt, entryAt, headers, valuesAt } from './schema';

const MATERIALS = '[material.glass]\neta = 2\n[material."my \\"red\\""]\nkd = 1\n';

function at(marked: string, known?: KnownNames) {
  const offset = marked.indexOf('¦');
  const text = marked.replace('¦', '');
  const { from, to, suggestions } = suggestionsAt(text, offset, known);
  /** The text with one of them. */
  const chosen = (name: string) => {
    const one = suggestions.find((suggestion) => suggestion.name === name);
    return one && text.slice(0, from) + one.insert + text.slice(to);
  };
  return { names: suggestions.map(({ name }) => name), chosen, suggestions };
}

test('keys of a table, with what the schema says of them', () => {
  const { names, suggestions } = at('[render]\n¦');
  expect(names.sort()).toEqual(Object.keys(schema.$defs.Render.properties).sort());
  const find = (name: string) => suggestions.find((one: Suggestion) => one.name === name);
  expect(find('max_depth')).toMatchObject({ detail: 'default 32', description: 'How many bounces may follow the camera ray.' });
  expect(find('integrator')).toMatchObject({ isRequired: true });
  expect(at('[[sphere]]\nr¦').chosen('radius')).toBe('[[sphere]]\nradius = ');
});

test('what the table has already is left out, but not the key at the cursor, nor those of its neighbours', () => {
  const { names } = at('[[light]]\ncolor = 1\n[[light]]\nposition = [1, 2, 3]\n¦\nname = "x"\n[[light]]\ncone = 3');
  expect(names).not.toContain('position');
  expect(names).not.toContain('name');
  expect(names).toEqual(expect.arrayContaining(['color', 'cone']));
  expect(at('[[light]]\ncol¦or = 1').chosen('color')).toBe('[[light]]\ncolor = 1');
  expect(at('[[light]]\nna¦ = 1').chosen('color')).toBe('[[light]]\ncolor = 1');
});

test('steps of a transform', () => {
  expect(at('[[mesh]]\ntransform = [{ ¦').names).toEqual(['rotate', 'scale', 'move']);
  expect(at('[[mesh]]\ninstances = [[{ rotate = { ¦').names).toEqual(['axis', 'degrees']);
});

test('headers, and what stands before the first', () => {
  expect(at('[¦').names.sort()).toEqual(['camera', 'material', 'render', 'sky', 'texture']);
  expect(at('[[¦').names.sort()).toEqual(['box', 'disc', 'lathe', 'light', 'mesh', 'plane', 'sphere']);
  expect(at('[ren¦').chosen('render')).toBe('[render]');
  expect(at('[re¦nder]').chosen('render')).toBe('[render]');
  expect(at('[[li¦').chosen('light')).toBe('[[light]]');
  expect(at('[mat¦').chosen('material')).toBe('[material.');
  const root = at('snell = 1\n¦');
  expect(root.names).not.toContain('snell');
  expect(root.chosen('ambient')).toBe('snell = 1\nambient = ');
  expect(root.chosen('sphere')).toBe('snell = 1\n[[sphere]]');
});

test('every header is one that the engine knows', () => {
  const all = [...headers('table'), ...headers('element')].map(({ name }) => name);
  expect(new Set(all).size).toBe(all.length);
  for (const name of all) expect(entriesAt(name === 'material' || name === 'texture' ? [name, 'x'] : [name]).length).toBeGreaterThan(1);
});

test('values, with and without quotes', () => {
  const models = ['lecture', 'course2018', 'course2020', 'whitted'];
  expect(at('[render]\nintegrator = ¦').names).toEqual(models);
  for (const typed of ['¦', 'wh¦', '"¦', '"wh¦', '"¦"', '"wh¦"', '"wh¦itted"', '"lec¦ture"', 'lec¦ture']) {
    expect(at(`[render]\nintegrator = ${typed}\nspp = 2`).chosen('whitted')).toBe('[render]\nintegrator = "whitted"\nspp = 2');
  }
  expect(at("[render]\nintegrator = 'wh¦'").chosen('whitted')).toBe("[render]\nintegrator = 'whitted'");
  expect(at('[material.a]\ntinted_transmission = t¦').chosen('true')).toBe('[material.a]\ntinted_transmission = true');
  expect(at('[render]\nspp = ¦').names).toEqual([]);
  expect(at('[render]\nintegrator = "lecture" ¦').names).toEqual([]);
});

test('names of materials, also those that need quotes', () => {
  expect(at(`${MATERIALS}[[sphere]]\nmaterial = ¦`).names).toEqual(['glass', 'my "red"']);
  expect(at(`[[sphere]]\nmaterial = "¦"\n${MATERIALS}`).chosen('my "red"')).toContain('material = "my \\"red\\""\n');
  expect(at(`[[sphere]]\nmaterial = '¦'\n${MATERIALS}`).names).toEqual(['glass']);
  expect(at(`${MATERIALS}[[mesh]]\nmaterials = { slot = "¦" }`).names).toContain('glass');
  expect(at('material = { a = { eta = 2 }, b = {} }\n[[plane]]\ninside = ¦').names).toEqual(['a', 'b']);
  expect(at('material.a.eta = 2\n[[plane]]\ninside = ¦').names).toEqual(['a']);
});

test('names of textures, glasses and files', () => {
  expect(at('[texture.board]\n[material.a]\ntexture = ¦').names).toEqual(['board']);
  expect(at('[material.a]\nglass = ¦', { glasses: ['N-BK7', 'fused silica'] }).chosen('fused silica')).toBe('[material.a]\nglass = "fused silica"');
  const files = ['cow.obj', 'cow.mtl', 'Map.PNG'];
  expect(at('[[mesh]]\nfile = "¦', { files }).names).toEqual(['cow.obj']);
  expect(at('[sky]\nimage = "¦', { files }).names).toEqual(['Map.PNG']);
});

test('names of what every object has are no keys', () => {
  expect(at('[constructor]\n¦').names).toEqual([]);
  expect(at('[render.__proto__]\n¦').names).toEqual([]);
  expect(entryAt(['render', 'toString'])).toBeUndefined();
  expect(valuesAt(['render', 'constructor'])).toEqual([]);
});
