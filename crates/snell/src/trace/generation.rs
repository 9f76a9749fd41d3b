//! One tile, from camera rays to finished pixels.

use super::lecture::{self, Coefficients, Weight};
use super::queue::{Columns, RayKind, RayQueue, ids};
use super::statistics::Statistics;
use crate::film::Rgb;
use crate::geometry::{Ray, Vec3};
use crate::lanes::{Lanes, Mask};
use crate::optics::phong::{self, Surface};
use crate::optics::snell;
use crate::scene::{Material, Shadows};
use crate::world::{LightSource, World};
use std::sync::atomic::{AtomicBool, Ordering};

/// A generation with more rays than this is split by pixels. It bounds the memory of the queues.
const GENERATION_BUDGET: usize = 1 << 16;

/// A pixel with more rays than this gets no more; the rest counts as lost light.
const RAYS_PER_PIXEL: u32 = 1 << 20;

/// Sees every generation when it is done, with its rays, hits and contributions.
pub(crate) trait Observer {
    fn generation(&mut self, queue: &RayQueue, hits: &Hits);
}

/// Looks at nothing: plain rendering.
impl Observer for () {
    #[inline(always)]
    fn generation(&mut self, _queue: &RayQueue, _hits: &Hits) {}
}

/// The hits of a generation, compacted, in the order of their rays.
#[derive(Debug, Default)]
pub(crate) struct Hits {
    /// Row of the ray in its queue.
    pub ray: Vec<u32>,
    pub primitive: Vec<u32>,
    pub t: Vec<f64>,
    pub point: Columns,
    /// Facing the ray; of unit length once [`Tracer::surfaces`] has run.
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

    fn clear(&mut self) {
        let Self { ray, primitive, t, point, normal, wo, local, contribution } = self;
        ray.clear();
        primitive.clear();
        t.clear();
        for columns in [point, normal, wo, local, contribution] {
            columns.clear();
        }
    }
}

/// Rays towards one light.
#[derive(Debug, Default)]
struct Shadow {
    /// Direction and cosine for every hit.
    wi: Columns,
    faces_light: Vec<bool>,
    lit: Vec<bool>,
    /// The compacted queue: row of the hit, ray, primitive that it leaves.
    hit: Vec<u32>,
    origin: Columns,
    dir: Columns,
    t_max: Vec<f64>,
    source: Vec<u32>,
}

impl Shadow {
    fn clear(&mut self) {
        let Self { wi, faces_light, lit, hit, origin, dir, t_max, source } = self;
        for columns in [wi, origin, dir] {
            columns.clear();
        }
        for flags in [faces_light, lit] {
            flags.clear();
        }
        for column in [hit, source] {
            column.clear();
        }
        t_max.clear();
    }
}

/// What the tracing of a tile needs to know besides the world.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Settings<'a> {
    /// Set to stop as soon as possible.
    pub cancel: Option<&'a AtomicBool>,
}

/// A worker: it owns the queues, which are used again for every tile.
#[derive(Debug)]
pub(crate) struct Tracer<'a, L, O> {
    world: &'a World,
    settings: Settings<'a>,
    pub observer: O,
    pub statistics: Statistics,
    hits: Hits,
    shadow: Shadow,
    refracted: RayQueue,
    /// Generations that wait: the depth and the rays.
    waiting: Vec<(u32, RayQueue)>,
    /// Queues that wait to be used again.
    spare: Vec<RayQueue>,
    /// Radiance and number of rays of each pixel of the tile, and the throughput it lost.
    radiance: Vec<Rgb>,
    rays_of: Vec<u32>,
    lost: Vec<f64>,
    lanes: std::marker::PhantomData<L>,
}

