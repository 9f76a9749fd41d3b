//! The models of the course's assignments, by year. A ray carries one colour, `a`: what the surfaces so far leave of the light.
//!
//! | | the hit adds `local ×` | mirror ray | exit ray, from spheres with Σko < 3 |
//! | --- | --- | --- | --- |
//! | `course2018` | `a` | `a ← kr·a` | never |
//! | `course2020` | `a` | `a ← kr·a` | `a ← (1 − kr)·a` |

use super::lecture::{exit_ray, mirror_ray, refracts};
use super::size;
use crate::color::Rgb;
use crate::lanes::{Lanes, record};
use crate::settings::Settings;
use crate::stage::CompiledMaterial;
use crate::trace::{Batch, Children, FirstSurface, Integrator, Most, RayKind};

record! {
    /// What a ray carries.
    Weight,
    /// Its columns.
    Weights { attenuation: Rgb, }
}

/// The course of 2018, assignments 3 and 4: mirrors only.
pub type Course2018 = Course<false>;

/// The course of 2019 and 2020: mirrors, and glass spheres of weight `1 − kr`.
pub type Course2020 = Course<true>;

/// The course, without or with glass.
#[derive(Clone, Copy, Debug)]
pub struct Course<const GLASS: bool>;

impl<const GLASS: bool> Integrator for Course<GLASS> {
    type Propagation = FirstSurface;
    type Carried = Weights;

    fn new(_settings: &Settings) -> Self {
        Self
    }

    #[inline(always)]
    fn from_camera<L: Lanes>() -> Weight<L> {
        Weight { attenuation: Rgb::gray(1.0).splat() }
    }

    #[inline(always)]
    fn throughput<L: Lanes>(carried: &Weight<L>) -> Rgb<L> {
        carried.attenuation
    }

    #[inline(always)]
    fn scatter<L: Lanes>(
        self,
        hits: &Batch<'_, L, FirstSurface>,
        _state: &(),
        children: &mut Children<FirstSurface>,
    ) -> Rgb<L> {
        let (ray, kr) = (hits.carried::<Weights>(), hits.material_color(|m| m.kr));
        let a = ray.attenuation;
        let mirror = mirrored(&ray, kr);
        let sends = hits.active & mirror.attenuation.not_black();
        children.push::<L, Weights>(RayKind::Mirror, sends, &mirror_ray(hits), &mirror);
        if GLASS {
            let refracted = (Rgb::gray(1.0).splat() - kr) * a;
            let sends = hits.active & refracts(&hits.material_color(|m| m.ko)) & refracted.not_black();
            let (leaves, exit) = exit_ray(hits, sends);
            children.push::<L, Weights>(RayKind::Refracted, leaves, &exit, &Weight { attenuation: refracted });
        }
        a * hits.local_color()
    }

    fn most(material: &CompiledMaterial, _brightest: Rgb) -> Most {
        let kr = size(material.kr);
        let passes = if GLASS { size(Rgb::gray(1.0) - material.kr) } else { Rgb::gray(0.0) };
        Most { local: Rgb::gray(1.0), children: Rgb::new(kr.r + passes.r, kr.g + passes.g, kr.b + passes.b) }
    }
}

/// What the mirror ray carries.
#[inline(always)]
fn mirrored<L: Lanes>(ray: &Weight<L>, kr: Rgb<L>) -> Weight<L> {
    Weight { attenuation: kr * ray.attenuation }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Unlike the lecture's, attenuations do not compound: with kr 0.9, bounce n weighs 0.9^n.
    #[test]
    fn what_a_bounce_weighs() {
        let mut ray = Course2018::from_camera::<f64>();
        for _ in 0..6 {
            ray = mirrored(&ray, Rgb::gray(0.9));
        }
        let weight = Course2018::throughput(&ray).r;
        assert!((weight - 0.531).abs() < 5e-4, "{weight}"); // 0.9^6 to three digits
    }
}
