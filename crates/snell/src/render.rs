//! From a world to a film: tiles, workers, progress, cancellation.

use crate::film::{Crop, Film, FilmTooLarge, Rgb};
pub use crate::lanes::LaneWidth;
use crate::lanes::{Kernel, Lanes, dispatch};
use crate::threads;
use crate::trace::{PixelTrace, Recorder, Statistics, Tracer};
use crate::world::World;
use std::fmt;
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Edge of a tile in pixels, if nobody says.
pub const TILE_SIZE: u32 = 32;

/// How to render; nothing here changes a bit of the picture but `crop`, which cuts it.
#[derive(Clone, Copy)]
pub struct Options<'a> {
    /// Worker threads; 0: as many as the machine has cores.
    pub threads: usize,
    /// Edge of a square tile in pixels, at least 1.
    pub tile_size: u32,
    /// Lanes of the kernels.
    pub lanes: LaneWidth,
    /// Only this part of the picture.
    pub crop: Option<Crop>,
    /// Called after every tile, from any thread.
    pub progress: Option<&'a (dyn Fn(Progress) + Sync)>,
    /// Set it to stop: what is finished by then comes back.
    pub cancel: Option<&'a AtomicBool>,
}

impl Default for Options<'_> {
    fn default() -> Self {
        Self { threads: 0, tile_size: TILE_SIZE, lanes: LaneWidth::best(), crop: None, progress: None, cancel: None }
    }
}

impl fmt::Debug for Options<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { threads, tile_size, lanes, crop, .. } = self;
        let mut debug = f.debug_struct("Options");
        debug.field("threads", threads).field("tile_size", tile_size).field("lanes", lanes).field("crop", crop);
        debug.finish_non_exhaustive()
    }
}

/// How far a render has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Pixels finished.
    pub pixels: u64,
    /// Pixels in all.
    pub total_pixels: u64,
    /// Rays of all kinds traced for them.
    pub rays: u64,
}

/// A picture and what it took.
#[derive(Clone, Debug)]
pub struct Rendered {
    /// The picture; some pixels are unfinished if it was cancelled.
    pub film: Film,
    /// What was traced. After a cancellation: for the finished tiles and some of the others.
    pub statistics: Statistics,
}

/// Why a render did not start.
#[derive(Clone, Copy, Debug, thiserror::Error)]
pub enum RenderError {
    /// Not enough memory.
    #[error(transparent)]
    FilmTooLarge(#[from] FilmTooLarge),
    /// The crop is empty or reaches beyond the picture.
    #[error(
        "the crop {}x{} at ({}, {}) does not lie within the picture of {}x{} pixels",
        crop.width, crop.height, crop.x, crop.y, size[0], size[1]
    )]
    CropOutside {
        /// What was asked for.
        crop: Crop,
        /// The picture.
        size: [u32; 2],
    },
}

/// Renders a picture.
///
/// # Errors
/// When the film does not fit into memory, or the crop not into the picture.
pub fn render(world: &World, options: &Options<'_>) -> Result<Rendered, RenderError> {
    let mut film = Film::new(world.camera.size, Crop { x: 0, y: 0, width: 0, height: 0 })?;
    let statistics = render_into(&mut film, world, options)?;
    Ok(Rendered { film, statistics })
}

