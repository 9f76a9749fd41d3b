//! The scene as a person writes it: plain data, with the names of the scene files.
//!
//! [`Scene`] is what files, Python and the browser describe; [`validate`] finds what is wrong with it and where;
//! [`World`](crate::world::World) is its compiled form.

mod camera;
mod generated;
mod light;
mod material;
mod problem;
mod render;
mod shape;
mod sky;
mod table;
mod texture;
mod transform;
mod validate;
mod warning;

use crate::settings::Settings;
pub use crate::settings::{Integrator, Shadows};
pub use camera::Camera;
pub use generated::{Cuboid, Disc, Lathe, Plane};
pub use light::Light;
pub use material::Material;
pub use problem::{Problem, Problems, Remedy, Step};
pub use render::{BANDS, MIN_THROUGHPUT, Render};
pub use shape::{Mesh, OpenMesh, Sphere};
pub use sky::Sky;
pub use texture::Texture;
pub use transform::Transform;
pub(crate) use transform::whole_map;
pub use validate::{LARGEST_NUMBER, MAX_BANDS, MAX_DEPTH, MAX_SPP, is_unprintable, validate};
pub use warning::{Warning, WarningCode};

pub use crate::film::transfer::{Rounding, Transfer};

use crate::color::Rgb;
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};

/// The version of the scene format that this library reads and writes.
pub const SCHEMA_VERSION: u32 = 1;

/// Everything that a picture depends on.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Scene {
    /// Version of this format: 1.
    pub snell: u32,
    /// Where the JSON Schema lies, for editors; ignored.
    #[serde(default, rename = "$schema", skip_serializing_if = "Option::is_none")]
    pub schema: Option<String>,
    /// Light that comes from everywhere alike.
    #[serde(default)]
    pub ambient: Rgb,
    /// `whitted`: light that comes from where nothing is hit.
    #[serde(default, skip_serializing_if = "is_black")]
    pub background: Rgb,
    /// `whitted`: light that depends on the direction, instead of `background`.
    #[serde(default, skip_serializing_if = "Option::is_none", deserialize_with = "table::maybe")]
    pub sky: Option<Sky>,
    /// Index of refraction of the space between the objects.
    #[serde(default = "one")]
    pub eta_outside: f64,
    /// How the picture is made.
    #[serde(deserialize_with = "table::one")]
    pub render: Render,
    /// Where it is seen from.
    #[serde(deserialize_with = "table::one")]
    pub camera: Camera,
    /// Where light comes from.
    #[serde(default, rename = "light", skip_serializing_if = "Vec::is_empty", deserialize_with = "table::many")]
    pub lights: Vec<Light>,
    /// What things are made of, by name.
    #[serde(
        default,
        rename = "material",
        skip_serializing_if = "IndexMap::is_empty",
        deserialize_with = "table::by_name"
    )]
    pub materials: IndexMap<String, Material>,
    /// Patterns on surfaces, by name.
    #[serde(
        default,
        rename = "texture",
        skip_serializing_if = "IndexMap::is_empty",
        deserialize_with = "table::by_name"
    )]
    pub textures: IndexMap<String, Texture>,
    /// Spheres.
    #[serde(default, rename = "sphere", skip_serializing_if = "Vec::is_empty", deserialize_with = "table::many")]
    pub spheres: Vec<Sphere>,
    /// Triangle meshes.
    #[serde(default, rename = "mesh", skip_serializing_if = "Vec::is_empty", deserialize_with = "table::many")]
    pub meshes: Vec<Mesh>,
    /// Rectangles.
    #[serde(default, rename = "plane", skip_serializing_if = "Vec::is_empty", deserialize_with = "table::many")]
    pub planes: Vec<Plane>,
    /// Boxes.
    #[serde(default, rename = "box", skip_serializing_if = "Vec::is_empty", deserialize_with = "table::many")]
    pub boxes: Vec<Cuboid>,
    /// Discs.
    #[serde(default, rename = "disc", skip_serializing_if = "Vec::is_empty", deserialize_with = "table::many")]
    pub discs: Vec<Disc>,
    /// What turns around an axis.
    #[serde(default, rename = "lathe", skip_serializing_if = "Vec::is_empty", deserialize_with = "table::many")]
    pub lathes: Vec<Lathe>,
}

/// The settings that a scene asks for.
impl From<&Scene> for Settings {
    fn from(scene: &Scene) -> Self {
        let render = &scene.render;
        Self {
            integrator: render.integrator,
            max_depth: render.max_depth,
            shadows: render.shadows(),
            spp: render.spp,
            seed: render.seed,
            min_throughput: render.min_throughput,
        }
    }
}

impl Scene {
    /// A scene of which only this is given: nothing in it, and no light.
    pub fn new(render: Render, camera: Camera) -> Self {
        Self {
            snell: SCHEMA_VERSION,
            schema: None,
            ambient: Rgb::default(),
            background: Rgb::default(),
            sky: None,
            eta_outside: 1.0,
            render,
            camera,
            lights: Vec::new(),
            materials: IndexMap::new(),
            textures: IndexMap::new(),
            spheres: Vec::new(),
            meshes: Vec::new(),
            planes: Vec::new(),
            boxes: Vec::new(),
            discs: Vec::new(),
            lathes: Vec::new(),
        }
    }

    /// Gives the picture another size. Where that is of another shape, the camera's bounds are widened to keep pixels square,
    /// and come back.
    pub fn resize(&mut self, size: [u32; 2]) -> Option<[f64; 4]> {
        let before = std::mem::replace(&mut self.render.size, size);
        let bounds = self.camera.bounds.as_mut()?;
        *bounds = camera::widened(*bounds, before, size)?;
        Some(*bounds)
    }
}

fn is_black(color: &Rgb) -> bool {
    *color == Rgb::gray(0.0)
}

pub(crate) fn one() -> f64 {
    1.0
}
