//! Pictures: the film that a render fills, and the curve to 8 and 16 bit.

pub mod transfer;

pub use crate::color::Rgb;

use crate::memory;
use std::fmt;

/// A rectangle of pixels: left and top edge, width and height.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
pub struct Crop {
    /// First column.
    pub x: u32,
    /// First row, 0 on top.
    pub y: u32,
    /// Columns.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

/// The picture as it is computed: linear colour, three `f64` per pixel, row 0 on top.
#[derive(Clone, PartialEq)]
pub struct Film {
    /// Size of the whole picture, width and height in pixels.
    pub full_size: [u32; 2],
    /// The part of it that this film holds.
    pub crop: Crop,
    /// Radiance, `crop.width·crop.height` pixels, row by row.
    pub pixels: Vec<Rgb>,
    /// Has this pixel been computed? Same order as `pixels`.
    pub finished: Vec<bool>,
}

/// The film does not fit into memory.
#[derive(Clone, Copy, Debug, thiserror::Error)]
#[error("a film of {width} x {height} pixels needs {bytes} bytes of memory, which cannot be allocated")]
pub struct FilmTooLarge {
    /// Columns asked for.
    pub width: u32,
    /// Rows asked for.
    pub height: u32,
    /// Bytes asked for.
    pub bytes: u64,
}

/// Bytes that a film needs for each pixel.
pub const BYTES_PER_PIXEL: u64 = size_of::<Rgb>() as u64 + 1;

impl Film {
    /// A black, unfinished film.
    ///
    /// # Errors
    /// When the memory cannot be had.
    pub fn new(full_size: [u32; 2], crop: Crop) -> Result<Self, FilmTooLarge> {
        let Crop { width, height, .. } = crop;
        let bytes = u64::from(width).saturating_mul(u64::from(height)).saturating_mul(BYTES_PER_PIXEL);
        let too_large = FilmTooLarge { width, height, bytes };
        let count = usize::try_from(u64::from(width) * u64::from(height)).map_err(|_| too_large)?;
        let pixels = memory::zeros(count).ok_or(too_large)?;
        let finished = memory::zeros(count).ok_or(too_large)?;
        Ok(Self { full_size, crop, pixels, finished })
    }

    /// Makes it an unfinished film of this size, in the memory that it has if the size is the same. The colours of unfinished
    /// pixels are of no meaning.
    pub(crate) fn start_again(&mut self, full_size: [u32; 2], crop: Crop) -> Result<(), FilmTooLarge> {
        if (self.crop.width, self.crop.height) == (crop.width, crop.height) {
            (self.full_size, self.crop) = (full_size, crop);
            self.finished.fill(false);
        } else {
            *self = Self::new(full_size, crop)?;
        }
        Ok(())
    }

    /// Makes all pixels black that are not finished.
    pub(crate) fn blacken_unfinished(&mut self) {
        for (pixel, _) in self.pixels.iter_mut().zip(&self.finished).filter(|(_, finished)| !**finished) {
            *pixel = Rgb::black();
        }
    }

    /// Width of the part that this film holds, in pixels.
    pub fn width(&self) -> usize {
        self.crop.width as usize
    }

    /// Height of the part that this film holds, in pixels.
    pub fn height(&self) -> usize {
        self.crop.height as usize
    }

    /// Is every pixel computed?
    pub fn is_finished(&self) -> bool {
        self.finished.iter().all(|&yes| yes)
    }

    /// Red, green and blue of all pixels, row by row, where they are.
    pub fn numbers(&self) -> &[f64] {
        memory::numbers(&self.pixels)
    }

    /// A part of it, as a film of its own; `None` where it does not lie within.
    pub fn part(&self, part: Crop) -> Option<Self> {
        let within = |start: u32, length: u32, first: u32, have: u32| {
            let end = start.checked_add(length)?;
            (length > 0 && start >= first && end <= first + have).then(|| (start - first) as usize)
        };
        let left = within(part.x, part.width, self.crop.x, self.crop.width)?;
        let top = within(part.y, part.height, self.crop.y, self.crop.height)?;
        let rows = (top..top + part.height as usize).map(|row| row * self.crop.width as usize + left);
        let rows = rows.map(|start| start..start + part.width as usize);
        Some(Self {
            full_size: self.full_size,
            crop: part,
            pixels: rows.clone().flat_map(|row| self.pixels[row].iter().copied()).collect(),
            finished: rows.flat_map(|row| self.finished[row].iter().copied()).collect(),
        })
    }

    /// The numbers of all pixels as little-endian bytes, NaN in one canonical form: equal pictures, equal bytes, on every
    /// machine. For hashing.
    pub fn bytes(&self) -> impl Iterator<Item = [u8; 8]> + '_ {
        let canonical = |v: f64| if v.is_nan() { f64::NAN } else { v };
        self.pixels.iter().flat_map(|p| [p.r, p.g, p.b]).map(move |v| canonical(v).to_le_bytes())
    }
}

impl fmt::Debug for Film {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Film").field("full_size", &self.full_size).field("crop", &self.crop).finish_non_exhaustive()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_part_is_cut_out() {
        let crop = Crop { x: 10, y: 20, width: 3, height: 2 };
        let mut film = Film::new([100, 100], crop).unwrap();
        for (i, pixel) in film.pixels.iter_mut().enumerate() {
            pixel.r = i as f64;
        }
        let part = film.part(Crop { x: 11, y: 21, width: 2, height: 1 }).unwrap();
        assert_eq!(part.pixels.iter().map(|p| p.r).collect::<Vec<_>>(), [4.0, 5.0]);
        assert_eq!((part.finished.len(), part.full_size), (2, [100, 100]));
        for outside in [[9, 20, 1, 1], [10, 20, 4, 1], [10, 20, 0, 1], [10, 21, 1, 2], [12, 20, u32::MAX, 1]] {
            let [x, y, width, height] = outside;
            assert!(film.part(Crop { x, y, width, height }).is_none(), "{outside:?}");
        }
    }

    #[test]
    fn an_impossible_film_is_an_error_and_not_an_abort() {
        let crop = Crop { x: 0, y: 0, width: u32::MAX, height: u32::MAX };
        let error = Film::new([u32::MAX, u32::MAX], crop).unwrap_err().to_string();
        assert!(error.contains("4294967295 x 4294967295"), "{error}");
    }
}
