/** Snell scene, version 1. Made of docs/scene.schema.json by `npm run types`: change the types in Rust instead. */

/**
 * One step of a placement.
 */
export type Transform =
  | {
      rotate: {
        /**
         * Direction of the axis, of any length but 0.
         *
         * @minItems 3
         * @maxItems 3
         */
        axis: [number, number, number];
        /**
         * Angle in degrees.
         */
        degrees: number;
      };
    }
  | {
      /**
       * @minItems 3
       * @maxItems 3
       */
      scale: [number, number, number];
    }
  | {
      /**
       * @minItems 3
       * @maxItems 3
       */
      move: [number, number, number];
    };
/**
 * Linear colour, 1 for white: one number for gray, or red, green, blue.
 */
export type Rgb = number | [number, number, number];
/**
 * What to do with a transparent mesh that has no inside.
 */
export type OpenMesh = 'fill' | 'opaque';
/**
 * What stands between a surface and a light.
 */
export type Shadows = 'off' | 'opaque' | 'tinted' | 'caustic';

/**
 * Everything that a picture depends on.
 */
export interface SceneDocument {
  /**
   * Where the JSON Schema lies, for editors; ignored.
   */
  $schema?: string | null;
  /**
   * Light that comes from everywhere alike.
   */
  ambient?: number | [number, number, number];
  /**
   * `whitted`: light that comes from where nothing is hit.
   */
  background?: number | [number, number, number];
  /**
   * Boxes.
   */
  box?: Cuboid[];
  camera: Camera;
  /**
   * Discs.
   */
  disc?: Disc[];
  /**
   * Index of refraction of the space between the objects.
   */
  eta_outside?: number;
  /**
   * What turns around an axis.
   */
  lathe?: Lathe[];
  /**
   * Where light comes from.
   */
  light?: Light[];
  /**
   * What things are made of, by name.
   */
  material?: {
    [k: string]: Material;
  };
  /**
   * Triangle meshes.
   */
  mesh?: Mesh[];
  /**
   * Rectangles.
   */
  plane?: Plane[];
  render: Render;
  /**
   * `whitted`: light that depends on the direction, instead of `background`.
   */
  sky?: Sky | null;
  /**
   * Version of this format: 1.
   */
  snell: number;
  /**
   * Spheres.
   */
  sphere?: Sphere[];
  /**
   * Patterns on surfaces, by name.
   */
  texture?: {
    [k: string]: Texture;
  };
}
/**
 * A box between two corners.
 */
export interface Cuboid {
  /**
   * Places where it stands, as for meshes.
   */
  instances?: Transform[][];
  /**
   * Name of its material.
   */
  material: string;
  /**
   * The corner of the largest coordinates.
   *
   * @minItems 3
   * @maxItems 3
   */
  max: [number, number, number];
  /**
   * The corner of the smallest coordinates.
   *
   * @minItems 3
   * @maxItems 3
   */
  min: [number, number, number];
  /**
   * Its name, for messages and explanations.
   */
  name?: string | null;
  /**
   * Steps that put it in its place, one after the other.
   */
  transform?: Transform[];
}
/**
 * Where it is seen from.
 */
export interface Camera {
  /**
   * Left, right, bottom and top edge of the picture on the image plane. Give this or `fov`.
   *
   * @minItems 4
   * @maxItems 4
   */
  bounds?: [number, number, number, number] | null;
  /**
   * Where the eye is.
   *
   * @minItems 3
   * @maxItems 3
   */
  eye: [number, number, number];
  /**
   * Read and ignored, as in the lecture.
   */
  far?: number | null;
  /**
   * Instead of `bounds`: the angle in degrees between the highest and the lowest row of pixels, which are square then.
   */
  fov?: number | null;
  /**
   * A point that it looks at.
   *
   * @minItems 3
   * @maxItems 3
   */
  look_at: [number, number, number];
  /**
   * Position of the image plane along `W`: negative, in front of the eye. Needed with `bounds`; with `fov` a tenth of the way
   * from `eye` to `look_at` if left out.
   */
  near?: number | null;
  /**
   * A direction that is up in the picture.
   *
   * @minItems 3
   * @maxItems 3
   */
  up: [number, number, number];
}
/**
 * A disc, or with a `transform` that stretches it an ellipse.
 */