/// Renders a picture in place of another one. Where both are of the same size its memory is used again, and need not
/// be fetched from the system.
///
/// # Errors
/// As [`render`]; the film may be of any size then.
pub fn render_into(film: &mut Film, world: &World, options: &Options<'_>) -> Result<Statistics, RenderError> {
    let size = world.camera.size;
    let crop = options.crop.unwrap_or(Crop { x: 0, y: 0, width: size[0], height: size[1] });
    let fits =
        |start: u32, length: u32, limit: u32| length > 0 && start.checked_add(length).is_some_and(|e| e <= limit);
    if !fits(crop.x, crop.width, size[0]) || !fits(crop.y, crop.height, size[1]) {
        return Err(RenderError::CropOutside { crop, size });
    }
    film.start_again(size, crop)?;
    // A tile fits into an array index, and so does a row of tiles, as the film does.
    let rows = usize::try_from(u64::from(options.tile_size.max(1)) * u64::from(crop.width)).unwrap_or(usize::MAX);
    let bands = film.pixels.chunks_mut(rows).zip(film.finished.chunks_mut(rows));
    let bands: Vec<Mutex<Band<'_>>> = bands.map(|(pixels, finished)| Mutex::new(Band { pixels, finished })).collect();
    let columns = u64::from(crop.width).div_ceil(u64::from(options.tile_size.max(1)));
    let shared = Shared {
        world,
        options,
        crop,
        order: Spread::new(columns * bands.len() as u64),
        taken: AtomicU64::new(0),
        rays: AtomicU64::new(0),
        bands,
        statistics: Mutex::new(Statistics::default()),
        pixels: AtomicU64::new(0),
    };
    shared.work();
    // A poisoned lock means that a worker panicked, which rayon has already passed on.
    let statistics = shared.statistics.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    if options.cancel.is_some_and(|c| c.load(Ordering::Relaxed)) {
        film.blacken_unfinished();
    }
    Ok(statistics)
}

/// Traces one pixel, column and row from the top left, and writes down every ray. The sum of the trees is the film's value,
/// bit for bit. `None` where the picture has no such pixel.
pub fn trace_pixel(world: &World, x: u32, y: u32) -> Option<PixelTrace> {
    PixelTracer::new(world).trace(x, y)
}

/// Traces one pixel after the other, in the memory of the one before.
pub(crate) struct PixelTracer<'a>(Tracer<'a, f64, Recorder>);

impl<'a> PixelTracer<'a> {
    pub fn new(world: &'a World) -> Self {
        Self(Tracer::new(world, None, Recorder::default()))
    }

    /// Rays of all kinds so far.
    pub fn rays(&self) -> u64 {
        self.0.statistics.rays.total()
    }

    /// As [`trace_pixel`].
    pub fn trace(&mut self, x: u32, y: u32) -> Option<PixelTrace> {
        let [width, height] = self.0.world.camera.size;
        let pixel = (x < width && y < height).then_some(Crop { x, y, width: 1, height: 1 })?;
        let radiance = self.0.trace(&pixel)?.first().copied()?;
        Some(PixelTrace { radiance, samples: std::mem::take(&mut self.0.observer.samples) })
    }
}

/// An order in which every number below `count` comes once, each far from the last ones: steps of the golden ratio leave no large
/// gap (Weyl 1916).
#[derive(Clone, Copy)]
struct Spread {
    count: u64,
    step: u64,
}

impl Spread {
    fn new(count: u64) -> Self {
        let gcd = |mut a: u64, mut b: u64| {
            while b != 0 {
                (a, b) = (b, a % b);
            }
            a
        };
        let golden = (count as f64 * 0.618_033_988_749_895) as u64;
        let step = (golden.max(1)..=count).find(|&step| gcd(step, count) == 1).unwrap_or(1);
        Self { count, step }
    }

    fn nth(self, turn: u64) -> u64 {
        (u128::from(turn) * u128::from(self.step) % u128::from(self.count)) as u64
    }
}

/// What one thread does.
struct Worker<'a, 'b>(&'a Shared<'b>);

impl Kernel for Worker<'_, '_> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        self.0.worker::<L>();
    }
}

/// One row of tiles: its part of the film.
struct Band<'a> {
    pixels: &'a mut [Rgb],
    finished: &'a mut [bool],
}

struct Shared<'a> {
    world: &'a World,
    options: &'a Options<'a>,
    crop: Crop,
    /// Sky and glass take turns, so that the pixels that are finished tell how long the others will take.
    order: Spread,
    /// How many tiles have been taken.
    taken: AtomicU64,
    rays: AtomicU64,
    pixels: AtomicU64,
    /// From top to bottom.
    bands: Vec<Mutex<Band<'a>>>,
    statistics: Mutex<Statistics>,
}

