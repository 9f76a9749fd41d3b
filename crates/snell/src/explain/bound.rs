//! How much a branch that was not followed could still have added.

use crate::film::Rgb;
use crate::scene::{Integrator, Material};
use crate::world::World;

/// So many further levels are considered.
pub(super) const LEVELS: i32 = 10;

/// The largest radiance that anything shows by itself, times what ten levels of branching can make of it. What a branch of
/// throughput 1 can add is at most this, in each channel, as long as it goes no deeper.
///
/// At each hit the surface adds `w·local`, and its children carry at most `g` together:
///
/// | | w | g |
/// | --- | --- | --- |
/// | `lecture` | ko | ko·kr + (1 − ko)·kr |
/// | `course2018` | 1 | kr |
/// | `course2020` | 1 | kr + (1 − kr) |
/// | `whitted` | ko | ko·kr + (1 − ko); where a texture has holes, from there to 1 |
///
/// so that a branch adds at most `L·(1 + g + g² + …)`. Splitting into bands multiplies by the sum of their shares without signs.
pub(super) fn per_throughput(world: &World) -> Rgb {
    let sum = |a: Rgb, b: Rgb| Rgb::new(a.r + b.r, a.g + b.g, a.b + b.b);
    let largest = |a: Rgb, b: Rgb| Rgb::new(a.r.max(b.r), a.g.max(b.g), a.b.max(b.b));
    let lights = world.lights.iter().fold(Rgb::gray(0.0), |all, light| sum(all, size(light.color)));
    let mut radiance = size(world.background.largest());
    let mut gain = Rgb::gray(0.0);
    let model = world.render.integrator;
    let brightest = world.patterns.iter().fold(Rgb::gray(1.0), |most, pattern| largest(most, pattern.largest()));
    for (number, m) in (0..).zip(&world.materials) {
        let local = size(world.ambient) * size(m.ka) * brightest + lights * (size(m.kd) * brightest + size(m.ks));
        let weighs =
            if matches!(model, Integrator::Lecture | Integrator::Whitted) { size(m.ko) } else { Rgb::gray(1.0) };
        radiance = largest(radiance, weighs * local + size(m.emission));
        gain = largest(gain, children(model, m, brightest));
        if world.has_holes(number) {
            // `ko` may be anything down to 0.
            let there_is_none = Material { ko: Rgb::gray(0.0), ..m.clone() };
            gain = largest(gain, children(model, &there_is_none, brightest));
        }
    }
    let split: Rgb = world.bands.iter().fold(Rgb::gray(0.0), |all, band| sum(all, size(band.weight)));
    let split = if world.spectra.is_empty() { Rgb::gray(1.0) } else { largest(split, Rgb::gray(1.0)) };
    let series = |g: f64| (0..=LEVELS).fold((0.0, 1.0), |(sum, power), _| (sum + power, power * g)).0;
    radiance * split * Rgb::new(series(gain.r), series(gain.g), series(gain.b))
}

/// What the children of a hit carry together, for each unit that arrives.
fn children(model: Integrator, m: &Material, brightest: Rgb) -> Rgb {
    let (ko, kr, clear) = (size(m.ko), size(m.kr), size(Rgb::gray(1.0) - m.ko));
    match model {
        Integrator::Lecture => ko * kr + clear * kr,
        Integrator::Course2018 => kr,
        Integrator::Course2020 => kr + size(Rgb::gray(1.0) - m.kr),
        Integrator::Whitted => {
            let dye = size(m.kd) * brightest;
            let dye = if m.dyed { Rgb::new(dye.r.max(1.0), dye.g.max(1.0), dye.b.max(1.0)) } else { Rgb::gray(1.0) };
            ko * kr + clear * dye
        }
    }
}

/// Without signs.
fn size(c: Rgb) -> Rgb {
    Rgb::new(c.r.abs(), c.g.abs(), c.b.abs())
}
