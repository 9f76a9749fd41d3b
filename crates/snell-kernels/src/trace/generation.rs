//! One tile, from camera rays to finished pixels.

use super::Tile;
use super::camera::CameraRays;
use super::carried::CarriedByAll;
use super::hits::Hits;
use super::integrator::Integrator;
use super::observer::{Observer, StateOf};
use super::pairwise::{Block, PairwiseSum};
use super::propagation::Propagation;
use super::queue::{Children, Generation, RayQueue};
use super::shading::{LocalColors, Scenery, ShadowRays};
use super::statistics::{Statistics, lost_units};
use super::tree::Cutoff;
use crate::color::Rgb;
use crate::geometry::bvh::Packet;
use crate::lanes::{Kernel, Lanes, Mask};
use crate::settings::Settings;
use crate::stage::Stage;
use alloc::boxed::Box;
use alloc::vec::Vec;
use core::ops::Range;
use core::sync::atomic::{AtomicBool, Ordering};

/// A generation with more rays than this is split by pixels. It bounds the memory of the queues.
const GENERATION_BUDGET: usize = 1 << 16;

/// A pixel with more rays than this gets no more; the rest counts as lost light. It bounds the time that a pixel takes, and
/// what its generation takes of memory: a ray has up to 18 numbers of 8 bytes, and more children may be made before they are
/// counted, twice as many, or one for each band of light.
const RAYS_PER_PIXEL: u32 = 1 << 18;

/// A worker: it owns the queues, which are used again for every tile.
#[derive(Debug)]
pub struct Tracer<'a, L, O, I: Integrator> {
    stage: &'a Stage,
    settings: &'a Settings,
    integrator: I,
    /// Set by somebody else to stop as soon as possible.
    cancel: Option<&'a AtomicBool>,
    /// Who watches.
    pub observer: O,
    /// What has been traced so far.
    pub statistics: Statistics,
    state: StateOf<'a, I>,
    /// Absent only while they are traced.
    camera_rays: Option<CameraRays<'a, I::Propagation>>,
    packet: Box<Packet>,
    hits: Hits<I::Propagation>,
    /// Which hits ask for lights, a bit for each.
    asks: Vec<u64>,
    shadow: ShadowRays,
    children: Children<I::Propagation>,
    /// Generations that wait: the depth and the rays.
    waiting: Vec<(u32, RayQueue<I::Propagation>)>,
    /// Queues that wait to be used again.
    spare: Vec<RayQueue<I::Propagation>>,
    tile: Tile,
    /// For a sample of each pixel of the tile: radiance, number of rays, and the throughput it lost.
    radiance: Vec<Rgb>,
    rays_of: Vec<u32>,
    lost: Vec<Rgb>,
    traced: TracedTile,
    /// Sums that wait to be used again.
    spare_sums: Vec<Vec<Rgb>>,
    lanes: core::marker::PhantomData<L>,
}

/// What the samples of a tile add up to, pixel by pixel and row by row.
#[derive(Debug, Default)]
pub struct TracedTile {
    /// Radiance.
    pub sums: PairwiseSum<Vec<Rgb>>,
    /// Lost light, in whole units.
    pub lost: Vec<u64>,
}

impl TracedTile {
    /// What all samples add up to, if they are the first ones.
    pub fn sum(&mut self) -> &[Rgb] {
        let mut blocks = self.sums.blocks_mut().iter_mut().map(|(_, sum)| sum);
        let Some(first) = blocks.next() else { return &[] };
        for block in blocks {
            add_to(first, block);
        }
        first
    }
}

/// Adds colours to others, one by one.
#[allow(clippy::ptr_arg, reason = "a function for `PairwiseSum`, whose sums are vectors")]
pub fn add_to(sums: &mut Vec<Rgb>, others: &Vec<Rgb>) {
    for (sum, &other) in sums.iter_mut().zip(others) {
        *sum = *sum + other;
    }
}

/// What the hits of a generation add, and the rays that leave them.
struct Scatter<'b, 'a, I: Integrator> {
    integrator: I,
    stage: &'a Stage,
    state: &'b StateOf<'a, I>,
    hits: &'b mut Hits<I::Propagation>,
    children: &'b mut Children<I::Propagation>,
}

impl<I: Integrator> Kernel for Scatter<'_, '_, I> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { integrator, stage, state, hits, children } = self;
        for start in (0..hits.len()).step_by(L::WIDTH) {
            let contribution = integrator.scatter(&hits.batch::<L>(stage, start), state, children);
            hits.set_contribution(start, contribution);
        }
    }
}

