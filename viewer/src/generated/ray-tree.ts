/** Snell ray tree, version 1. Made of docs/ray-tree.schema.json by `npm run types`: change the types in Rust instead. */

/**
 * Why nothing follows.
 */
export type Ending = 'missed' | 'depth' | 'threshold' | 'rays' | 'absorbed';

/**
 * Why a pixel has the colour it has.
 */
export interface RayTreeDocument {
  /**
   * The pixel, as in the film.
   *
   * @minItems 3
   * @maxItems 3
   */
  color: [number, number, number];
  /**
   * The model of light.
   */
  integrator: 'lecture' | 'course2018' | 'course2020' | 'whitted';
  /**
   * Column and row, from the top left.
   *
   * @minItems 2
   * @maxItems 2
   */
  pixel: [number, number];
  /**
   * The samples, in the order of addition.
   */
  samples: ExplainedSample[];
  /**
   * The name of the scene.
   */
  scene: string;
  /**
   * What a person would say first.
   */
  sentence: string;
  /**
   * Width and height of the picture.
   *
   * @minItems 2
   * @maxItems 2
   */
  size: [number, number];
  /**
   * The version of this form.
   */
  snell_ray_tree: 1;
  /**
   * Samples of the pixel.
   */
  spp: number;
  /**
   * The curve by which it is shown.
   */
  transfer: 'linear' | 'srgb';
}
/**
 * One sample: contributions add up to its colour in the order of the nodes, and samples to the pixel times `spp`.
 */
export interface ExplainedSample {
  /**
   * Its sum.
   *
   * @minItems 3
   * @maxItems 3
   */
  color: [number, number, number];
  /**
   * The throughput of the rays that were not followed.
   *
   * @minItems 3
   * @maxItems 3
   */
  lost: [number, number, number];
  /**
   * The rays; parents come before their children.
   */
  nodes: ExplainedNode[];
}
/**
 * One ray.
 */
export interface ExplainedNode {
  /**
   * The wavelength, if dispersion has split it.
   */
  band_nm: number | null;
  /**
   * The most that it could still have added within ten more levels, if it was not followed.
   *
   * @minItems 3
   * @maxItems 3
   */
  bound: [number, number, number] | null;
  /**
   * What its end adds to the sample.
   *
   * @minItems 3
   * @maxItems 3
   */
  contribution: [number, number, number];
  /**
   * Bounces behind it.
   */
  depth: number;
  /**
   * Where it goes, of unit length.
   *
   * @minItems 3
   * @maxItems 3
   */
  dir: [number, number, number];
  /**
   * Why nothing follows; `None` if something does.
   */
  ended: Ending | null;
  /**
   * The index of refraction there.
   */
  eta: number;
  /**
   * What it met.
   */
  hit: ExplainedHit | null;
  /**
   * Its place in the list.
   */
  id: number;
  /**
   * What kind of ray.
   */
  kind: 'camera' | 'mirror' | 'refracted' | 'inside';
  /**
   * The light that the surface itself sends along it.
   */
  local: LocalLight | null;
  /**
   * The object that it is in, or `outside`.
   */
  medium: string;
  /**
   * Where it starts.
   *
   * @minItems 3
   * @maxItems 3
   */
  origin: [number, number, number];
  /**
   * That of the ray before it.
   */
  parent: number | null;
  /**
   * The same with everything below it.
   *
   * @minItems 3
   * @maxItems 3
   */
  subtotal: [number, number, number];
  /**
   * What it can add to the sample for each unit of radiance, where it starts.
   *
   * @minItems 3
   * @maxItems 3
   */
  throughput: [number, number, number];
}
/**
 * What a ray met.
 */
export interface ExplainedHit {
  /**
   * Angle to the normal before the surface.
   */
  angle_in: number;
  /**
   * Behind it, if anything goes through.
   */
  angle_out: number | null;
  /**
   * The index before the surface.
   */
  eta_before: number;
  /**
   * And behind.
   */
  eta_behind: number;
  /**
   * The material.
   */
  material: string;
  /**
   * Of unit length, towards the ray.
   *
   * @minItems 3
   * @maxItems 3
   */
  normal: [number, number, number];
  /**
   * The object.
   */
  object: string;
  /**
   * Where.
   *
   * @minItems 3
   * @maxItems 3
   */
  point: [number, number, number];
  /**
   * The number of the primitive.
   */
  primitive: number;
  /**
   * How far away.
   */
  t: number;
  /**
   * The ray's throughput where it arrives: a medium may have absorbed some.
   *
   * @minItems 3
   * @maxItems 3
   */
  throughput: [number, number, number];
  /**
   * Does it all come back?
   */
  total_reflection: boolean;
}
/**
 * The light that a surface itself sends out, before opacity and throughput weigh it.
 */
export interface LocalLight {
  /**
   * Of the light from everywhere.
   *
   * @minItems 3
   * @maxItems 3
   */
  ambient: [number, number, number];
  /**
   * Of its own.
   *
   * @minItems 3
   * @maxItems 3
   */
  emission: [number, number, number];
  /**
   * Of each light.
   */
  lights: LightAtHit[];
}
/**
 * What a light does there.
 */
export interface LightAtHit {
  /**
   * Which of the two.
   */
  at_infinity: boolean;
  /**
   * Where.
   *
   * @minItems 3
   * @maxItems 3
   */
  block_point: [number, number, number] | null;
  /**
   * What stands in its way, if nothing arrives.
   */
  blocked_by: string | null;
  /**
   * What it adds.
   *
   * @minItems 3
   * @maxItems 3
   */
  diffuse: [number, number, number];
  /**
   * Does the surface face it?
   */
  facing: boolean;
  /**
   * And in its highlight.
   *
   * @minItems 3
   * @maxItems 3
   */
  highlight: [number, number, number];
  /**
   * The light.
   */
  name: string;
  /**
   * Where it stands, or the direction towards it.
   *
   * @minItems 3
   * @maxItems 3
   */
  point: [number, number, number];
  /**
   * What it shines through.
   */
  through: string[];
  /**
   * What of it arrives.
   *
   * @minItems 3
   * @maxItems 3
   */
  transmittance: [number, number, number];
}
