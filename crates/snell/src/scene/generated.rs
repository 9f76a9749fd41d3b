//! Shapes that a few numbers describe: planes, boxes, discs, and what a lathe makes.

use super::shape::is_zero;
use super::{Mesh, Transform};
use crate::geometry::tessellate;
use serde::{Deserialize, Serialize};
use std::sync::Arc;

/// A rectangle.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Plane {
    /// Its name, for messages and explanations.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Its middle.
    #[serde(default)]
    pub center: [f64; 3],
    /// Where its front looks, of any length.
    #[serde(default = "up")]
    pub normal: [f64; 3],
    /// Width and height. Nothing is infinite here: errors are bounded by the size of the scene.
    pub size: [f64; 2],
    /// Name of its material.
    pub material: String,
    /// `whitted`: the material of what is behind it, as for meshes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inside: Option<String>,
    /// `whitted`: with `inside`, the material of what it looks at.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outside: Option<String>,
    /// Steps that put it in its place, one after the other.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub transform: Vec<Transform>,
    /// Places where it stands, as for meshes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub instances: Vec<Vec<Transform>>,
}

/// A box between two corners.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Cuboid {
    /// Its name, for messages and explanations.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// The corner of the smallest coordinates.
    pub min: [f64; 3],
    /// The corner of the largest coordinates.
    pub max: [f64; 3],
    /// Name of its material.
    pub material: String,
    /// Steps that put it in its place, one after the other.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub transform: Vec<Transform>,
    /// Places where it stands, as for meshes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub instances: Vec<Vec<Transform>>,
}

/// A disc, or with a `transform` that stretches it an ellipse.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Disc {
    /// Its name, for messages and explanations.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Its middle.
    #[serde(default)]
    pub center: [f64; 3],
    /// Where its front looks, of any length.
    #[serde(default = "up")]
    pub normal: [f64; 3],
    /// Its radius, above 0.
    pub radius: f64,
    /// Name of its material.
    pub material: String,
    /// `whitted`: the material of what is behind it, as for meshes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inside: Option<String>,
    /// `whitted`: with `inside`, the material of what it looks at.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outside: Option<String>,
    /// Steps that put it in its place, one after the other.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub transform: Vec<Transform>,
    /// Places where it stands, as for meshes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub instances: Vec<Vec<Transform>>,
}

/// What turns around the y axis: bottles, lenses, bowls.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Lathe {
    /// Its name, for messages and explanations.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Points `[radius, height]`. Along a profile that leads up, the outer side is away from the axis. It encloses something if it
    /// starts and ends on the axis (radius 0), or ends where it starts.
    pub profile: Vec<[f64; 2]>,
    /// Corners of a ring; left out: 64.
    #[serde(default = "segments")]
    pub segments: u32,
    /// Normals are smoothed over edges up to this angle in degrees; 0 is flat.
    #[serde(default, skip_serializing_if = "is_zero")]
    pub smooth_angle: f64,
    /// Name of its material.
    pub material: String,
    /// `whitted`: the material of what is behind it, as for meshes.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub inside: Option<String>,
    /// `whitted`: with `inside`, the material of what it looks at.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub outside: Option<String>,
    /// Steps that put it in its place, one after the other.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub transform: Vec<Transform>,
    /// Places where it stands, as for meshes.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub instances: Vec<Vec<Transform>>,
}

fn up() -> [f64; 3] {
    [0.0, 1.0, 0.0]
}

fn segments() -> u32 {
    64
}

impl Plane {
    /// A plane without a name, in one place.
    pub fn new(center: [f64; 3], normal: [f64; 3], size: [f64; 2], material: &str) -> Self {
        Self {
            name: None,
            center,
            normal,
            size,
            material: material.to_owned(),
            inside: None,
            outside: None,
            transform: Vec::new(),
            instances: Vec::new(),
        }
    }
}

impl Lathe {
    /// The mesh of the lathe number `index` of a scene.
    pub(crate) fn mesh(&self, index: usize) -> Mesh {
        Mesh {
            name: Some(self.name.clone().unwrap_or_else(|| format!("lathe {}", index + 1))),
            geometry: Some(Arc::new(tessellate::lathe(&self.profile, self.segments))),
            smooth_angle: self.smooth_angle,
            material: Some(self.material.clone()),
            inside: self.inside.clone(),
            outside: self.outside.clone(),
            transform: self.transform.clone(),
            instances: self.instances.clone(),
            ..Mesh::default()
        }
    }
}
