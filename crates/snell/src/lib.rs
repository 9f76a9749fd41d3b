//! Snell: a ray tracer that shows its work.
//!
//! Data flows one way:
//!
//! ```text
//! scene::Scene ── validate ──▶ world::World ── camera rays ──▶ trace: generations of hits and children
//!  (a person     (what is         (arrays,                        │                         │
//!   writes it)    wrong, where)    tree)                          ▼                         ▼
//!                                                            film::Film                trace::RayTree
//! ```
//!
//! ```
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! use snell::film::Rgb;
//! use snell::scene::{Camera, Integrator, Light, Material, Render, Rounding, Scene, Shadows, Sphere, Transfer};
//!
//! let scene = Scene {
//!     snell: 1,
//!     schema: None,
//!     ambient: Rgb::gray(0.2),
//!     background: Rgb::gray(0.0),
//!     eta_outside: 1.0,
//!     render: Render {
//!         integrator: Integrator::Lecture,
//!         size: [32, 32],
//!         max_depth: 6,
//!         min_throughput: snell::scene::MIN_THROUGHPUT,
//!         bands: snell::scene::BANDS,
//!         shadows: Shadows::Opaque,
//!         transfer: Transfer::Linear,
//!         rounding: Rounding::Round,
//!     },
//!     camera: Camera {
//!         eye: [0.0, 0.0, 10.0],
//!         look_at: [0.0, 0.0, 0.0],
//!         up: [0.0, 1.0, 0.0],
//!         bounds: [-1.0, 1.0, -1.0, 1.0],
//!         near: -5.0,
//!         far: None,
//!     },
//!     lights: vec![Light { name: None, position: Some([5.0, 5.0, 5.0]), direction: None, color: Rgb::gray(1.0) }],
//!     materials: [("red".to_owned(), Material { kd: Rgb::new(1.0, 0.0, 0.0), ..Material::default() })].into(),
//!     spheres: vec![Sphere { name: None, center: [0.0; 3], radius: 1.0, material: "red".to_owned() }],
//!     meshes: vec![],
//! };
//! let world = snell::world::World::new(&scene).map_err(|problems| problems[0].to_string())?;
//! let rendered = snell::render::render(&world, &snell::render::Options::default())?;
//! let center = rendered.film.pixels[16 * 32 + 16];
//! assert!(center.r > 0.4 && center.g == 0.0, "{center:?}");
//! # Ok(())
//! # }
//! ```

pub mod film;
pub mod geometry;
pub mod lanes;
mod memory;
pub mod optics;
pub mod rays;
pub mod render;
pub mod scene;
pub mod texture;
mod threads;
pub mod trace;
pub mod world;
