//! The hits of a generation as columns, and a view of several of them at once.

use super::queue::{Columns, RayQueue, Weight};
use crate::film::Rgb;
use crate::geometry::Vec3;
use crate::lanes::{Lanes, Mask};
use crate::scene::Material;
use crate::world::World;

/// The hits of a generation, compacted, in the order of their rays.
#[derive(Debug, Default)]
pub(crate) struct Hits {
    /// Row of the ray in its queue.
    pub ray: Vec<u32>,
    pub primitive: Vec<u32>,
    pub t: Vec<f64>,
    pub point: Columns,
    /// Of unit length, facing the ray.
    pub normal: Columns,
    /// Towards where the ray came from.
    pub wo: Columns,
    /// The local colour while it is summed.
    pub local: Columns,
    /// What the hit adds to its pixel.
    pub contribution: Columns,
}

impl Hits {
    pub fn len(&self) -> usize {
        self.ray.len()
    }

    pub fn clear(&mut self) {
        let Self { ray, primitive, t, point, normal, wo, local, contribution } = self;
        ray.clear();
        primitive.clear();
        t.clear();
        for columns in [point, normal, wo, local, contribution] {
            columns.clear();
        }
    }

    /// Finds the closest hits of all rays.
    pub fn find<L: Lanes>(&mut self, world: &World, queue: &RayQueue) {
        self.clear();
        for start in (0..queue.len()).step_by(L::WIDTH) {
            let (ray, source, active) = queue.rays::<L>(start);
            let found = world.intersect(&ray, source, active);
            if !found.hit.any() {
                continue;
            }
            found.t.compress(found.hit, &mut self.t);
            self.point.compress(found.hit, ray.at(found.t).into());
            self.wo.compress(found.hit, (-ray.dir).into());
            for lane in (0..L::WIDTH).filter(|&i| found.hit.test(i)) {
                self.ray.push((start + lane) as u32);
                self.primitive.push(found.primitive.lane(lane) as u32);
            }
        }
        for row in 0..self.len() {
            let (point, dir) = (self.point.row(row).into(), -Vec3::from(self.wo.row(row)));
            self.normal.push(world.facing_normal(self.primitive[row], point, dir).into());
        }
        for start in (0..self.len()).step_by(L::WIDTH) {
            let active = L::Mask::first(self.len() - start);
            let unit = self.normal.vector::<L>(start).unit();
            self.normal.overwrite(start, active, unit.into());
        }
    }
}

/// The coefficients of a surface that decide how light goes on.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Coefficients<L: Lanes> {
    pub kr: Rgb<L>,
    pub ko: Rgb<L>,
}

/// The hits from one row on, one in each lane. Lanes beyond the end repeat the last hit and are not active.
#[derive(Clone, Copy)]
pub(crate) struct Batch<'a> {
    pub world: &'a World,
    queue: &'a RayQueue,
    hits: &'a Hits,
    start: usize,
}

impl<'a> Batch<'a> {
    pub fn new(world: &'a World, queue: &'a RayQueue, hits: &'a Hits, start: usize) -> Self {
        Self { world, queue, hits, start }
    }

    #[inline(always)]
    pub fn active<L: Lanes>(self) -> L::Mask {
        L::Mask::first(self.hits.len() - self.start)
    }

    #[inline(always)]
    pub fn point<L: Lanes>(self) -> Vec3<L> {
        self.hits.point.vector(self.start)
    }

    #[inline(always)]
    pub fn normal<L: Lanes>(self) -> Vec3<L> {
        self.hits.normal.vector(self.start)
    }

    #[inline(always)]
    pub fn wo<L: Lanes>(self) -> Vec3<L> {
        self.hits.wo.vector(self.start)
    }

    #[inline(always)]
    pub fn local_color<L: Lanes>(self) -> Rgb<L> {
        self.hits.local.color(self.start)
    }

    /// What the rays that hit here carry.
    #[inline(always)]
    pub fn weight<L: Lanes>(self) -> Weight<L> {
        let ray = |lane: usize| self.hits.ray[self.row(lane)] as usize;
        Weight {
            attenuation: Rgb::from_fn(|i| self.queue.attenuation.row(ray(i)).into()),
            factor: Rgb::from_fn(|i| self.queue.factor.row(ray(i)).into()),
        }
    }

    #[inline(always)]
    pub fn coefficients<L: Lanes>(self) -> Coefficients<L> {
        Coefficients { kr: self.material_color(|m| m.kr), ko: self.material_color(|m| m.ko) }
    }

    #[inline(always)]
    pub fn material<L: Lanes>(self, value: impl Fn(&Material) -> f64) -> L {
        L::from_fn(|i| value(self.material_of(i)))
    }

    #[inline(always)]
    pub fn material_color<L: Lanes>(self, value: impl Fn(&Material) -> Rgb) -> Rgb<L> {
        Rgb::from_fn(|i| value(self.material_of(i)))
    }

    #[inline(always)]
    pub fn is_sphere<L: Lanes>(self) -> L::Mask {
        let spheres = self.world.spheres.len();
        L::Mask::from_fn(|i| self.primitive(i) < spheres)
    }

    /// Centre of the sphere that was hit; for a triangle any point, which nobody looks at.
    #[inline(always)]
    pub fn center<L: Lanes>(self) -> Vec3<L> {
        Vec3::from_fn(|i| self.world.spheres.get(self.primitive(i)).map_or(Vec3::default(), |s| s.center))
    }

    #[inline(always)]
    fn row(self, lane: usize) -> usize {
        (self.start + lane).min(self.hits.len() - 1)
    }

    #[inline(always)]
    fn primitive(self, lane: usize) -> usize {
        self.hits.primitive[self.row(lane)] as usize
    }

    #[inline(always)]
    fn material_of(self, lane: usize) -> &'a Material {
        &self.world.materials[self.world.material_of[self.primitive(lane)] as usize]
    }
}
