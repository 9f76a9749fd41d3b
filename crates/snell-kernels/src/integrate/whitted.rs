//! The physical Whitted model (Whitted, *An Improved Illumination Model for Shaded Display*, CACM 23(6), 1980), with real
//! optics: what a hit adds, and which rays leave from it with which weight.
//!
//! | | on the outer side | from inside |
//! | --- | --- | --- |
//! | the hit adds | `ko × local + a × emission` | nothing |
//! | mirror ray | `ko·kr + (1 − ko)·R` | `R` |
//! | refracted ray | `(1 − ko)·(1 − R)`, times `kd` with tinted transmission | `1 − R` |
//!
//! all times the throughput. `R` is Fresnel's reflectance of the interface; total internal reflection is `R = 1`. Radiance is
//! carried as `L/n²`, which an interface does not change. A surface that lets nothing through has `ko` 1.
//!
//! `a` is the alpha of the texture, 1 without one: the share of the surface that is there (its coverage, Porter and Duff 1984).
//! `ko` stands for `ko·a`. What is left goes on as the material lets light through; if it lets none through, straight on.
//!
//! At its first dispersive interface a white ray splits: a refracted ray for each band of light, with the band's index and its
//! share of white. What is reflected goes one way for all, with `R` = Σ share·R of the bands, and stays white.

use super::size;
use crate::color::Rgb;
use crate::geometry::Vec3;
use crate::lanes::{Lanes, Mask, index, record};
use crate::optics::fresnel::fresnel_dielectric;
use crate::optics::snell::{reflect, refract};
use crate::settings::Settings;
use crate::stage::{Background, CompiledMaterial, Stage};
use crate::trace::interfaces::{InterfaceState, Interfaces, Travel, media_of, mirrored, onward, through_holes};
use crate::trace::media::{Media, WHITE};
use crate::trace::pane::{Pane, Passage};
use crate::trace::{Batch, Children, Integrator, Most, RayKind};

record! {
    /// What a ray carries.
    Carried,
    /// Its columns.
    CarriedColumns {
        /// What can be added to the pixel for each unit of radiance.
        throughput: Rgb,
    }
}

/// Real optics: Fresnel, total reflection, the inside of solids, absorption.
#[derive(Clone, Copy, Debug)]
pub struct Whitted {
    /// Rays that carry less than this part of what they could are not followed.
    min_throughput: f64,
}

impl Integrator for Whitted {
    type Propagation = Interfaces;
    type Carried = CarriedColumns;

    fn new(settings: &Settings) -> Self {
        Self { min_throughput: settings.min_throughput }
    }

    #[inline(always)]
    fn from_camera<L: Lanes>() -> Carried<L> {
        Carried { throughput: Rgb::gray(1.0).splat() }
    }

    #[inline(always)]
    fn throughput<L: Lanes>(carried: &Carried<L>) -> Rgb<L> {
        carried.throughput
    }

    #[inline(always)]
    fn arriving<L: Lanes>(hits: &Batch<'_, L, Interfaces>) -> Rgb<L> {
        hits.carried::<CarriedColumns>().throughput * hits.face().transmittance
    }

    #[inline(always)]
    fn asks_for_light<L: Lanes>(hits: &Batch<'_, L, Interfaces>) -> L::Mask {
        hits.active & hits.face().outer.gt(L::splat(0.0)) & opacity(hits).not_black()
    }

    #[inline(always)]
    fn scatter<L: Lanes>(
        self,
        hits: &Batch<'_, L, Interfaces>,
        state: &InterfaceState<'_>,
        children: &mut Children<Interfaces>,
    ) -> Rgb<L> {
        scatter(hits, &state.media, children)
    }

    fn ends_early(self) -> bool {
        self.min_throughput > 0.0
    }

    fn carries_too_little(self, stage: &Stage, carried: &Carried<f64>, travel: &Travel<f64>) -> bool {
        self.ends_early() && part_carried(stage, carried.throughput, index(travel.band) as u32) < self.min_throughput
    }

    fn most(material: &CompiledMaterial, brightest: Rgb) -> Most {
        let (ko, kr, clear) = (size(material.ko), size(material.kr), size(Rgb::gray(1.0) - material.ko));
        let dye = size(material.kd) * brightest;
        let dye = if material.tints > 0.0 {
            Rgb::new(dye.r.max(1.0), dye.g.max(1.0), dye.b.max(1.0))
        } else {
            Rgb::gray(1.0)
        };
        Most { local: ko, children: ko * kr + clear * dye }
    }
}

