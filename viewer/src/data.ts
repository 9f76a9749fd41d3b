/**
 * What the viewer is given. Snell writes it; nothing of it is computed again here.
 * Lengths are in scene units, angles in degrees, wavelengths in nm, colours linear.
 */

import type { ExplainedNode, RayTreeDocument } from './generated/ray-tree';
import type { ViewMesh as GeneratedMesh, ViewScene as GeneratedScene } from './generated/view';

export type {
  Ending,
  ExplainedHit as Hit,
  LightAtHit,
  ExplainedNode as RayNode,
  ExplainedSample as Sample,
  LocalLight,
  RayTreeDocument,
} from './generated/ray-tree';
export type { ViewCamera, ViewLight, ViewSphere } from './generated/view';

/** Its lists are long, and may be typed arrays. Nobody changes a list in place: one that is given again is not looked at again. */
export interface ViewMesh extends Omit<GeneratedMesh, 'vertices' | 'faces'> {
  vertices: Numbers;
  faces: Numbers;
}

export interface ViewScene extends Omit<GeneratedScene, 'meshes'> {
  meshes: ViewMesh[];
}

export type RayKind = ExplainedNode['kind'];
export type Transfer = RayTreeDocument['transfer'];
export type Vec3 = [number, number, number];
export type Color = [number, number, number];
export type Numbers = number[] | Float32Array | Float64Array | Uint32Array;

/** Everything that is shown. */
export interface ViewerData {
  scene: ViewScene;
  /** `null` or nothing: the scene alone. */
  tree?: RayTreeDocument | null;
  /** What stands above the scene while there is no tree. */
  title?: string;
  /** A PNG of what the camera sees, shown on its image plane. */
  picture?: BufferSource | null;
}
