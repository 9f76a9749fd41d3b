//! Lights.

use crate::color::Rgb;
use serde::{Deserialize, Serialize};

/// A light at a point, or at infinity in a direction. It does not fall off with distance. One with a `target` is a spot light.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
#[serde(deny_unknown_fields)]
pub struct Light {
    /// Its name, for messages and explanations.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub name: Option<String>,
    /// Where it stands. Give this or `direction`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub position: Option<[f64; 3]>,
    /// The direction towards a light at infinity, of any length.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub direction: Option<[f64; 3]>,
    /// A point that a spot light shines at; it needs `position` and `cone`.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub target: Option<[f64; 3]>,
    /// Angle in degrees between the middle of a spot light and its edge, above 0 and at most 180.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub cone: Option<f64>,
    /// Width in degrees of the soft edge of a spot light, within `cone`; left out: 0, a sharp edge.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub edge: Option<f64>,
    /// Its intensity.
    pub color: Rgb,
}

impl Light {
    /// A light at a point.
    pub fn at(position: [f64; 3], color: Rgb) -> Self {
        let position = Some(position);
        Self { name: None, position, direction: None, target: None, cone: None, edge: None, color }
    }

    /// A light at infinity.
    pub fn from_direction(direction: [f64; 3], color: Rgb) -> Self {
        Self { position: None, direction: Some(direction), ..Self::at([0.0; 3], color) }
    }
}
