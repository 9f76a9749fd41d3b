//! The local colour of the hits: ambient light, then light by light, with shadows.

use super::hits::{Batch, Hits};
use super::leaving::Leaving;
use super::media::OUTSIDE;
use super::observer::Observer;
use super::propagation::Propagation;
use crate::color::Rgb;
use crate::geometry::Vec3;
use crate::geometry::bvh::{Nearest, PACKET, Packet};
use crate::lanes::{Columns, Kernel, Lanes, Mask, Number, Table, index, table};
use crate::optics::phong::{self, Surface};
use crate::settings::Shadows;
use crate::stage::{LightSource, Stage};
use alloc::vec::Vec;

table! {
    /// A ray towards a light.
    ShadowRay,
    /// The same in columns.
    ShadowRayColumns {
        /// Row of the hit.
        hit: Number,
        origin: Vec3,
        dir: Vec3,
        /// Of the light.
        distance: Number,
        /// The primitive that the ray leaves.
        source: Number,
        /// Up to here nothing blocks the light, with surfaces that are met from both sides without a closer look.
        clear_at: Number,
    }
}

/// Rays towards one light; the memory is used again for the next one.
#[derive(Debug, Default)]
pub struct ShadowRays {
    /// For every hit the direction towards the light.
    wi: Columns<3>,
    /// Whether the light reaches it, a bit per hit.
    lit: Vec<u64>,
    rays: ShadowRayColumns,
    /// With tinted shadows what of the light reaches each hit.
    light: Columns<3>,
}

/// What shadow rays need of their worker.
pub struct Scenery<'b, 'a, P: Propagation> {
    pub stage: &'b Stage,
    pub shadows: Shadows,
    pub state: &'b mut P::State<'a>,
    pub packet: &'b mut Packet,
}

impl ShadowRays {
    /// Does the light reach this hit?
    pub fn is_lit(&self, row: usize) -> bool {
        self.lit[row / 64] >> (row % 64) & 1 != 0
    }

    /// With tinted shadows what of the light reaches this hit.
    pub fn left(&self, row: usize) -> Option<Rgb> {
        (self.light.len() > 0).then(|| [0, 1, 2].map(|channel| self.light.at(channel, row)).into())
    }

    /// Decides which hits a light reaches: those that face it, and, with shadows, see it. Returns how many rays that took.
    #[inline(always)]
    fn aim<L: Lanes, P: Propagation>(
        &mut self,
        scenery: &mut Scenery<'_, '_, P>,
        hits: &Hits<P>,
        light: &LightSource,
        asks: &[u64],
    ) -> usize {
        let (stage, tinted) = (scenery.stage, scenery.shadows == Shadows::Tinted);
        self.wi.clear();
        self.rays.clear();
        self.lit.clear();
        self.lit.resize(hits.len().div_ceil(64), 0);
        self.light.clear();
        let mut count = 0;
        for start in (0..hits.len()).step_by(L::WIDTH) {
            let batch = hits.batch::<L>(stage, start);
            let (point, source) = (batch.point(), batch.primitive());
            let (wi, distance) = light.seen_from(point);
            let mut lit = bits_at::<L>(asks, start) & faces(&batch, wi);
            if let Some(spot) = &light.spot {
                lit = lit & spot.falloff(wi).gt(L::splat(0.0));
            }
            self.wi.push(L::Mask::first(hits.len() - start), wi.into());
            let mut asked = lit;
            if scenery.shadows != Shadows::Off && (tinted || lit.any()) {
                count += lit.bits().count_ones() as usize;
                if tinted {
                    self.light.push(L::Mask::first(hits.len() - start), Rgb::gray(1.0).splat::<L>().into());
                    // Within a medium all light is dimmed.
                    let within = lit & !P::medium_before(&batch).eq(L::splat(f64::from(OUTSIDE)));
                    asked = asked & !within;
                    lit = self.tint::<L, P>(scenery, &batch, start, lit, within, (wi, distance));
                }
                asked = asked & lit;
                if let Some(spheres) = stage.tree.few_spheres() {
                    let nothing = Nearest::none(asked, L::splat(P::T_MIN), distance, source);
                    let hit = nothing.among(P::TWO_SIDED, spheres, point, wi).hit;
                    lit = if tinted {
                        self.tint::<L, P>(scenery, &batch, start, lit, hit, (wi, distance))
                    } else {
                        lit & !hit
                    };
                } else {
                    let (origin, clear) = P::shadow_start(&batch, wi);
                    let hit = L::ramp(start);
                    self.rays.push(asked, &ShadowRay { hit, origin, dir: wi, distance, source, clear_at: clear });
                }
            }
            self.lit[start / 64] |= u64::from(lit.bits()) << (start % 64);
        }
        self.block::<L, P>(scenery, hits);
        count
    }

