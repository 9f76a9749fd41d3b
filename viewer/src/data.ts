/**
 * What the viewer is given. Snell writes it; nothing of it is computed again here.
 * Lengths are in scene units, angles in degrees, wavelengths in nm, colours linear.
 */

export type Vec3 = [number, number, number];
export type Color = [number, number, number];

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

/** All rays of one pixel, with what each of them adds to it. */
export interface RayTreeDocument {
  /** Version of the format. */
  snell_ray_tree: 1;
  /** Name of the scene. */
  scene: string;
  integrator: string;
  /** Column and row, counted from the left and from the top. */
  pixel: [number, number];
  size: [number, number];
  /** The pixel, the mean of its samples. */
  color: Color;
  /** How the picture is written: with the curve of sRGB, or as it is. */
  transfer: Transfer;
  /** Samples per pixel. */
  spp: number;
  /** The explanation in one sentence. */
  sentence: string;
  samples: Sample[];
}

export type Transfer = 'srgb' | 'linear';

/** One ray through the pixel, and everything that follows from it. */
export interface Sample {
  color: Color;
  /** Throughput of the rays that were not followed. */
  lost: Color;
  /** `nodes[id].id` is `id`; parents come before their children. */
  nodes: RayNode[];
}

/** `inside` travels within a solid. */
export type RayKind = 'camera' | 'mirror' | 'refracted' | 'inside';

/** Why a branch has no rays below it: why its last ray has no children. */
export type Ending = 'missed' | 'depth' | 'threshold' | 'absorbed' | 'rays';

/** One ray. */
export interface RayNode {
  id: number;
  parent: number | null;
  depth: number;
  kind: RayKind;
  origin: Vec3;
  /** Of unit length. */
  dir: Vec3;
  /** What it travels through, and the refractive index of that. */
  medium: string;
  eta: number;
  /** Wavelength, if dispersion has split the light. */
  band_nm: number | null;
  /** What it can add to the sample for each unit of radiance. */
  throughput: Color;
  /** `null` if it met nothing, or was not followed. */
  hit: Hit | null;
  local: LocalLight | null;
  /** What its end adds to the sample, weighted by the throughput. */
  contribution: Color;
  /** The contribution of this ray and of all rays below it. */
  subtotal: Color;
  ended: Ending | null;
  /** The most that an ended branch could still have added. */
  bound: Color | null;
}

/** Where a ray ends. */
export interface Hit {
  object: string;
  primitive: number;
  /** Distance from the origin of the ray. */
  t: number;
  point: Vec3;
  /** Of unit length, towards the side that the ray comes from. */
  normal: Vec3;
  /** To the normal, before the surface. */
  angle_in: number;
  /** To the normal, behind the surface; `null` if nothing goes through. */
  angle_out: number | null;
  eta_before: number;
  eta_behind: number;
  total_reflection: boolean;
  material: string;
}

/** The light that a surface itself sends along the ray. */
export interface LocalLight {
  ambient: Color;
  emission: Color;
  lights: LightAtHit[];
}

/** One light, seen from where a ray ends. */
export interface LightAtHit {
  name: string;
  /** Does the surface face it? */
  facing: boolean;
  /** How much of it comes through. */
  transmittance: Color;
  blocked_by: string | null;
  block_point: Vec3 | null;
  diffuse: Color;
  highlight: Color;
  /** Where the light is, or the direction towards it if it is infinitely far away. */
  point: Vec3;
  at_infinity: boolean;
}

/** What can be seen of a scene. */
export interface ViewScene {
  /** Version of the format. */
  snell_view: 1;
  spheres: ViewSphere[];
  meshes: ViewMesh[];
  camera: ViewCamera;
  lights: ViewLight[];
  /** How pictures of the scene are written; without it, as the tree says, or with the curve of sRGB. */
  transfer?: Transfer;
}

export interface ViewSphere {
  name: string;
  center: Vec3;
  radius: number;
  color: Color;
  /** From 0 to 1. */
  opacity: number;
}

export interface ViewMesh {
  name: string;
  /** x, y, z of each vertex. */
  vertices: number[];
  /** Three numbers of vertices for each triangle. */
  faces: number[];
  color: Color;
  /** From 0 to 1. */
  opacity: number;
}

export interface ViewCamera {
  eye: Vec3;
  /** Of the image plane: left bottom, right bottom, left top, right top. */
  corners: [Vec3, Vec3, Vec3, Vec3];
  up: Vec3;
}

/** A point light has a position, one at infinity a direction towards it. */
export interface ViewLight {
  name: string;
  position: Vec3 | null;
  direction: Vec3 | null;
  color: Color;
}
