//! One tile, from camera rays to finished pixels.

use super::camera::CameraRays;
use super::hits::Hits;
use super::interfaces::{FindInterfaces, Ways};
use super::lecture::{self, Blend};
use super::media::{Media, WHITE};
use super::observer::Observer;
use super::queue::{Generation, RayKind, RayQueue};
use super::shading::{self, ShadowRays};
use super::statistics::Statistics;
use super::tree::{Ended, mean};
use super::whitted;
use crate::film::{Crop, Rgb};
use crate::geometry::bvh::Packet;
use crate::lanes::{Kernel, Lanes, index};
use crate::scene::Integrator;
use crate::world::World;
use std::sync::atomic::{AtomicBool, Ordering};

/// A generation with more rays than this is split by pixels. It bounds the memory of the queues.
const GENERATION_BUDGET: usize = 1 << 16;

/// A pixel with more rays than this gets no more; the rest counts as lost light. It bounds the time that a pixel takes, and
/// what its generation takes of memory: a ray has 21 numbers of 8 bytes, and more children may be made before they are
/// counted, twice as many, or one for each band of light.
const RAYS_PER_PIXEL: u32 = 1 << 18;

/// A worker: it owns the queues, which are used again for every tile.
#[derive(Debug)]
pub(crate) struct Tracer<'a, L, O> {
    pub world: &'a World,
    /// Set by somebody else to stop as soon as possible.
    cancel: Option<&'a AtomicBool>,
    pub observer: O,
    pub statistics: Statistics,
    /// Waits to be used again for the next tile.
    camera_rays: Option<CameraRays<'a>>,
    packet: Box<Packet>,
    media: Media<'a>,
    ways: Ways,
    hits: Hits,
    shadow: ShadowRays,
    refracted: RayQueue,
    /// Refracted rays of white ones that have split, by bands; none where nothing disperses.
    bands: Vec<RayQueue>,
    /// Generations that wait: the depth and the rays.
    waiting: Vec<(u32, RayQueue)>,
    /// Queues that wait to be used again.
    spare: Vec<RayQueue>,
    tile: Crop,
    /// For a sample of each pixel of the tile: radiance, number of rays, and the throughput it lost.
    radiance: Vec<Rgb>,
    rays_of: Vec<u32>,
    lost: Vec<Rgb>,
    /// Of several samples the sum of their radiance.
    sum: Vec<Rgb>,
    /// What all samples lost without signs, which colours of single wavelengths have, as the mean of the three channels.
    lost_sizes: Vec<f64>,
    lanes: std::marker::PhantomData<L>,
}

/// What the hits of a generation do in the physical model: a function of its own.
struct Whitted<'b, 'a, L, O> {
    tracer: &'b mut Tracer<'a, L, O>,
    children: &'b mut RayQueue,
}

impl<K: Lanes, O> Kernel for Whitted<'_, '_, K, O> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { tracer, children } = self;
        for start in (0..tracer.hits.len()).step_by(L::WIDTH) {
            let batch = tracer.hits.batch::<L>(tracer.world, start);
            let (contribution, mirror, refracted) = whitted::answer(&batch, &tracer.media, &mut tracer.bands);
            children.push(RayKind::Mirror, mirror.0, &mirror.1);
            tracer.refracted.push(RayKind::Refracted, refracted.0, &refracted.1);
            tracer.hits.set_contribution(start, contribution);
        }
    }
}

impl<'a, L: Lanes, O: Observer> Tracer<'a, L, O> {
    pub fn new(world: &'a World, cancel: Option<&'a AtomicBool>, observer: O) -> Self {
        Self {
            world,
            cancel,
            observer,
            statistics: Statistics::default(),
            camera_rays: None,
            packet: Box::default(),
            media: Media::new(world),
            ways: Ways::default(),
            hits: Hits::default(),
            shadow: ShadowRays::default(),
            refracted: RayQueue::default(),
            bands: if world.spectra.is_empty() {
                vec![]
            } else {
                world.bands.iter().map(|_| RayQueue::default()).collect()
            },
            waiting: Vec::new(),
            spare: Vec::new(),
            tile: Crop { x: 0, y: 0, width: 1, height: 1 },
            radiance: Vec::new(),
            rays_of: Vec::new(),
            lost: Vec::new(),
            sum: Vec::new(),
            lost_sizes: Vec::new(),
            lanes: std::marker::PhantomData,
        }
    }

