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
    Ending, ExplainedHit, ExplainedNode, ExplainedSample, Explanation, LightAtHit, LocalLight, NodeKind, explain,
};
pub use path::{How, Leg, Path, PathError, SKY};
pub use sentence::{color_name, percent};
pub use survey::{Layers, Sightings, by_path, find, layers, only};
pub use view::{ViewGeometry, ViewScene};