impl<'a, L: Lanes, O: Observer> Tracer<'a, L, O> {
    pub fn new(world: &'a World, settings: Settings<'a>, observer: O) -> Self {
        Self {
            world,
            settings,
            observer,
            statistics: Statistics::default(),
            hits: Hits::default(),
            shadow: Shadow::default(),
            refracted: RayQueue::default(),
            waiting: Vec::new(),
            spare: Vec::new(),
            radiance: Vec::new(),
            rays_of: Vec::new(),
            lost: Vec::new(),
            lanes: std::marker::PhantomData,
        }
    }

    /// Traces some pixels of the whole picture, given by column and row, and returns their radiance in the same order;
    /// `None` if it was cancelled on the way.
    pub fn trace(&mut self, pixels: &[(u32, u32)]) -> Option<&[Rgb]> {
        let count = pixels.len();
        self.radiance.clear();
        self.radiance.resize(count, Rgb::black());
        self.rays_of.clear();
        self.rays_of.resize(count, 0);
        self.lost.clear();
        self.lost.resize(count, 0.0);

        let mut camera_rays = self.spare.pop().unwrap_or_default();
        camera_rays.clear();
        for (i, &(x, y)) in pixels.iter().enumerate() {
            let (origin, dir) = self.world.camera.ray(x, y);
            camera_rays.push_camera_ray(i as u32, origin, dir, lecture::T_MIN);
        }
        self.waiting.push((0, camera_rays));
        while let Some((depth, queue)) = self.waiting.pop() {
            if self.settings.cancel.is_some_and(|c| c.load(Ordering::Relaxed)) {
                self.waiting.clear();
                return None;
            }
            let children = self.generation(depth, &queue);
            self.spare.push(queue);
            self.enqueue(depth + 1, children);
        }
        self.count_lost_light(pixels);
        Some(&self.radiance)
    }

    /// Lets a generation wait, in two parts if it is large. Splitting goes by pixels and keeps the order of rays, so no
    /// pixel sees a difference.
    fn enqueue(&mut self, depth: u32, queue: RayQueue) {
        let (Some(&low), Some(&high)) = (queue.pixel.iter().min(), queue.pixel.iter().max()) else {
            self.spare.push(queue);
            return;
        };
        if queue.len() <= GENERATION_BUDGET || low == high {
            self.waiting.push((depth, queue));
            return;
        }
        let middle = low + (high - low) / 2;
        let mut halves = [(); 2].map(|()| self.spare.pop().unwrap_or_default());
        for half in &mut halves {
            half.clear();
        }
        for row in 0..queue.len() {
            halves[usize::from(queue.pixel[row] > middle)].copy_row(&queue, row);
        }
        self.spare.push(queue);
        let [first, second] = halves;
        self.enqueue(depth, second);
        self.enqueue(depth, first);
    }

    /// Traces one generation, adds what it contributes, and returns its children.
    fn generation(&mut self, depth: u32, queue: &RayQueue) -> RayQueue {
        for (row, &kind) in queue.kind.iter().enumerate() {
            self.statistics.rays.add(kind);
            self.rays_of[queue.pixel[row] as usize] += 1;
        }
        self.statistics.count_generation(depth, queue.len() as u64);

        self.closest_hits(queue);
        self.surfaces();
        self.local_colors();
        self.contributions(queue);
        for (row, &ray) in self.hits.ray.iter().enumerate() {
            let pixel = &mut self.radiance[queue.pixel[ray as usize] as usize];
            *pixel = *pixel + Rgb::from(self.hits.contribution.row(row));
        }
        self.observer.generation(queue, &self.hits);

        let mut children = self.spare.pop().unwrap_or_default();
        children.clear();
        self.spawn(queue, &mut children);
        self.limit(depth, &mut children);
        children
    }

