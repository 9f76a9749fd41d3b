//! Lights.

use crate::film::Rgb;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// A light at a point, or at infinity in a direction. It does not fall off with distance.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
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
    /// Its intensity.
    pub color: Rgb,
}
