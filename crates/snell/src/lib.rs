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
//! use snell::render::{Options, Settings, render};
//! use snell::scene::{Camera, Integrator, Light, Material, Render, Scene, Sphere};
//!
//! let camera = Camera::new([0.0, 0.0, 10.0], [0.0; 3], [0.0, 1.0, 0.0], [-1.0, 1.0, -1.0, 1.0], -5.0);
//! let scene = Scene {
//!     ambient: Rgb::gray(0.2),
//!     lights: vec![Light::at([5.0, 5.0, 5.0], Rgb::gray(1.0))],
//!     materials: [("red".to_owned(), Material { kd: Rgb::new(1.0, 0.0, 0.0), ..Material::default() })].into(),
//!     spheres: vec![Sphere::new([0.0; 3], 1.0, "red")],
//!     ..Scene::new(Render::new(Integrator::Lecture, [32, 32]), camera)
//! };
//! let world = snell::world::World::new(&scene)?;
//! let rendered = render(&world, &Settings::from(&scene), &Options::default())?;
//! let center = rendered.film.pixels[16 * 32 + 16];
//! assert!(center.r > 0.4 && center.g == 0.0, "{center:?}");
//! # Ok(())
//! # }
//! ```

pub mod explain;
pub mod film;
pub mod geometry;
pub mod lanes;
mod memory;
pub mod optics;
pub mod rays;
pub mod render;
pub mod scene;
pub mod threads;
pub mod world;

pub use snell_kernels::{texture, trace};

use snell_kernels::{color, integrate, settings, stage};
