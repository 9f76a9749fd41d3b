//! A render that goes on step by step.

use super::accumulator::Accumulator;
use super::spread::Spread;
use super::{Options, Passes, Progress, RenderError};
use crate::color::Rgb;
use crate::film::{Crop, Film};
use crate::integrate::{WithIntegrator, with_integrator};
use crate::lanes::{Kernel, Lanes, dispatch};
use crate::settings::Settings;
use crate::threads;
use crate::trace::{Block, Integrator, Statistics, Tile, TracedTile, Tracer, mean};
use crate::world::World;
use std::cmp::Reverse;
use std::collections::VecDeque;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// A render that goes on step by step, and may be paused or dropped between any two of them.
///
/// ```
/// # use snell::scene::{Camera, Integrator, Render, Scene};
/// # fn main() -> Result<(), Box<dyn std::error::Error>> {
/// # let camera = Camera::new([0.0, 0.0, 10.0], [0.0; 3], [0.0, 1.0, 0.0], [-1.0, 1.0, -1.0, 1.0], -5.0);
/// # let scene = Scene::new(Render::new(Integrator::Lecture, [64, 64]), camera);
/// use snell::render::{Options, Passes, Renderer, Settings};
///
/// let world = snell::world::World::new(&scene)?;
/// let options = Options { passes: Passes::CoarseToFine { coarsest: 8 }, ..Options::default() };
/// let mut renderer = Renderer::new(world, Settings::from(&scene), &options)?;
/// while !renderer.is_finished() {
///     // One tile, here on the caller's thread; `renderer.film()` may be shown after each.
///     let changed = renderer.step(1);
///     assert_eq!(changed.len(), 1);
/// }
/// assert!(renderer.film().is_finished());
/// # Ok(())
/// # }
/// ```
///
/// It holds its world, and borrows nothing but what the options name: whoever shows a picture while it comes, as a browser does, keeps
/// both in one place.
#[derive(Debug)]
pub struct Renderer<'a> {
    world: Arc<World>,
    settings: Settings,
    film: Film,
    schedule: Schedule<'a>,
}

impl<'a> Renderer<'a> {
    /// Begins a render.
    ///
    /// # Errors
    /// When the film does not fit into memory, the crop not into the picture, or the world not to the model of light.
    pub fn new(world: impl Into<Arc<World>>, settings: Settings, options: &Options<'a>) -> Result<Self, RenderError> {
        let world = world.into();
        let mut film = Film::new(world.camera.size, Crop { x: 0, y: 0, width: 0, height: 0 })?;
        let schedule = Schedule::new(&mut film, &world, &settings, options)?;
        Ok(Self { world, settings, film, schedule })
    }

    /// Renders so many tiles more, or all that are left. Returns those that have changed in the film: with coarse tiles the squares
    /// of [`Tile::step`] pixels around their pixels, too.
    pub fn step(&mut self, tiles: u64) -> Vec<Tile> {
        self.schedule.step(&mut self.film, &self.world, &self.settings, tiles)
    }

    /// Is everything rendered?
    pub fn is_finished(&self) -> bool {
        self.schedule.is_finished()
    }

    /// How fine the pixels are that come next; `None` when everything is rendered.
    pub fn fineness(&self) -> Option<Fineness> {
        self.schedule.passes.front().map(Pass::fineness)
    }

    /// The picture so far: pixels that are not finished are black, or like a neighbour of a coarser pass.
    pub fn film(&self) -> &Film {
        &self.film
    }

    /// What was traced for it.
    pub fn statistics(&self) -> Statistics {
        self.schedule.statistics()
    }

    /// The light that each pixel of the film has lost so far, over all of its samples, in the whole units of
    /// [`LostLight`](crate::trace::LostLight). `None` with [`Passes::WholeTiles`], of which only the statistics know.
    pub fn lost(&self) -> Option<&[u64]> {
        (self.schedule.options.passes != Passes::WholeTiles).then_some(&self.schedule.lost)
    }

