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
mod carried;
mod first_surface;
mod generation;
mod hits;
mod integrator;
pub mod interfaces;
mod leaving;
pub mod media;
mod observer;
mod pairwise;
pub mod pane;
mod propagation;
mod queue;
mod recorder;
mod sampler;
mod shading;
mod statistics;
mod tile;
mod tree;

pub use first_surface::FirstSurface;
pub use generation::{TracedTile, Tracer, add_to};
pub use hits::Batch;
pub use integrator::{Integrator, Most};
pub use pairwise::{Block, PairwiseSum, Twice};
pub use propagation::Propagation;
pub use queue::RayKind;
pub use queue::{Children, Outgoing};
pub use recorder::Recorder;
pub use statistics::{LostLight, Overlap, Overlaps, RayCounts, Statistics, StrayExits};
pub use tile::Tile;
pub use tree::mean;
pub use tree::{Cutoff, Hit, LightAtHit, Node, PixelTrace, RayTree};
