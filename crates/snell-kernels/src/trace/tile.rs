//! Which pixels are traced together.

/// Some pixels of a picture: every `step`-th one from (`x`, `y`) on, `width` of them in a row and `height` rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Tile {
    /// Column of the first one, from the left.
    pub x: u32,
    /// Row of the first one, from the top.
    pub y: u32,
    /// How far neighbours are apart, at least 1.
    pub step: u32,
    /// Pixels in a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

impl Tile {
    /// One pixel.
    pub fn pixel(x: u32, y: u32) -> Self {
        Self { x, y, step: 1, width: 1, height: 1 }
    }

    /// How many pixels.
    pub fn pixel_count(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// The columns of its pixels.
    pub fn columns(&self) -> impl Iterator<Item = u32> + use<> {
        (self.x..).step_by(self.step as usize).take(self.width as usize)
    }

    /// Their rows.
    pub fn rows(&self) -> impl Iterator<Item = u32> + use<> {
        (self.y..).step_by(self.step as usize).take(self.height as usize)
    }

    /// The number of one of its pixels, counted row by row, in a picture of this width.
    pub fn number_in_picture(&self, pixel: usize, width: u32) -> u64 {
        let (column, row) = (pixel % self.width as usize, pixel / self.width as usize);
        let at = |first: u32, count: usize| u64::from(first) + u64::from(self.step) * count as u64;
        at(self.y, row) * u64::from(width) + at(self.x, column)
    }
}
