//! From a world to a film: in one go or step by step, on as many threads as there are, with progress and cancellation.

mod accumulator;
mod partial;
mod renderer;
mod spread;
mod warnings;

pub use crate::lanes::LaneWidth;
pub use crate::settings::Settings;
pub use partial::{Grid, JoinError, PartialFilm, Piece};
pub use renderer::{Fineness, Renderer};
pub use warnings::warnings;

use crate::film::{Crop, Film, FilmTooLarge};
use crate::integrate::{WithIntegrator, with_first_hit, with_integrator};
use crate::scene;
use crate::trace::{Integrator, PixelTrace, RayTree, Recorder, Statistics, Tile, Tracer};
use crate::world::World;
use renderer::Schedule;
use std::fmt;
use std::sync::atomic::{AtomicBool, Ordering};

/// Edge of a tile in pixels, if nobody says.
pub const TILE_SIZE: u32 = 32;

/// How to render; nothing here changes a bit of the picture but `crop`, which cuts it.
#[derive(Clone, Copy)]
pub struct Options<'a> {
    /// Worker threads; 0: [those by default](crate::threads::ByDefault).
    pub threads: usize,
    /// Edge of a square tile in pixels, at least 1.
    pub tile_size: u32,
    /// Lanes of the kernels.
    pub lanes: LaneWidth,
    /// Only this part of the picture.
    pub crop: Option<Crop>,
    /// In which order.
    pub passes: Passes,
    /// Called after every tile, from any thread.
    pub progress: Option<&'a (dyn Fn(Progress) + Sync)>,
    /// Set it to stop: what is finished by then comes back.
    pub cancel: Option<&'a AtomicBool>,
}

/// In which order a picture is rendered.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum Passes {
    /// Tile by tile, each with all of its samples.
    #[default]
    WholeTiles,
    /// So that there is soon something to look at: the first sample of every `coarsest`-th pixel, then of those between, and so on;
    /// then as many samples of all pixels as there are already, again and again.
    CoarseToFine {
        /// A power of two.
        coarsest: u32,
    },
}

impl Default for Options<'_> {
    fn default() -> Self {
        Self {
            threads: 0,
            tile_size: TILE_SIZE,
            lanes: LaneWidth::best(),
            crop: None,
            passes: Passes::default(),
            progress: None,
            cancel: None,
        }
    }
}

impl Options<'_> {
    /// The part of the picture that is wanted: all of it, if nobody says.
    ///
    /// # Errors
    /// If it is empty, or does not lie within.
    pub fn crop_of(&self, world: &World) -> Result<Crop, RenderError> {
        let size = world.camera.size;
        let crop = self.crop.unwrap_or(Crop { x: 0, y: 0, width: size[0], height: size[1] });
        let fits =
            |start: u32, length: u32, limit: u32| length > 0 && start.checked_add(length).is_some_and(|e| e <= limit);
        let is_within = fits(crop.x, crop.width, size[0]) && fits(crop.y, crop.height, size[1]);
        if is_within { Ok(crop) } else { Err(RenderError::CropOutside { crop, size }) }
    }
}

impl fmt::Debug for Options<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { threads, tile_size, lanes, crop, passes, .. } = self;
        let mut debug = f.debug_struct("Options");
        debug.field("threads", threads).field("tile_size", tile_size).field("lanes", lanes).field("crop", crop);
        debug.field("passes", passes).finish_non_exhaustive()
    }
}

/// How far a render has come.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Progress {
    /// Pixels finished; of a pixel that has some of its samples only these count.
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
    /// What was traced for the finished tiles.
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
    /// There are no such samples.
    #[error("no samples {} to {}: each pixel has {spp}", samples[0], i64::from(samples[1]) - 1)]
    SamplesOutside {
        /// What was asked for: the first, and the one behind the last.
        samples: [u32; 2],
        /// Samples per pixel.
        spp: u32,
    },
    /// The world was compiled for other models of light.
    #[error("the world was compiled for models of light other than {integrator:?}: with solids and media, or without")]
    OtherModel {
        /// What was asked for.
        integrator: scene::Integrator,
    },
}

