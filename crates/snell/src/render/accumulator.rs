//! What the passes of a render have added up to so far.

use crate::color::Rgb;
use crate::trace::{Block, PairwiseSum, add_to};

/// What the pixels add up to, row by row, by the samples of all passes that are complete.
#[derive(Clone, Debug, Default)]
pub(super) struct Accumulator {
    sums: PairwiseSum<Vec<Rgb>>,
}

impl Accumulator {
    /// How many samples of each pixel are there.
    pub fn sample_count(&self) -> u64 {
        self.sums.samples().iter().map(|range| range.end - range.start).sum()
    }

    /// Adds the samples of a pass, which are others than those of the passes before.
    pub fn add(&mut self, blocks: Vec<(Block, Vec<Rgb>)>) {
        for (block, plane) in blocks {
            // No sample is there twice.
            let _ = self.sums.insert(block, plane, add_to, drop);
        }
    }

    /// What a pixel adds up to so far, by its number row by row, with the blocks that come next.
    pub fn sum_with(&self, pixel: usize, next: impl Iterator<Item = Rgb>) -> Rgb {
        let blocks = self.sums.blocks().iter().map(|(_, plane)| plane[pixel]).chain(next);
        blocks.reduce(|sum, block| sum + block).unwrap_or(Rgb::black())
    }
}
