//! Vectors, rays, and what a ray can hit. Pure geometry: no materials, no light.

pub mod area;
pub mod bounds;
pub mod bvh;
#[cfg(test)]
pub(crate) mod exact;
pub mod make;
pub mod mesh;
pub mod ray;
#[cfg(test)]
mod soak;
pub mod solid;
pub mod sphere;
pub mod transform;
pub mod triangle;
pub mod vec3;

pub use bounds::Bounds;
pub use mesh::{NO_UVS, TriangleMesh};
pub use sphere::Sphere;
pub use transform::Affine;
pub use vec3::Vec3;
