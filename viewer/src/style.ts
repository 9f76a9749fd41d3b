/** A shadow root in which the style of the page and that of the viewer do not meet. */

import frameStyle from './style/frame.css?inline';
import panelStyle from './style/panel.css?inline';

export function styled(host: HTMLElement): ShadowRoot {
  const root = host.attachShadow({ mode: 'open' });
  const sheet = new CSSStyleSheet();
  sheet.replaceSync(panelStyle + frameStyle);
  root.adoptedStyleSheets = [sheet];
  return root;
}
