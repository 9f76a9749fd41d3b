//! Meshes, the building of trees, and whether a mesh is a solid; on top of the kernels' vectors, rays and shapes.

pub mod bvh;
pub mod mesh;
pub mod solid;
pub mod tessellate;
#[cfg(test)]
mod tests;

pub use mesh::{NO_UVS, TriangleMesh};
pub use snell_kernels::geometry::{
    Affine, Bounds, Sphere, Vec3, area, bounds, ray, shape, sphere, transform, triangle, vec3,
};