    /// Traces a tile of the picture, and returns the radiance of its pixels, row by row; `None` if it was cancelled on the way.
    #[inline(always)]
    pub fn trace(&mut self, tile: &Crop) -> Option<&[Rgb]> {
        let mut camera_rays = self.camera_rays.take().unwrap_or_else(|| CameraRays::new(self.world));
        let (count, spp) = (tile.width as usize * tile.height as usize, self.world.render.spp);
        self.tile = *tile;
        self.sum.clear();
        self.lost_sizes.clear();
        self.lost_sizes.resize(count, 0.0);
        for sample in 0..spp {
            self.media.forget();
            camera_rays.aim(tile, sample, &self.media);
            self.trace_sample(&camera_rays)?;
            if spp > 1 {
                self.sum.resize(count, Rgb::black());
                for (sum, &radiance) in self.sum.iter_mut().zip(&self.radiance) {
                    *sum = *sum + radiance;
                }
            }
        }
        self.camera_rays = Some(camera_rays);
        self.count_lost_light();
        if spp == 1 {
            return Some(&self.radiance);
        }
        for sum in &mut self.sum {
            *sum = mean(*sum, spp);
        }
        Some(&self.sum)
    }

    /// Traces one ray for each pixel, with all that follows from it.
    #[inline(always)]
    fn trace_sample(&mut self, camera_rays: &CameraRays<'_>) -> Option<()> {
        let count = camera_rays.len();
        self.radiance.clear();
        self.radiance.resize(count, Rgb::black());
        self.rays_of.clear();
        self.rays_of.resize(count, 1);
        self.lost.clear();
        self.lost.resize(count, Rgb::black());

        let children = self.generation(0, camera_rays);
        self.enqueue(1, children);
        while let Some((depth, queue)) = self.waiting.pop() {
            if self.cancel.is_some_and(|c| c.load(Ordering::Relaxed)) {
                self.waiting.clear();
                return None;
            }
            for pixel in queue.pixels() {
                self.rays_of[pixel] += 1;
            }
            let children = self.generation(depth, &queue);
            self.spare.push(queue);
            self.enqueue(depth + 1, children);
        }
        self.observer.sample(&self.lost);
        Some(())
    }

    fn empty_queue(&mut self) -> RayQueue {
        let mut queue = self.spare.pop().unwrap_or_default();
        queue.clear();
        queue
    }

    /// Lets a generation wait, in two parts if it is large. Splitting goes by pixels and keeps the order of rays, so no
    /// pixel sees a difference.
    fn enqueue(&mut self, depth: u32, queue: RayQueue) {
        if queue.len() <= GENERATION_BUDGET {
            if queue.len() == 0 {
                self.spare.push(queue);
            } else {
                self.waiting.push((depth, queue));
            }
            return;
        }
        let (low, high) = queue.pixels().fold((usize::MAX, 0), |(low, high), p| (low.min(p), high.max(p)));
        if low == high {
            self.waiting.push((depth, queue));
            return;
        }
        let middle = low + (high - low) / 2;
        let mut halves = [self.empty_queue(), self.empty_queue()];
        for row in 0..queue.len() {
            halves[usize::from(queue.pixel(row) > middle)].copy_row(&queue, row);
        }
        self.spare.push(queue);
        let [first, second] = halves;
        self.enqueue(depth, second);
        self.enqueue(depth, first);
    }

