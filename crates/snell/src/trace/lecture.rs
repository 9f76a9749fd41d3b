//! The lecture's three ways of blending: what a hit adds, and which rays leave from it with which weight.
//!
//! A ray carries two colours: `a`, what the surfaces so far leave of the light, and `f`, the product of the factors that
//! its parents apply to the whole result.
//!
//! | | the hit adds `local ×` | mirror ray | exit ray, from spheres with Σko < 3 |
//! | --- | --- | --- | --- |
//! | `lecture` | `f·a·ko` | `a ← kr·a`, `f ← f·a·ko` | `a ← kr·a`, `f ← f·a·(1 − ko)` |
//! | `course2018` | `f·a` | `a ← kr·a`, `f ← f` | never |
//! | `course2020` | `f·a` | `a ← kr·a`, `f ← f` | `a ← (1 − kr)·a`, `f ← f` |
//!
//! In `lecture` the parent applies `a` and the child applies it again, as in the lecture's own code: the attenuations
//! compound, and bounce n weighs `kr^(n(n+1)/2)` instead of `kr^n`. In the course's models `f` stays 1.

use super::hits::{Batch, Coefficients};
use super::media::{OUTSIDE, WHITE};
use super::queue::{Load, Rays, Weight};
use crate::film::Rgb;
use crate::geometry::Vec3;
use crate::lanes::{Lanes, Mask};
use crate::optics::snell;
use crate::scene::Integrator;

/// No hit nearer than this counts. The lecture's own number, in scene units; it
/// belongs to the models of this file only.
pub(crate) const T_MIN: f64 = 1e-5;

/// The three ways of blending.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Blend {
    Lecture,
    Course2018,
    Course2020,
}

impl Blend {
    /// `None` for other models of light.
    pub fn of(integrator: Integrator) -> Option<Self> {
        match integrator {
            Integrator::Lecture => Some(Self::Lecture),
            Integrator::Course2018 => Some(Self::Course2018),
            Integrator::Course2020 => Some(Self::Course2020),
            Integrator::Whitted => None,
        }
    }
}

/// What does this surface add here?
#[inline(always)]
pub(crate) fn contribution<L: Lanes>(blend: Blend, hits: &Batch<'_, L>) -> Rgb<L> {
    local(blend, &hits.weight(), &hits.coefficients()) * hits.local_color()
}

/// Which mirror rays leave from here, with what weight? One that carries nothing is not sent.
#[inline(always)]
pub(crate) fn mirror_ray<L: Lanes>(blend: Blend, hits: &Batch<'_, L>) -> (L::Mask, Rays<L>) {
    let weight = mirror(blend, &hits.weight(), &hits.coefficients());
    // Kept of unit length: the errors of a thousand bounces would add up, and boxes have margins for one rounding.
    let dir = snell::reflect(hits.wo(), hits.normal()).unit();
    (hits.active & weight.throughput().not_black(), child(hits, hits.point(), dir, weight))
}

/// Which rays leave on the far side of a glass sphere, with what weight?
#[inline(always)]
pub(crate) fn exit_ray<L: Lanes>(blend: Blend, hits: &Batch<'_, L>) -> (L::Mask, Rays<L>) {
    let coefficients = hits.coefficients();
    let weight = refracted(blend, &hits.weight(), &coefficients);
    let goes_in = hits.active & hits.is_sphere() & refracts(&coefficients) & weight.throughput().not_black();
    if !goes_in.any() {
        return (goes_in, child(hits, hits.point(), hits.wo(), weight));
    }
    let (eta_outside, eta_inside) = (L::splat(hits.world.eta_outside), hits.material(|m| m.eta));
    let (origin, dir, leaves) =
        snell::through_sphere(hits.point(), hits.normal(), hits.wo(), hits.center(), eta_outside, eta_inside);
    // Where the indices are equal the direction must stay what it is, to the bit.
    let dir = Vec3::select(eta_inside.eq(eta_outside), dir, dir.unit());
    (goes_in & leaves, child(hits, origin, dir, weight))
}

#[inline(always)]
fn child<L: Lanes>(hits: &Batch<'_, L>, origin: Vec3<L>, dir: Vec3<L>, weight: Weight<L>) -> Rays<L> {
    let (source, parent, pixel) = (hits.primitive(), hits.ray(), hits.pixel());
    let (medium, band) = (L::splat(f64::from(OUTSIDE)), L::splat(f64::from(WHITE)));
    let (t_min, back) = (L::splat(T_MIN), Vec3::default().splat());
    Rays { origin, dir, load: Load { weight, t_min, source, parent, pixel, medium, band, back } }
}

/// What the local colour is multiplied by.
#[inline(always)]
fn local<L: Lanes>(blend: Blend, ray: &Weight<L>, surface: &Coefficients<L>) -> Rgb<L> {
    match blend {
        Blend::Lecture => ray.factor * ray.attenuation * surface.ko,
        Blend::Course2018 | Blend::Course2020 => ray.factor * ray.attenuation,
    }
}

/// What the mirror ray carries.
#[inline(always)]
fn mirror<L: Lanes>(blend: Blend, ray: &Weight<L>, surface: &Coefficients<L>) -> Weight<L> {
    Weight {
        attenuation: surface.kr * ray.attenuation,
        factor: match blend {
            Blend::Lecture => ray.factor * ray.attenuation * surface.ko,
            Blend::Course2018 | Blend::Course2020 => ray.factor,
        },
    }
}

/// What the exit ray of a sphere carries.
#[inline(always)]
fn refracted<L: Lanes>(blend: Blend, ray: &Weight<L>, surface: &Coefficients<L>) -> Weight<L> {
    let white = Rgb::gray(1.0).splat();
    match blend {
        Blend::Lecture => Weight {
            attenuation: surface.kr * ray.attenuation,
            factor: ray.factor * ray.attenuation * (white - surface.ko),
        },
        Blend::Course2018 => Weight { attenuation: Rgb::black(), factor: Rgb::black() },
        Blend::Course2020 => Weight { attenuation: (white - surface.kr) * ray.attenuation, factor: ray.factor },
    }
}

/// Does this surface send an exit ray? `Σko < 3`.
#[inline(always)]
fn refracts<L: Lanes>(surface: &Coefficients<L>) -> L::Mask {
    (surface.ko.r + surface.ko.g + surface.ko.b).lt(L::splat(3.0))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The lecture's compounding: with kr 0.9, an opaque mirror corridor weighs bounce n by 0.9^(n(n+1)/2).
    #[test]
    fn attenuations_compound_in_the_lecture_and_nowhere_else() {
        let surface = Coefficients { kr: Rgb::gray(0.9), ko: Rgb::gray(1.0) };
        for (blend, sixth) in [(Blend::Lecture, 0.109), (Blend::Course2018, 0.531)] {
            let one = Rgb::gray(1.0);
            let mut ray = Weight::<f64> { attenuation: one, factor: one };
            for _ in 0..6 {
                ray = mirror(blend, &ray, &surface);
            }
            let weight = local(blend, &ray, &surface).r;
            assert!((weight - sixth).abs() < 5e-4, "{blend:?}: {weight}"); // three digits are quoted in the design
        }
    }
}