impl Shared<'_> {
    fn work(&self) {
        // More threads than tiles have nothing to do.
        let most = usize::try_from(self.order.count).unwrap_or(usize::MAX);
        threads::run(self.options.threads.min(most), || dispatch(self.options.lanes, Worker(self)));
    }

    fn tile_size(&self) -> u64 {
        u64::from(self.options.tile_size.max(1))
    }

    /// Tiles in a band.
    fn columns(&self) -> u64 {
        u64::from(self.crop.width).div_ceil(self.tile_size())
    }

    #[inline(always)]
    fn worker<L: Lanes>(&self) {
        let mut tracer = Tracer::<L, ()>::new(self.world, self.options.cancel, ());
        while let Some((band, tile)) = self.take_tile() {
            let rays_before = tracer.statistics.rays.total();
            let Some(radiance) = tracer.trace(&tile) else { break };
            self.store(band, &tile, radiance);
            let pixels = u64::from(tile.width) * u64::from(tile.height);
            self.report(pixels, tracer.statistics.rays.total() - rays_before);
        }
        if let Ok(mut statistics) = self.statistics.lock() {
            statistics.merge(&tracer.statistics);
        }
    }

    /// The next tile and its band, if there is one and nobody has cancelled.
    fn take_tile(&self) -> Option<(usize, Crop)> {
        let turn = self.taken.fetch_add(1, Ordering::Relaxed);
        if turn >= self.order.count || self.options.cancel.is_some_and(|c| c.load(Ordering::Relaxed)) {
            return None;
        }
        let (size, crop, tile) = (self.tile_size(), &self.crop, self.order.nth(turn));
        let (band, column) = (tile / self.columns(), tile % self.columns());
        let (left, top) = (column * size, band * size);
        let width = size.min(u64::from(crop.width) - left) as u32;
        let height = size.min(u64::from(crop.height) - top) as u32;
        Some((band as usize, Crop { x: crop.x + left as u32, y: crop.y + top as u32, width, height }))
    }

    /// Stores the pixels of a tile, row by row.
    fn store(&self, band: usize, tile: &Crop, radiance: &[Rgb]) {
        let Ok(mut film) = self.bands[band].lock() else { return };
        let (left, width) = ((tile.x - self.crop.x) as usize, tile.width as usize);
        for (row, colors) in radiance.chunks(width).enumerate() {
            let start = row * self.crop.width as usize + left;
            film.pixels[start..start + width].copy_from_slice(colors);
            film.finished[start..start + width].fill(true);
        }
    }

    fn report(&self, pixels: u64, rays: u64) {
        let pixels = self.pixels.fetch_add(pixels, Ordering::Relaxed) + pixels;
        let rays = self.rays.fetch_add(rays, Ordering::Relaxed) + rays;
        if let Some(progress) = self.options.progress {
            let total_pixels = u64::from(self.crop.width) * u64::from(self.crop.height);
            progress(Progress { pixels, total_pixels, rays });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::Spread;

    #[test]
    fn every_number_has_its_turn_and_neighbours_in_time_are_far_apart() {
        for count in 1..300 {
            let spread = Spread::new(count);
            let order: Vec<u64> = (0..count).map(|turn| spread.nth(turn)).collect();
            let mut sorted = order.clone();
            sorted.sort_unstable();
            assert_eq!(sorted, (0..count).collect::<Vec<_>>());
            // Halves are sampled evenly from the first tenth on, so that a rate tells the time left.
            let begun = &order[..count.div_ceil(10) as usize];
            let upper = begun.iter().filter(|&&band| band < count / 2).count();
            assert!(upper.abs_diff(begun.len() - upper) <= 1 + begun.len() / 4, "{count}: {begun:?}");
        }
    }
}
