//! Why a pixel has the colour it has.
//!
//! ```text
//! render::trace_pixel ─▶ PixelTrace ─┬─▶ Explanation   with names, angles, bounds: the JSON form, and text
//!  (the engine, recorded)            ├─▶ Path          camera → glass(refract) → green, of every contribution
//!                                    ├─▶ sentence      what a person would say first
//!                                    └─▶ Channels        what the camera's rays met, pixel by pixel
//! ```
//!
//! Nothing here traces a ray or knows physics that the engine does not have: it names and adds up what was recorded.

mod angles;
mod black;
mod bound;
mod channels;
mod document;
mod path;
mod sentence;
mod survey;
pub mod text;
mod view;

pub use black::black_picture;
pub use channels::{Channels, channels, hits};
pub use document::{
    Ending, ExplainedHit, ExplainedLight, ExplainedNode, ExplainedSample, Explanation, LocalLight, NodeKind, explain,
};
pub use path::{How, Leg, Path, PathError, SKY};
pub use sentence::{color_name, percent};
pub use survey::{Layers, Sightings, by_path, find, layers, only};
pub use view::ViewScene;

use crate::scene::Scene;
use crate::world::World;

/// The names of a scene, which its world does not keep.
#[derive(Clone, Copy, Debug)]
pub struct Names<'a> {
    /// The world.
    pub world: &'a World,
    /// The scene that it was made of.
    pub scene: &'a Scene,
}

/// What the space between the objects is called.
pub const OUTSIDE: &str = "outside";

impl<'a> Names<'a> {
    /// The object that a primitive belongs to.
    pub fn object(&self, primitive: u32) -> &'a str {
        self.world.object_of(primitive).map_or("?", |object| object.name.as_str())
    }

    /// A light, by its number in the scene.
    pub fn light(&self, number: usize) -> String {
        let name = self.scene.lights.get(number).and_then(|light| light.name.clone());
        name.unwrap_or_else(|| format!("light {}", number + 1))
    }

    /// A material, by its number in the scene.
    pub fn material(&self, number: u32) -> &'a str {
        self.scene.materials.get_index(number as usize).map_or("?", |(name, _)| name.as_str())
    }

    /// The medium of a solid, by its number: the object, or the material that interfaces speak of.
    pub fn medium(&self, solid: Option<u32>) -> &'a str {
        let solid = solid.and_then(|solid| self.world.solids.get(solid as usize));
        solid.map_or(OUTSIDE, |solid| match solid.between_faces_of {
            Some(material) => self.material(material),
            None => self.object(solid.primitive),
        })
    }
}