    /// Follows the light of some of the lit hits straight through what is transparent; says which are lit then.
    #[inline(always)]
    fn tint<L: Lanes, P: Propagation>(
        &mut self,
        scenery: &mut Scenery<'_, '_, P>,
        hits: &Batch<'_, L, P>,
        start: usize,
        lit: L::Mask,
        dimmed: L::Mask,
        (wi, distance): (Vec3<L>, L),
    ) -> L::Mask {
        if !dimmed.any() {
            return lit;
        }
        let (source, medium, wo) = (hits.primitive(), P::medium_before(hits), hits.wo());
        let (origin, clear) = P::shadow_start(hits, wi);
        let mut dark = 0;
        for lane in 0..L::WIDTH {
            if dimmed.test(lane) {
                let ray = Leaving {
                    origin: origin.lane(lane),
                    dir: wi.lane(lane),
                    source: source.lane(lane),
                    clear: clear.lane(lane),
                    wo: wo.lane(lane),
                };
                let medium = index(medium.lane(lane)) as u32;
                let passed = P::light_along(scenery.state, &ray, distance.lane(lane), medium);
                dark |= u32::from(passed == Rgb::gray(0.0)) << lane;
                self.light.replace::<f64, 3>(0, start + lane, passed.into());
            }
        }
        lit & !L::Mask::from_bits(dark)
    }

    /// Takes the light from the hits whose rays towards it meet anything, or what that takes of it.
    #[inline(always)]
    fn block<L: Lanes, P: Propagation>(&mut self, scenery: &mut Scenery<'_, '_, P>, hits: &Hits<P>) {
        let stage = scenery.stage;
        let shear = stage.tree.needs_shears();
        for first in (0..self.rays.len()).step_by(PACKET) {
            let count = (self.rays.len() - first).min(PACKET);
            for start in (0..count).step_by(L::WIDTH) {
                let ShadowRay { origin, dir, distance, source, clear_at, .. } = self.rays.rows::<L>(first + start);
                // A wall may be met a little behind the start, in the corner of a room.
                let t_min = if P::TWO_SIDED { L::splat(-stage.exit_tolerance) } else { clear_at };
                scenery.packet.set(start, origin, dir, t_min, distance, source, shear);
            }
            let mut blocked = stage.tree.intersect::<L, true>(scenery.packet, u64::MAX >> (PACKET - count));
            if P::TWO_SIDED {
                blocked = self.look_closer::<L, P>(scenery, hits, first, blocked);
            }
            while blocked != 0 {
                let row = first + blocked.trailing_zeros() as usize;
                let hit = index(self.rays.hit(row));
                blocked &= blocked - 1;
                let mut dark = true;
                if scenery.shadows == Shadows::Tinted {
                    let ray = self.leaving(stage, hits, row);
                    let passed = P::light_along(scenery.state, &ray, self.rays.distance(row), OUTSIDE);
                    self.light.replace::<f64, 3>(0, hit, passed.into());
                    dark = passed == Rgb::gray(0.0);
                }
                if dark {
                    self.lit[hit / 64] &= !(1 << (hit % 64));
                }
            }
        }
    }

    /// Which of the blocked rays of a packet are still blocked, if what is only a part of the place that they leave does not count.
    #[inline(always)]
    fn look_closer<L: Lanes, P: Propagation>(
        &self,
        scenery: &mut Scenery<'_, '_, P>,
        hits: &Hits<P>,
        first: usize,
        mut blocked: u64,
    ) -> u64 {
        let Scenery { stage, packet, shadows, .. } = scenery;
        let (mut again, mut waiting) = (0, blocked);
        while waiting != 0 {
            let ray = waiting.trailing_zeros() as usize & (PACKET - 1);
            waiting &= waiting - 1;
            let (distance, clear) = (self.rays.distance(first + ray), self.rays.clear_at(first + ray));
            if packet.t[ray] <= clear && !self.leaving(stage, hits, first + ray).is_blocked(stage, distance, *shadows) {
                blocked &= !(1 << ray);
                again |= 1 << ray;
                (packet.t_min[ray], packet.t[ray], packet.primitive[ray]) = (clear, distance, -1.0);
            }
        }
        if again == 0 { blocked } else { blocked | stage.tree.intersect::<L, true>(packet, again) }
    }

