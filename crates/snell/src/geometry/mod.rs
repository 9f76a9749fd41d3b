//! Vectors, rays, and what a ray can hit. Pure geometry: no materials, no light.

pub mod area;
pub mod bounds;
pub mod bvh;
#[cfg(test)]
pub(crate) mod exact;
pub mod mesh;
pub mod ray;
pub mod shape;
#[cfg(test)]
mod soak;
pub mod solid;
pub mod tessellate;
pub mod transform;
pub mod vec3;

pub use bounds::Bounds;
pub use mesh::{NO_UVS, TriangleMesh};
pub use shape::{Sphere, sphere, triangle};
pub use transform::Affine;
pub use vec3::Vec3;