/// What a ray carries of what one of its band of light could, in the channel where that is most. A band is a small share of
/// white, of some channels next to none, and of any channel perhaps a negative one.
fn part_carried(stage: &Stage, throughput: Rgb, band: u32) -> f64 {
    let whole = if band == WHITE { Rgb::gray(1.0) } else { stage.bands[band as usize].weight };
    let parts = throughput.to_array().into_iter().zip(whole.to_array());
    parts.map(|(carried, whole)| if whole == 0.0 { 0.0 } else { (carried / whole).abs() }).fold(0.0, f64::max)
}

/// What of the light on the outer side does not go through.
#[inline(always)]
fn opacity<L: Lanes>(hits: &Batch<'_, L, Interfaces>) -> Rgb<L> {
    let face = hits.face();
    let ko = hits.material_color(
        #[inline(always)]
        |m| m.ko,
    );
    let coverage = hits.coverage();
    let whole = Rgb::select(face.before.eq(face.after) & !is_pane(hits), Rgb::gray(1.0).splat(), ko);
    whole * Rgb::new(coverage, coverage, coverage)
}

/// Which hits are on opaque surfaces that are only partly there?
#[inline(always)]
fn is_cut_out<L: Lanes>(hits: &Batch<'_, L, Interfaces>) -> L::Mask {
    let face = hits.face();
    let partly = hits.active & hits.coverage().lt(L::splat(1.0)) & face.before.eq(face.after);
    if partly.any() { partly & !is_pane(hits) } else { partly }
}

/// Which hits are on thin faces, whole panes?
#[inline(always)]
fn is_pane<L: Lanes>(hits: &Batch<'_, L, Interfaces>) -> L::Mask {
    let face = hits.face();
    if !(face.before.eq(face.after) & hits.active).any() {
        return L::Mask::from_bits(0);
    }
    let thickness = hits.material(
        #[inline(always)]
        |m| m.thickness,
    );
    hits.active & face.before.eq(face.after) & !thickness.lt(L::splat(0.0))
}

/// What the panes do, and from where rays go on behind them.
#[inline(always)]
fn through_panes<L: Lanes>(hits: &Batch<'_, L, Interfaces>, media: &Media<'_>) -> (Passage<L>, Vec3<L>) {
    let (wo, n, ng) = (hits.wo(), hits.normal(), hits.geometric_normal());
    let n = Vec3::select(wo.dot(n).gt(L::splat(0.0)), n, ng);
    let eta = L::from_fn(
        #[inline(always)]
        |lane| {
            let [before, _, band] = media_of(hits, lane);
            let own = hits.stage.eta_of(hits.material_number(lane), (band != WHITE).then_some(band));
            own / media.eta(before, band)
        },
    );
    let thickness = hits.material(
        #[inline(always)]
        |m| m.thickness,
    );
    let sigma_a = hits.material_color(
        #[inline(always)]
        |m| m.sigma_a,
    );
    let pane = Pane { thickness, eta, sigma_a };
    // By the face itself: the new start stays in its plane.
    (pane.passage(wo.dot(n)), pane.behind(hits.point(), ng, wo))
}

/// What is seen where nothing is.
#[inline(always)]
fn background<L: Lanes>(hits: &Batch<'_, L, Interfaces>) -> Rgb<L> {
    match &hits.stage.background {
        Background::Color(color) => color.splat(),
        sky => {
            let (there, dir) = (hits.is_sky().bits(), -hits.wo());
            Rgb::from_fn(
                #[inline(always)]
                |lane| if there >> lane & 1 == 0 { Rgb::gray(0.0) } else { sky.color(dir.lane(lane)) },
            )
        }
    }
}

