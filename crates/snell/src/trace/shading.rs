//! The local colour of the hits: ambient light, then light by light, with shadows.

use super::hits::Hits;
use super::lecture::T_MIN;
use crate::film::Rgb;
use crate::geometry::Vec3;
use crate::geometry::bvh::{Nearest, PACKET, Packet};
use crate::lanes::{Columns, Lanes, Mask, index};
use crate::optics::phong::{self, Surface};
use crate::scene::Shadows;
use crate::world::{LightSource, World};

/// Columns of the rays towards a light.
const HIT: usize = 0;
const ORIGIN: usize = 1;

/// Rays towards one light; the memory is used again for the next one.
#[derive(Debug, Default)]
pub(crate) struct ShadowRays {
    /// For every hit the direction towards the light.
    wi: Columns<3>,
    /// Whether the light reaches it, a bit per hit.
    lit: Vec<u64>,
    /// Row of the hit, origin, direction, distance of the light, primitive that the ray leaves.
    rays: Columns<9>,
}

impl ShadowRays {
    /// Decides which hits a light reaches: those that face it, and, with shadows, see it. Returns how many rays that took.
    #[inline(always)]
    fn aim<L: Lanes>(&mut self, world: &World, hits: &Hits, light: &LightSource, packet: &mut Packet) -> usize {
        self.wi.clear();
        self.rays.clear();
        self.lit.clear();
        self.lit.resize(hits.len().div_ceil(64), 0);
        let with_shadows = world.render.shadows == Shadows::Opaque;
        let mut count = 0;
        for start in (0..hits.len()).step_by(L::WIDTH) {
            let batch = hits.batch::<L>(world, start);
            let (point, source) = (batch.point(), batch.primitive());
            let (wi, distance) = if light.at_infinity {
                (light.at.splat(), L::splat(f64::INFINITY))
            } else {
                let to_light = light.at.splat() - point;
                (to_light.unit(), to_light.length())
            };
            let mut lit = batch.active & batch.normal().dot(wi).gt(L::splat(0.0));
            self.wi.push(batch.active, wi.into());
            if with_shadows && lit.any() {
                count += lit.bits().count_ones() as usize;
                if let Some(spheres) = world.tree.few() {
                    let nothing = Nearest::none(lit, L::splat(T_MIN), distance, source);
                    lit = lit & !nothing.among(spheres, point, wi).hit;
                } else {
                    let (row, p) = (L::ramp(start), point);
                    self.rays.push(lit, [row, p.x, p.y, p.z, wi.x, wi.y, wi.z, distance, source]);
                }
            }
            self.lit[start / 64] |= u64::from(lit.bits()) << (start % 64);
        }
        self.block::<L>(world, packet);
        count
    }

    /// Takes the light from the hits whose rays towards it meet anything.
    #[inline(always)]
    fn block<L: Lanes>(&mut self, world: &World, packet: &mut Packet) {
        let shear = world.tree.has_triangles();
        for first in (0..self.rays.len()).step_by(PACKET) {
            let count = (self.rays.len() - first).min(PACKET);
            for start in (0..count).step_by(L::WIDTH) {
                let [x, y, z, dx, dy, dz, distance, source] = self.rays.group::<L, 8>(ORIGIN, first + start);
                packet.set(start, Vec3::new(x, y, z), Vec3::new(dx, dy, dz), L::splat(T_MIN), distance, source, shear);
            }
            let mut blocked = world.tree.intersect::<L, true>(packet, u64::MAX >> (PACKET - count));
            while blocked != 0 {
                let hit = index(self.rays.at(HIT, first + blocked.trailing_zeros() as usize));
                blocked &= blocked - 1;
                self.lit[hit / 64] &= !(1 << (hit % 64));
            }
        }
    }
}

/// Sums up the local colour of every hit. Returns how many shadow rays that took.
#[inline(always)]
pub(crate) fn local_colors<L: Lanes>(
    world: &World,
    hits: &mut Hits,
    shadow: &mut ShadowRays,
    packet: &mut Packet,
) -> usize {
    let ambient = world.ambient.splat::<L>();
    for start in (0..hits.len()).step_by(L::WIDTH) {
        let light = ambient * hits.batch::<L>(world, start).material_color(|m| m.ka);
        hits.set_local_color(start, light);
    }
    let mut rays = 0;
    for light in &world.lights {
        rays += shadow.aim::<L>(world, hits, light, packet);
        let intensity = light.color.splat::<L>();
        for start in (0..hits.len()).step_by(L::WIDTH) {
            let lit = L::Mask::from_bits((shadow.lit[start / 64] >> (start % 64)) as u32);
            if !lit.any() {
                continue;
            }
            let batch = hits.batch::<L>(world, start);
            let surface = Surface {
                kd: batch.material_color(|m| m.kd),
                ks: batch.material_color(|m| m.ks),
                spow: batch.material(|m| m.spow),
            };
            let [x, y, z] = shadow.wi.group(0, start);
            let before = batch.local_color();
            let [diffuse, highlight] =
                phong::light(lit, batch.normal(), batch.wo(), Vec3::new(x, y, z), intensity, &surface);
            hits.set_local_color(start, Rgb::select(lit, before + diffuse + highlight, before));
        }
    }
    rays
}