    /// How far it has come.
    pub fn progress(&self) -> Progress {
        self.schedule.progress()
    }

    /// The picture, and what was traced for it.
    pub fn into_film(self) -> (Film, Statistics) {
        let statistics = self.schedule.statistics();
        (self.film, statistics)
    }
}

/// Of several renders, each of a part of a picture, those with less are to go on first: then the whole picture gets finer together.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Fineness {
    samples: u32,
    /// How far pixels are apart, and where those of the pass lie between those before.
    step: Reverse<u32>,
    between: [u32; 2],
}

/// What is still to be rendered into a film; each step is told the world and the settings again, which must be the same.
#[derive(Debug)]
pub(super) struct Schedule<'a> {
    options: Options<'a>,
    /// Width of the whole picture, and the part of it that is rendered.
    full_width: u32,
    crop: Crop,
    /// Samples per pixel.
    spp: u32,
    /// The one that is under way comes first.
    passes: VecDeque<Pass>,
    /// Edge of its tiles.
    tile_size: u32,
    /// How many tiles of it have been taken, and those that were taken and not finished.
    taken: u64,
    again: Vec<u64>,
    /// Sums of the samples of this pass, pixel by pixel; empty without accumulator.
    planes: Vec<(Block, Vec<Rgb>)>,
    /// What passes before have added up to.
    accumulator: Option<Accumulator>,
    /// The light that each pixel has lost so far, in whole units; empty if pixels come with all of their samples at once.
    lost: Vec<u64>,
    /// What was traced so far.
    statistics: Statistics,
    /// Samples and rays of all tiles so far.
    samples: u64,
    rays: u64,
}

/// Some samples of some pixels: of every `step`-th one from (`x`, `y`) of the crop on.
#[derive(Clone, Debug)]
struct Pass {
    x: u32,
    y: u32,
    step: u32,
    samples: Range<u32>,
    /// Is it the last one of its samples?
    completes: bool,
}

impl Pass {
    fn fineness(&self) -> Fineness {
        Fineness { samples: self.samples.start, step: Reverse(self.step), between: [self.y, self.x] }
    }

    /// How many pixels in a row, and how many rows.
    fn pixels(&self, crop: &Crop) -> [u32; 2] {
        let count = |start: u32, length: u32| length.saturating_sub(start).div_ceil(self.step);
        [count(self.x, crop.width), count(self.y, crop.height)]
    }

    /// How many tiles in a row, and how many rows of them.
    fn tiles(&self, crop: &Crop, tile_size: u32) -> [u64; 2] {
        self.pixels(crop).map(|pixels| u64::from(pixels.div_ceil(tile_size)))
    }

    /// A tile, by its column and row.
    fn tile(&self, crop: &Crop, tile_size: u32, [column, row]: [u64; 2]) -> Tile {
        let [width, height] = self.pixels(crop);
        let (left, top) = (column as u32 * tile_size, row as u32 * tile_size);
        Tile {
            x: crop.x + self.x + left * self.step,
            y: crop.y + self.y + top * self.step,
            step: self.step,
            width: tile_size.min(width - left),
            height: tile_size.min(height - top),
        }
    }
}

/// Samples of a pixel in one pass over a picture that is shown meanwhile: a power of two.
const MOST_SAMPLES: u32 = 32;

/// Rays that a tile of such a picture should take at most, some milliseconds of them: whoever renders it step by step has more to do.
const MOST_RAYS: u64 = 1 << 13;

