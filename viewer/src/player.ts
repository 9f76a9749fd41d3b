/** Steps through the recursion: generation by generation, the rays appear and the colour builds up from what they add. */

import { cssColor } from './color';
import type { Transfer } from './data';
import { element, namedButton, swatch } from './dom';
import type { TreeModel } from './model';
import { percent } from './words';

/** Milliseconds for each generation, at the usual speed. */
const STEP = 1200;
const SPEEDS = [0.5, 1, 2, 4];
const [PLAY, PAUSE] = ['▶\uFE0E', '❚❚'];

export class Player {
  readonly root = element('div', { class: 'player', role: 'group', 'aria-label': 'Generations of rays' });
  private at: number;
  private timer: ReturnType<typeof setInterval> | undefined;
  private readonly slider = element('input', { type: 'range', min: 0, step: 1, 'aria-label': 'Generation' });
  private readonly speed = element('select', { 'aria-label': 'Speed' });
  private readonly play = namedButton('Play', PLAY, () => (this.timer === undefined ? this.start() : this.stop()));
  private readonly text = element('span', { 'aria-live': 'polite' });
  private readonly soFar = swatch('');

  /** `show` is told the generation up to which rays are shown. */
  constructor(
    private readonly model: TreeModel,
    private readonly transfer: Transfer,
    private readonly show: (generation: number) => void,
  ) {
    this.at = model.last;
    // One ray has no story.
    this.root.hidden = model.last === 0;
    this.slider.max = String(model.last);
    this.slider.addEventListener('input', () => {
      this.stop();
      this.go(Number(this.slider.value));
    });
    for (const speed of SPEEDS) this.speed.append(element('option', { value: speed }, `${speed}×`));
    this.speed.value = '1';
    this.speed.addEventListener('change', () => this.timer !== undefined && this.start());
    const step = (name: string, label: string, by: number) =>
      namedButton(name, label, () => {
        this.stop();
        this.go(this.at + by);
      });
    const moving = window.matchMedia('(prefers-reduced-motion: reduce)').matches ? [] : [this.play, this.speed];
    const whole = swatch(cssColor(model.colorUntil(model.last), transfer));
    this.soFar.title = 'Colour so far';
    whole.title = 'Colour in the end';
    this.root.append(
      step('Generation before', '‹', -1),
      ...moving.slice(0, 1),
      step('Next generation', '›', 1),
      this.slider,
      ...moving.slice(1),
      element('p', {}, this.text, this.soFar, 'of', whole),
    );
    this.describe();
  }

  get generation(): number {
    return this.at;
  }

  /** Within what there is. */
  go(generation: number): void {
    const at = Math.min(this.model.last, Math.max(0, generation));
    if (at === this.at) return;
    this.at = at;
    this.describe();
    this.show(at);
  }

  stop(): void {
    clearInterval(this.timer);
    this.timer = undefined;
    this.label('Play', PLAY);
  }

  private start(): void {
    clearInterval(this.timer);
    if (this.at === this.model.last) this.go(0);
    this.timer = setInterval(() => {
      this.go(this.at + 1);
      if (this.at === this.model.last) this.stop();
    }, STEP / Number(this.speed.value));
    this.label('Pause', PAUSE);
  }

  private label(name: string, label: string): void {
    this.play.textContent = label;
    this.play.title = name;
    this.play.setAttribute('aria-label', name);
  }

  private describe(): void {
    const { model, at } = this;
    const rays = model.countUntil(at);
    const color = model.colorUntil(at);
    const sum = (values: number[]) => values.reduce((a, b) => a + b, 0);
    const whole = sum(model.colorUntil(model.last));
    const share = whole > 0 ? `, ${percent(Math.min(1, sum(color) / whole))}` : '';
    const text = `Generation ${at} of ${model.last}: ${rays} ${rays === 1 ? 'ray' : 'rays'}${share}`;
    this.text.textContent = text;
    this.slider.value = String(at);
    this.slider.setAttribute('aria-valuetext', text);
    this.soFar.style.background = cssColor(color, this.transfer);
  }
}