/// Renders a picture.
///
/// # Errors
/// When the film does not fit into memory, the crop not into the picture, or the world not to the model of light.
pub fn render(world: &World, settings: &Settings, options: &Options<'_>) -> Result<Rendered, RenderError> {
    let mut film = Film::new(world.camera.size, Crop { x: 0, y: 0, width: 0, height: 0 })?;
    let statistics = render_into(&mut film, world, settings, options)?;
    Ok(Rendered { film, statistics })
}

/// Renders a picture in place of another one. Where both are of the same size its memory is used again, and need not
/// be fetched from the system.
///
/// # Errors
/// As [`render`]; the film may be of any size then.
pub fn render_into(
    film: &mut Film,
    world: &World,
    settings: &Settings,
    options: &Options<'_>,
) -> Result<Statistics, RenderError> {
    let mut schedule = Schedule::new(film, world, settings, options)?;
    schedule.step(film, world, settings, u64::MAX);
    if options.cancel.is_some_and(|c| c.load(Ordering::Relaxed)) {
        film.blacken_unfinished();
    }
    Ok(schedule.statistics())
}

/// Traces one pixel, column and row from the top left, and writes down every ray. The sum of the trees is the film's value,
/// bit for bit. `None` where the picture has no such pixel, or the world was compiled for other models of light.
pub fn trace_pixel(world: &World, settings: &Settings, x: u32, y: u32) -> Option<PixelTrace> {
    PixelTracer::new(world, settings)?.trace(x, y)
}

/// Traces one pixel after the other, in the memory of the one before.
pub(crate) struct PixelTracer<'a> {
    size: [u32; 2],
    samples: u32,
    tracer: Box<dyn TracePixel + 'a>,
}

impl<'a> PixelTracer<'a> {
    /// `None` if the world was compiled for other models of light.
    pub fn new(world: &'a World, settings: &'a Settings) -> Option<Self> {
        let tracer =
            world.is_for(settings.integrator).then(|| with_integrator(settings.integrator, New { world, settings }))?;
        Some(Self { size: world.camera.size, samples: settings.spp, tracer })
    }

    /// Only what the first sample's ray of the camera meets, without light.
    pub fn of_first_hits(world: &'a World, settings: &'a Settings) -> Option<Self> {
        let tracer =
            world.is_for(settings.integrator).then(|| with_first_hit(settings.integrator, New { world, settings }))?;
        Some(Self { size: world.camera.size, samples: 1, tracer })
    }

    /// Rays of all kinds so far.
    pub fn rays(&self) -> u64 {
        self.tracer.rays()
    }

    /// As [`trace_pixel`].
    pub fn trace(&mut self, x: u32, y: u32) -> Option<PixelTrace> {
        let [width, height] = self.size;
        (x < width && y < height).then(|| self.tracer.trace_pixel(x, y, self.samples))?
    }
}

/// A tracer that writes down what it traces, whatever the model of light.
trait TracePixel {
    fn rays(&self) -> u64;
    fn trace_pixel(&mut self, x: u32, y: u32, samples: u32) -> Option<PixelTrace>;
}

impl<I: Integrator> TracePixel for Tracer<'_, f64, Recorder, I> {
    fn rays(&self) -> u64 {
        self.statistics.rays.total()
    }

    fn trace_pixel(&mut self, x: u32, y: u32, samples: u32) -> Option<PixelTrace> {
        let sum = self.trace(&Tile::pixel(x, y), 0..samples)?.sum().first().copied()?;
        let samples: Vec<RayTree> = std::mem::take(&mut self.observer.samples);
        Some(PixelTrace { radiance: crate::trace::mean(sum, samples.len() as u32), samples })
    }
}

/// Makes such a tracer.
struct New<'a> {
    world: &'a World,
    settings: &'a Settings,
}

impl<'a> WithIntegrator for New<'a> {
    type Output = Box<dyn TracePixel + 'a>;
    fn run<I: Integrator>(self) -> Self::Output {
        Box::new(Tracer::<f64, Recorder, I>::new(self.world, self.settings, None, Recorder::default()))
    }
}
