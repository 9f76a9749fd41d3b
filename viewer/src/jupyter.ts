/** What the viewer knows of the page of JupyterLab and Notebook 7 around it. */

import type { Scheme } from './theme';

const WIDGET = '[class*="jupyter-widgets"], [data-mime-type*="widget-view"]';

/** JupyterLab has a theme of its own, whatever the browser asks for. */
export function jupyterScheme(): Scheme {
  const light = document.body.dataset.jpThemeLight;
  return light === undefined ? 'auto' : light === 'false' ? 'dark' : 'light';
}

/** Calls back whenever the theme changes. Returns what ends that. */
export function onJupyterTheme(act: () => void): () => void {
  const changes = new MutationObserver(act);
  changes.observe(document.body, { attributes: true, attributeFilter: ['data-jp-theme-light'] });
  return () => changes.disconnect();
}

/**
 * The still picture of a widget is the output just before it, for when the notebook is read where no widget lives.
 * Here one lives, so that output is hidden. Returns what shows it again. Elsewhere than in Jupyter nothing is done.
 */
export function hideStillBefore(el: HTMLElement): () => void {
  let restore = () => {};
  const hide = () => {
    restore();
    const still = el.closest('.jp-OutputArea-child')?.previousElementSibling;
    if (!(still instanceof HTMLElement) || still.querySelector('img') === null || still.querySelector(WIDGET) !== null) return;
    const { display } = still.style;
    still.style.display = 'none';
    restore = () => {
      still.style.display = display;
      restore = () => {};
    };
  };
  // Outputs come and go: the still picture is shown anew whenever it changes.
  const changes = new MutationObserver(hide);
  // The first call may come before the widget is in the page; a size means that it is.
  const sizes = new ResizeObserver(() => {
    const area = el.closest('.jp-OutputArea');
    if (area === null) return;
    sizes.disconnect();
    changes.observe(area, { childList: true, subtree: true });
    hide();
  });
  sizes.observe(el);
  return () => {
    sizes.disconnect();
    changes.disconnect();
    restore();
  };
}
