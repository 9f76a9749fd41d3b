//! Growing the ray tree, generation by generation.
//!
//! ```text
//! generation 0      camera rays, one per pixel of a tile
//!      │ closest hits, compacted: only rays that hit go on
//!      │ local colour ── light by light: shadow rays, compacted, any hit
//!      │ contributions, added to their pixels one by one in queue order
//!      ▼ children, compacted: all mirror rays, then all refracted rays, each in their parents' order
//! generation 1 … until max_depth, or until no ray is left
//! ```
//!
//! The order of addition within a pixel follows from its own rays alone, so neither the tile, nor the lane width, nor
//! the thread can change a bit of it.

mod camera;
mod generation;
mod hits;
mod interfaces;
mod leaving;
mod lecture;
mod media;
mod observer;
mod pane;
mod queue;
mod recorder;
mod sampler;
mod shading;
mod statistics;
mod tree;
mod warnings;
mod whitted;

pub(crate) use generation::Tracer;
pub use queue::RayKind;
pub(crate) use recorder::Recorder;
pub use statistics::{LostLight, Overlap, Overlaps, RayCounts, Statistics, StrayExits};
pub(crate) use tree::mean;
pub use tree::{Ended, Hit, Lit, Node, PixelTrace, RayTree};
