//! With what a picture is computed, besides what stands there.

/// With what a picture is computed. Every one of these changes its bits.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The model of light. A world is compiled for some models ([`Stage::has_media`](crate::stage::Stage::has_media)).
    pub integrator: Integrator,
    /// How many bounces may follow the camera ray.
    pub max_depth: u32,
    /// What stands between a surface and a light.
    pub shadows: Shadows,
    /// Samples per pixel, at least 1. One looks through the point of the grid, more are spread over half a step around it.
    pub spp: u32,
    /// Another number spreads the samples otherwise.
    pub seed: u32,
    /// `whitted`: branches that carry less than this part of what they could are not followed.
    pub min_throughput: f64,
}

/// The model of light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "lowercase"))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub enum Integrator {
    /// The lecture's recursion, with its compounding attenuation and its one-step way through glass spheres.
    Lecture,
    /// The course of 2018, assignments 3 and 4: mirrors only.
    Course2018,
    /// The course of 2019 and 2020: mirrors, and glass spheres of weight `1 − kr`.
    Course2020,
    /// Real optics: Fresnel, total reflection, the inside of solids, absorption.
    Whitted,
}

impl Integrator {
    /// Do camera rays start at the eye? In the models of the lecture and the course they start on the image plane.
    pub fn starts_at_eye(self) -> bool {
        self == Self::Whitted
    }

    /// Are rays followed through solids, from medium to medium?
    pub fn has_media(self) -> bool {
        self == Self::Whitted
    }
}

/// What stands between a surface and a light.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize), serde(rename_all = "lowercase"))]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
pub enum Shadows {
    /// Nothing: every light reaches every surface that faces it.
    Off,
    /// Anything at all blocks a light, transparent or not.
    Opaque,
    /// `whitted`: light goes straight through transparent things, and what they reflect and absorb is lost.
    Tinted,
    /// Not built yet, and refused: light as glass focuses it.
    Caustic,
}
