//! Sums of samples of a picture, which merge to the bits of the whole.

use crate::color::Rgb;
use crate::film::{Crop, Film, FilmTooLarge};
use crate::trace::{Block, PairwiseSum, Statistics, Twice, add_to, mean};
use serde::{Deserialize, Serialize};
use std::ops::Range;

/// Some samples of each pixel of a picture or a part of it: what they add up to, and what they took.
///
/// Samples that were rendered apart, on whatever machines, merge to the same bits as if they had been rendered together
/// ([`PairwiseSum`]).
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
#[serde(into = "Stored", try_from = "Stored")]
pub struct Accumulator {
    size: [u32; 2],
    crop: Crop,
    /// Pixels row by row.
    sums: PairwiseSum<Vec<Rgb>>,
    /// The light that each pixel has lost, in whole units.
    lost: Vec<u64>,
    statistics: Statistics,
}

/// Why samples were not merged.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
pub enum MergeError {
    /// They are not of the same pixels.
    #[error(
        "these samples are of {}x{} pixels at ({}, {}) of a picture of {}x{} pixels, those of {}x{} at ({}, {}) of one of {}x{}",
        .0.1.width, .0.1.height, .0.1.x, .0.1.y, .0.0[0], .0.0[1], .1.1.width, .1.1.height, .1.1.x, .1.1.y, .1.0[0], .1.0[1]
    )]
    OtherPixels(([u32; 2], Crop), ([u32; 2], Crop)),
    /// Some are there already.
    #[error(transparent)]
    Twice(#[from] Twice),
}

impl Accumulator {
    /// No samples of a part of a picture of this size.
    pub fn new(size: [u32; 2], crop: Crop) -> Self {
        Self { size, crop, sums: PairwiseSum::new(), lost: Vec::new(), statistics: Statistics::default() }
    }

    /// Which part of the picture it holds.
    pub fn crop(&self) -> Crop {
        self.crop
    }

    /// The size of the whole picture.
    pub fn size(&self) -> [u32; 2] {
        self.size
    }

    /// Which samples are there, in as few ranges as possible.
    pub fn samples(&self) -> Vec<Range<u64>> {
        self.sums.samples()
    }

    /// The sums, block by block in the order of their samples, each pixel by pixel and row by row.
    pub fn blocks(&self) -> &[(Block, Vec<Rgb>)] {
        self.sums.blocks()
    }

    /// Adds what has been rendered.
    pub(super) fn add(
        &mut self,
        blocks: Vec<(Block, Vec<Rgb>)>,
        lost: &[u64],
        statistics: &Statistics,
    ) -> Result<(), Twice> {
        for (block, _) in &blocks {
            self.sums.check(*block)?;
        }
        for (block, plane) in blocks {
            self.sums.insert(block, plane, add_to, drop)?;
        }
        if self.lost.is_empty() {
            self.lost = lost.to_vec();
        } else {
            self.lost.iter_mut().zip(lost).for_each(|(sum, &lost)| *sum = sum.saturating_add(lost));
        }
        self.statistics.merge(statistics);
        Ok(())
    }

    /// Adds other samples of the same pixels.
    ///
    /// # Errors
    /// When they are of other pixels, or some of them are there already; nothing is changed then.
    pub fn merge(&mut self, other: Self) -> Result<(), MergeError> {
        let Self { size, crop, mut sums, lost, statistics } = other;
        if (self.size, self.crop) != (size, crop) {
            return Err(MergeError::OtherPixels((self.size, self.crop), (size, crop)));
        }
        Ok(self.add(sums.take(), &lost, &statistics)?)
    }

    /// What a pixel adds up to so far, by its number row by row, with a block that comes next.
    pub(super) fn sum_with(&self, pixel: usize, next: impl Iterator<Item = Rgb>) -> Rgb {
        let blocks = self.sums.blocks().iter().map(|(_, plane)| plane[pixel]).chain(next);
        blocks.reduce(|sum, block| sum + block).unwrap_or(Rgb::black())
    }

    /// The picture, if the samples are the first ones without a gap.
    ///
    /// # Errors
    /// When its memory cannot be allocated.
    pub fn film(&self) -> Result<Option<Film>, FilmTooLarge> {
        let [Range { start: 0, end }] = self.samples()[..] else { return Ok(None) };
        let mut film = Film::new(self.size, self.crop)?;
        for (pixel, color) in film.pixels.iter_mut().enumerate() {
            *color = mean(self.sum_with(pixel, std::iter::empty()), u32::try_from(end).unwrap_or(u32::MAX));
        }
        film.finished.fill(true);
        Ok(Some(film))
    }