/// The passes over a picture, without those that have no pixels.
fn passes(crop: &Crop, spp: u32, kind: Passes) -> VecDeque<Pass> {
    let Passes::CoarseToFine { coarsest } = kind else {
        return [Pass { x: 0, y: 0, step: 1, samples: 0..spp, completes: true }].into();
    };
    let mut passes = VecDeque::new();
    let mut step = coarsest.clamp(1, 1 << 16).next_power_of_two();
    // The first sample from coarse to fine: every `step`-th pixel, then those between, each time twice as many in a row.
    passes.push_back(Pass { x: 0, y: 0, step, samples: 0..1, completes: false });
    while step > 1 {
        let half = step / 2;
        for [x, y] in [[half, 0], [0, half], [half, half]] {
            passes.push_back(Pass { x, y, step, samples: 0..1, completes: false });
        }
        step = half;
    }
    passes.retain(|pass| !pass.pixels(crop).contains(&0));
    if let Some(last) = passes.back_mut() {
        last.completes = true;
    }
    // Then as many samples at a time as there are already, so that there are few sums to keep.
    let mut first = 1;
    while first < spp {
        let end = first.saturating_add(first.min(MOST_SAMPLES)).min(spp);
        passes.push_back(Pass { x: 0, y: 0, step: 1, samples: first..end, completes: true });
        first = end;
    }
    passes
}

/// How far a picture is that has so many samples of all its pixels, and took so many rays.
fn progress(crop: &Crop, spp: u32, samples: u64, rays: u64) -> Progress {
    let total_pixels = u64::from(crop.width) * u64::from(crop.height);
    Progress { pixels: samples / u64::from(spp), total_pixels, rays }
}

impl<'a> Schedule<'a> {
    /// Makes the film ready, and plans what to render into it.
    pub fn new(
        film: &mut Film,
        world: &World,
        settings: &Settings,
        options: &Options<'a>,
    ) -> Result<Self, RenderError> {
        if !world.is_for(settings.integrator) {
            return Err(RenderError::OtherModel { integrator: settings.integrator });
        }
        let size = world.camera.size;
        let crop = options.crop_of(world)?;
        film.start_again(size, crop)?;
        let passes = passes(&crop, settings.spp, options.passes);
        let in_one = passes.iter().filter(|pass| pass.completes).count() == 1;
        let lost = match options.passes {
            Passes::WholeTiles => Vec::new(),
            Passes::CoarseToFine { .. } => vec![0; film.pixels.len()],
        };
        let options = Options { tile_size: options.tile_size.clamp(1, 1 << 15), ..*options };
        Ok(Self {
            options,
            full_width: size[0],
            crop,
            spp: settings.spp,
            passes,
            tile_size: options.tile_size,
            taken: 0,
            again: Vec::new(),
            planes: Vec::new(),
            accumulator: (!in_one).then(Accumulator::default),
            lost,
            statistics: Statistics::default(),
            samples: 0,
            rays: 0,
        })
    }

    pub fn is_finished(&self) -> bool {
        self.passes.is_empty()
    }

    pub fn statistics(&self) -> Statistics {
        let mut all = self.statistics.clone();
        if !self.lost.is_empty() {
            // The worst pixel of all samples need not be the worst of any pass.
            let (width, full_width) = (u64::from(self.crop.width), u64::from(self.full_width));
            let pixels = self.lost.iter().zip(0..).filter(|(lost, _)| **lost > 0).map(|(&lost, at)| {
                let (column, row) = (at % width, at / width);
                ((u64::from(self.crop.y) + row) * full_width + u64::from(self.crop.x) + column, lost)
            });
            all.lost = all.lost.with_worst_of(pixels);
        }
        all
    }

    pub fn progress(&self) -> Progress {
        progress(&self.crop, self.spp, self.samples, self.rays)
    }

    /// Renders so many tiles more, or all that are left, and returns those that have changed.
    pub fn step(&mut self, film: &mut Film, world: &World, settings: &Settings, tiles: u64) -> Vec<Tile> {
        let mut changed = Vec::new();
        while (changed.len() as u64) < tiles && !self.is_finished() && !self.is_cancelled() {
            let wanted = tiles - changed.len() as u64;
            changed.append(&mut self.step_of_pass(film, world, settings, wanted));
        }
        changed
    }