export interface Disc {
  /**
   * Its middle.
   *
   * @minItems 3
   * @maxItems 3
   */
  center?: [number, number, number];
  /**
   * `whitted`: the material of what is behind it, as for meshes.
   */
  inside?: string | null;
  /**
   * Places where it stands, as for meshes.
   */
  instances?: Transform[][];
  /**
   * Name of its material.
   */
  material: string;
  /**
   * Its name, for messages and explanations.
   */
  name?: string | null;
  /**
   * Where its front looks, of any length.
   *
   * @minItems 3
   * @maxItems 3
   */
  normal?: [number, number, number];
  /**
   * `whitted`: with `inside`, the material of what it looks at.
   */
  outside?: string | null;
  /**
   * Its radius, above 0.
   */
  radius: number;
  /**
   * Steps that put it in its place, one after the other.
   */
  transform?: Transform[];
}
/**
 * What turns around the y axis: bottles, lenses, bowls.
 */
export interface Lathe {
  /**
   * `whitted`: the material of what is behind it, as for meshes.
   */
  inside?: string | null;
  /**
   * Places where it stands, as for meshes.
   */
  instances?: Transform[][];
  /**
   * Name of its material.
   */
  material: string;
  /**
   * Its name, for messages and explanations.
   */
  name?: string | null;
  /**
   * `whitted`: with `inside`, the material of what it looks at.
   */
  outside?: string | null;
  /**
   * Points `[radius, height]`. Along a profile that leads up, the outer side is away from the axis. It encloses something if it
   * starts and ends on the axis (radius 0), or ends where it starts.
   */
  profile: [number, number][];
  /**
   * Corners of a ring; left out: 64.
   */
  segments?: number;
  /**
   * Normals are smoothed over edges up to this angle in degrees; 0 is flat.
   */
  smooth_angle?: number;
  /**
   * Steps that put it in its place, one after the other.
   */
  transform?: Transform[];
}
/**
 * A light at a point, or at infinity in a direction. It does not fall off with distance. One with a `target` is a spot light.
 */
export interface Light {
  /**
   * Its intensity.
   */
  color: number | [number, number, number];
  /**
   * Angle in degrees between the middle of a spot light and its edge, above 0 and at most 180.
   */
  cone?: number | null;
  /**
   * The direction towards a light at infinity, of any length.
   *
   * @minItems 3
   * @maxItems 3
   */
  direction?: [number, number, number] | null;
  /**
   * Width in degrees of the soft edge of a spot light, within `cone`; left out: 0, a sharp edge.
   */
  edge?: number | null;
  /**
   * Its name, for messages and explanations.
   */
  name?: string | null;
  /**
   * Where it stands. Give this or `direction`.
   *
   * @minItems 3
   * @maxItems 3
   */
  position?: [number, number, number] | null;
  /**
   * A point that a spot light shines at; it needs `position` and `cone`.
   *
   * @minItems 3
   * @maxItems 3
   */
  target?: [number, number, number] | null;
}
/**
 * What a surface does with light. What is left out is 0, but `ko` 1 (opaque), `spow` 16 and `eta` 1.
 */
