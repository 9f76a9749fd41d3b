//! One tile, from camera rays to finished pixels.

use super::hits::{Batch, Hits};
use super::lecture::{self, Child};
use super::queue::{RayKind, RayQueue};
use super::shading::{self, ShadowRays};
use super::statistics::Statistics;
use crate::film::Rgb;
use crate::lanes::{Lanes, Mask};
use crate::world::World;
use std::sync::atomic::{AtomicBool, Ordering};

/// A generation with more rays than this is split by pixels. It bounds the memory of the queues.
const GENERATION_BUDGET: usize = 1 << 16;

/// A pixel with more rays than this gets no more; the rest counts as lost light. It bounds the time that a pixel takes, and
/// what its generation takes of memory: a ray has 13 numbers of 8 bytes and some small ones, so 30 MB a queue.
const RAYS_PER_PIXEL: u32 = 1 << 18;

/// Sees every generation when it is done, with its rays, hits and contributions.
pub(crate) trait Observer {
    fn generation(&mut self, queue: &RayQueue, hits: &Hits);
}

/// Looks at nothing: plain rendering.
impl Observer for () {
    #[inline(always)]
    fn generation(&mut self, _queue: &RayQueue, _hits: &Hits) {}
}

/// A worker: it owns the queues, which are used again for every tile.
#[derive(Debug)]
pub(crate) struct Tracer<'a, L, O> {
    world: &'a World,
    /// Set by somebody else to stop as soon as possible.
    cancel: Option<&'a AtomicBool>,
    pub observer: O,
    pub statistics: Statistics,
    hits: Hits,
    shadow: ShadowRays,
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
    pub fn new(world: &'a World, cancel: Option<&'a AtomicBool>, observer: O) -> Self {
        Self {
            world,
            cancel,
            observer,
            statistics: Statistics::default(),
            hits: Hits::default(),
            shadow: ShadowRays::default(),
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

        let mut camera_rays = self.empty_queue();
        for (i, &(x, y)) in pixels.iter().enumerate() {
            let (origin, dir) = self.world.camera.ray(x, y);
            camera_rays.push_camera_ray(i as u32, origin, dir, lecture::T_MIN);
        }
        self.waiting.push((0, camera_rays));
        while let Some((depth, queue)) = self.waiting.pop() {
            if self.cancel.is_some_and(|c| c.load(Ordering::Relaxed)) {
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

    fn empty_queue(&mut self) -> RayQueue {
        let mut queue = self.spare.pop().unwrap_or_default();
        queue.clear();
        queue
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
        let mut halves = [self.empty_queue(), self.empty_queue()];
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
        for (&kind, &pixel) in queue.kind.iter().zip(&queue.pixel) {
            self.statistics.rays.add(kind);
            self.rays_of[pixel as usize] += 1;
        }
        self.statistics.count_generation(depth, queue.len() as u64);

        self.hits.find::<L>(self.world, queue);
        let shadow_rays = shading::local_colors::<L>(self.world, queue, &mut self.hits, &mut self.shadow);
        self.statistics.rays.shadow += shadow_rays as u64;
        for start in (0..self.hits.len()).step_by(L::WIDTH) {
            let batch = Batch::new(self.world, queue, &self.hits, start);
            let (active, added) = (batch.active::<L>(), lecture::contribution::<L>(batch));
            self.hits.contribution.compress(active, added.into());
        }
        for (row, &ray) in self.hits.ray.iter().enumerate() {
            let pixel = &mut self.radiance[queue.pixel[ray as usize] as usize];
            *pixel = *pixel + Rgb::from(self.hits.contribution.row(row));
        }
        self.observer.generation(queue, &self.hits);

        let mut children = self.empty_queue();
        self.spawn(queue, &mut children);
        self.limit(depth, &mut children);
        children
    }

    /// The children of all hits: the mirror rays, then the refracted rays, each in their parents' order.
    fn spawn(&mut self, queue: &RayQueue, children: &mut RayQueue) {
        self.refracted.clear();
        for start in (0..self.hits.len()).step_by(L::WIDTH) {
            let batch = Batch::new(self.world, queue, &self.hits, start);
            push(children, RayKind::Mirror, &lecture::mirror_ray::<L>(batch), queue, &self.hits, start);
            let exit = lecture::exit_ray::<L>(batch);
            push(&mut self.refracted, RayKind::Refracted, &exit, queue, &self.hits, start);
        }
        for row in 0..self.refracted.len() {
            children.copy_row(&self.refracted, row);
        }
    }

    /// Ends what is beyond the depth limit or the limit of rays per pixel, and counts it as lost.
    fn limit(&mut self, depth: u32, children: &mut RayQueue) {
        let too_deep = depth >= self.world.render.max_depth;
        let most = self.rays_of.iter().copied().max().unwrap_or(0) as usize;
        if !too_deep && most + children.len() <= RAYS_PER_PIXEL as usize {
            return;
        }
        let mut kept = self.empty_queue();
        let mut planned = if too_deep { Vec::new() } else { self.rays_of.clone() };
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
}

/// Appends the children of some hits to a queue.
#[inline(always)]
fn push<L: Lanes>(to: &mut RayQueue, kind: RayKind, child: &Child<L>, parents: &RayQueue, hits: &Hits, start: usize) {
    to.origin.compress(child.exists, child.origin.into());
    to.dir.compress(child.exists, child.dir.into());
    to.attenuation.compress(child.exists, child.weight.attenuation.into());
    to.factor.compress(child.exists, child.weight.factor.into());
    for lane in (0..L::WIDTH).filter(|&i| child.exists.test(i)) {
        let ray = hits.ray[start + lane];
        to.t_min.push(lecture::T_MIN);
        to.pixel.push(parents.pixel[ray as usize]);
        to.source.push(hits.primitive[start + lane]);
        to.kind.push(kind);
        to.parent.push(ray);
    }
}
