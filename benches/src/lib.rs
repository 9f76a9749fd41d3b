//! What the benchmarks have in common: scenes, meshes and rays that are the same for Snell and its peers.
//!
//! Everything here is deterministic. Positions of meshes and rays are rounded to `f32`, which is what Embree works in,
//! so that both programs trace the very same numbers.

pub mod flake;
pub mod knot;
pub mod rays;
pub mod scenes;
pub mod spheres;

use snell::render::{LaneWidth, Options};
use snell::scene::{Problem, Scene};
use snell::world::World;
use std::time::{Duration, Instant};

/// The lane width that rays are timed with: the best that the library has on this machine. The one place to change.
pub fn lanes() -> LaneWidth {
    Options::default().lanes
}

/// Compiles a scene with some threads and says how long building the tree took. The one place to change when the
/// library tells the time of the tree alone: now it is the whole of [`World::new`].
///
/// # Errors
/// What is wrong with the scene, or that there are no threads to be had.
pub fn build(scene: &Scene, threads: usize) -> Result<(World, Duration), String> {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().map_err(|e| e.to_string())?;
    let start = Instant::now();
    let world = pool.install(|| World::new(scene));
    let time = start.elapsed();
    let problems = |found: Vec<Problem>| found.iter().map(ToString::to_string).collect::<Vec<_>>().join("; ");
    Ok((world.map_err(problems)?, time))
}

/// A well-mixing hash of 32 bits: Wellons, *Prospecting for Hash Functions*, 2018, "lowbias32".
pub fn hash(x: u32) -> u32 {
    let x = (x ^ (x >> 16)).wrapping_mul(0x7feb_352d);
    let x = (x ^ (x >> 15)).wrapping_mul(0x846c_a68b);
    x ^ (x >> 16)
}

/// A number between 0 and 1, both excluded, for each `x`.
pub fn uniform(x: u32) -> f64 {
    (f64::from(hash(x)) + 0.5) / 4_294_967_296.0
}

/// Rounded to the numbers that Embree has.
pub(crate) fn to_f32(v: f64) -> f64 {
    f64::from(v as f32)
}
