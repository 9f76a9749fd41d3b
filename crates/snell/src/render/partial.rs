//! Pictures of which some samples are there: what machines that share the work hand to each other, and what is kept of an
//! unfinished render.

use super::spread::Spread;
use super::{Options, Progress, RenderError, Settings};
use crate::color::Rgb;
use crate::film::{Crop, Film, FilmTooLarge};
use crate::integrate::{WithIntegrator, with_integrator};
use crate::lanes::{Kernel, Lanes, dispatch};
use crate::threads;
use crate::trace::{Block, Integrator, PairwiseSum, Statistics, Tile, Tracer, Twice, add_to, mean};
use crate::world::World;
use serde::{Deserialize, Serialize};
use std::marker::PhantomData;
use std::ops::Range;
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Mutex, PoisonError};
use std::time::Instant;

/// A rectangle of pixels of which the same samples are there.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct Piece {
    /// The pixels.
    pub rect: Crop,
    /// The first sample of each range, and the one behind its last; in order, and apart from each other.
    pub samples: Vec<[u32; 2]>,
}

impl Piece {
    /// The blocks whose sums are kept for each pixel, in order.
    pub fn blocks(&self) -> Vec<Block> {
        self.samples.iter().flat_map(|&[first, end]| Block::of(first..end)).collect()
    }

    /// How many pixels.
    pub fn pixel_count(&self) -> u64 {
        u64::from(self.rect.width) * u64::from(self.rect.height)
    }
}

/// Some samples of the pixels of a rectangle, in cells that may each have others.
///
/// Samples that were rendered apart, on whatever machines, add up to the same bits as if they had been rendered together
/// ([`PairwiseSum`]).
#[derive(Clone, Debug, PartialEq)]
pub struct PartialFilm {
    size: [u32; 2],
    crop: Crop,
    grid: Grid,
    /// Row by row.
    cells: Vec<Cell>,
    /// Without the worst pixel, which is looked for when somebody asks.
    statistics: Statistics,
}

/// Where a rectangle is cut, in columns and rows: from its first edge to its last one.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Grid {
    x: Vec<u32>,
    y: Vec<u32>,
}

impl Grid {
    /// Cuts a rectangle along tiles of this size, and along the edges of others where they cross it.
    pub fn new(crop: Crop, tile_size: u32, along: impl IntoIterator<Item = Crop>) -> Self {
        let tiles = |start: u32, length: u32| (0..length).step_by(tile_size.max(1) as usize).map(move |at| start + at);
        let mut x: Vec<u32> = tiles(crop.x, crop.width).chain([crop.x + crop.width]).collect();
        let mut y: Vec<u32> = tiles(crop.y, crop.height).chain([crop.y + crop.height]).collect();
        for other in along {
            x.extend([other.x, other.x.saturating_add(other.width)]);
            y.extend([other.y, other.y.saturating_add(other.height)]);
        }
        x.retain(|&x| (crop.x..=crop.x + crop.width).contains(&x));
        y.retain(|&y| (crop.y..=crop.y + crop.height).contains(&y));
        for edges in [&mut x, &mut y] {
            edges.sort_unstable();
            edges.dedup();
        }
        Self { x, y }
    }

    fn columns(&self) -> usize {
        self.x.len() - 1
    }

