//! With what a picture is computed, besides what stands there.

use crate::scene::{Integrator, Scene, Shadows};

/// With what a picture is computed. Every one of these changes its bits.
#[derive(Clone, Debug, PartialEq)]
pub struct Settings {
    /// The model of light. A world is compiled for some models ([`World::new`](crate::world::World::new)).
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

impl Settings {
    /// The settings that a scene asks for.
    pub fn of(scene: &Scene) -> Self {
        let render = &scene.render;
        Self {
            integrator: render.integrator,
            max_depth: render.max_depth,
            shadows: render.shadows(),
            spp: render.spp,
            seed: render.seed,
            min_throughput: render.min_throughput,
        }
    }
}