    fn is_cancelled(&self) -> bool {
        self.options.cancel.is_some_and(|cancel| cancel.load(Ordering::Relaxed))
    }

    /// The same within the pass that is under way.
    fn step_of_pass(&mut self, film: &mut Film, world: &World, settings: &Settings, tiles: u64) -> Vec<Tile> {
        let Some(pass) = self.passes.front().cloned() else { return Vec::new() };
        if self.taken == 0 {
            self.tile_size = self.size_for(&pass);
        }
        let (count, size) = (self.crop.width as usize * self.crop.height as usize, self.tile_size);
        if self.accumulator.is_some() && self.planes.is_empty() {
            let blocks = Block::of(pass.samples.clone());
            self.planes = blocks.into_iter().map(|block| (block, vec![Rgb::black(); count])).collect();
        }
        let [columns, rows] = pass.tiles(&self.crop, size);
        let order = Spread::new(columns * rows);
        let left = order.count - self.taken;
        let fresh = left.min(tiles.saturating_sub(self.again.len() as u64));
        let again = self.again.split_off(self.again.len() - tiles.min(self.again.len() as u64) as usize);
        let turns: Vec<u64> = again.into_iter().chain(self.taken..self.taken + fresh).collect();
        self.taken += fresh;
        // A row of tiles fits into an array index, as the film does.
        let pixels = usize::try_from(u64::from(size) * u64::from(pass.step) * u64::from(self.crop.width));
        let pixels = pixels.unwrap_or(usize::MAX).min(count);
        let mut planes: Vec<_> = self.planes.iter_mut().map(|(_, plane)| plane.chunks_mut(pixels)).collect();
        let mut lost = self.lost.chunks_mut(pixels);
        let films = film.pixels.chunks_mut(pixels).zip(film.finished.chunks_mut(pixels));
        let bands = films.enumerate().map(|(number, (colors, finished))| {
            let planes = planes.iter_mut().filter_map(Iterator::next).collect();
            Mutex::new(Band { first: number * pixels, colors, finished, planes, lost: lost.next().unwrap_or_default() })
        });
        let shared = Shared {
            schedule: SharedSchedule {
                world,
                settings,
                options: &self.options,
                tile_size: size,
                crop: self.crop,
                accumulator: self.accumulator.as_ref(),
                before: [self.samples, self.rays],
            },
            bands: bands.collect(),
            pass: &pass,
            order,
            turns: &turns,
            next: AtomicU64::new(0),
            done: [AtomicU64::new(0), AtomicU64::new(0)],
            result: Mutex::new(Finished::default()),
        };
        with_integrator(settings.integrator, Work(&shared));
        // A poisoned lock means that a worker panicked, which rayon has already passed on.
        let Finished { tiles, statistics, turns: mut finished } =
            shared.result.into_inner().unwrap_or_else(PoisonError::into_inner);
        finished.sort_unstable();
        self.samples +=
            tiles.iter().map(|tile: &Tile| tile.pixel_count() as u64).sum::<u64>() * pass.samples.len() as u64;
        self.rays += statistics.rays.total();
        self.statistics.merge(&statistics);
        self.again.extend(turns.iter().filter(|turn| finished.binary_search(turn).is_err()));
        if self.taken == order.count && self.again.is_empty() {
            self.end_pass(pass.completes);
        }
        tiles
    }

    /// The edge of the tiles of a pass, as far as the passes before tell what a pixel takes.
    fn size_for(&self, pass: &Pass) -> u32 {
        let rays = (self.rays * pass.samples.len() as u64).checked_div(self.samples).unwrap_or(0);
        let pixels = MOST_RAYS / rays.max(1);
        (pixels.isqrt() as u32).clamp(1, self.options.tile_size)
    }