    /// What the samples took.
    pub fn statistics(&self) -> Statistics {
        let number = |at: usize| {
            let (column, row) = (at as u64 % u64::from(self.crop.width), at as u64 / u64::from(self.crop.width));
            (u64::from(self.crop.y) + row) * u64::from(self.size[0]) + u64::from(self.crop.x) + column
        };
        // The worst pixel of all samples need not be the worst of any part of them.
        let pixels = self.lost.iter().enumerate().filter(|(_, lost)| **lost > 0);
        let lost = self.statistics.lost.with_worst_of(pixels.map(|(at, &lost)| (number(at), lost)));
        Statistics { lost, ..self.statistics.clone() }
    }
}

/// An accumulator in a file or a message.
#[derive(Serialize, Deserialize)]
struct Stored {
    size: [u32; 2],
    crop: Crop,
    blocks: Vec<(Block, Vec<[f64; 3]>)>,
    lost: Vec<u64>,
    statistics: Statistics,
}

impl From<Accumulator> for Stored {
    fn from(accumulator: Accumulator) -> Self {
        let Accumulator { size, crop, mut sums, lost, statistics } = accumulator;
        let numbers = |plane: Vec<Rgb>| plane.into_iter().map(Rgb::to_array).collect();
        let blocks = sums.take().into_iter().map(|(block, plane)| (block, numbers(plane))).collect();
        Self { size, crop, blocks, lost, statistics }
    }
}

impl TryFrom<Stored> for Accumulator {
    type Error = String;
    fn try_from(stored: Stored) -> Result<Self, String> {
        let Stored { size, crop, blocks, lost, statistics } = stored;
        let fits = |start: u32, length: u32, limit: u32| start.checked_add(length).is_some_and(|end| end <= limit);
        if !fits(crop.x, crop.width, size[0]) || !fits(crop.y, crop.height, size[1]) {
            return Err(format!("the part {crop:?} does not lie within the picture of {}x{} pixels", size[0], size[1]));
        }
        let count = u64::from(crop.width) * u64::from(crop.height);
        let mut accumulator = Self::new(size, crop);
        for (block, plane) in blocks {
            if block.log2 > 31 || block.first.trailing_zeros() < block.log2 {
                return Err(format!("{block:?} is no aligned block of samples"));
            }
            if plane.len() as u64 != count {
                return Err(format!("{block:?} has {} pixels instead of {count}", plane.len()));
            }
            let plane = plane.into_iter().map(Rgb::from).collect();
            accumulator.sums.insert(block, plane, add_to, drop).map_err(|twice| twice.to_string())?;
        }
        let expected = if accumulator.sums.blocks().is_empty() { 0 } else { count };
        if lost.len() as u64 != expected {
            return Err(format!("the lost light of {} pixels instead of {expected}", lost.len()));
        }
        (accumulator.lost, accumulator.statistics) = (lost, statistics);
        Ok(accumulator)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn accumulator() -> Accumulator {
        let mut accumulator = Accumulator::new([9, 9], Crop { x: 1, y: 2, width: 2, height: 1 });
        let plane = vec![Rgb::new(0.1, -0.0, f64::INFINITY), Rgb::new(1e-300, f64::MAX, 0.3)];
        accumulator.add(vec![(Block { first: 2, log2: 1 }, plane)], &[7, 0], &Statistics::default()).unwrap();
        accumulator
    }

    #[test]
    fn what_is_stored_comes_back() {
        let bytes = postcard::to_allocvec(&accumulator()).unwrap();
        assert_eq!(postcard::from_bytes::<Accumulator>(&bytes).unwrap(), accumulator());
    }

    #[test]
    fn what_does_not_fit_is_refused_and_changes_nothing() {
        let mut whole = accumulator();
        let again = whole.merge(accumulator()).unwrap_err();
        assert_eq!(again.to_string(), "the samples 2 to 3 are there twice");
        let elsewhere = Accumulator::new([9, 9], Crop { x: 0, y: 2, width: 2, height: 1 });
        assert!(whole.merge(elsewhere).unwrap_err().to_string().contains("2x1 pixels at (1, 2)"));
        assert_eq!(whole, accumulator());
        assert!(whole.film().unwrap().is_none(), "samples 0 and 1 are missing");
        let change = |change: fn(&mut Stored)| {
            let mut stored = Stored::from(accumulator());
            change(&mut stored);
            Accumulator::try_from(stored).unwrap_err()
        };
        assert!(change(|s| s.blocks[0].0.first = 1).contains("aligned"));
        assert!(change(|s| s.blocks[0].0.log2 = 40).contains("aligned"));
        assert!(change(|s| s.crop.width = 3).contains("2 pixels instead of 3"));
        assert!(change(|s| s.crop.x = u32::MAX).contains("within"));
        assert!(change(|s| s.lost.push(1)).contains("lost light"));
        assert!(change(|s| s.blocks = [s.blocks.clone(), s.blocks.clone()].concat()).contains("twice"));
    }
}
