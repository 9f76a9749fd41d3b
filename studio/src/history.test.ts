import { expect, test } from 'vitest';
import { History } from './history';

const version = (text: string, label = text) => ({ base: 1, text, label });

test('versions come back in their order, and what follows is forgotten by another change', () => {
  const history = new History<number>();
  for (const text of ['a', 'b', 'c']) history.record(version(text));
  expect(history.undoLabel).toBe('c');
  history.move(-1);
  history.move(-1);
  history.move(-1);
  expect([history.current!.text, history.undoLabel, history.redoLabel]).toEqual(['a', null, 'b']);
  history.move(1);
  history.record(version('d'));
  expect([history.current!.text, history.redoLabel, history.peek(-1)!.text]).toEqual(['d', null, 'b']);
});

test('a drag is one step, and so is the next one', () => {
  const history = new History<number>();
  history.record(version('start'));
  for (const text of ['1', '2', '3']) history.record(version(text), 'drag');
  for (const text of ['4', '5'] as const) history.record(version(text), 'another drag');
  expect(history.peek(-1)!.text).toBe('3');
  history.move(-1);
  expect(history.peek(-1)!.text).toBe('start');
});

test('a group never swallows the version that it started from', () => {
  const history = new History<number>();
  history.record(version('start'), 'drag');
  history.record(version('1'), 'drag');
  expect(history.peek(-1)!.text).toBe('start');
});

test('a change after undo in the same group does not take the place of what is shown', () => {
  const history = new History<number>();
  history.record(version('a'));
  history.record(version('b'), 'slider');
  history.move(-1);
  history.record(version('c'), 'slider');
  expect(history.peek(-1)!.text).toBe('a');
});

test('the same text again is no step', () => {
  const history = new History<number>();
  history.record(version('a'));
  history.record(version('a'));
  expect(history.undoLabel).toBe(null);
});

test('what is being written stays with the version that is left, until it is shown again', () => {
  const history = new History<number>();
  history.keepDraft('too early');
  history.record(version('a'));
  history.keepDraft('a, broken');
  history.record({ base: 2, text: 'b', label: 'open b' });
  expect(history.takeDraft()).toBe(null);
  history.move(-1);
  expect([history.current!.text, history.takeDraft()]).toEqual(['a', 'a, broken']);
  // It is in a person's hands now, who may drop it.
  history.keepDraft(null);
  history.move(1);
  history.move(-1);
  expect(history.takeDraft()).toBe(null);
});

test('memory is bounded, and the newest version always stays', () => {
  const history = new History<number>();
  for (let count = 0; count < 10; count++) history.record(version(`${count}`.padStart(20e6)));
  let steps = 0;
  while (history.undoLabel !== null) {
    history.move(-1);
    steps++;
  }
  expect(steps).toBeLessThan(4);
  history.record(version('x'.repeat(70e6)));
  expect(history.current!.text.length).toBe(70e6);
});