    /// Closest hits, compacted.
    fn closest_hits(&mut self, queue: &RayQueue) {
        self.hits.clear();
        for start in (0..queue.len()).step_by(L::WIDTH) {
            let (ray, source, active) = queue.rays::<L>(start);
            let found = self.world.intersect(&ray, source, active);
            if !found.hit.any() {
                continue;
            }
            let point = ray.at(found.t);
            let hits = &mut self.hits;
            found.t.compress(found.hit, &mut hits.t);
            hits.point.compress(found.hit, point.into());
            hits.wo.compress(found.hit, (-ray.dir).into());
            for lane in (0..L::WIDTH).filter(|&i| found.hit.test(i)) {
                hits.ray.push((start + lane) as u32);
                hits.primitive.push(found.primitive.lane(lane) as u32);
            }
        }
    }

    /// Unit normals that face their rays.
    fn surfaces(&mut self) {
        let hits = &mut self.hits;
        for row in 0..hits.ray.len() {
            let (point, wo) = (Vec3::from(hits.point.row(row)), Vec3::from(hits.wo.row(row)));
            hits.normal.push(self.world.facing_normal(hits.primitive[row], point, -wo).into());
        }
        for start in (0..hits.len()).step_by(L::WIDTH) {
            let unit = hits.normal.vector::<L>(start).unit();
            for lane in 0..L::WIDTH.min(hits.ray.len() - start) {
                let n = unit.lane(lane);
                (hits.normal.x[start + lane], hits.normal.y[start + lane], hits.normal.z[start + lane]) =
                    (n.x, n.y, n.z);
            }
        }
    }

    /// The local colour of every hit: ambient light, then light by light.
    fn local_colors(&mut self) {
        let ambient = self.world.ambient.splat::<L>();
        for start in (0..self.hits.len()).step_by(L::WIDTH) {
            let active = L::Mask::first(self.hits.len() - start);
            let ka = self.material_color(start, |m| m.ka);
            self.hits.local.compress(active, (ambient * ka).into());
        }
        for light in &self.world.lights {
            self.shadows(light);
            self.add_light(light);
        }
    }

    /// Decides which hits a light reaches.
    fn shadows(&mut self, light: &LightSource) {
        let (hits, shadow) = (&self.hits, &mut self.shadow);
        shadow.clear();
        let with_shadows = self.world.render.shadows == Shadows::Opaque;
        for start in (0..hits.len()).step_by(L::WIDTH) {
            let active = L::Mask::first(hits.len() - start);
            let (point, n) = (hits.point.vector::<L>(start), hits.normal.vector::<L>(start));
            let (wi, distance) = if light.at_infinity {
                (light.at.splat(), L::splat(f64::INFINITY))
            } else {
                let to_light = light.at.splat() - point;
                let distance = to_light.length();
                (to_light.unit(), distance)
            };
            let faces = active & n.dot(wi).gt(L::splat(0.0));
            shadow.wi.compress(active, wi.into());
            for lane in 0..L::WIDTH.min(hits.len() - start) {
                shadow.faces_light.push(faces.test(lane));
                shadow.lit.push(faces.test(lane));
            }
            if with_shadows && faces.any() {
                shadow.origin.compress(faces, point.into());
                shadow.dir.compress(faces, wi.into());
                distance.compress(faces, &mut shadow.t_max);
                for lane in (0..L::WIDTH).filter(|&i| faces.test(i)) {
                    shadow.hit.push((start + lane) as u32);
                    shadow.source.push(hits.primitive[start + lane]);
                }
            }
        }
        self.statistics.rays.shadow += shadow.hit.len() as u64;
        for start in (0..shadow.hit.len()).step_by(L::WIDTH) {
            let ray = Ray {
                origin: shadow.origin.vector(start),
                dir: shadow.dir.vector(start),
                t_min: L::splat(lecture::T_MIN),
                t_max: L::load(&shadow.t_max[start..]),
            };
            let active = L::Mask::first(shadow.hit.len() - start);
            let blocked = self.world.occluded(&ray, ids::<L>(&shadow.source, start), active);
            for lane in (0..L::WIDTH).filter(|&i| blocked.test(i)) {
                shadow.lit[shadow.hit[start + lane] as usize] = false;
            }
        }
    }