    /// The cells, row by row.
    pub fn cells(&self) -> impl Iterator<Item = Crop> + '_ {
        (0..self.columns() * (self.y.len() - 1)).map(|number| self.cell(number))
    }

    /// The rows at which it is cut, from its first to behind its last one.
    pub fn rows(&self) -> &[u32] {
        &self.y
    }

    /// The cells that lie within a rectangle, by their numbers, row by row.
    pub fn within(&self, rect: Crop) -> impl Iterator<Item = usize> + use<> {
        let some = |edges: &[u32], start: u32, length: u32| {
            let first = edges.partition_point(|&edge| edge < start);
            let end = edges.partition_point(|&edge| edge <= start.saturating_add(length));
            first..end.saturating_sub(1).max(first)
        };
        let (columns, x) = (self.columns(), some(&self.x, rect.x, rect.width));
        some(&self.y, rect.y, rect.height).flat_map(move |row| x.clone().map(move |column| row * columns + column))
    }

    fn cell(&self, number: usize) -> Crop {
        let (column, row) = (number % self.columns(), number / self.columns());
        let (x, y) = (self.x[column], self.y[row]);
        Crop { x, y, width: self.x[column + 1] - x, height: self.y[row + 1] - y }
    }

    /// Neighbouring cells of which the same is true, as rectangles: first the neighbours in a row, then equal ones below each other.
    /// `of` tells of each cell, by its number, what is true, and nothing of those that do not matter.
    pub fn rectangles<T: PartialEq>(&self, of: impl Fn(usize) -> Option<T>) -> Vec<(Crop, T)> {
        let mut done: Vec<(Crop, T)> = Vec::new();
        let mut open: Vec<(Crop, T)> = Vec::new();
        let cells: Vec<Crop> = self.cells().collect();
        for (row, cells) in cells.chunks(self.columns()).enumerate() {
            let mut found: Vec<(Crop, T)> = Vec::new();
            for (column, cell) in cells.iter().enumerate() {
                let Some(fact) = of(row * self.columns() + column) else { continue };
                match found.last_mut() {
                    Some((last, same)) if *same == fact && last.x + last.width == cell.x => last.width += cell.width,
                    _ => found.push((*cell, fact)),
                }
            }
            let mut below = Vec::new();
            for (cell, fact) in found {
                let above = open.iter().position(|(rect, same)| {
                    (rect.x, rect.width, rect.y + rect.height) == (cell.x, cell.width, cell.y) && *same == fact
                });
                match above {
                    Some(above) => {
                        let (mut rect, fact) = open.remove(above);
                        rect.height += cell.height;
                        below.push((rect, fact));
                    }
                    None => below.push((cell, fact)),
                }
            }
            done.append(&mut open);
            open = below;
        }
        done.append(&mut open);
        done.sort_by_key(|(rect, _)| (rect.y, rect.x));
        done
    }
}

/// Why films were not joined.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum JoinError {
    /// They are of pictures of different sizes.
    #[error("they are of pictures of different sizes: {} x {} and {} x {} pixels", .0[0], .0[1], .1[0], .1[1])]
    OtherSize([u32; 2], [u32; 2]),
    /// They have samples in common.
    #[error(transparent)]
    Twice(#[from] Twice),
}

#[derive(Clone, Debug, Default, PartialEq)]
struct Cell {
    /// Pixels row by row.
    sums: PairwiseSum<Vec<Rgb>>,
    /// What each pixel has lost, in whole units; empty where there are no samples.
    lost: Vec<u64>,
}

impl Cell {
    fn add(&mut self, blocks: Vec<(Block, Vec<Rgb>)>, lost: &[u64]) -> Result<(), Twice> {
        for (block, _) in &blocks {
            self.sums.check(*block)?;
        }
        for (block, plane) in blocks {
            self.sums.insert(block, plane, add_to, drop)?;
        }
        self.lost.resize(lost.len(), 0);
        self.lost.iter_mut().zip(lost).for_each(|(sum, &lost)| *sum = sum.saturating_add(lost));
        Ok(())
    }

    fn samples(&self) -> Vec<[u32; 2]> {
        let end = |end: u64| u32::try_from(end).unwrap_or(u32::MAX);
        self.sums.samples().into_iter().map(|range| [range.start as u32, end(range.end)]).collect()
    }
}

/// The smallest rectangle around two.
fn around(a: Crop, b: Crop) -> Crop {
    let span = |a: u32, a_length: u32, b: u32, b_length: u32| {
        let first = a.min(b);
        (first, (a + a_length).max(b + b_length) - first)
    };
    let ((x, width), (y, height)) = (span(a.x, a.width, b.x, b.width), span(a.y, a.height, b.y, b.height));
    Crop { x, y, width, height }
}

/// What is missing of some samples where those of `there` are.
fn missing(wanted: Range<u32>, there: &[[u32; 2]]) -> Vec<Range<u32>> {
    let (mut missing, mut from) = (Vec::new(), wanted.start);
    for &[first, end] in there {
        if first > from {
            missing.push(from..first.min(wanted.end));
        }
        from = from.max(end);
    }
    missing.push(from..wanted.end);
    missing.retain(|range| range.start < range.end);
    missing
}

/// Ranges that double, so that few sums are kept of what is there after each: 0, 1, 2 to 3, 4 to 7, …
fn doubling(samples: Range<u32>) -> Vec<Range<u32>> {
    let (mut ranges, mut first, mut count) = (Vec::new(), samples.start, 1);
    while first < samples.end {
        let end = first.saturating_add(count).min(samples.end);
        ranges.push(first..end);
        count = (end - samples.start).max(1);
        first = end;
    }
    ranges
}

