//! The local colour of the hits: ambient light, then light by light, with shadows.

use super::hits::{Batch, Hits};
use super::leaving::{Leaving, back, until_clear};
use super::lecture::T_MIN;
use super::media::{Media, OUTSIDE};
use super::observer::Observer;
use super::whitted;
use crate::film::Rgb;
use crate::geometry::Vec3;
use crate::geometry::bvh::{Nearest, PACKET, Packet};
use crate::lanes::{Columns, Lanes, Mask, index};
use crate::optics::phong::{self, Surface};
use crate::scene::{Integrator, Shadows};
use crate::world::{LightSource, World};

/// Columns of the rays towards a light.
const HIT: usize = 0;
const ORIGIN: usize = 1;
const DISTANCE: usize = 7;
const CLEAR: usize = 9;

/// Rays towards one light; the memory is used again for the next one.
#[derive(Debug, Default)]
pub(crate) struct ShadowRays {
    /// For every hit the direction towards the light.
    wi: Columns<3>,
    /// Whether the light reaches it, a bit per hit.
    lit: Vec<u64>,
    /// Row of the hit, origin, direction, distance of the light, primitive that the ray leaves, and up to where nothing blocks the
    /// light: with real optics, without a closer look, and from a place in front of the hit.
    rays: Columns<10>,
    /// With tinted shadows what of the light reaches each hit.
    light: Columns<3>,
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
    fn aim<L: Lanes>(&mut self, media: &mut Media<'_>, hits: &Hits, light: &LightSource, packet: &mut Packet) -> usize {
        let world = media.world();
        self.wi.clear();
        self.rays.clear();
        self.lit.clear();
        self.lit.resize(hits.len().div_ceil(64), 0);
        let with_shadows = world.render.shadows() != Shadows::Off;
        let tinted = world.render.shadows() == Shadows::Tinted;
        self.light.clear();
        let real_optics = world.render.integrator == Integrator::Whitted;
        let mut count = 0;
        for start in (0..hits.len()).step_by(L::WIDTH) {
            let batch = hits.batch::<L>(world, start);
            let (point, source) = (batch.point(), batch.primitive());
            let (wi, distance) = light.seen_from(point);
            let shows = if real_optics { whitted::has_local_color(&batch) } else { batch.active };
            let mut lit = shows & batch.normal().dot(wi).gt(L::splat(0.0));
            if real_optics {
                // Light does not shine through the body of a smoothed mesh.
                lit = lit & batch.geometric_normal().dot(wi).gt(L::splat(0.0));
            }
            if let Some(spot) = &light.spot {
                lit = lit & spot.share(wi).gt(L::splat(0.0));
            }
            self.wi.push(L::Mask::first(hits.len() - start), wi.into());
            let mut asked = lit;
            if with_shadows && (tinted || lit.any()) {
                count += lit.bits().count_ones() as usize;
                if tinted {
                    self.light.push(L::Mask::first(hits.len() - start), Rgb::gray(1.0).splat::<L>().into());
                    // Within a medium every way is dimmed.
                    let within = lit & !batch.face().before.eq(L::splat(f64::from(OUTSIDE)));
                    asked = asked & !within;
                    lit = self.tint::<L>(media, &batch, start, lit, within, (wi, distance));
                }
                asked = asked & lit;
                if let Some(spheres) = world.tree.few_spheres() {
                    let t_min = if real_optics { 0.0 } else { T_MIN };
                    let nothing = Nearest::none(asked, L::splat(t_min), distance, source);
                    let hit = if real_optics {
                        nothing.among(true, spheres, point, wi).hit
                    } else {
                        nothing.among(false, spheres, point, wi).hit
                    };
                    lit = if tinted {
                        self.tint::<L>(media, &batch, start, lit, hit, (wi, distance))
                    } else {
                        lit & !hit
                    };
                } else {
                    let (row, mut p, mut clear) = (L::ramp(start), point, L::splat(T_MIN));
                    if real_optics {
                        p = point + batch.wo() * back(world, batch.t());
                        clear = until_clear(world, batch.geometric_normal().dot(wi));
                    }
                    self.rays.push(asked, [row, p.x, p.y, p.z, wi.x, wi.y, wi.z, distance, source, clear]);
                }
            }
            self.lit[start / 64] |= u64::from(lit.bits()) << (start % 64);
        }
        self.block::<L>(media, hits, packet);
        count
    }

    /// Follows the light of some of the lit hits straight through what is transparent; says which are lit then.
    #[inline(always)]
    fn tint<L: Lanes>(
        &mut self,
        media: &mut Media<'_>,
        hits: &Batch<'_, L>,
        start: usize,
        lit: L::Mask,
        dimmed: L::Mask,
        (wi, distance): (Vec3<L>, L),
    ) -> L::Mask {
        if !dimmed.any() {
            return lit;
        }
        let (source, medium, wo) = (hits.primitive(), hits.face().before, hits.wo());
        let point = hits.point() + wo * back(hits.world, hits.t());
        let clear = until_clear(hits.world, hits.geometric_normal().dot(wi));
        let mut dark = 0;
        for lane in 0..L::WIDTH {
            if dimmed.test(lane) {
                let way = Leaving {
                    origin: point.lane(lane),
                    dir: wi.lane(lane),
                    source: source.lane(lane),
                    clear: clear.lane(lane),
                    wo: wo.lane(lane),
                };
                let passed = media.light_along(&way, distance.lane(lane), index(medium.lane(lane)) as u32);
                dark |= u32::from(passed == Rgb::gray(0.0)) << lane;
                self.light.replace::<f64, 3>(0, start + lane, passed.into());
            }
        }
        lit & !L::Mask::from_bits(dark)
    }

