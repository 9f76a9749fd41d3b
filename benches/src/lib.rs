//! What the benchmarks have in common: scenes, meshes and rays that are the same for Snell and its peers.
//!
//! Everything here is deterministic. Positions of meshes and rays are rounded to `f32`, which is what Embree works in,
//! so that both programs trace the very same numbers.

pub mod flake;
pub mod knot;
pub mod rays;
pub mod scenes;
pub mod spheres;

use snell::geometry::bvh::{self, MARGIN, Quality, Shapes};
use snell::geometry::shape::Triangles;
use snell::geometry::{Bounds, Sphere};
use snell::render::{LaneWidth, Options};
use snell::scene::{Problems, Scene};
use snell::world::World;
use std::hint::black_box;
use std::time::{Duration, Instant};

/// The lane width that rays are timed with: the best that this machine has.
pub fn lanes() -> LaneWidth {
    Options::default().lanes
}

/// Compiles a scene, and says how long its tree alone took, on so many threads: from arrays of spheres, vertices and faces to
/// a tree that rays can be sent through, which is what Embree's `rtcCommitScene` does.
///
/// # Errors
/// What is wrong with the scene.
pub fn build(scene: &Scene, threads: usize) -> Result<(World, Duration), String> {
    let (mut vertices, mut faces) = (Vec::new(), Vec::new());
    for geometry in scene.meshes.iter().filter_map(|mesh| mesh.geometry.as_ref()) {
        let base = vertices.len() as u32;
        vertices.extend(&geometry.vertices);
        faces.extend(geometry.faces.iter().map(|face| face.map(|v| v + base)));
    }
    let sphere = |s: &snell::scene::Sphere| Sphere { center: s.center.into(), radius: s.radius };
    let spheres: Vec<Sphere> = scene.spheres.iter().map(sphere).collect();
    let triangles = Triangles { vertices: &vertices, faces: &faces };
    let shapes = Shapes { spheres: &spheres, triangles, ..Shapes::default() };
    let start = Instant::now();
    let everything = (0..shapes.count()).map(|i| shapes.bounds(i)).fold(Bounds::EMPTY, Bounds::union);
    let tree = bvh::build(&shapes, vec![], MARGIN * everything.diagonal(), Quality::Good, threads);
    let time = start.elapsed();
    drop(black_box(tree));
    Ok((World::build(scene, Quality::Good, threads).map_err(|problems: Problems| problems.to_string())?, time))
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