    /// Traces one generation, adds what it contributes, and returns its children.
    #[inline(always)]
    fn generation(&mut self, depth: u32, rays: &impl Generation) -> RayQueue {
        self.statistics.rays.add(rays.counts());
        self.statistics.count_generation(depth, rays.len() as u64);

        let blend = Blend::of(self.world.render.integrator);
        if blend.is_some() {
            self.hits.find::<L>(self.world, rays, &mut self.packet);
        } else {
            let mut found = Statistics::default();
            L::call(FindInterfaces {
                hits: &mut self.hits,
                rays,
                media: &mut self.media,
                ways: &mut self.ways,
                packet: &mut self.packet,
                statistics: &mut found,
            });
            found.renumber(|pixel| self.number_of(pixel as usize));
            self.statistics.merge(&found);
        }
        let shadow_rays = shading::local_colors::<L>(
            &mut self.media,
            &mut self.hits,
            &mut self.shadow,
            &mut self.packet,
            &mut self.observer,
        );
        self.statistics.rays.shadow += shadow_rays as u64;
        let mut children = self.empty_queue();
        self.refracted.clear();
        self.bands.iter_mut().for_each(RayQueue::clear);
        // A loop for each model: neither should have to make room for the other.
        if let Some(blend) = blend {
            for start in (0..self.hits.len()).step_by(L::WIDTH) {
                let batch = self.hits.batch::<L>(self.world, start);
                let contribution = lecture::contribution(blend, &batch);
                let (sends_mirror, mirror) = lecture::mirror_ray(blend, &batch);
                let (sends_exit, exit) = lecture::exit_ray(blend, &batch);
                children.push(RayKind::Mirror, sends_mirror, &mirror);
                self.refracted.push(RayKind::Refracted, sends_exit, &exit);
                self.hits.set_contribution(start, contribution);
            }
        } else {
            L::call(Whitted { tracer: self, children: &mut children });
        }
        children.append(&self.refracted);
        for band in &self.bands {
            children.append(band);
        }
        for row in 0..self.hits.len() {
            let pixel = &mut self.radiance[self.hits.pixel(row)];
            *pixel = *pixel + self.hits.contribution(row);
        }
        self.observer.generation(rays, &self.hits, &self.media);
        self.limit(depth, &mut children);
        children
    }

    /// Ends what is beyond the depth limit or the limit of rays per pixel, or carries too little, and counts it as lost.
    fn limit(&mut self, depth: u32, children: &mut RayQueue) {
        let render = &self.world.render;
        let too_deep = depth >= render.max_depth;
        let least = if render.integrator == Integrator::Whitted { render.min_throughput } else { 0.0 };
        let most = self.rays_of.iter().copied().max().unwrap_or(0) as usize;
        if !too_deep && least == 0.0 && most + children.len() <= RAYS_PER_PIXEL as usize {
            return;
        }
        let mut kept = self.empty_queue();
        let mut planned = if too_deep { Vec::new() } else { self.rays_of.clone() };
        for row in 0..children.len() {
            let pixel = children.pixel(row);
            let load = children.loads::<f64>(row);
            let throughput = load.weight.throughput();
            let too_little = least > 0.0 && self.part_carried(throughput, index(load.band) as u32) < least;
            let too_many = planned.get(pixel).is_some_and(|&rays| rays >= RAYS_PER_PIXEL);
            if too_deep || too_little || too_many {
                let why = match (too_deep, too_little) {
                    (true, _) => Ended::Depth,
                    (false, true) => Ended::Throughput,
                    (false, false) => Ended::Rays,
                };
                self.observer.ended(children, row, why, &self.media);
                self.lost[pixel] = self.lost[pixel] + throughput;
                self.lost_sizes[pixel] += Rgb::from(throughput.to_array().map(f64::abs)).mean();
                self.statistics.lost.rays += 1;
            } else {
                planned[pixel] += 1;
                kept.copy_row(children, row);
            }
        }
        std::mem::swap(children, &mut kept);
        self.spare.push(kept);
    }

    /// What a ray carries of what one of its band of light could, in the channel where that is most. A band is a small share of
    /// white, of some channels next to none, and of any channel perhaps a negative one.
    fn part_carried(&self, throughput: Rgb, band: u32) -> f64 {
        let whole = if band == WHITE { Rgb::gray(1.0) } else { self.world.bands[band as usize].weight };
        let parts = throughput.to_array().into_iter().zip(whole.to_array());
        parts.map(|(carried, whole)| if whole == 0.0 { 0.0 } else { (carried / whole).abs() }).fold(0.0, f64::max)
    }

    fn count_lost_light(&mut self) {
        for pixel in 0..self.lost_sizes.len() {
            if self.lost_sizes[pixel] > 0.0 {
                let mean = self.lost_sizes[pixel] / f64::from(self.world.render.spp);
                self.statistics.lost.add(self.number_of(pixel), mean);
            }
        }
    }

    /// The number of a pixel of the tile in the whole picture, row by row.
    fn number_of(&self, pixel: usize) -> u64 {
        let (tile, columns) = (&self.tile, self.tile.width as usize);
        let (x, y) = (u64::from(tile.x) + (pixel % columns) as u64, u64::from(tile.y) + (pixel / columns) as u64);
        y * u64::from(self.world.camera.size[0]) + x
    }
}
