//! A picture that other instances render, put together from what they hand over.

use crate::part::rows;
use snell::film::{BYTES_PER_PIXEL, Crop, Film, FilmTooLarge, Rgb};
use snell::render::Progress;
use snell::trace::Statistics;
use snell_formats::Report;
use std::ops::Range;

/// What has come so far.
pub struct Gathered {
    pub film: Film,
    /// The light that each pixel has lost, in units of 2⁻³².
    lost: Vec<f64>,
    pub statistics: Statistics,
}

impl Gathered {
    /// What it needs for each pixel.
    pub const BYTES_PER_PIXEL: u64 = BYTES_PER_PIXEL + size_of::<f64>() as u64;

    /// Nothing yet.
    pub fn new(full_size: [u32; 2], crop: Crop) -> Result<Self, FilmTooLarge> {
        let film = Film::new(full_size, crop)?;
        let lost = vec![0.0; film.pixels.len()];
        Ok(Self { film, lost, statistics: Statistics::default() })
    }

    /// The light that the pixels of a part have lost; `None` where the part does not lie within the picture.
    pub fn lost(&self, part: Crop) -> Option<Vec<f64>> {
        Some(rows(part, self.film.crop)?.flat_map(|row| self.lost[row].iter().copied()).collect())
    }

    /// Does something with the film as it is shown: each pixel has a colour, since the first pass is over all of them.
    pub fn as_shown<R>(&mut self, act: impl FnOnce(&Film) -> R) -> R {
        let shown = vec![true; self.film.finished.len()];
        let finished = std::mem::replace(&mut self.film.finished, shown);
        let result = act(&self.film);
        self.film.finished = finished;
        result
    }

    /// Of what others have rendered only finished pixels count.
    pub fn progress(&self) -> Progress {
        Progress {
            pixels: self.film.finished.iter().filter(|finished| **finished).count() as u64,
            total_pixels: self.film.finished.len() as u64,
            rays: self.statistics.rays.total(),
        }
    }

    /// Takes a part, with all of its samples or as far as it has come.
    pub fn put(&mut self, part: Crop, values: &[f64], finished: bool) -> Result<(), Report> {
        let mut colors = values.chunks_exact(3).map(|color| Rgb::new(color[0], color[1], color[2]));
        for row in self.rows_for(part, values.len() as u64, 3)? {
            self.film.finished[row.clone()].fill(finished);
            self.film.pixels[row].iter_mut().zip(&mut colors).for_each(|(pixel, color)| *pixel = color);
        }
        Ok(())
    }

    /// Takes the light that the pixels of a part have lost.
    pub fn put_lost(&mut self, part: Crop, lost: &[f64]) -> Result<(), Report> {
        let rows = self.rows_for(part, lost.len() as u64, 1)?;
        rows.zip(lost.chunks(part.width as usize)).for_each(|(row, lost)| self.lost[row].copy_from_slice(lost));
        Ok(())
    }

    /// The rows of a part that comes with so many `numbers`, `per_pixel` for each pixel.
    fn rows_for(
        &self,
        part: Crop,
        numbers: u64,
        per_pixel: u64,
    ) -> Result<impl Iterator<Item = Range<usize>> + use<>, Report> {
        let Crop { x, y, width, height } = part;
        let fits = || numbers == per_pixel * u64::from(width) * u64::from(height);
        rows(part, self.film.crop).filter(|_| fits()).ok_or_else(|| {
            let pixels = format!("{width} x {height} pixels at {x},{y}");
            Report::error(format!("{numbers} numbers for {pixels} are no part of the picture"))
        })
    }

    /// Takes what another instance has traced.
    pub fn put_statistics(&mut self, text: &str) -> Result<(), Report> {
        let statistics: Statistics =
            serde_json::from_str(text).map_err(|e| Report::error(format!("these are no statistics: {e}")))?;
        self.statistics.merge(&statistics);
        Ok(())
    }
}
