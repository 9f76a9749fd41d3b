/** Snell view, version 1. Made of docs/view.schema.json by `npm run types`: change the types in Rust instead. */

/**
 * What can be seen of a scene. Lengths are in scene units, colours linear.
 */
export interface ViewScene {
  camera: ViewCamera;
  lights: ViewLight[];
  meshes: ViewMesh[];
  /**
   * The version of this form.
   */
  snell_view: 1;
  spheres: ViewSphere[];
  /**
   * The curve by which colours are shown.
   */
  transfer: 'linear' | 'srgb';
}
export interface ViewCamera {
  /**
   * Of the image plane: left bottom, right bottom, left top, right top.
   *
   * @minItems 4
   * @maxItems 4
   */
  corners: [[number, number, number], [number, number, number], [number, number, number], [number, number, number]];
  /**
   * @minItems 3
   * @maxItems 3
   */
  eye: [number, number, number];
  /**
   * @minItems 3
   * @maxItems 3
   */
  up: [number, number, number];
}
export interface ViewLight {
  /**
   * @minItems 3
   * @maxItems 3
   */
  color: [number, number, number];
  /**
   * Or, if it is infinitely far away, the direction towards it.
   *
   * @minItems 3
   * @maxItems 3
   */
  direction: [number, number, number] | null;
  name: string;
  /**
   * Where it stands.
   *
   * @minItems 3
   * @maxItems 3
   */
  position: [number, number, number] | null;
}
export interface ViewMesh {
  /**
   * @minItems 3
   * @maxItems 3
   */
  color: [number, number, number];
  /**
   * Three vertices for each face.
   */
  faces: number[];
  name: string;
  /**
   * From 0 to 1.
   */
  opacity: number;
  /**
   * x, y, z of one vertex after the other.
   */
  vertices: number[];
}
export interface ViewSphere {
  /**
   * @minItems 3
   * @maxItems 3
   */
  center: [number, number, number];
  /**
   * @minItems 3
   * @maxItems 3
   */
  color: [number, number, number];
  name: string;
  /**
   * From 0 to 1.
   */
  opacity: number;
  radius: number;
}