    /// Takes the light from the hits whose rays towards it meet anything, or what that takes of it.
    #[inline(always)]
    fn block<L: Lanes>(&mut self, media: &mut Media<'_>, hits: &Hits, packet: &mut Packet) {
        let world = media.world();
        let tinted = world.render.shadows() == Shadows::Tinted;
        let real_optics = world.render.integrator == Integrator::Whitted;
        let shear = world.tree.needs_shears();
        for first in (0..self.rays.len()).step_by(PACKET) {
            let count = (self.rays.len() - first).min(PACKET);
            for start in (0..count).step_by(L::WIDTH) {
                let [x, y, z, dx, dy, dz, distance, source, clear] = self.rays.group::<L, 9>(ORIGIN, first + start);
                // A wall may be met a little behind the start, in the corner of a room.
                let t_min = if real_optics { L::splat(-world.behind) } else { clear };
                packet.set(start, Vec3::new(x, y, z), Vec3::new(dx, dy, dz), t_min, distance, source, shear);
            }
            let mut blocked = world.tree.intersect::<L, true>(packet, u64::MAX >> (PACKET - count));
            if real_optics {
                blocked = self.look_closer::<L>(world, hits, packet, first, blocked);
            }
            while blocked != 0 {
                let row = first + blocked.trailing_zeros() as usize;
                let hit = index(self.rays.at(HIT, row));
                blocked &= blocked - 1;
                let mut dark = true;
                if tinted {
                    let way = self.leaving(world, hits, row);
                    let passed = media.light_along(&way, self.rays.at(DISTANCE, row), OUTSIDE);
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
    fn look_closer<L: Lanes>(
        &self,
        world: &World,
        hits: &Hits,
        packet: &mut Packet,
        first: usize,
        mut blocked: u64,
    ) -> u64 {
        let (mut again, mut waiting) = (0, blocked);
        while waiting != 0 {
            let ray = waiting.trailing_zeros() as usize & (PACKET - 1);
            waiting &= waiting - 1;
            let [distance, clear] = [DISTANCE, CLEAR].map(|column| self.rays.at(column, first + ray));
            if packet.t[ray] <= clear && !self.leaving(world, hits, first + ray).is_blocked(world, distance) {
                blocked &= !(1 << ray);
                again |= 1 << ray;
                (packet.t_min[ray], packet.t[ray], packet.primitive[ray]) = (clear, distance, -1.0);
            }
        }
        if again == 0 { blocked } else { blocked | world.tree.intersect::<L, true>(packet, again) }
    }

    /// The ray of a row.
    fn leaving(&self, world: &World, hits: &Hits, row: usize) -> Leaving {
        let [x, y, z, dx, dy, dz, _, source, clear] = self.rays.group::<f64, 9>(ORIGIN, row);
        let wo = hits.batch::<f64>(world, index(self.rays.at(HIT, row))).wo();
        Leaving { origin: Vec3::new(x, y, z), dir: Vec3::new(dx, dy, dz), source, clear, wo }
    }
}

/// Sums up the local colour of every hit. Returns how many shadow rays that took.
#[inline(always)]
pub(crate) fn local_colors<L: Lanes>(
    media: &mut Media<'_>,
    hits: &mut Hits,
    shadow: &mut ShadowRays,
    packet: &mut Packet,
    observer: &mut impl Observer,
) -> usize {
    let world = media.world();
    let ambient = world.ambient.splat::<L>();
    for start in (0..hits.len()).step_by(L::WIDTH) {
        let light = ambient * hits.batch::<L>(world, start).patterned(|m| m.ka);
        hits.set_local_color(start, light);
    }
    observer.ambient(hits, world);
    let mut rays = 0;
    for light in &world.lights {
        rays += shadow.aim::<L>(media, hits, light, packet);
        observer.light(world, light, hits, shadow);
        for start in (0..hits.len()).step_by(L::WIDTH) {
            let lit = L::Mask::from_bits((shadow.lit[start / 64] >> (start % 64)) as u32);
            if !lit.any() {
                continue;
            }
            let batch = hits.batch::<L>(world, start);
            let before = batch.local_color();
            let [diffuse, highlight] = light_on(&batch, light, shadow, start);
            hits.set_local_color(start, Rgb::select(lit, before + diffuse + highlight, before));
        }
    }
    rays
}

/// What a light adds to the hits of a batch that it reaches: diffuse, and highlight.
#[inline(always)]
pub(super) fn light_on<L: Lanes>(
    batch: &Batch<'_, L>,
    light: &LightSource,
    shadow: &ShadowRays,
    start: usize,
) -> [Rgb<L>; 2] {
    let lit = L::Mask::from_bits((shadow.lit[start / 64] >> (start % 64)) as u32);
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
        let share = spot.share(wi);
        intensity = intensity * Rgb::new(share, share, share);
    }
    phong::light(lit, batch.normal(), batch.wo(), wi, intensity, &surface)
}