impl PartialFilm {
    /// No samples of a rectangle of a picture of this size, which lies within it.
    pub fn new(size: [u32; 2], crop: Crop, grid: Grid) -> Self {
        let cells = grid.cells().map(|_| Cell::default()).collect();
        Self { size, crop, grid, cells, statistics: Statistics::default() }
    }

    /// The size of the whole picture.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Which part of the picture it is about.
    pub fn crop(&self) -> Crop {
        self.crop
    }

    /// Adds the samples of a piece, as [`row`](Self::row) and [`lost_row`](Self::lost_row) give them, row by row: those of the part of
    /// it that lies within. Its edges must be among those of the grid.
    ///
    /// # Errors
    /// When some of them are there already; some cells may have been changed then.
    pub fn insert(&mut self, piece: &Piece, sums: &[Rgb], lost: &[u64]) -> Result<(), Twice> {
        let (rect, blocks) = (piece.rect, piece.blocks());
        for number in self.grid.within(rect) {
            let (at, cell) = (self.grid.cell(number), &mut self.cells[number]);
            let count = at.width as usize * at.height as usize;
            let mut planes: Vec<(Block, Vec<Rgb>)> =
                blocks.iter().map(|&block| (block, Vec::with_capacity(count))).collect();
            let mut lost_here = Vec::with_capacity(count);
            for y in at.y..at.y + at.height {
                let start = (y - rect.y) as usize * rect.width as usize + (at.x - rect.x) as usize;
                let end = start + at.width as usize;
                lost_here.extend_from_slice(&lost[start..end]);
                for pixel in sums[start * blocks.len()..end * blocks.len()].chunks(blocks.len()) {
                    planes.iter_mut().zip(pixel).for_each(|((_, plane), &sum)| plane.push(sum));
                }
            }
            cell.add(planes, &lost_here)?;
        }
        Ok(())
    }

    /// All that this and other films of the same picture have, in the smallest rectangle around them.
    ///
    /// # Errors
    /// When some samples are there twice, or one is of a picture of another size.
    pub fn joined(&self, others: &[&Self]) -> Result<Self, JoinError> {
        if let Some(other) = others.iter().find(|other| other.size != self.size) {
            return Err(JoinError::OtherSize(self.size, other.size));
        }
        let parts: Vec<&Self> = [self].into_iter().chain(others.iter().copied()).collect();
        let crop = others.iter().map(|part| part.crop).fold(self.crop, around);
        let pieces: Vec<(&Self, Piece)> =
            parts.iter().flat_map(|part| part.pieces().into_iter().map(move |piece| (*part, piece))).collect();
        let grid = Grid::new(crop, u32::MAX, pieces.iter().map(|(_, piece)| piece.rect));
        let mut all = Self::new(self.size, crop, grid);
        let (mut sums, mut lost) = (Vec::new(), Vec::new());
        for (part, piece) in pieces {
            sums.clear();
            lost.clear();
            for y in piece.rect.y..piece.rect.y + piece.rect.height {
                part.row(&piece, y, &mut sums);
                part.lost_row(&piece, y, &mut lost);
            }
            all.insert(&piece, &sums, &lost)?;
        }
        for part in parts {
            all.count(&part.statistics);
        }
        Ok(all)
    }

    /// Counts what samples that were inserted took.
    pub fn count(&mut self, statistics: &Statistics) {
        self.statistics.merge(statistics);
    }

    /// What is there, in rectangles.
    pub fn pieces(&self) -> Vec<Piece> {
        let of = |cell: usize| Some(self.cells[cell].samples()).filter(|samples| !samples.is_empty());
        self.grid.rectangles(of).into_iter().map(|(rect, samples)| Piece { rect, samples }).collect()
    }

    /// The cells of a row of pixels of a piece, and which row of each it is.
    fn cells_of_row(&self, rect: Crop, y: u32) -> impl Iterator<Item = (&Cell, usize, Crop)> {
        let row = self.grid.y.partition_point(|&edge| edge <= y) - 1;
        let (top, height) = (self.grid.y[row], self.grid.y[row + 1] - self.grid.y[row]);
        let of_row = Crop { y: top, height, ..rect };
        self.grid.within(of_row).map(move |number| {
            let at = self.grid.cell(number);
            (&self.cells[number], (y - at.y) as usize, at)
        })
    }

    /// The sums of a row of a piece, pixel by pixel, and of each pixel [block by block](Piece::blocks).
    pub fn row(&self, piece: &Piece, y: u32, put: &mut Vec<Rgb>) {
        for (cell, row, at) in self.cells_of_row(piece.rect, y) {
            let start = row * at.width as usize;
            for pixel in start..start + at.width as usize {
                put.extend(cell.sums.blocks().iter().map(|(_, plane)| plane[pixel]));
            }
        }
    }

