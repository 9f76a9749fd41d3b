//! The physical Whitted model (Whitted, *An Improved Illumination Model for Shaded Display*, CACM 23(6), 1980), with real
//! optics: what a hit adds, and which rays leave from it with which weight.
//!
//! | | on the outer side | from inside |
//! | --- | --- | --- |
//! | the hit adds | `ko × local + emission` | nothing |
//! | mirror ray | `ko·kr + (1 − ko)·R` | `R` |
//! | refracted ray | `(1 − ko)·(1 − R)` | `1 − R` |
//!
//! all times the throughput. `R` is Fresnel's reflectance of the interface; total internal reflection is `R = 1`. Radiance is
//! carried as `L/n²`, which an interface does not change. A surface that lets nothing through has `ko` 1.

use super::hits::Batch;
use super::media::Media;
use super::queue::{Load, Rays, Weight};
use crate::film::Rgb;
use crate::geometry::Vec3;
use crate::lanes::Lanes;
use crate::optics::fresnel::fresnel_dielectric;
use crate::optics::snell::{reflect, refract};

/// Rays in lanes, and which of them leave.
type Leaving<L> = (<L as Lanes>::Mask, Rays<L>);

/// Which hits show their own colour, and so have to ask for lights: outer sides that are not wholly transparent.
#[inline(always)]
pub(crate) fn has_local_color<L: Lanes>(hits: &Batch<'_, L>) -> L::Mask {
    hits.active & hits.face().outer.gt(L::splat(0.0)) & opacity(hits).not_black()
}

/// What of the light on the outer side does not go through.
#[inline(always)]
fn opacity<L: Lanes>(hits: &Batch<'_, L>) -> Rgb<L> {
    let face = hits.face();
    let ko = hits.material_color(
        #[inline(always)]
        |m| m.ko,
    );
    Rgb::select(face.before.eq(face.after), Rgb::gray(1.0).splat(), ko)
}

/// What a batch of hits adds, and the mirror and refracted rays that leave.
#[inline(always)]
pub(crate) fn answer<L: Lanes>(hits: &Batch<'_, L>, media: &Media<'_>) -> (Rgb<L>, Leaving<L>, Leaving<L>) {
    let (zero, white, none) = (L::splat(0.0), Rgb::gray(1.0).splat::<L>(), Rgb::black());
    let (face, throughput) = (hits.face(), hits.weight().throughput());
    let outer = face.outer.gt(zero);
    let color = |on_outer_side: Rgb<L>| Rgb::select(outer, on_outer_side, none);
    let ko = color(opacity(hits));
    let kr = hits.material_color(
        #[inline(always)]
        |m| m.kr,
    );
    let emission = color(hits.material_color(
        #[inline(always)]
        |m| m.emission,
    ));
    let own = ko * hits.local_color() + emission;
    let sky = hits.world.background.splat();
    let contribution = throughput * Rgb::select(hits.is_sky(), sky, own);

    let eta = L::from_fn(|lane| {
        let [before, after] = hits.media_of(lane);
        media.medium(after).eta / media.medium(before).eta
    });
    let (wo, n, ng) = (hits.wo(), hits.normal(), hits.geometric_normal());
    let shading = Directions::new(wo, n, eta);
    let flat = Directions::new(wo, ng, eta);
    // A smoothed normal gives way where it would send rays to the wrong side.
    let wrong = !(shading.mirror.dot(ng).gt(zero) & (shading.refracted.dot(ng).lt(zero) | !shading.refracts));
    let to = Directions::select(wrong | !wo.dot(n).gt(zero), flat, shading);
    let r = Rgb::new(to.reflectance, to.reflectance, to.reflectance);
    let clear = white - ko;
    let dye = Rgb::select(
        outer,
        hits.material_color(
            #[inline(always)]
            |m| if m.dyed { m.kd } else { Rgb::gray(1.0) },
        ),
        white,
    );
    let mirror_weight = throughput * (ko * kr + clear * r);
    let refracted_weight = throughput * (clear * dye) * (white - r);
    let child = |dir: Vec3<L>, medium: L, attenuation: Rgb<L>| {
        let (source, parent, pixel) = (hits.primitive(), hits.ray(), hits.pixel());
        let load = Load { weight: Weight { attenuation, factor: white }, t_min: zero, source, parent, pixel, medium };
        (hits.active & attenuation.not_black(), Rays { origin: hits.point(), dir, load })
    };
    let mirror = child(to.mirror, face.before, mirror_weight);
    let (sends, refracted) = child(to.refracted, face.after, refracted_weight);
    (contribution, mirror, (sends & to.refracts & !face.before.eq(face.after), refracted))
}

/// Where light goes from a smooth interface.
#[derive(Clone, Copy)]
struct Directions<L: Lanes> {
    mirror: Vec3<L>,
    refracted: Vec3<L>,
    /// Is there a refracted ray? Otherwise `reflectance` is 1.
    refracts: L::Mask,
    reflectance: L,
}

impl<L: Lanes> Directions<L> {
    #[inline(always)]
    fn new(wo: Vec3<L>, n: Vec3<L>, eta: L) -> Self {
        let reflectance = fresnel_dielectric(wo.dot(n), eta);
        let (refracted, exists) = refract(wo, n, L::splat(1.0) / eta);
        let refracts = exists & reflectance.lt(L::splat(1.0));
        // One decision for both: in the last bits Fresnel's and Snell's radicands may disagree.
        let reflectance = L::select(refracts, reflectance, L::splat(1.0));
        // Equal indices leave a direction what it is, to the bit.
        let refracted = Vec3::select(eta.eq(L::splat(1.0)), refracted, refracted.unit());
        Self { mirror: reflect(wo, n).unit(), refracted, refracts, reflectance }
    }

    #[inline(always)]
    fn select(mask: L::Mask, yes: Self, no: Self) -> Self {
        Self {
            mirror: Vec3::select(mask, yes.mirror, no.mirror),
            refracted: Vec3::select(mask, yes.refracted, no.refracted),
            refracts: (mask & yes.refracts) | (!mask & no.refracts),
            reflectance: L::select(mask, yes.reflectance, no.reflectance),
        }
    }
}
