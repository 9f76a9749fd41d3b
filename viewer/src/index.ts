/** The public face of the viewer; see the README. */

export type * from './data';
export { mount, type SelectListener, type Viewer, type ViewerOptions } from './viewer';
export { validate, ViewerDataError } from './validate';
