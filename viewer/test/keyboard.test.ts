import { expect, test } from 'vitest';
import { treeAction } from '../src/keyboard';
import { TreeModel } from '../src/model';
import { rays } from './fixture';

//  0 unfolded
//    1 unfolded
//      3
//      4 folded (5)
//    2 folded (6)
const rows = new TreeModel(rays([null, 0, 0, 1, 1, 4, 2])).rows(new Set([0, 1]));
const names = ['camera', 'inside', 'mirror', 'mirror', 'refracted'];
const press = (key: string, current: number) => treeAction(key, rows, current, (id) => names[id]!);
const focus = (id: number) => ({ do: 'focus', id });

test('up and down go through what can be seen', () => {
  expect(press('ArrowDown', 1)).toEqual(focus(3));
  expect(press('ArrowDown', 4)).toEqual(focus(2));
  expect(press('ArrowUp', 2)).toEqual(focus(4));
  expect(press('ArrowUp', 0)).toBeNull();
  expect(press('ArrowDown', 2)).toBeNull();
});

test('right unfolds, then goes to the first child', () => {
  expect(press('ArrowRight', 4)).toEqual({ do: 'expand', ids: [4] });
  expect(press('ArrowRight', 1)).toEqual(focus(3));
  expect(press('ArrowRight', 3)).toBeNull();
});

test('left folds, then goes to the parent', () => {
  expect(press('ArrowLeft', 1)).toEqual({ do: 'collapse', ids: [1] });
  expect(press('ArrowLeft', 4)).toEqual(focus(1));
  expect(press('ArrowLeft', 0)).toEqual({ do: 'collapse', ids: [0] });
});

test('home, end and the star', () => {
  expect(press('Home', 2)).toEqual(focus(0));
  expect(press('End', 0)).toEqual(focus(2));
  expect(press('*', 1)).toEqual({ do: 'expand', ids: [1, 2] });
});

test('enter and space select', () => {
  expect(press('Enter', 3)).toEqual({ do: 'select', id: 3 });
  expect(press(' ', 3)).toEqual({ do: 'select', id: 3 });
});

test('letters go to the next row that begins so, around the end', () => {
  expect(press('m', 3)).toEqual(focus(2));
  expect(press('M', 2)).toEqual(focus(3));
  expect(press('x', 2)).toBeNull();
});

test('other keys are left to the browser', () => {
  expect(press('Tab', 1)).toBeNull();
  expect(press('F5', 1)).toBeNull();
});
