/** What the page in a notebook's cell and the widget around it know of each other. */

import type { Work } from '../storage';

/** In the window of the page, as `snellHost`, before its script runs. */
export interface NotebookHost {
  /** Address of the engine's module. */
  module: string;
  /** What is shown first. */
  scene: Work;
  /** The scene has changed. */
  changed(work: Work): void;
  /** The picture is finished. */
  finished(picture: HTMLCanvasElement): void;
  /** Calls back with the colours of the notebook, now and whenever they change. */
  onTheme(act: (theme: 'auto' | 'light' | 'dark') => void): void;
}

declare global {
  interface Window {
    snellHost?: NotebookHost;
  }
}