export interface Material {
  /**
   * `whitted`: the Abbe number of the glass whose index at the d line (587.56 nm) is `eta`; infinite for no dispersion.
   */
  abbe?: number | null;
  /**
   * `whitted`: the colour of white light after `attenuation_distance` inside.
   */
  attenuation_color?: Rgb | null;
  /**
   * `whitted`: at which thickness `attenuation_color` is seen, in scene units.
   */
  attenuation_distance?: number | null;
  /**
   * `whitted`: Cauchy's A, B and C instead of `eta`: the index at λ µm is A + B/λ² + C/λ⁴.
   *
   * @minItems 3
   * @maxItems 3
   */
  cauchy?: [number, number, number] | null;
  /**
   * Linear colour, 1 for white: one number for gray, or red, green, blue.
   */
  emission?: number | [number, number, number];
  /**
   * Index of refraction.
   */
  eta?: number;
  /**
   * Name of a glass of the catalogue, instead of `eta`: its index at the d line, and with `whitted` its colours.
   */
  glass?: string | null;
  /**
   * Linear colour, 1 for white: one number for gray, or red, green, blue.
   */
  ka?: number | [number, number, number];
  /**
   * Linear colour, 1 for white: one number for gray, or red, green, blue.
   */
  kd?: number | [number, number, number];
  /**
   * Linear colour, 1 for white: one number for gray, or red, green, blue.
   */
  ko?: number | [number, number, number];
  /**
   * Linear colour, 1 for white: one number for gray, or red, green, blue.
   */
  kr?: number | [number, number, number];
  /**
   * Linear colour, 1 for white: one number for gray, or red, green, blue.
   */
  ks?: number | [number, number, number];
  /**
   * `whitted`: where solids overlap, the one of the highest priority is there; among equals the one entered last.
   */
  priority?: number;
  /**
   * `whitted`: Sellmeier's pairs B, C instead of `eta`: the index squared at λ µm is 1 + Σ Bλ²/(λ² − C), C in µm².
   */
  sellmeier?: [number, number][] | null;
  /**
   * `whitted`: absorption per scene unit, instead of a colour at a distance.
   */
  sigma_a?: Rgb | null;
  /**
   * Exponent of the highlight.
   */
  spow?: number;
  /**
   * Name of a texture, by which `ka` and `kd` are multiplied, and with `whitted` `ko` and `emission` by its alpha.
   */
  texture?: string | null;
  /**
   * `whitted`: each face is a whole pane of this thickness in scene units, with both of its sides, so that the
   * mesh need not be closed.
   */
  thickness?: number | null;
  /**
   * `whitted`: transmitted light is multiplied by the diffuse colour `kd`. Older files call it `dyed`.
   */
  tinted_transmission?: boolean;
}
/**
 * A triangle mesh, from a file or written out.
 */
export interface Mesh {
  /**
   * Three numbers of vertices for each face, counted from 0, counter-clockwise seen from outside.
   */
  faces?: [number, number, number][];
  /**
   * The model file, relative to the scene file. Give this, or `vertices` and `faces`.
   */
  file?: string | null;
  /**
   * `whitted`: the material of what is behind its faces, which then are interfaces, and need not be closed.
   */
  inside?: string | null;
  /**
   * Places where the mesh stands, each a list of steps after those of `transform`; empty for once, where `transform` puts
   * it. However many places, its triangles are held once.
   */
  instances?: Transform[][];
  /**
   * Name of the material of all faces; left out: what the model file says.
   */
  material?: string | null;
  /**
   * Which material stands for which name in the model file, where `material` is left out.
   */
  materials?: {
    [k: string]: string;
  };
  /**
   * Its name, for messages and explanations.
   */
  name?: string | null;
  /**
   * `whitted`: what to do with a transparent mesh that is not closed; left out: it is refused.
   */
  open?: OpenMesh | null;
  /**
   * `whitted`: with `inside`, the material of what its faces look at; left out: the space between the objects.
   */
  outside?: string | null;
  /**
   * Normals are smoothed over edges up to this angle in degrees; 0 is flat.
   */
  smooth_angle?: number;
  /**
   * Steps that put the model in its place, one after the other.
   */
  transform?: Transform[];
  /**
   * Positions, if there is no file.
   */
  vertices?: [number, number, number][];
}
/**
 * A rectangle.
 */
export interface Plane {
  /**
   * Its middle.
   *
   * @minItems 3
   * @maxItems 3
   */
  center?: [number, number, number];
  /**
   * `whitted`: the material of what is behind it, as for meshes.
   */
  inside?: string | null;
  /**
   * Places where it stands, as for meshes.
   */
  instances?: Transform[][];
  /**
   * Name of its material.
   */
  material: string;
  /**
   * Its name, for messages and explanations.
   */
  name?: string | null;
  /**
   * Where its front looks, of any length.
   *
   * @minItems 3
   * @maxItems 3
   */
  normal?: [number, number, number];
  /**
   * `whitted`: with `inside`, the material of what it looks at.
   */
  outside?: string | null;
  /**
   * Width and height. Nothing is infinite here: errors are bounded by the size of the scene.
   *
   * @minItems 2
   * @maxItems 2
   */
  size: [number, number];
  /**
   * Steps that put it in its place, one after the other.
   */
  transform?: Transform[];
}
/**
 * How the picture is made.
 */