    /// Adds a light to the hits that it reaches.
    fn add_light(&mut self, light: &LightSource) {
        let intensity = light.color.splat::<L>();
        for start in (0..self.hits.len()).step_by(L::WIDTH) {
            let count = L::WIDTH.min(self.hits.len() - start);
            let lit = L::Mask::from_fn(|i| i < count && self.shadow.lit[start + i]);
            if !lit.any() {
                continue;
            }
            let surface = Surface {
                kd: self.material_color(start, |m| m.kd),
                ks: self.material_color(start, |m| m.ks),
                spow: self.material(start, |m| m.spow),
            };
            let (n, wo) = (self.hits.normal.vector(start), self.hits.wo.vector(start));
            let [diffuse, highlight] = phong::light(lit, n, wo, self.shadow.wi.vector(start), intensity, &surface);
            let sum = self.hits.local.color::<L>(start) + diffuse + highlight;
            for lane in (0..count).filter(|&i| lit.test(i)) {
                let c = sum.lane(lane);
                let local = &mut self.hits.local;
                (local.x[start + lane], local.y[start + lane], local.z[start + lane]) = (c.r, c.g, c.b);
            }
        }
    }

    /// What every hit adds to its pixel.
    fn contributions(&mut self, queue: &RayQueue) {
        for start in (0..self.hits.len()).step_by(L::WIDTH) {
            let active = L::Mask::first(self.hits.len() - start);
            let weight = lecture::local(self.world.render.integrator, &self.weight(queue, start), &self.surface(start));
            let added = weight * self.hits.local.color::<L>(start);
            self.hits.contribution.compress(active, added.into());
        }
    }

    /// The children of all hits: the mirror rays, then the refracted rays, each in their parents' order.
    fn spawn(&mut self, queue: &RayQueue, children: &mut RayQueue) {
        let model = self.world.render.integrator;
        let mut refracted = std::mem::take(&mut self.refracted);
        refracted.clear();
        for start in (0..self.hits.len()).step_by(L::WIDTH) {
            let active = L::Mask::first(self.hits.len() - start);
            let (weight, surface) = (self.weight(queue, start), self.surface(start));
            let (p, n) = (self.hits.point.vector::<L>(start), self.hits.normal.vector::<L>(start));
            let wo = self.hits.wo.vector::<L>(start);

            let mirror = lecture::mirror(model, &weight, &surface);
            let carries = active & (mirror.factor * mirror.attenuation).not_black();
            self.push(children, queue, RayKind::Mirror, start, carries, p, snell::reflect(wo, n), &mirror);

            let through = lecture::refracted(model, &weight, &surface);
            let carries = active
                & lecture::refracts(&surface)
                & (through.factor * through.attenuation).not_black()
                & self.is_sphere(start);
            if carries.any() {
                let center = Vec3::from_fn(|i| self.center(start + i));
                let eta_inside = self.material(start, |m| m.eta);
                let eta_outside = L::splat(self.world.eta_outside);
                let (exit, wi, leaves) = snell::through_sphere(p, n, wo, center, eta_outside, eta_inside);
                self.push(&mut refracted, queue, RayKind::Refracted, start, carries & leaves, exit, wi, &through);
            }
        }
        for row in 0..refracted.len() {
            children.copy_row(&refracted, row);
        }
        self.refracted = refracted;
    }

    #[expect(clippy::too_many_arguments, reason = "one row of a queue has this many columns")]
    #[inline(always)]
    fn push(
        &self,
        to: &mut RayQueue,
        parents: &RayQueue,
        kind: RayKind,
        start: usize,
        mask: L::Mask,
        origin: Vec3<L>,
        dir: Vec3<L>,
        weight: &Weight<L>,
    ) {
        to.origin.compress(mask, origin.into());
        to.dir.compress(mask, dir.into());
        to.attenuation.compress(mask, weight.attenuation.into());
        to.factor.compress(mask, weight.factor.into());
        for lane in (0..L::WIDTH).filter(|&i| mask.test(i)) {
            let ray = self.hits.ray[start + lane];
            to.t_min.push(lecture::T_MIN);
            to.pixel.push(parents.pixel[ray as usize]);
            to.source.push(self.hits.primitive[start + lane]);
            to.kind.push(kind);
            to.parent.push(ray);
        }
    }

