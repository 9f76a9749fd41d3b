/** The public face of the viewer; see the README. */

export type * from './data';
export type { Change, Editing, Handles, Movement, ObjectRef } from './editing';
export { hideStillBefore, jupyterScheme, onJupyterTheme } from './jupyter';
export { TreePanel } from './tree-panel';
export { mount, type Viewer, type ViewerEvents, type ViewerOptions } from './viewer';
export { validate, ViewerDataError } from './validate';
export { widget, type WidgetMessage, type WidgetModel, type WidgetTraits } from './widget';