    /// Goes on with the next pass.
    fn end_pass(&mut self, completes_samples: bool) {
        self.passes.pop_front();
        self.taken = 0;
        if completes_samples && let Some(accumulator) = &mut self.accumulator {
            accumulator.add(std::mem::take(&mut self.planes));
        }
    }
}

/// One row of tiles: its part of the film, of the sums of this pass, and of the light that was lost.
struct Band<'a> {
    /// The number of its first pixel in the film.
    first: usize,
    colors: &'a mut [Rgb],
    finished: &'a mut [bool],
    planes: Vec<&'a mut [Rgb]>,
    lost: &'a mut [u64],
}

/// What does not change during a step.
struct SharedSchedule<'b> {
    world: &'b World,
    settings: &'b Settings,
    options: &'b Options<'b>,
    tile_size: u32,
    crop: Crop,
    accumulator: Option<&'b Accumulator>,
    /// Samples and rays before this step.
    before: [u64; 2],
}

/// What workers share during a step.
struct Shared<'b> {
    schedule: SharedSchedule<'b>,
    /// From top to bottom.
    bands: Vec<Mutex<Band<'b>>>,
    pass: &'b Pass,
    order: Spread,
    /// Which tiles of the order to render, and how many of them have been taken.
    turns: &'b [u64],
    next: AtomicU64,
    /// Samples and rays of the tiles that are done.
    done: [AtomicU64; 2],
    result: Mutex<Finished>,
}

/// What workers have done.
#[derive(Default)]
struct Finished {
    tiles: Vec<Tile>,
    statistics: Statistics,
    /// Their turns.
    turns: Vec<u64>,
}

/// Starts the workers.
struct Work<'c, 'b>(&'c Shared<'b>);

impl WithIntegrator for Work<'_, '_> {
    type Output = ();
    fn run<I: Integrator>(self) {
        let Self(shared) = self;
        let options = shared.schedule.options;
        // More threads than tiles have nothing to do.
        let threads = if shared.turns.len() == 1 { 1 } else { options.threads.min(shared.turns.len()) };
        threads::run(threads, || dispatch(options.lanes, Worker::<I>(shared, std::marker::PhantomData)));
    }
}

/// What one thread does.
struct Worker<'c, 'b, I>(&'c Shared<'b>, std::marker::PhantomData<I>);

