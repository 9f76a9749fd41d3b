//! The lecture's recursion.
//!
//! A ray carries two colours: `a`, what the surfaces so far leave of the light, and `f`, the product of the factors that
//! its parents apply to the whole result.
//!
//! | the hit adds `local ×` | mirror ray | exit ray, from spheres with Σko < 3 |
//! | --- | --- | --- |
//! | `f·a·ko` | `a ← kr·a`, `f ← f·a·ko` | `a ← kr·a`, `f ← f·a·(1 − ko)` |
//!
//! The parent applies `a` and the child applies it again, as in the lecture's own code: the attenuations compound, and bounce n
//! weighs `kr^(n(n+1)/2)` instead of `kr^n`.

use super::size;
use crate::color::Rgb;
use crate::geometry::Vec3;
use crate::lanes::{Lanes, Mask, record};
use crate::optics::snell;
use crate::settings::Settings;
use crate::stage::CompiledMaterial;
use crate::trace::{Batch, Children, FirstSurface, Integrator, Most, Outgoing, RayKind};

record! {
    /// What a ray carries.
    Weight,
    /// Its columns.
    Weights {
        /// What the surfaces passed so far leave of the light: `a`.
        attenuation: Rgb,
        /// The product of the parents' factors, which apply besides `a`: `f`.
        factor: Rgb,
    }
}

/// The lecture's recursion, with its compounding attenuation and its one-step way through glass spheres.
#[derive(Clone, Copy, Debug)]
pub struct Lecture;

impl Integrator for Lecture {
    type Propagation = FirstSurface;
    type Carried = Weights;

    fn new(_settings: &Settings) -> Self {
        Self
    }

    #[inline(always)]
    fn from_camera<L: Lanes>() -> Weight<L> {
        let white = Rgb::gray(1.0).splat();
        Weight { attenuation: white, factor: white }
    }

    #[inline(always)]
    fn throughput<L: Lanes>(carried: &Weight<L>) -> Rgb<L> {
        carried.factor * carried.attenuation
    }

    #[inline(always)]
    fn scatter<L: Lanes>(
        self,
        hits: &Batch<'_, L, FirstSurface>,
        _state: &(),
        children: &mut Children<FirstSurface>,
    ) -> Rgb<L> {
        let (ray, surface) = (hits.carried::<Weights>(), Coefficients::of(hits));
        let mirror = mirror(&ray, &surface);
        children.push::<L, Weights>(RayKind::Mirror, sends(hits, &mirror), &mirror_ray(hits), &mirror);
        let refracted = refracted(&ray, &surface);
        let (leaves, exit) = exit_ray(hits, refracts(&surface.ko) & sends(hits, &refracted));
        children.push::<L, Weights>(RayKind::Refracted, leaves, &exit, &refracted);
        local(&ray, &surface) * hits.local_color()
    }

    fn most(material: &CompiledMaterial, _brightest: Rgb) -> Most {
        let (ko, kr, clear) = (size(material.ko), size(material.kr), size(Rgb::gray(1.0) - material.ko));
        Most { local: ko, children: ko * kr + clear * kr }
    }
}

/// The coefficients of a surface that decide how light goes on.
#[derive(Clone, Copy, Debug)]
struct Coefficients<L: Lanes> {
    kr: Rgb<L>,
    ko: Rgb<L>,
}

impl<L: Lanes> Coefficients<L> {
    #[inline(always)]
    fn of(hits: &Batch<'_, L, FirstSurface>) -> Self {
        Self { kr: hits.material_color(|m| m.kr), ko: hits.material_color(|m| m.ko) }
    }
}

/// Which hits send a ray that carries this?
#[inline(always)]
fn sends<L: Lanes>(hits: &Batch<'_, L, FirstSurface>, weight: &Weight<L>) -> L::Mask {
    hits.active & Lecture::throughput(weight).not_black()
}

/// What the local colour is multiplied by.
#[inline(always)]
fn local<L: Lanes>(ray: &Weight<L>, surface: &Coefficients<L>) -> Rgb<L> {
    ray.factor * ray.attenuation * surface.ko
}

/// What the mirror ray carries.
#[inline(always)]
fn mirror<L: Lanes>(ray: &Weight<L>, surface: &Coefficients<L>) -> Weight<L> {
    Weight { attenuation: surface.kr * ray.attenuation, factor: ray.factor * ray.attenuation * surface.ko }
}

/// What the exit ray of a sphere carries.
#[inline(always)]
fn refracted<L: Lanes>(ray: &Weight<L>, surface: &Coefficients<L>) -> Weight<L> {
    let clear = Rgb::gray(1.0).splat() - surface.ko;
    Weight { attenuation: surface.kr * ray.attenuation, factor: ray.factor * ray.attenuation * clear }
}

/// Does a surface send an exit ray? `Σko < 3`.
#[inline(always)]
pub fn refracts<L: Lanes>(ko: &Rgb<L>) -> L::Mask {
    (ko.r + ko.g + ko.b).lt(L::splat(3.0))
}

/// The mirror rays of some hits.
#[inline(always)]
pub fn mirror_ray<L: Lanes>(hits: &Batch<'_, L, FirstSurface>) -> Outgoing<L, FirstSurface> {
    // Kept of unit length: the errors of a thousand bounces would add up, and boxes have margins for one rounding.
    hits.leaving(hits.point(), snell::reflect(hits.wo(), hits.normal()).unit(), ())
}

/// The rays on the far side of glass spheres, of the hits in the mask, and which of them there are.
#[inline(always)]
pub fn exit_ray<L: Lanes>(hits: &Batch<'_, L, FirstSurface>, sends: L::Mask) -> (L::Mask, Outgoing<L, FirstSurface>) {
    let goes_in = sends & hits.is_sphere();
    if !goes_in.any() {
        return (goes_in, hits.leaving(hits.point(), hits.wo(), ()));
    }
    let (eta_outside, eta_inside) = (L::splat(hits.stage.eta_outside), hits.material(|m| m.eta));
    let (origin, dir, leaves) =
        snell::through_sphere(hits.point(), hits.normal(), hits.wo(), hits.center(), eta_outside, eta_inside);
    // Where the indices are equal the direction must stay what it is, to the bit.
    let dir = Vec3::select(eta_inside.eq(eta_outside), dir, dir.unit());
    (goes_in & leaves, hits.leaving(origin, dir, ()))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The lecture's compounding: with kr 0.9, an opaque mirror corridor weighs bounce n by 0.9^(n(n+1)/2).
    #[test]
    fn attenuations_compound() {
        let surface = Coefficients { kr: Rgb::gray(0.9), ko: Rgb::gray(1.0) };
        let mut ray = Lecture::from_camera::<f64>();
        for _ in 0..6 {
            ray = mirror(&ray, &surface);
        }
        let weight = local(&ray, &surface).r;
        assert!((weight - 0.109).abs() < 5e-4, "{weight}"); // 0.9^21 to three digits
    }
}
