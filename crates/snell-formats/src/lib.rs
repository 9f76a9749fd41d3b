//! Files in and out of Snell.
//!
//! | in | out |
//! | --- | --- |
//! | [`load`](mod@load): scene files (TOML, JSON), the course's driver files, NFF, their models (OBJ, PLY, STL) | [`scene_file`]: TOML, JSON; [`schema`]: their JSON Schema, and that of ray trees; [`model`]: OBJ |
//! | [`picture`]: PNG, PPM, EXR, NPY, to compare or to read the recipe; as [`texture`]s | [`picture`]: the same |
//! | [`recipe`]: how a picture was made | the same |
//!
//! Whatever is wrong with a file becomes a [`Report`] with the place, what was read, what was expected and what to do.

pub mod builtin;
pub mod disk;
pub mod driver;
pub mod figure;
pub mod given;
pub mod load;
pub mod memory;
pub mod model;
pub mod nff;
pub mod page;
pub mod picture;
pub mod recipe;
pub mod report;
pub mod scene_file;
pub mod schema;
pub mod text;
pub mod texture;
mod words;

pub use load::{LoadOptions, Loaded, load};
pub use report::{Report, Source};
pub use texture::read_image;
