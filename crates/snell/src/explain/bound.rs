//! How much a branch that was not followed could still have added.

use crate::color::Rgb;
use crate::integrate::{WithIntegrator, size, with_integrator};
use crate::scene;
use crate::stage::CompiledMaterial;
use crate::trace::{Integrator, Most};
use crate::world::World;

/// So many further levels are considered.
pub(super) const LEVELS: i32 = 10;

/// The largest radiance that anything shows by itself, times what ten levels of branching can make of it. What a branch of
/// throughput 1 can add is at most this, in each channel, as long as it goes no deeper.
///
/// At each hit the surface adds at most `w` of its local colour, and its children carry at most `g` together, as
/// [`Integrator::most`] says, so that a branch adds at most `L·(1 + g + g² + …)`. Splitting into bands multiplies by the sum of their
/// shares without signs.
pub(super) fn per_throughput(world: &World, integrator: scene::Integrator) -> Rgb {
    with_integrator(integrator, Bound { world })
}

struct Bound<'a> {
    world: &'a World,
}

impl WithIntegrator for Bound<'_> {
    type Output = Rgb;
    fn run<I: Integrator>(self) -> Rgb {
        let world = self.world;
        let sum = |a: Rgb, b: Rgb| Rgb::new(a.r + b.r, a.g + b.g, a.b + b.b);
        let largest = |a: Rgb, b: Rgb| Rgb::new(a.r.max(b.r), a.g.max(b.g), a.b.max(b.b));
        let lights = world.lights.iter().fold(Rgb::gray(0.0), |all, light| sum(all, size(light.color)));
        let mut radiance = size(world.background.largest());
        let mut gain = Rgb::gray(0.0);
        let brightest = world.patterns.iter().fold(Rgb::gray(1.0), |most, pattern| largest(most, pattern.largest()));
        for m in &world.materials {
            let local = size(world.ambient) * size(m.ka) * brightest + lights * (size(m.kd) * brightest + size(m.ks));
            let Most { local: weighs, children } = I::most(m, brightest);
            radiance = largest(radiance, weighs * local + size(m.emission));
            gain = largest(gain, children);
            if m.has_holes {
                // `ko` may be anything down to 0.
                let there_is_none = CompiledMaterial { ko: Rgb::gray(0.0), ..*m };
                gain = largest(gain, I::most(&there_is_none, brightest).children);
            }
        }
        let split: Rgb = world.bands.iter().fold(Rgb::gray(0.0), |all, band| sum(all, size(band.weight)));
        let split = if world.spectra.is_empty() { Rgb::gray(1.0) } else { largest(split, Rgb::gray(1.0)) };
        let series = |g: f64| (0..=LEVELS).fold((0.0, 1.0), |(sum, power), _| (sum + power, power * g)).0;
        radiance * split * Rgb::new(series(gain.r), series(gain.g), series(gain.b))
    }
}
