//! Materials, by the lecture's coefficients.

use super::one;
use crate::film::Rgb;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

/// What a surface does with light. What is left out is 0, but `ko` 1 (opaque), `spow` 16 and `eta` 1.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields, default)]
pub struct Material {
    /// Share of the ambient light.
    pub ka: Rgb,
    /// Diffuse reflectance.
    pub kd: Rgb,
    /// Colour of the highlight.
    pub ks: Rgb,
    /// Share that the mirror ray carries on.
    pub kr: Rgb,
    /// Opacity: the share `1 − ko` of the light goes through.
    pub ko: Rgb,
    /// Exponent of the highlight.
    pub spow: f64,
    /// Index of refraction.
    #[serde(default = "one")]
    pub eta: f64,
}

impl Default for Material {
    fn default() -> Self {
        let none = Rgb::gray(0.0);
        Self { ka: none, kd: none, ks: none, kr: none, ko: Rgb::gray(1.0), spow: 16.0, eta: 1.0 }
    }
}
