//! What the passes of a render have added up to so far.

use crate::color::Rgb;
use crate::film::Crop;
use crate::trace::{Block, PairwiseSum, Statistics, add_to};

/// The samples of all passes that are complete: what the pixels add up to, and what they took.
#[derive(Clone, Debug)]
pub(super) struct Accumulator {
    full_width: u32,
    crop: Crop,
    /// Pixels row by row.
    sums: PairwiseSum<Vec<Rgb>>,
    /// The light that each pixel has lost, in whole units.
    lost: Vec<u64>,
    statistics: Statistics,
}

impl Accumulator {
    /// No samples of a part of a picture of this width.
    pub fn new(full_width: u32, crop: Crop) -> Self {
        Self { full_width, crop, sums: PairwiseSum::new(), lost: Vec::new(), statistics: Statistics::default() }
    }

    /// How many samples of each pixel are there.
    pub fn sample_count(&self) -> u64 {
        self.sums.samples().iter().map(|range| range.end - range.start).sum()
    }

    /// Adds the samples of a pass, which are others than those of the passes before.
    pub fn add(&mut self, blocks: Vec<(Block, Vec<Rgb>)>, lost: Vec<u64>, statistics: &Statistics) {
        for (block, plane) in blocks {
            // No sample is there twice.
            let _ = self.sums.insert(block, plane, add_to, drop);
        }
        if self.lost.is_empty() {
            self.lost = lost;
        } else {
            self.lost.iter_mut().zip(lost).for_each(|(sum, lost)| *sum = sum.saturating_add(lost));
        }
        self.statistics.merge(statistics);
    }

    /// What a pixel adds up to so far, by its number row by row, with the blocks that come next.
    pub fn sum_with(&self, pixel: usize, next: impl Iterator<Item = Rgb>) -> Rgb {
        let blocks = self.sums.blocks().iter().map(|(_, plane)| plane[pixel]).chain(next);
        blocks.reduce(|sum, block| sum + block).unwrap_or(Rgb::black())
    }

    /// What the samples took.
    pub fn statistics(&self) -> Statistics {
        let number = |at: usize| {
            let (column, row) = (at as u64 % u64::from(self.crop.width), at as u64 / u64::from(self.crop.width));
            (u64::from(self.crop.y) + row) * u64::from(self.full_width) + u64::from(self.crop.x) + column
        };
        // The worst pixel of all samples need not be the worst of any part of them.
        let pixels = self.lost.iter().enumerate().filter(|(_, lost)| **lost > 0);
        let lost = self.statistics.lost.with_worst_of(pixels.map(|(at, &lost)| (number(at), lost)));
        Statistics { lost, ..self.statistics.clone() }
    }
}