    /// What the pixels of a row of a piece have lost, in whole units.
    pub fn lost_row(&self, piece: &Piece, y: u32, put: &mut Vec<u64>) {
        for (cell, row, at) in self.cells_of_row(piece.rect, y) {
            put.extend_from_slice(&cell.lost[row * at.width as usize..][..at.width as usize]);
        }
    }

    /// What the samples took.
    pub fn statistics(&self) -> Statistics {
        let numbered = self.grid.cells().zip(&self.cells).flat_map(|(at, cell)| {
            let width = at.width as usize;
            cell.lost.iter().enumerate().filter(|(_, lost)| **lost > 0).map(move |(i, &lost)| {
                let (x, y) = (u64::from(at.x) + (i % width) as u64, u64::from(at.y) + (i / width) as u64);
                ([x, y], lost)
            })
        });
        let number = |[x, y]: [u64; 2]| y * u64::from(self.size[0]) + x;
        let lost = self.statistics.lost.with_worst_of(numbered.map(|(at, lost)| (number(at), lost)));
        Statistics { lost, ..self.statistics.clone() }
    }

    /// Are these samples of all pixels there?
    pub fn has(&self, samples: Range<u32>) -> bool {
        self.cells.iter().all(|cell| missing(samples.clone(), &cell.samples()).is_empty())
    }

    /// Which of these samples are not there, in rectangles.
    pub fn missing(&self, samples: Range<u32>) -> Vec<Piece> {
        let of = |cell: usize| {
            let missing = missing(samples.clone(), &self.cells[cell].samples());
            Some(missing.into_iter().map(|range| [range.start, range.end]).collect()).filter(|m: &Vec<_>| !m.is_empty())
        };
        self.grid.rectangles(of).into_iter().map(|(rect, samples)| Piece { rect, samples }).collect()
    }

    /// The picture of its rectangle, as [`put_into`](Self::put_into) makes it.
    ///
    /// # Errors
    /// When its memory cannot be allocated.
    pub fn film(&self, spp: u32) -> Result<Film, FilmTooLarge> {
        let mut film = Film::new(self.size, self.crop)?;
        self.put_into(&mut film, spp);
        Ok(film)
    }

    /// Puts its pixels into a film that its rectangle lies within. Those of which all `spp` samples are there are finished; of which
    /// only the first ones are there, these are shown. Others stay as they are.
    pub fn put_into(&self, film: &mut Film, spp: u32) {
        let (crop, width) = (film.crop, film.crop.width as usize);
        for (at, cell) in self.grid.cells().zip(&self.cells) {
            let [[0, count]] = cell.samples()[..] else { continue };
            for row in 0..at.height as usize {
                let from = row * at.width as usize;
                let to = ((at.y - crop.y) as usize + row) * width + (at.x - crop.x) as usize;
                for column in 0..at.width as usize {
                    let blocks = cell.sums.blocks().iter().map(|(_, plane)| plane[from + column]);
                    let sum = blocks.reduce(|sum, block| sum + block).unwrap_or(Rgb::black());
                    film.pixels[to + column] = mean(sum, count);
                }
                film.finished[to..to + at.width as usize].fill(count == spp);
            }
        }
    }

