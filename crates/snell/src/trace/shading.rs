//! The local colour of the hits: ambient light, then light by light, with shadows.

use super::hits::{Batch, Hits};
use super::lecture::T_MIN;
use super::queue::{Columns, RayQueue, ids};
use crate::geometry::Ray;
use crate::lanes::{Lanes, Mask};
use crate::optics::phong::{self, Surface};
use crate::scene::Shadows;
use crate::world::{LightSource, World};

/// Rays towards one light; the memory is used again for the next one.
#[derive(Debug, Default)]
pub(crate) struct ShadowRays {
    /// For every hit the direction towards the light, and whether the light reaches it.
    wi: Columns,
    lit: Vec<bool>,
    /// The compacted queue: row of the hit, ray, primitive that it leaves.
    hit: Vec<u32>,
    origin: Columns,
    dir: Columns,
    t_max: Vec<f64>,
    source: Vec<u32>,
}

impl ShadowRays {
    fn clear(&mut self) {
        let Self { wi, lit, hit, origin, dir, t_max, source } = self;
        for columns in [wi, origin, dir] {
            columns.clear();
        }
        lit.clear();
        for column in [hit, source] {
            column.clear();
        }
        t_max.clear();
    }

    /// Decides which hits a light reaches: those that face it, and, with shadows, see it.
    fn aim<L: Lanes>(&mut self, world: &World, hits: &Hits, light: &LightSource) {
        self.clear();
        let with_shadows = world.render.shadows == Shadows::Opaque;
        for start in (0..hits.len()).step_by(L::WIDTH) {
            let active = L::Mask::first(hits.len() - start);
            let (point, n) = (hits.point.vector::<L>(start), hits.normal.vector::<L>(start));
            let (wi, distance) = if light.at_infinity {
                (light.at.splat(), L::splat(f64::INFINITY))
            } else {
                let to_light = light.at.splat() - point;
                (to_light.unit(), to_light.length())
            };
            let faces = active & n.dot(wi).gt(L::splat(0.0));
            self.wi.compress(active, wi.into());
            self.lit.extend((0..L::WIDTH.min(hits.len() - start)).map(|lane| faces.test(lane)));
            if with_shadows && faces.any() {
                self.origin.compress(faces, point.into());
                self.dir.compress(faces, wi.into());
                distance.compress(faces, &mut self.t_max);
                for lane in (0..L::WIDTH).filter(|&i| faces.test(i)) {
                    self.hit.push((start + lane) as u32);
                    self.source.push(hits.primitive[start + lane]);
                }
            }
        }
        for start in (0..self.hit.len()).step_by(L::WIDTH) {
            let ray = Ray {
                origin: self.origin.vector(start),
                dir: self.dir.vector(start),
                t_min: L::splat(T_MIN),
                t_max: L::load(&self.t_max[start..]),
            };
            let active = L::Mask::first(self.hit.len() - start);
            let blocked = world.occluded(&ray, ids::<L>(&self.source, start), active);
            for lane in (0..L::WIDTH).filter(|&i| blocked.test(i)) {
                self.lit[self.hit[start + lane] as usize] = false;
            }
        }
    }
}

/// Sums up the local colour of every hit. Returns how many shadow rays that took.
pub(crate) fn local_colors<L: Lanes>(
    world: &World,
    queue: &RayQueue,
    hits: &mut Hits,
    shadow: &mut ShadowRays,
) -> usize {
    let ambient = world.ambient.splat::<L>();
    for start in (0..hits.len()).step_by(L::WIDTH) {
        let batch = Batch::new(world, queue, hits, start);
        let (active, light) = (batch.active::<L>(), ambient * batch.material_color(|m| m.ka));
        hits.local.compress(active, light.into());
    }
    let mut rays = 0;
    for light in &world.lights {
        shadow.aim::<L>(world, hits, light);
        rays += shadow.hit.len();
        let intensity = light.color.splat::<L>();
        for start in (0..hits.len()).step_by(L::WIDTH) {
            let count = L::WIDTH.min(hits.len() - start);
            let lit = L::Mask::from_fn(|i| i < count && shadow.lit[start + i]);
            if !lit.any() {
                continue;
            }
            let batch = Batch::new(world, queue, hits, start);
            let surface = Surface {
                kd: batch.material_color(|m| m.kd),
                ks: batch.material_color(|m| m.ks),
                spow: batch.material(|m| m.spow),
            };
            let wi = shadow.wi.vector(start);
            let [diffuse, highlight] = phong::light(lit, batch.normal(), batch.wo(), wi, intensity, &surface);
            let sum = batch.local_color::<L>() + diffuse + highlight;
            hits.local.overwrite(start, lit, sum.into());
        }
    }
    rays
}
