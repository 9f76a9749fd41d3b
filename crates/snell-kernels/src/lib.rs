//! What traces Snell's rays, without the standard library, threads or files: what a processor, a browser and a GPU share.
//!
//! ```text
//!  stage::Stage         camera rays                                        integrate: what a hit adds,
//!  what stands there, ──────────────▶ trace::Tracer ── hits in lanes ────▶ and which rays leave it
//!  as numbers                          │   ▲  a generation of rays                   │
//!                                      │   └───────────────── children ◀─────────────┘
//!                                      ▼
//!                              sums of the samples of a tile, and with the Recorder a tree of rays
//! ```
//!
//! Whoever uses it builds the [`Stage`](stage::Stage) and its [`tree`](geometry::bvh::Bvh), asks the machine for its
//! [`instructions`](instructions_of_this_machine), and shares out the tiles. The crate `snell` does all of that.
//!
//! An orange in even light, seen by a camera of one pixel:
//!
//! ```
//! use snell_kernels::color::Rgb;
//! use snell_kernels::geometry::bvh::{Bvh, Shapes, primitives::Primitives};
//! use snell_kernels::geometry::{Sphere, Vec3};
//! use snell_kernels::integrate::{WithIntegrator, with_integrator};
//! use snell_kernels::lanes::{Kernel, Lanes, dispatch};
//! use snell_kernels::settings::{Integrator, Settings, Shadows};
//! use snell_kernels::stage::{CameraFrame, CompiledMaterial, Stage, Surfaces};
//! use snell_kernels::trace::{self, Tile, Tracer};
//!
//! /// The first pixel.
//! struct Pixel<'a>(&'a Stage, &'a Settings);
//!
//! impl WithIntegrator for Pixel<'_> {
//!     type Output = Rgb;
//!     fn run<I: trace::Integrator>(self) -> Rgb {
//!         struct With<'a, I>(Pixel<'a>, core::marker::PhantomData<I>);
//!         impl<I: trace::Integrator> Kernel for With<'_, I> {
//!             type Output = Rgb;
//!             #[inline(always)]
//!             fn run<L: Lanes>(self) -> Rgb {
//!                 let Pixel(stage, settings) = self.0;
//!                 let mut tracer = Tracer::<L, (), I>::new(stage, settings, None, ());
//!                 tracer.trace(&Tile::pixel(0, 0), 0..1).map_or(Rgb::gray(0.0), |sums| sums.sum()[0])
//!             }
//!         }
//!         dispatch(4, snell_kernels::instructions_of_this_machine!(), With::<I>(self, core::marker::PhantomData))
//!     }
//! }
//!
//! let axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Vec3::from);
//! let eye = Vec3::new(0.0, 0.0, 5.0);
//! let camera = CameraFrame { eye, axes, bounds: [-1.0, 1.0, -1.0, 1.0], size: [1, 1], near: -1.0, from_eye: false };
//! let sphere = Sphere { center: Vec3::new(0.0, 0.0, 0.0), radius: 1.0 };
//! let shapes = Shapes { spheres: &[sphere], ..Shapes::default() };
//! // A handful of spheres needs no nodes.
//! let tree = Bvh::new(Vec::new(), Primitives::default(), 0, &shapes, Vec::new()).into();
//! let orange = CompiledMaterial { ka: Rgb::new(1.0, 0.5, 0.0), ..CompiledMaterial::BLACK };
//! let mut stage = Stage { spheres: vec![sphere], materials: vec![orange], tree, ambient: Rgb::gray(1.0), ..Stage::new(camera) };
//! stage.surfaces = Surfaces { material_of: vec![0], ..Surfaces::default() }.into();
//! stage.objects = vec![0..1];
//!
//! let (integrator, shadows) = (Integrator::Lecture, Shadows::Off);
//! let settings = Settings { integrator, max_depth: 4, shadows, spp: 1, seed: 0, min_throughput: 0.0 };
//! assert_eq!(with_integrator(integrator, Pixel(&stage, &settings)), Rgb::new(1.0, 0.5, 0.0));
//! ```

#![cfg_attr(not(test), no_std)]

extern crate alloc;

pub mod color;
pub mod geometry;
pub mod integrate;
pub mod lanes;
pub mod optics;
pub mod settings;
pub mod stage;
pub mod texture;
pub mod trace;
