//! Scenes that are hard on the engine, and the matrix of settings that must not change a bit of their pictures.
//!
//! For tests and measurements only, native and in WASM. All scenes are computed: the same bits on every machine.
//!
//! ```text
//!  glass, hostile, crowd, … ──▶ all() ──▶ matrix: lanes × threads × tiles, and ranges of samples ──▶ one line for each scene
//!                                                                                                     │
//!                                           native (tests/same_bits.rs, the binary) ── diff ── WASM (tests/wasm)
//! ```
//!
//! ```
//! use snell_test_scenes::{glass, matrix};
//!
//! println!("{}", matrix::all_ways("windows", &glass::windows(), &[1]));
//! ```

#![allow(clippy::unwrap_used, clippy::missing_panics_doc, reason = "a test that cannot go on fails")]

pub mod brilliant;
mod build;
pub mod convex;
mod crowd;
pub mod glass;
mod hostile;
mod instances;
pub mod matrix;
pub mod real_files;

pub use build::{at_size, lecture};
pub use crowd::{crowd, far_away, hall_of_mirrors};
pub use hostile::tiny_and_huge;
pub use instances::instances;

use snell::scene::{Integrator, Scene};
use snell_formats::builtin;

/// A scene and what it is called.
pub type Named = (String, Scene);

/// The scenes of the golden hash: the lecture's, and the crowd in all models of light. Never to be added to.
pub fn first_light() -> Vec<Named> {
    let of_the_lecture = builtin::SCENES.iter().filter(|(name, _)| name.starts_with("lecture/"));
    let built_in = of_the_lecture.map(|(name, _)| ((*name).to_owned(), lecture(name, 40)));
    let crowds = [Integrator::Lecture, Integrator::Course2018, Integrator::Course2020]
        .map(|i| (format!("crowd with {i:?}"), crowd(i)));
    built_in.chain(crowds).collect()
}

/// Thousands of primitives in each, with one kind of trouble.
pub fn hostile() -> Vec<Named> {
    hostile::all().into_iter().map(|(name, scene)| (name.to_owned(), scene)).collect()
}

/// Every scene of the matrix.
pub fn all() -> Vec<Named> {
    let mut scenes = first_light();
    scenes.extend(hostile());
    // With this seed a tree without margins around its boxes loses hits at the origin already.
    scenes.extend([0.0, 4096.0, -3e8].map(|offset| (format!("far away by {offset}"), far_away(offset, 0, true))));
    scenes.extend([0.0, 1e6].map(|offset| (format!("instances away by {offset}"), instances(offset, true))));
    scenes.push(("hall of mirrors".to_owned(), hall_of_mirrors(5)));
    let glass = [
        ("bubbles", glass::bubbles()),
        ("marbles", glass::marbles()),
        ("blocks", glass::blocks()),
        ("windows", glass::windows()),
    ];
    scenes.extend(glass.map(|(name, scene)| (format!("{name} of glass"), scene)));
    scenes.extend(["gallery/ball", "gallery/bubbles"].map(|name| (name.to_owned(), lecture(name, 24))));
    scenes
}
