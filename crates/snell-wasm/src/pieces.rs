//! The part of a picture that one of many instances renders: pieces that get finer together.

use crate::part::rows;
use snell::film::{Crop, Film};
use snell::render::{Fineness, Options, Progress, RenderError, Renderer};
use snell::trace::{Statistics, Tile};
use snell::world::CompiledScene;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Side of a piece in pixels.
const SIDE: u32 = 64;

/// Pieces of a picture, each with a render of its own.
pub struct Pieces {
    renderers: Vec<Renderer<'static>>,
    /// Those that are not finished, the coarsest first.
    waiting: BinaryHeap<Reverse<(Fineness, usize)>>,
}

/// Cuts a part of a picture along a grid, and returns the pieces of a share: its number from 0 and the number of shares. Neighbours
/// belong to different shares, as what takes long is often in one place.
pub fn cut(crop: Crop, [share, shares]: [u32; 2]) -> impl Iterator<Item = Crop> {
    let cells = |start: u32, length: u32| start / SIDE..(start + length).div_ceil(SIDE);
    let along = |cell: u32, start: u32, length: u32| {
        let (first, end) = (start.max(cell * SIDE), (start + length).min((cell + 1).saturating_mul(SIDE)));
        (first, end - first)
    };
    let columns = cells(crop.x, crop.width);
    let grid = cells(crop.y, crop.height).flat_map(move |row| columns.clone().map(move |column| (column, row)));
    grid.filter(move |(column, row)| (column + row) % shares == share).map(move |(column, row)| {
        let ((x, width), (y, height)) = (along(column, crop.x, crop.width), along(row, crop.y, crop.height));
        Crop { x, y, width, height }
    })
}

impl Pieces {
    /// Begins to render these parts of a picture.
    pub fn begin(
        compiled: &CompiledScene,
        options: &Options<'static>,
        crops: impl Iterator<Item = Crop>,
    ) -> Result<Self, RenderError> {
        let begin = |crop| {
            let options = Options { crop: Some(crop), ..*options };
            Renderer::new(compiled.shared_world(), compiled.settings(), &options)
        };
        let renderers = crops.map(begin).collect::<Result<Vec<_>, _>>()?;
        let waiting = renderers.iter().enumerate().filter_map(|(at, piece)| Some(Reverse((piece.fineness()?, at))));
        let waiting = waiting.collect();
        Ok(Self { renderers, waiting })
    }

    pub fn is_finished(&self) -> bool {
        self.waiting.is_empty()
    }

    /// Renders a tile of the coarsest piece. Returns what has changed, and the piece.
    pub fn step(&mut self) -> Option<(Vec<Tile>, Crop)> {
        let Reverse((_, at)) = self.waiting.pop()?;
        let piece = &mut self.renderers[at];
        let tiles = piece.step(1);
        self.waiting.extend(piece.fineness().map(|fineness| Reverse((fineness, at))));
        Some((tiles, piece.film().crop))
    }

    /// The whole picture, if it is in one piece.
    pub fn whole(&self) -> Option<&Film> {
        match &self.renderers[..] {
            [renderer] => Some(renderer.film()),
            _ => None,
        }
    }

    /// What lies within a piece.
    pub fn part(&self, part: Crop) -> Option<Film> {
        self.renderers.iter().find_map(|piece| piece.film().part(part))
    }

    /// The light that the pixels of what lies within a piece have lost so far, in units of 2⁻³².
    pub fn lost(&self, part: Crop) -> Option<Vec<f64>> {
        let (piece, rows) = self.renderers.iter().find_map(|piece| Some((piece, rows(part, piece.film().crop)?)))?;
        let lost = piece.lost()?;
        Some(rows.flat_map(|row| lost[row].iter().map(|&units| units as f64)).collect())
    }

    pub fn progress(&self) -> Progress {
        let add = |sum: Progress, one: Progress| Progress {
            pixels: sum.pixels + one.pixels,
            total_pixels: sum.total_pixels + one.total_pixels,
            rays: sum.rays + one.rays,
        };
        let nothing = Progress { pixels: 0, total_pixels: 0, rays: 0 };
        self.renderers.iter().map(Renderer::progress).fold(nothing, add)
    }

    pub fn statistics(&self) -> Statistics {
        let mut all = Statistics::default();
        self.renderers.iter().for_each(|piece| all.merge(&piece.statistics()));
        all
    }
}
