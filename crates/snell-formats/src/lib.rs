//! Files in and out of Snell.
//!
//! | in | out |
//! | --- | --- |
//! | [`load`](mod@load): scene files (TOML, JSON), the course's driver files, NFF, their models (OBJ, PLY, STL) | [`scene_file`]: TOML, JSON; [`schema`]: their JSON Schema, and that of ray trees; [`model`]: OBJ |
//! | [`picture`]: PNG, PPM, EXR, NPY, to compare or to read the recipe; as [`texture`]s | [`picture`]: the same |
//! | [`recipe`]: how a picture was made | the same |
//!
//! ```text
//!  a file, or a built-in scene ──▶ Source ── load ──▶ Scene ── snell ──▶ Film ── Writing ──▶ a file with its recipe
//!                                              │                                                        │
//!                                              └─▶ Report, where anything is wrong          a picture ──┘ read again: load, diff
//! ```
//!
//! ```
//! use snell::render::{Options, Settings, render};
//! use snell::world::World;
//! use snell_formats::picture::{Format, Writing};
//! use snell_formats::scene_file::{self, Syntax};
//!
//! # fn main() -> Result<(), Box<dyn std::error::Error>> {
//! let source = snell_formats::builtin::find("lecture/default")?;
//! let mut scene = scene_file::parse(&source, Syntax::Toml)?;
//! scene.render.size = [40, 30];
//! let film = render(&World::new(&scene)?, &Settings::from(&scene), &Options::default())?.film;
//! let mut bytes = std::io::Cursor::new(Vec::new());
//! let writing = Writing { format: Format::Npy, encoding: scene.render.encoding(), threads: 0 };
//! writing.write_to(&mut bytes, &film, || None)?;
//! assert!(bytes.into_inner().starts_with(b"\x93NUMPY"));
//! # Ok(())
//! # }
//! ```
//!
//! Whatever is wrong with a file becomes a [`Report`] with the place, what was read, what was expected and what to do.

pub mod builtin;
pub mod driver;
pub mod figure;
pub mod files;
pub mod given;
pub mod load;
pub mod memory;
pub mod model;
pub mod nff;
pub mod page;
#[cfg(feature = "disk")]
pub mod part;
pub mod picture;
pub mod recipe;
pub mod report;
pub mod scene_file;
#[cfg(feature = "schemars")]
pub mod schema;
pub mod sweep;
pub mod text;
pub mod texture;
mod words;

#[cfg(feature = "disk")]
pub use files::disk;
#[cfg(feature = "disk")]
pub use load::load;
pub use load::{LoadOptions, Loaded};
pub use report::{Report, Source};
#[cfg(feature = "disk")]
pub use texture::read_image;