    /// Renders what is missing of these samples, cell by cell, fewer samples first, until everything is there, until it is cancelled, or
    /// until that time. Of the options those count that do not say what to render.
    ///
    /// # Errors
    /// As [`render`](super::render).
    pub fn render(
        &mut self,
        world: &World,
        settings: &Settings,
        samples: Range<u32>,
        options: &Options<'_>,
        until: Option<Instant>,
    ) -> Result<(), RenderError> {
        if !world.is_for(settings.integrator) {
            return Err(RenderError::OtherModel { integrator: settings.integrator });
        }
        if samples.is_empty() || samples.end > settings.spp {
            let samples = [samples.start, samples.end];
            return Err(RenderError::SamplesOutside { samples, spp: settings.spp });
        }
        if world.camera.size != self.size {
            return Err(RenderError::CropOutside { crop: self.crop, size: world.camera.size });
        }
        let there: Vec<Vec<[u32; 2]>> = self.cells.iter().map(Cell::samples).collect();
        let at: Vec<Crop> = self.grid.cells().collect();
        let order = Spread::new(at.len() as u64);
        let mut tasks = Vec::new();
        for range in doubling(samples.clone()) {
            for cell in (0..order.count).map(|turn| order.nth(turn) as usize) {
                tasks.extend(missing(range.clone(), &there[cell]).into_iter().map(|range| (cell, range)));
            }
        }
        let pixels = |at: &Crop| u64::from(at.width) * u64::from(at.height);
        let total_pixels: u64 = at.iter().map(pixels).sum();
        let left: u64 = tasks.iter().map(|(cell, range)| pixels(&at[*cell]) * range.len() as u64).sum();
        let count = samples.len() as u64;
        let shared = Shared {
            world,
            settings,
            options,
            until,
            tasks: &tasks,
            at: &at,
            cells: self.cells.iter_mut().map(Mutex::new).collect(),
            next: AtomicUsize::new(0),
            total_pixels,
            count,
            samples: AtomicU64::new(total_pixels * count - left),
            rays: AtomicU64::new(self.statistics.rays.total()),
            statistics: Mutex::new(Statistics::default()),
        };
        with_integrator(settings.integrator, Work(&shared));
        // A poisoned lock means that a worker panicked, which rayon has already passed on.
        let statistics = shared.statistics.into_inner().unwrap_or_else(PoisonError::into_inner);
        self.statistics.merge(&statistics);
        Ok(())
    }
}

/// What workers share.
struct Shared<'s, 'a> {
    world: &'s World,
    settings: &'s Settings,
    options: &'s Options<'a>,
    until: Option<Instant>,
    /// Cells and samples.
    tasks: &'s [(usize, Range<u32>)],
    at: &'s [Crop],
    cells: Vec<Mutex<&'s mut Cell>>,
    next: AtomicUsize,
    total_pixels: u64,
    /// Samples of each pixel.
    count: u64,
    /// Samples and rays so far.
    samples: AtomicU64,
    rays: AtomicU64,
    statistics: Mutex<Statistics>,
}

/// Starts the workers.
struct Work<'w, 's, 'a>(&'w Shared<'s, 'a>);

impl WithIntegrator for Work<'_, '_, '_> {
    type Output = ();
    fn run<I: Integrator>(self) {
        let Self(shared) = self;
        let threads = if shared.tasks.len() == 1 { 1 } else { shared.options.threads.min(shared.tasks.len()) };
        threads::run(threads, || dispatch(shared.options.lanes, Worker::<I>(shared, PhantomData)));
    }
}

/// What one thread does.
struct Worker<'w, 's, 'a, I>(&'w Shared<'s, 'a>, PhantomData<I>);

impl<I: Integrator> Kernel for Worker<'_, '_, '_, I> {
    type Output = ();
    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self(shared, _) = self;
        let mut tracer = Tracer::<L, (), I>::new(shared.world, shared.settings, shared.options.cancel, ());
        let mut statistics = Statistics::default();
        while let Some((cell, samples)) = shared.take_task() {
            let Crop { x, y, width, height } = shared.at[*cell];
            let tile = Tile { x, y, step: 1, width, height };
            let Some(traced) = tracer.trace(&tile, samples.clone()) else { break };
            let (sums, lost) = (traced.sums.take(), std::mem::take(&mut traced.lost));
            // Each sample is the task of one worker.
            let _ = shared.cells[*cell].lock().unwrap_or_else(PoisonError::into_inner).add(sums, &lost);
            let of_tile = std::mem::take(&mut tracer.statistics);
            shared.report(tile.pixel_count() as u64 * samples.len() as u64, of_tile.rays.total());
            statistics.merge(&of_tile);
        }
        shared.statistics.lock().unwrap_or_else(PoisonError::into_inner).merge(&statistics);
    }
}

impl Shared<'_, '_> {
    /// The next task, if there is one and time for it.
    fn take_task(&self) -> Option<&(usize, Range<u32>)> {
        let is_cancelled = self.options.cancel.is_some_and(|cancel| cancel.load(Ordering::Relaxed));
        if is_cancelled || self.until.is_some_and(|until| Instant::now() >= until) {
            return None;
        }
        self.tasks.get(self.next.fetch_add(1, Ordering::Relaxed))
    }

    fn report(&self, samples: u64, rays: u64) {
        let samples = self.samples.fetch_add(samples, Ordering::Relaxed) + samples;
        let rays = self.rays.fetch_add(rays, Ordering::Relaxed) + rays;
        if let Some(progress) = self.options.progress {
            let (total_pixels, pixels) = (self.total_pixels, samples / self.count);
            progress(Progress { pixels, total_pixels, rays });
        }
    }
}
