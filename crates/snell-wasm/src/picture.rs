//! A picture that comes tile by tile, rendered here or gathered from others.

use crate::gathered::Gathered;
use crate::page::now;
use crate::pieces::{Pieces, cut};
use serde::Deserialize;
use snell::film::{BYTES_PER_PIXEL, Crop, Film, Rgb};
use snell::render::{Options, Passes, Progress, RenderError};
use snell::scene::{Integrator, Shadows, Warning};
use snell::trace::{Statistics, Tile};
use snell::world::CompiledScene;
use snell_formats::recipe::Changes;
use snell_formats::{Report, memory};

/// How a picture is asked for: what is left out is as the scene has it.
#[derive(Default, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct Asked {
    size: Option<[u32; 2]>,
    spp: Option<u32>,
    depth: Option<u32>,
    integrator: Option<Integrator>,
    shadows: Option<Shadows>,
    /// The first sample of every so many-th pixel comes first; left out, each tile comes with all of its samples.
    coarsest: Option<u32>,
    crop: Option<Crop>,
    /// The number of a share, from 0, and how many there are.
    share: Option<[u32; 2]>,
}

impl Asked {
    /// Reads options.
    pub fn parse(options: Option<&str>) -> Result<Self, Report> {
        let Some(options) = options else { return Ok(Self::default()) };
        // As an object alone: serde would take a list for its values.
        let object: serde_json::Result<serde_json::Map<_, _>> = serde_json::from_str(options);
        object.and_then(|object| serde_json::from_value(object.into())).map_err(|e| {
            let help = "like { \"size\": [256, 256], \"coarsest\": 8 }; there are size, spp, depth, integrator, shadows, coarsest, crop, \
                        share";
            Report::error(format!("these are no options of a picture: {e}")).help(help)
        })
    }

    /// What makes it another picture than that of the scene.
    pub fn changes(&self) -> Changes {
        Changes {
            size: self.size,
            crop: self.crop,
            spp: self.spp,
            depth: self.depth,
            integrator: self.integrator,
            shadows: self.shadows,
            ..Changes::default()
        }
    }

    fn passes(&self) -> Passes {
        self.coarsest.map_or(Passes::WholeTiles, |coarsest| Passes::CoarseToFine { coarsest })
    }
}

/// A picture, or the part of it that there is.
pub enum Picture {
    /// It is rendered here, all of it or a share.
    Rendered(Pieces),
    /// Others render it.
    Gathered(Box<Gathered>),
}

/// Sums of samples, and the light that was lost: at most so many bytes for each pixel, while passes refine it.
const BYTES_OF_PASSES: u64 = 4 * size_of::<Rgb>() as u64 + size_of::<u64>() as u64;

impl Picture {
    /// Begins a picture.
    pub fn begin(compiled: &CompiledScene, asked: &Asked) -> Result<Self, Report> {
        let options = Options { crop: asked.crop, passes: asked.passes(), ..Options::default() };
        let of_passes = if options.passes == Passes::WholeTiles { 0 } else { BYTES_OF_PASSES };
        let crop = options.crop_of(compiled.world()).map_err(refused)?;
        let [share, shares] = asked.share.unwrap_or([0, 1]);
        if share >= shares {
            return Err(Report::error(format!("there is no share {share} of {shares}")).help("shares count from 0"));
        }
        enough_memory(crop, shares, BYTES_PER_PIXEL + of_passes)?;
        let pieces = match asked.share {
            Some(share) => Pieces::begin(compiled, &options, cut(crop, share)),
            None => Pieces::begin(compiled, &options, std::iter::once(crop)),
        };
        pieces.map(Self::Rendered).map_err(refused)
    }

    /// Begins one that others render.
    pub fn gather(compiled: &CompiledScene, asked: &Asked) -> Result<Self, Report> {
        let options = Options { crop: asked.crop, ..Options::default() };
        let crop = options.crop_of(compiled.world()).map_err(refused)?;
        enough_memory(crop, 1, Gathered::BYTES_PER_PIXEL)?;
        let gathered = Gathered::new(compiled.world().camera.size, crop).map_err(|error| refused(error.into()))?;
        Ok(Self::Gathered(Box::new(gathered)))
    }

    /// The picture, if it is not only a share.
    pub fn film(&self) -> Option<&Film> {
        match self {
            Self::Rendered(pieces) => pieces.whole(),
            Self::Gathered(gathered) => Some(&gathered.film),
        }
    }