export interface Render {
  /**
   * `whitted`: into how many wavelengths a ray splits at its first dispersive face; 1 for no colours.
   */
  bands?: number;
  /**
   * The model of light. Always written: there is no silent default.
   */
  integrator: 'lecture' | 'course2018' | 'course2020' | 'whitted';
  /**
   * How many bounces may follow the camera ray.
   */
  max_depth?: number;
  /**
   * `whitted`: branches that carry less than this part of what they could, of white or of their band of light, are not
   * followed, and counted as lost light.
   */
  min_throughput?: number;
  /**
   * What happens to the fraction in 8 and 16 bit.
   */
  rounding?: 'round' | 'truncate';
  /**
   * Another number spreads the samples otherwise.
   */
  seed?: number;
  /**
   * What stands between a surface and a light; left out: `tinted` in `whitted`, `opaque` in the other models.
   */
  shadows?: Shadows | null;
  /**
   * Width and height in pixels.
   *
   * @minItems 2
   * @maxItems 2
   */
  size: [number, number];
  /**
   * Samples per pixel: 1 looks through the point of the grid, more are spread over half a step around it.
   */
  spp?: number;
  /**
   * The curve to 8 and 16 bit.
   */
  transfer?: 'linear' | 'srgb';
}
/**
 * A sky around the scene: a gradient from `horizon` to `zenith`, or a picture.
 */
export interface Sky {
  /**
   * By what the picture is multiplied.
   */
  brightness?: number;
  /**
   * The colour at the horizon. Give this or `image`.
   */
  horizon?: Rgb | null;
  /**
   * A picture of all directions by longitude and latitude, EXR or PNG, relative to the scene file; −z is in its middle.
   */
  image?: string | null;
  /**
   * The colour straight down; left out: that of the horizon.
   */
  nadir?: Rgb | null;
  /**
   * Degrees by which the picture is turned about the y axis, right-handed.
   */
  rotate?: number;
  /**
   * The colour straight up; between, it goes by the sine of the elevation. Left out: that of the horizon.
   */
  zenith?: Rgb | null;
}
/**
 * A sphere.
 */
export interface Sphere {
  /**
   * Centre.
   *
   * @minItems 3
   * @maxItems 3
   */
  center: [number, number, number];
  /**
   * Places where it stands, each a list of steps after those of `transform`; empty for once.
   */
  instances?: Transform[][];
  /**
   * Name of its material.
   */
  material: string;
  /**
   * Its name, for messages and explanations.
   */
  name?: string | null;
  /**
   * Radius; 0 is allowed and invisible.
   */
  radius: number;
  /**
   * Steps that put it in its place, one after the other; it must stay a sphere.
   */
  transform?: Transform[];
}
/**
 * A pattern on a surface: squares of two colours, or a picture.
 *
 * It lies on planes, discs and the sides of boxes once, on spheres by longitude and latitude, around what a lathe made, and on
 * meshes by the texture coordinates of the model.
 */
export interface Texture {
  /**
   * Two colours of squares. Give this or `image`.
   *
   * @minItems 2
   * @maxItems 2
   */
  checker?: [Rgb, Rgb] | null;
  /**
   * A picture, PNG, PPM or EXR, relative to the scene file. `whitted`: where its alpha is 0, the surface is not there.
   */
  image?: string | null;
  /**
   * Are the numbers of a PNG or PPM linear light, and not those of the sRGB curve?
   */
  linear?: boolean;
  /**
   * How many squares or pictures lie beside and above each other.
   *
   * @minItems 2
   * @maxItems 2
   */
  repeat?: [number, number];
}