    /// Ends what is beyond the depth limit or the limit of rays per pixel, and counts it as lost.
    fn limit(&mut self, depth: u32, children: &mut RayQueue) {
        let too_deep = depth >= self.world.render.max_depth;
        let most = self.rays_of.iter().copied().max().unwrap_or(0) as usize;
        if !too_deep && most + children.len() <= RAYS_PER_PIXEL as usize {
            return;
        }
        let mut kept = self.spare.pop().unwrap_or_default();
        kept.clear();
        let mut planned = self.rays_of.clone();
        for row in 0..children.len() {
            let pixel = children.pixel[row] as usize;
            if too_deep || planned[pixel] >= RAYS_PER_PIXEL {
                let Rgb { r, g, b } = children.throughput(row);
                self.lost[pixel] += Rgb::new(r.abs(), g.abs(), b.abs()).mean();
                self.statistics.lost.rays += 1;
            } else {
                planned[pixel] += 1;
                kept.copy_row(children, row);
            }
        }
        std::mem::swap(children, &mut kept);
        self.spare.push(kept);
    }

    fn count_lost_light(&mut self, pixels: &[(u32, u32)]) {
        let width = u64::from(self.world.camera.size[0]);
        for (&(x, y), &lost) in pixels.iter().zip(&self.lost) {
            if lost > 0.0 {
                self.statistics.lost.add(u64::from(y) * width + u64::from(x), lost);
            }
        }
    }

    // Columns gathered for the hits from a row on.

    /// The row of a lane; lanes beyond the end repeat the last hit.
    #[inline(always)]
    fn row(&self, row: usize) -> usize {
        row.min(self.hits.len() - 1)
    }

    #[inline(always)]
    fn material_of(&self, row: usize) -> &Material {
        let primitive = self.hits.primitive[self.row(row)] as usize;
        &self.world.materials[self.world.material_of[primitive] as usize]
    }

    #[inline(always)]
    fn material(&self, start: usize, value: impl Fn(&Material) -> f64) -> L {
        L::from_fn(|i| value(self.material_of(start + i)))
    }

    #[inline(always)]
    fn material_color(&self, start: usize, value: impl Fn(&Material) -> Rgb) -> Rgb<L> {
        Rgb::from_fn(|i| value(self.material_of(start + i)))
    }

    #[inline(always)]
    fn surface(&self, start: usize) -> Coefficients<L> {
        Coefficients { kr: self.material_color(start, |m| m.kr), ko: self.material_color(start, |m| m.ko) }
    }

    #[inline(always)]
    fn weight(&self, queue: &RayQueue, start: usize) -> Weight<L> {
        let ray = |i: usize| self.hits.ray[self.row(start + i)] as usize;
        Weight {
            attenuation: Rgb::from_fn(|i| queue.attenuation.row(ray(i)).into()),
            factor: Rgb::from_fn(|i| queue.factor.row(ray(i)).into()),
        }
    }

    #[inline(always)]
    fn is_sphere(&self, start: usize) -> L::Mask {
        let spheres = self.world.spheres.len();
        L::Mask::from_fn(|i| (self.hits.primitive[self.row(start + i)] as usize) < spheres)
    }

    /// Centre of the sphere hit; for a triangle any point, which nobody looks at.
    #[inline(always)]
    fn center(&self, row: usize) -> Vec3 {
        let primitive = self.hits.primitive[self.row(row)] as usize;
        self.world.spheres.get(primitive).map_or(Vec3::default(), |s| s.center)
    }
}