    /// A part of it. A share has those that lie within one of its pieces.
    pub fn part(&self, part: Crop) -> Option<Film> {
        match self {
            Self::Rendered(pieces) => pieces.part(part),
            Self::Gathered(gathered) => gathered.film.part(part),
        }
    }

    /// The light that the pixels of such a part have lost so far, in units of 2⁻³². Where tiles come whole, nobody knows.
    pub fn lost(&self, part: Crop) -> Option<Vec<f64>> {
        match self {
            Self::Rendered(pieces) => pieces.lost(part),
            Self::Gathered(gathered) => gathered.lost(part),
        }
    }

    pub fn is_finished(&self) -> bool {
        match self {
            Self::Rendered(pieces) => pieces.is_finished(),
            Self::Gathered(gathered) => gathered.film.is_finished(),
        }
    }

    /// How far it is.
    pub fn progress(&self) -> Progress {
        match self {
            Self::Rendered(pieces) => pieces.progress(),
            Self::Gathered(gathered) => gathered.progress(),
        }
    }

    /// What was traced for it.
    pub fn statistics(&self) -> Statistics {
        match self {
            Self::Rendered(pieces) => pieces.statistics(),
            Self::Gathered(gathered) => gathered.statistics.clone(),
        }
    }

    /// What is odd about what was rendered.
    pub fn warnings(&self, compiled: &CompiledScene) -> Vec<Warning> {
        snell::render::warnings(&self.statistics(), compiled.world(), &compiled.settings())
    }

    /// Renders tile after tile until the time is over, at least one. Returns which parts of the picture have changed.
    pub fn step(&mut self, milliseconds: f64) -> Vec<Changed> {
        let Self::Rendered(pieces) = self else { return Vec::new() };
        let (start, mut changed) = (now(), Vec::new());
        while let Some((tiles, piece)) = pieces.step() {
            changed.extend(tiles.iter().map(|tile| Changed::of(tile, &piece)));
            if now() - start >= milliseconds || milliseconds.is_nan() {
                break;
            }
        }
        changed
    }

    /// The picture that takes what others have rendered.
    pub fn gathered(&mut self) -> Result<&mut Gathered, Report> {
        match self {
            Self::Rendered(_) => Err(Report::error("this picture is rendered here, and takes nothing from elsewhere")),
            Self::Gathered(gathered) => Ok(gathered),
        }
    }
}

fn refused(error: RenderError) -> Report {
    Report::error(error.to_string())
}

/// Refuses what would not fit into the 4 GiB of an instance: where memory cannot be had, it traps.
fn enough_memory(Crop { width, height, .. }: Crop, shares: u32, bytes_per_pixel: u64) -> Result<(), Report> {
    let pixels = (u64::from(width) * u64::from(height)).div_ceil(u64::from(shares));
    let needed = pixels.saturating_mul(bytes_per_pixel);
    memory::check(&format!("a picture of {width} x {height} pixels"), needed)
        .or_else(|report| if is_there(needed) { Ok(()) } else { Err(report) })
        .map_err(|report| report.help("choose a smaller size, or render a part (crop)"))
}

/// Can so many bytes be had in one piece? What a picture before has given back does not count as free, and is there all the same.
fn is_there(bytes: u64) -> bool {
    let mut memory: Vec<u8> = Vec::new();
    let is_there = usize::try_from(bytes).is_ok_and(|bytes| memory.try_reserve_exact(bytes).is_ok());
    // Or the compiler would leave out memory that nobody uses.
    std::hint::black_box(memory.as_ptr());
    is_there
}

/// A part of the picture that has changed, in pixels of the whole one.
pub struct Changed {
    rect: Crop,
    /// How far the pixels are apart that were rendered; those between look like them for now.
    step: u32,
}

impl Changed {
    fn of(tile: &Tile, crop: &Crop) -> Self {
        let length = |start: u32, count: u32, end: u32| count.saturating_mul(tile.step).min(end - start);
        let width = length(tile.x, tile.width, crop.x + crop.width);
        let height = length(tile.y, tile.height, crop.y + crop.height);
        Self { rect: Crop { x: tile.x, y: tile.y, width, height }, step: tile.step }
    }

    /// Left, top, width, height, step.
    pub fn numbers(&self) -> [u32; 5] {
        let Self { rect: Crop { x, y, width, height }, step } = *self;
        [x, y, width, height, step]
    }
}
