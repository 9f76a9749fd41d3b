//! Textures: pictures and patterns as functions of two coordinates, and the coordinates of a point on a surface.
//!
//! `u` runs to the right and `v` up; a picture covers 0 to 1 in both, `(0, 0)` its lower left corner.

pub mod checker;
pub mod image;
pub mod mapping;

pub use checker::checker;
pub use image::{Image, ImageError};
pub use mapping::{barycentric, interpolate, latlong_uv, sphere_uv};