impl<I: Integrator> Kernel for Worker<'_, '_, I> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self(shared, _) = self;
        let SharedSchedule { world, settings, options, .. } = shared.schedule;
        let mut tracer = Tracer::<L, (), I>::new(world, settings, options.cancel, ());
        let mut mine = Finished::default();
        while let Some((turn, band, tile)) = shared.take_tile() {
            let Some(traced) = tracer.trace(&tile, shared.pass.samples.clone()) else { break };
            shared.store(band, &tile, traced);
            let statistics = std::mem::take(&mut tracer.statistics);
            shared.report(tile.pixel_count() as u64 * shared.pass.samples.len() as u64, statistics.rays.total());
            mine.statistics.merge(&statistics);
            mine.tiles.push(tile);
            mine.turns.push(turn);
        }
        let mut all = lock(&shared.result);
        all.statistics.merge(&mine.statistics);
        all.tiles.append(&mut mine.tiles);
        all.turns.append(&mut mine.turns);
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl Shared<'_> {
    /// The next tile, its turn and its band, if there is one and nobody has cancelled.
    fn take_tile(&self) -> Option<(u64, usize, Tile)> {
        let turn = *self.turns.get(self.next.fetch_add(1, Ordering::Relaxed) as usize)?;
        let SharedSchedule { options, tile_size, crop, .. } = &self.schedule;
        if options.cancel.is_some_and(|c| c.load(Ordering::Relaxed)) {
            return None;
        }
        let [columns, _] = self.pass.tiles(crop, *tile_size);
        let number = self.order.nth(turn);
        let (column, row) = (number % columns, number / columns);
        Some((turn, row as usize, self.pass.tile(crop, *tile_size, [column, row])))
    }

    /// Stores the pixels of a tile.
    fn store(&self, band: usize, tile: &Tile, traced: &mut TracedTile) {
        let SharedSchedule { crop, accumulator, .. } = &self.schedule;
        let (width, step) = (crop.width as usize, tile.step as usize);
        let mut band = lock(&self.bands[band]);
        let Band { first, colors, finished, planes, lost } = &mut *band;
        let start = (tile.y - crop.y) as usize * width + (tile.x - crop.x) as usize - *first;
        let row_starts = (0..tile.height as usize).map(|row| start + row * step * width);
        if let Some(accumulator) = accumulator {
            let count = (accumulator.sample_count() + self.pass.samples.len() as u64) as u32;
            for (row, start) in row_starts.clone().enumerate() {
                for column in 0..tile.width as usize {
                    let (from, to) = (row * tile.width as usize + column, start + column * step);
                    for (plane, (_, sums)) in planes.iter_mut().zip(traced.sums.blocks()) {
                        plane[to] = sums[from];
                    }
                    let blocks = traced.sums.blocks().iter().map(|(_, sums)| sums[from]);
                    let color = mean(accumulator.sum_with(*first + to, blocks), count);
                    (colors[to], finished[to]) = (color, true);
                }
            }
        } else {
            let sums = traced.sum();
            let count = self.pass.samples.len() as u32;
            for (start, sums) in row_starts.clone().zip(sums.chunks(tile.width as usize)) {
                if step == 1 {
                    colors[start..start + sums.len()].copy_from_slice(sums);
                    finished[start..start + sums.len()].fill(true);
                } else {
                    for (column, &sum) in sums.iter().enumerate() {
                        (colors[start + column * step], finished[start + column * step]) = (sum, true);
                    }
                }
                if count > 1 {
                    let row = colors[start..].iter_mut().step_by(step).take(sums.len());
                    row.for_each(|color| *color = mean(*color, count));
                }
            }
        }
        if !lost.is_empty() {
            for (start, traced) in row_starts.zip(traced.lost.chunks(tile.width as usize)) {
                let row = lost[start..].iter_mut().step_by(step);
                row.zip(traced).for_each(|(sum, &lost)| *sum = sum.saturating_add(lost));
            }
        }
        if step > 1 {
            self.fill_squares(tile, start, colors, finished);
        }
    }

    /// Shows the pixels of a coarse tile in place of those around them that are not finished.
    fn fill_squares(&self, tile: &Tile, start: usize, colors: &mut [Rgb], finished: &[bool]) {
        let (width, step) = (self.schedule.crop.width as usize, tile.step as usize);
        // The first pass has all the room up to its next pixels; later ones lie between the pixels of passes before them.
        let side = if self.pass.x == 0 && self.pass.y == 0 { step } else { step / 2 };
        let left = start % width;
        for row in 0..tile.height as usize {
            for column in 0..tile.width as usize {
                let at = start + row * step * width + column * step;
                let right = side.min(width - left - column * step);
                let (color, rows) = (colors[at], side.min((colors.len() - at).div_ceil(width)));
                for below in (0..rows).map(|y| at + y * width) {
                    for to in (below..below + right).filter(|&to| !finished[to]) {
                        colors[to] = color;
                    }
                }
            }
        }
    }

    fn report(&self, samples: u64, rays: u64) {
        let [done_samples, done_rays] = &self.done;
        let SharedSchedule { settings, options, crop, before, .. } = &self.schedule;
        let samples = before[0] + done_samples.fetch_add(samples, Ordering::Relaxed) + samples;
        let rays = before[1] + done_rays.fetch_add(rays, Ordering::Relaxed) + rays;
        if let Some(tell) = options.progress {
            tell(progress(crop, settings.spp, samples, rays));
        }
    }
}