/// What a batch of hits adds, and the mirror and refracted rays that leave. White rays that meet dispersion split into rays of bands.
#[inline(always)]
fn scatter<L: Lanes>(
    hits: &Batch<'_, L, Interfaces>,
    media: &Media<'_>,
    children: &mut Children<Interfaces>,
) -> Rgb<L> {
    let (zero, white, none) = (L::splat(0.0), Rgb::gray(1.0).splat::<L>(), Rgb::black());
    let (face, throughput) = (hits.face(), Whitted::arriving(hits));
    let outer = face.outer.gt(zero);
    let ko = Rgb::select(outer, opacity(hits), none);
    let kr = hits.material_color(
        #[inline(always)]
        |m| m.kr,
    );
    let emission = hits.material_color(
        #[inline(always)]
        |m| m.emission,
    );
    let (coverage, cut_out) = (hits.coverage(), is_cut_out(hits));
    let emission = Rgb::select(outer, emission * Rgb::new(coverage, coverage, coverage), none);
    let own = ko * hits.local_color() + emission;
    let contribution = throughput * Rgb::select(hits.is_sky(), background(hits), own);

    let tinted = hits.material(
        #[inline(always)]
        |m| m.tints,
    );
    let tints = outer & tinted.gt(zero) & !cut_out;
    let (clear, dye) = (white - ko, if tints.any() { Rgb::select(tints, hits.dye(), white) } else { white });

    let to = Directions::new(hits, relative_index(hits, media, None));
    let mut reflectance = Rgb::new(to.reflectance, to.reflectance, to.reflectance);
    let goes_through = !face.before.eq(face.after);
    let splits = if children.bands() == 0 { L::Mask::from_bits(0) } else { splitting(hits, media) };
    if splits.any() {
        let mut reflected = none;
        for number in 0..children.bands() {
            let share = hits.stage.bands[number].weight.splat::<L>();
            let to = Directions::new(hits, relative_index(hits, media, Some(number as u32)));
            let r = Rgb::new(to.reflectance, to.reflectance, to.reflectance);
            reflected = reflected + share * r;
            let throughput = throughput * (clear * dye) * (share * (white - r));
            let travel = onward(hits, to.refracted, face.after, L::splat(number as f64));
            let ray = hits.leaving(hits.point(), to.refracted, travel);
            let sends = hits.active & throughput.not_black() & splits & to.refracts;
            children.push_band::<L, CarriedColumns>(number, sends, &ray, &Carried { throughput });
        }
        reflectance = Rgb::select(splits, reflected, reflectance);
    }
    let (band, mut goes_on, mut transmittance) = (face.band, to.refracts & goes_through, white - reflectance);
    let (mut origin, mut dir) = (hits.point(), to.refracted);
    let panes = is_pane(hits);
    if panes.any() {
        let (passage, behind) = through_panes(hits, media);
        reflectance = Rgb::select(panes, passage.reflectance, reflectance);
        transmittance = Rgb::select(panes, passage.transmittance, transmittance);
        (origin, dir) = (Vec3::select(panes, behind, origin), Vec3::select(panes, -hits.wo(), dir));
        goes_on = goes_on | panes;
    }
    if cut_out.any() {
        reflectance = Rgb::select(cut_out, none, reflectance);
        transmittance = Rgb::select(cut_out, white, transmittance);
        dir = Vec3::select(cut_out, -hits.wo(), dir);
        goes_on = goes_on | cut_out;
    }
    let weight = throughput * (ko * kr + clear * reflectance);
    let mirror = hits.leaving(hits.point(), to.mirror, mirrored(hits, to.mirror, face.before, band));
    let sends = hits.active & weight.not_black();
    children.push::<L, CarriedColumns>(RayKind::Mirror, sends, &mirror, &Carried { throughput: weight });
    let weight = throughput * (clear * dye) * transmittance;
    let mut travel = onward(hits, dir, face.after, band);
    if cut_out.any() {
        travel = through_holes(hits, cut_out, dir, travel);
    }
    let refracted = hits.leaving(origin, dir, travel);
    let sends = hits.active & weight.not_black() & goes_on & !splits;
    children.push::<L, CarriedColumns>(RayKind::Refracted, sends, &refracted, &Carried { throughput: weight });
    contribution
}

/// `eta_t / eta_i`, for the band of each ray, or for one that white rays split into.
#[inline(always)]
fn relative_index<L: Lanes>(hits: &Batch<'_, L, Interfaces>, media: &Media<'_>, of: Option<u32>) -> L {
    L::from_fn(|lane| {
        let [before, after, band] = media_of(hits, lane);
        let band = of.unwrap_or(band);
        media.eta(after, band) / media.eta(before, band)
    })
}

/// Which rays are white and meet dispersion?
#[inline(always)]
fn splitting<L: Lanes>(hits: &Batch<'_, L, Interfaces>, media: &Media<'_>) -> L::Mask {
    let bits = (0..L::WIDTH).map(|lane| {
        let [before, after, band] = media_of(hits, lane);
        u32::from(band == WHITE && media.splits(before, after)) << lane
    });
    hits.active & L::Mask::from_bits(bits.sum())
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
    /// By the shading normal, which yields where it would send rays to the wrong side of the face.
    #[inline(always)]
    fn new(hits: &Batch<'_, L, Interfaces>, eta: L) -> Self {
        let (wo, n, ng, zero) = (hits.wo(), hits.normal(), hits.geometric_normal(), L::splat(0.0));
        let flat = Self::by(wo, ng, eta);
        if !(hits.active & !(n.x.eq(ng.x) & n.y.eq(ng.y) & n.z.eq(ng.z))).any() {
            return flat;
        }
        let shading = Self::by(wo, n, eta);
        let right = wo.dot(n).gt(zero)
            & shading.mirror.dot(ng).gt(zero)
            & (shading.refracted.dot(ng).lt(zero) | !shading.refracts);
        Self::select(right, shading, flat)
    }

    #[inline(always)]
    fn by(wo: Vec3<L>, n: Vec3<L>, eta: L) -> Self {
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
