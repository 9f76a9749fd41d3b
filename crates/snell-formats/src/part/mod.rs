//! Parts of pictures in files: sums of samples, which anybody can read, and which merge to the bits of the whole.
//!
//! ```text
//!  part.npz, a ZIP archive without compression: numpy.load opens it
//!   ├─ sums.npy   float64, N x 3: piece by piece, row by row, pixel by pixel, and of each pixel block by block
//!   ├─ lost.npy   uint64, one number for each pixel of each piece: what its samples have lost, in units of 2⁻³²
//!   └─ part.json  the recipe, the pieces (rectangles and ranges of samples), what the samples took
//! ```
//!
//! A block is a range of `2^k` samples, the first a multiple of that; its sum is the pairwise one. A range is the largest blocks that
//! make it up, in order: 0 to 5 are those of 4 and 2 samples.

mod merge;
mod read;
mod write;

pub use merge::{Merge, incomplete, words};
pub use read::{PartFile, check};
pub use write::write;

use crate::recipe::Recipe;
use serde::{Deserialize, Serialize};
use snell::film::Crop;
use snell::render::Piece;
use snell::trace::Statistics;

/// The version of this form.
pub(crate) const VERSION: u32 = 1;

const SUMS: &str = "sums.npy";
const LOST: &str = "lost.npy";
const HEADER: &str = "part.json";

/// What a part is of, and what is in it.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Header {
    /// The version of this form.
    pub snell_part: u32,
    /// How the whole picture is made.
    pub recipe: Recipe,
    /// Width and height of the picture.
    pub size: [u32; 2],
    /// The part of it that is wanted, of which this is a part.
    pub crop: Crop,
    /// Samples per pixel that are wanted.
    pub spp: u32,
    /// What is there, in the order of the numbers.
    pub pieces: Vec<Piece>,
    /// What the samples took.
    pub statistics: Statistics,
}

impl Header {
    /// Of a part of the picture of a recipe that has been [resolved](Recipe::resolve).
    pub fn new(recipe: &Recipe, size: [u32; 2], pieces: Vec<Piece>, statistics: Statistics) -> Self {
        let [width, height] = size;
        let crop = recipe.crop.unwrap_or(Crop { x: 0, y: 0, width, height });
        let mut recipe = recipe.clone();
        recipe.film_sha256 = None;
        let spp = recipe.spp.unwrap_or(1);
        Self { snell_part: VERSION, recipe, size, crop, spp, pieces, statistics }
    }

    /// How much of the samples of the picture is there, from 0 to 1; the shares of all parts of a picture add up to 1.
    pub fn share(&self) -> f64 {
        let samples = |piece: &Piece| piece.samples.iter().map(|[first, end]| f64::from(end - first)).sum::<f64>();
        let there: f64 = self.pieces.iter().map(|piece| piece.pixel_count() as f64 * samples(piece)).sum();
        there / (f64::from(self.crop.width) * f64::from(self.crop.height) * f64::from(self.spp))
    }
}

/// Numbers of `sums.npy` in threes, and of `lost.npy`.
fn counts(pieces: &[Piece]) -> Option<[u64; 2]> {
    let mut counts = [0u64; 2];
    for piece in pieces {
        let pixels = piece.pixel_count();
        counts[0] = counts[0].checked_add(pixels.checked_mul(piece.blocks().len() as u64)?)?;
        counts[1] = counts[1].checked_add(pixels)?;
    }
    counts[0].checked_mul(24)?;
    Some(counts)
}

#[cfg(test)]
mod tests;
