//! Vectors, rays, shapes, and the traversal of a finished tree. Pure geometry: no materials, no light.

pub mod area;
pub mod bounds;
pub mod bvh;
pub mod ray;
pub mod shape;
pub mod transform;
pub mod vec3;

pub use bounds::Bounds;
pub use shape::{Sphere, sphere, triangle};
pub use transform::Affine;
pub use vec3::Vec3;