    /// The ray of a row.
    fn leaving<P: Propagation>(&self, stage: &Stage, hits: &Hits<P>, row: usize) -> Leaving {
        let ShadowRay { hit, origin, dir, source, clear_at, .. } = self.rays.rows::<f64>(row);
        Leaving { origin, dir, source, clear: clear_at, wo: hits.batch::<f64>(stage, index(hit)).wo() }
    }
}

/// Which hits face a light in this direction? Light does not shine through the body of a smoothed mesh, either.
#[inline(always)]
pub(super) fn faces<L: Lanes, P: Propagation>(hits: &Batch<'_, L, P>, wi: Vec3<L>) -> L::Mask {
    let faces = hits.active & hits.normal().dot(wi).gt(L::splat(0.0));
    if P::TWO_SIDED { faces & hits.geometric_normal().dot(wi).gt(L::splat(0.0)) } else { faces }
}

/// The bits of some hits, from a row on.
#[inline(always)]
fn bits_at<L: Lanes>(bits: &[u64], start: usize) -> L::Mask {
    L::Mask::from_bits((bits[start / 64] >> (start % 64)) as u32)
}

/// Sums up the local colour of every hit, and says how many shadow rays that took.
pub struct LocalColors<'c, 'b, 'a, P: Propagation, O> {
    pub scenery: Scenery<'b, 'a, P>,
    pub hits: &'c mut Hits<P>,
    pub shadow: &'c mut ShadowRays,
    pub observer: &'c mut O,
    /// Which hits ask for lights, a bit for each.
    pub asks: &'c [u64],
}

impl<P: Propagation, O: Observer> Kernel for LocalColors<'_, '_, '_, P, O> {
    type Output = usize;
    #[inline(always)]
    fn run<L: Lanes>(self) -> usize {
        let Self { mut scenery, hits, shadow, observer, asks } = self;
        let stage = scenery.stage;
        let ambient = stage.ambient.splat::<L>();
        for start in (0..hits.len()).step_by(L::WIDTH) {
            let light = ambient * hits.batch::<L>(stage, start).patterned(|m| m.ka);
            hits.set_local_color(start, light);
        }
        observer.ambient(hits, stage);
        let mut rays = 0;
        for light in &stage.lights {
            rays += shadow.aim::<L, P>(&mut scenery, hits, light, asks);
            observer.light(stage, scenery.shadows, light, hits, asks, shadow);
            for start in (0..hits.len()).step_by(L::WIDTH) {
                let lit = bits_at::<L>(&shadow.lit, start);
                if !lit.any() {
                    continue;
                }
                let batch = hits.batch::<L>(stage, start);
                let before = batch.local_color();
                let [diffuse, highlight] = light_on(&batch, light, shadow, start);
                hits.set_local_color(start, Rgb::select(lit, before + diffuse + highlight, before));
            }
        }
        rays
    }
}

/// What a light adds to the hits of a batch that it reaches: diffuse, and highlight.
#[inline(always)]
pub(super) fn light_on<L: Lanes, P: Propagation>(
    batch: &Batch<'_, L, P>,
    light: &LightSource,
    shadow: &ShadowRays,
    start: usize,
) -> [Rgb<L>; 2] {
    let lit = bits_at::<L>(&shadow.lit, start);
    let surface =
        Surface { kd: batch.patterned(|m| m.kd), ks: batch.material_color(|m| m.ks), spow: batch.material(|m| m.spow) };
    let mut intensity = light.color.splat::<L>();
    if shadow.light.len() > 0 {
        let [r, g, b] = shadow.light.group(0, start);
        intensity = intensity * Rgb::new(r, g, b);
    }
    let [x, y, z] = shadow.wi.group(0, start);
    let wi = Vec3::new(x, y, z);
    if let Some(spot) = &light.spot {
        let falloff = spot.falloff(wi);
        intensity = intensity * Rgb::new(falloff, falloff, falloff);
    }
    phong::light(lit, batch.normal(), batch.wo(), wi, intensity, &surface)
}