impl<'a, L: Lanes, O: Observer, I: Integrator> Tracer<'a, L, O, I> {
    /// A worker. `cancel`: set by somebody else to stop as soon as possible.
    pub fn new(stage: &'a Stage, settings: &'a Settings, cancel: Option<&'a AtomicBool>, observer: O) -> Self {
        let state = I::Propagation::new(stage);
        let jitter = (settings.spp > 1).then_some(settings.seed);
        let carried = CarriedByAll::new::<I::Carried>(&I::from_camera());
        Self {
            stage,
            settings,
            integrator: I::new(settings),
            cancel,
            observer,
            statistics: Statistics::default(),
            camera_rays: Some(CameraRays::new(&stage.camera, I::Propagation::medium_of_eye(&state), carried, jitter)),
            state,
            packet: Box::default(),
            hits: Hits::default(),
            asks: Vec::new(),
            shadow: ShadowRays::default(),
            children: Children::new(if stage.spectra.is_empty() { 0 } else { stage.bands.len() }),
            waiting: Vec::new(),
            spare: Vec::new(),
            tile: Tile::pixel(0, 0),
            radiance: Vec::new(),
            rays_of: Vec::new(),
            lost: Vec::new(),
            traced: TracedTile::default(),
            spare_sums: Vec::new(),
            lanes: core::marker::PhantomData,
        }
    }

    /// Traces some samples of each pixel of a tile; `None` if it was cancelled on the way.
    #[inline(always)]
    pub fn trace(&mut self, tile: &Tile, samples: Range<u32>) -> Option<&mut TracedTile> {
        let count = tile.pixel_count();
        self.tile = *tile;
        self.spare_sums.extend(self.traced.sums.take().into_iter().map(|(_, sum)| sum));
        self.traced.lost.clear();
        self.traced.lost.resize(count, 0);
        for sample in samples {
            I::Propagation::start_tile(&mut self.state);
            if let Some(camera_rays) = &mut self.camera_rays {
                camera_rays.aim(tile, sample);
            }
            self.trace_sample()?;
            let empty = self.spare_sums.pop().unwrap_or_default();
            let radiance = core::mem::replace(&mut self.radiance, empty);
            let block = Block { first: sample, log2: 0 };
            let spare = |sum| self.spare_sums.push(sum);
            // Each sample comes once.
            let _ = self.traced.sums.insert(block, radiance, add_to, spare);
        }
        self.count_lost_light();
        Some(&mut self.traced)
    }

    /// Traces one ray for each pixel, with all that follows from it.
    #[inline(always)]
    fn trace_sample(&mut self) -> Option<()> {
        let count = self.tile.pixel_count();
        self.radiance.clear();
        self.radiance.resize(count, Rgb::black());
        self.rays_of.clear();
        self.rays_of.resize(count, 1);
        self.lost.clear();
        self.lost.resize(count, Rgb::black());

        if let Some(camera_rays) = self.camera_rays.take() {
            let children = self.generation(0, &camera_rays);
            self.camera_rays = Some(camera_rays);
            self.enqueue(1, children);
        }
        while let Some((depth, queue)) = self.waiting.pop() {
            if self.cancel.is_some_and(|c| c.load(Ordering::Relaxed)) {
                self.waiting.clear();
                return None;
            }
            for row in 0..queue.len() {
                self.rays_of[queue.pixel(row)] += 1;
            }
            let children = self.generation(depth, &queue);
            self.spare.push(queue);
            self.enqueue(depth + 1, children);
        }
        self.observer.sample(&self.lost);
        Some(())
    }

    fn empty_queue(&mut self) -> RayQueue<I::Propagation> {
        let mut queue = self.spare.pop().unwrap_or_default();
        queue.clear();
        queue
    }

    /// Lets a generation wait, in two parts if it is large. Splitting goes by pixels and keeps the order of rays, so no
    /// pixel sees a difference.
    fn enqueue(&mut self, depth: u32, queue: RayQueue<I::Propagation>) {
        if queue.len() <= GENERATION_BUDGET {
            if queue.len() == 0 {
                self.spare.push(queue);
            } else {
                self.waiting.push((depth, queue));
            }
            return;
        }
        let pixels = (0..queue.len()).map(|row| queue.pixel(row));
        let (low, high) = pixels.fold((usize::MAX, 0), |(low, high), p| (low.min(p), high.max(p)));
        if low == high {
            self.waiting.push((depth, queue));
            return;
        }
        let middle = low + (high - low) / 2;
        let mut halves = [self.empty_queue(), self.empty_queue()];
        let half = |row: usize| usize::from(queue.pixel(row) > middle);
        let mut first = 0;
        while first < queue.len() {
            let end = (first..queue.len()).find(|&row| half(row) != half(first)).unwrap_or(queue.len());
            halves[half(first)].copy_rows(&queue, first..end);
            first = end;
        }
        self.spare.push(queue);
        let [first, second] = halves;
        self.enqueue(depth, second);
        self.enqueue(depth, first);
    }

