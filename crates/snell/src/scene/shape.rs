//! Shapes that files describe: spheres, and meshes from model files or written out.

use super::Transform;
use crate::geometry::TriangleMesh;
use indexmap::IndexMap;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A sphere.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Sphere {
    /// Its name, for messages and explanations.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Centre.
    pub center: [f64; 3],
    /// Radius; 0 is allowed and invisible.
    pub radius: f64,
    /// Name of its material.
    pub material: String,
    /// Steps that put it in its place, one after the other; it must stay a sphere.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub transform: Vec<Transform>,
    /// Places where it stands, each a list of steps after those of `transform`; empty for once.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub instances: Vec<Vec<Transform>>,
}

impl Sphere {
    /// A sphere without a name, in one place.
    pub fn new(center: [f64; 3], radius: f64, material: &str) -> Self {
        let material = material.to_owned();
        Self { name: None, center, radius, material, transform: Vec::new(), instances: Vec::new() }
    }
}

/// A triangle mesh, from a file or written out.
#[derive(Clone, Debug, Default, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Mesh {
    /// Its name, for messages and explanations.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// The model file, relative to the scene file. Give this, or `vertices` and `faces`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub file: Option<String>,
    /// Positions, if there is no file.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub vertices: Vec<[f64; 3]>,
    /// Three numbers of vertices for each face, counted from 0, counter-clockwise seen from outside.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub faces: Vec<[u32; 3]>,
    /// Name of the material of all faces; left out: what the model file says.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub material: Option<String>,
    /// Which material stands for which name in the model file, where `material` is left out.
    #[serde(default, skip_serializing_if = "IndexMap::is_empty")]
    pub materials: IndexMap<String, String>,
    /// Normals are smoothed over edges up to this angle in degrees; 0 is flat.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub smooth_angle: f64,
    /// `whitted`: what to do with a transparent mesh that is not closed; left out: it is refused.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub open: Option<OpenMesh>,
    /// `whitted`: the material of what is behind its faces, which then are interfaces, and need not be closed.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inside: Option<String>,
    /// `whitted`: with `inside`, the material of what its faces look at; left out: the space between the objects.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outside: Option<String>,
    /// Steps that put the model in its place, one after the other.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub transform: Vec<Transform>,
    /// Places where the mesh stands, each a list of steps after those of `transform`; empty for once, where `transform` puts
    /// it. However many places, its triangles are held once.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub instances: Vec<Vec<Transform>>,
    /// The triangles themselves, once the file has been read; `None` before.
    #[serde(skip)]
    #[cfg_attr(feature = "schemars", schemars(skip))]
    pub geometry: Option<Arc<TriangleMesh>>,
}

/// What to do with a transparent mesh that has no inside.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum OpenMesh {
    /// Its holes are closed, as far as that needs no guessing.
    Fill,
    /// Nothing goes through it.
    Opaque,
}

#[allow(clippy::trivially_copy_pass_by_ref, reason = "the signature of serde; what is small depends on the machine")]
pub(super) fn is_zero(value: &f64) -> bool {
    *value == 0.0
}