    /// Traces one generation, adds what it contributes, and returns its children.
    #[inline(always)]
    fn generation(&mut self, depth: u32, rays: &impl Generation<I::Propagation>) -> RayQueue<I::Propagation> {
        self.statistics.rays.add(rays.counts());
        self.statistics.count_generation(depth, rays.len() as u64);

        let mut found = Statistics::default();
        let Self { state, stage, hits, packet, .. } = self;
        I::Propagation::find_hits::<L>(state, stage, rays, hits, packet, &mut found);
        found.renumber(|pixel| self.number_of(pixel as usize));
        self.statistics.merge(&found);
        self.ask_for_light();
        let scenery = Scenery {
            stage: self.stage,
            shadows: self.settings.shadows,
            state: &mut self.state,
            packet: &mut self.packet,
        };
        self.statistics.rays.shadow += L::call(LocalColors {
            scenery,
            hits: &mut self.hits,
            shadow: &mut self.shadow,
            observer: &mut self.observer,
            asks: &self.asks,
        }) as u64;
        L::call(Scatter::<I> {
            integrator: self.integrator,
            stage: self.stage,
            state: &self.state,
            hits: &mut self.hits,
            children: &mut self.children,
        });
        let empty = self.empty_queue();
        let mut children = self.children.take(empty);
        for row in 0..self.hits.len() {
            let pixel = &mut self.radiance[self.hits.pixel(row)];
            *pixel = *pixel + self.hits.contribution(row);
        }
        self.observer.generation::<I>(self.stage, rays, &self.hits, &self.state);
        self.limit(depth, &mut children);
        children
    }

    /// Finds out which hits ask for lights.
    #[inline(always)]
    fn ask_for_light(&mut self) {
        self.asks.clear();
        self.asks.resize(self.hits.len().div_ceil(64), 0);
        for start in (0..self.hits.len()).step_by(L::WIDTH) {
            let batch = self.hits.batch::<L>(self.stage, start);
            self.asks[start / 64] |= u64::from(I::asks_for_light(&batch).bits()) << (start % 64);
        }
    }

    /// Ends what is beyond the depth limit or the limit of rays per pixel, or carries too little, and counts it as lost.
    fn limit(&mut self, depth: u32, children: &mut RayQueue<I::Propagation>) {
        let too_deep = depth >= self.settings.max_depth;
        let most = self.rays_of.iter().copied().max().unwrap_or(0) as usize;
        if !too_deep && !self.integrator.ends_early() && most + children.len() <= RAYS_PER_PIXEL as usize {
            return;
        }
        let mut kept = self.empty_queue();
        // The first row that is not yet copied. Neighbours mostly share their fate, and mostly none ends at all.
        let mut first = 0;
        let mut planned = if too_deep { Vec::new() } else { self.rays_of.clone() };
        for row in 0..children.len() {
            let pixel = children.pixel(row);
            let carried = children.carried::<f64, I::Carried>(row);
            let too_little = self.integrator.carries_too_little(self.stage, &carried, &children.travel(row));
            let too_many = planned.get(pixel).is_some_and(|&rays| rays >= RAYS_PER_PIXEL);
            if too_deep || too_little || too_many {
                let why = match (too_deep, too_little) {
                    (true, _) => Cutoff::Depth,
                    (false, true) => Cutoff::Threshold,
                    (false, false) => Cutoff::Rays,
                };
                self.observer.cut_off::<I>(self.stage, children, row, why, &self.state);
                let throughput = I::throughput(&carried);
                self.lost[pixel] = self.lost[pixel] + throughput;
                self.traced.lost[pixel] = self.traced.lost[pixel].saturating_add(lost_units(throughput));
                self.statistics.lost.rays += 1;
                kept.copy_rows(children, first..row);
                first = row + 1;
            } else {
                planned[pixel] += 1;
            }
        }
        if first > 0 {
            kept.copy_rows(children, first..children.len());
            core::mem::swap(children, &mut kept);
        }
        self.spare.push(kept);
    }

    fn count_lost_light(&mut self) {
        for pixel in 0..self.traced.lost.len() {
            if self.traced.lost[pixel] > 0 {
                self.statistics.lost.add(self.number_of(pixel), self.traced.lost[pixel]);
            }
        }
    }

    /// The number of a pixel of the tile in the whole picture, row by row.
    fn number_of(&self, pixel: usize) -> u64 {
        self.tile.number_in_picture(pixel, self.stage.camera.size[0])
    }
}
