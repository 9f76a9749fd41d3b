//! A picture as a texture, looked up between its texels.

use crate::color::Rgb;
use alloc::vec::Vec;
use core::ops::{Add, Mul};

/// A picture in linear light, kept as `f32`: 8192 x 4096 texels take 400 megabytes. All arithmetic is in `f64`.
#[derive(Clone, PartialEq)]
pub struct Image {
    width: usize,
    height: usize,
    pixels: Vec<[f32; 3]>,
    /// The share of each texel that is there, from 0 to 1; `None` where all of it is.
    alpha: Option<Vec<f32>>,
}

/// What keeps numbers from being an image.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum ImageError {
    /// No texels, or another number of them than the size says.
    #[error("{count} texels are no image of {width} x {height}")]
    Size {
        /// Columns.
        width: usize,
        /// Rows.
        height: usize,
        /// Texels that were given.
        count: usize,
    },
    /// A texel that is infinite or NaN, or too large for `f32`.
    #[error("the texel in column {column}, row {row} (from 0, row 0 on top) is not a finite number")]
    NotFinite {
        /// Its column.
        column: usize,
        /// Its row, 0 on top.
        row: usize,
    },
}

/// Weights of texels are multiples of this, the relative precision of the texels themselves. A position is off by at most
/// two roundings, 2⁻²⁷ for 2²⁶ columns, so that the centre of a texel is met to the bit; and the products along a row are exact.
const WEIGHT_STEP: f64 = 1.0 / (1u32 << 24) as f64;

impl Image {
    /// An image of `width·height` texels of linear red, green, blue, row by row, row 0 on top.
    ///
    /// # Errors
    /// No texels, a number of them that does not fit the size, or one that is not finite.
    pub fn new(width: usize, height: usize, pixels: Vec<[f32; 3]>) -> Result<Self, ImageError> {
        if pixels.is_empty() || width.checked_mul(height) != Some(pixels.len()) {
            return Err(ImageError::Size { width, height, count: pixels.len() });
        }
        match pixels.iter().position(|pixel| !pixel.iter().all(|c| c.is_finite())) {
            Some(at) => Err(ImageError::NotFinite { column: at % width, row: at / width }),
            None => Ok(Self { width, height, pixels, alpha: None }),
        }
    }

    /// The same with an alpha for each texel: the share of it that is there. Colours are not multiplied by it. What lies
    /// beyond 0 and 1, as filters that ring leave it, counts as 0 and 1. Alpha that is 1 everywhere is not kept.
    ///
    /// # Errors
    /// As [`Image::new`], and a number of alphas that does not fit the size, or one that is not finite.
    pub fn with_alpha(
        width: usize,
        height: usize,
        pixels: Vec<[f32; 3]>,
        mut alpha: Vec<f32>,
    ) -> Result<Self, ImageError> {
        let image = Self::new(width, height, pixels)?;
        if alpha.len() != image.pixels.len() {
            return Err(ImageError::Size { width, height, count: alpha.len() });
        }
        if let Some(at) = alpha.iter().position(|a| !a.is_finite()) {
            return Err(ImageError::NotFinite { column: at % width, row: at / width });
        }
        for a in &mut alpha {
            *a = a.clamp(0.0, 1.0);
        }
        let is_whole = alpha.iter().all(|&a| a == 1.0);
        Ok(Self { alpha: (!is_whole).then_some(alpha), ..image })
    }

    /// Columns, at least 1.
    pub fn width(&self) -> usize {
        self.width
    }

    /// Rows, at least 1.
    pub fn height(&self) -> usize {
        self.height
    }

    /// All texels, linear red, green, blue, row by row, row 0 on top.
    pub fn pixels(&self) -> &[[f32; 3]] {
        &self.pixels
    }

    /// The share of each texel that is there, from 0 to 1, in the same order; `None` where all of it is.
    pub fn alpha(&self) -> Option<&[f32]> {
        self.alpha.as_deref()
    }

    /// The colour at `(u, v)`, bilinear between the four nearest texel centres; the image repeats in both directions. The
    /// centre of the texel in column i and row j is at `((i + ½)/width, 1 − (j + ½)/height)`, and there its colour comes back
    /// to the bit. A coordinate that is not finite counts as 0. Alpha is not looked at.
    pub fn bilinear(&self, u: f64, v: f64) -> Rgb {
        self.around(u, v).mix(|at| self.color(at))
    }

    /// The colour of what is there at `(u, v)`, and the share that is, from 0 to 1; places as in [`Image::bilinear`].
    ///
    /// Each texel's colour counts by its alpha, and the sum is divided by the alpha that is found (Porter and Duff,
    /// *Compositing Digital Images*, Computer Graphics 18(3), 1984): colours that are hidden where alpha is 0 do not bleed in.
    /// Among texels of alpha 1 these are the bits of [`Image::bilinear`]; where nothing is, the colour is black.
    pub fn bilinear_with_alpha(&self, u: f64, v: f64) -> (Rgb, f64) {
        let around = self.around(u, v);
        if self.alpha.is_none() {
            return (around.mix(|at| self.color(at)), 1.0);
        }
        let alpha = around.mix(|at| self.alpha_of(at));
        let color = around.mix(|at| self.color(at) * self.alpha_of(at));
        (if alpha > 0.0 { color.to_array().map(|c| c / alpha).into() } else { Rgb::black() }, alpha)
    }

    /// The colour of an image of a sphere in latitude and longitude, in front of black, where not all of it is there. It repeats
    /// only in `u`: between the centres of the outermost rows and the poles, and beyond `v` = 0 and 1, the outermost rows go on.
    pub fn bilinear_latlong(&self, u: f64, v: f64) -> Rgb {
        // NaN becomes 0 too.
        let v = if v >= 0.0 { v.min(1.0) } else { 0.0 };
        let last = self.height as i64 - 1;
        let around = self.between(u, place(v, self.height), |row| row.clamp(0, last) as usize);
        around.mix(|at| self.color(at) * self.alpha_of(at))
    }

    fn color(&self, at: usize) -> Rgb {
        self.pixels[at].map(f64::from).into()
    }

    fn alpha_of(&self, at: usize) -> f64 {
        self.alpha.as_ref().map_or(1.0, |alpha| f64::from(alpha[at]))
    }

    /// In an image that repeats.
    fn around(&self, u: f64, v: f64) -> Around {
        self.between(u, place(part(v), self.height), |row| wrapped(row, self.height))
    }

    /// Between a row, counted from the bottom, and the one above it. `inside` is the row to take for one outside.
    fn between(&self, u: f64, (row, above): (i64, f64), inside: impl Fn(i64) -> usize) -> Around {
        let (column, right) = place(part(u), self.width);
        let columns = [column, column + 1].map(|column| wrapped(column, self.width));
        let texels = [row, row + 1].map(|row| columns.map(|c| (self.height - 1 - inside(row)) * self.width + c));
        Around { texels, right, above }
    }
}

/// The four texels around a place, row by row from below, and how far between them it lies.
struct Around {
    texels: [[usize; 2]; 2],
    right: f64,
    above: f64,
}

impl Around {
    /// Of what the texels have the mean, by how near they are.
    fn mix<T: Mul<f64, Output = T> + Add<Output = T>>(&self, of: impl Fn(usize) -> T) -> T {
        let [low, high] = self.texels.map(|[left, next]| of(left) * (1.0 - self.right) + of(next) * self.right);
        low * (1.0 - self.above) + high * self.above
    }
}

impl core::fmt::Debug for Image {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.debug_struct("Image").field("width", &self.width).field("height", &self.height).finish_non_exhaustive()
    }
}

/// What is left of a coordinate in an image that repeats, from 0 to 1; 0 for what is not finite.
fn part(coordinate: f64) -> f64 {
    let part = coordinate - libm::floor(coordinate);
    if part.is_nan() { 0.0 } else { part }
}

fn wrapped(index: i64, count: usize) -> usize {
    index.rem_euclid(count as i64) as usize
}

/// The texel whose centre lies at or before a coordinate from 0 to 1, from −1 to `count` − 1, and the weight of the next one.
fn place(coordinate: f64, count: usize) -> (i64, f64) {
    let from_edge = libm::round(coordinate * count as f64 / WEIGHT_STEP) * WEIGHT_STEP;
    let from_centre = from_edge - 0.5;
    let whole = libm::floor(from_centre);
    (whole as i64, from_centre - whole)
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    /// Every texel is different.
    fn image(width: usize, height: usize) -> Image {
        let texel = |i: usize| [i as f32 / 7.0, 1.0 - i as f32, 0.1];
        Image::new(width, height, (0..width * height).map(texel).collect()).unwrap()
    }

    fn texel(image: &Image, column: usize, row: usize) -> Rgb {
        image.pixels()[row * image.width() + column].map(f64::from).into()
    }

    #[test]
    fn rows_are_counted_from_the_top_and_v_from_the_bottom() {
        let [a, b, c, d] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 1.0]];
        let image = Image::new(2, 2, vec![a, b, c, d]).unwrap();
        for (u, v, expected) in [(0.25, 0.75, a), (0.75, 0.75, b), (0.25, 0.25, c), (0.75, 0.25, d)] {
            assert_eq!(image.bilinear(u, v), expected.map(f64::from).into());
        }
        assert_eq!(image.bilinear(0.5, 0.75), Rgb::new(0.5, 0.5, 0.0), "half way between a and b");
        assert_eq!(image.bilinear(0.4375, 0.75), Rgb::new(0.625, 0.375, 0.0), "3/8 of the way from a to b");
        assert_eq!(image.bilinear(0.25, 0.375), Rgb::new(0.25, 0.0, 0.75), "a quarter of the way up from c to a");
        assert_eq!(image.bilinear(0.0, 0.75), Rgb::new(0.5, 0.5, 0.0), "between the last column and the first");
        assert_eq!(image.bilinear(0.25, 1.0), Rgb::new(0.5, 0.0, 0.5), "between the top and the bottom");
        assert_eq!(image.bilinear_latlong(0.0, 0.75), Rgb::new(0.5, 0.5, 0.0), "around the back");
        assert_eq!(image.bilinear_latlong(0.25, 1.0), Rgb::new(1.0, 0.0, 0.0), "the top row up to the pole");
        assert_eq!(image.bilinear_latlong(0.25, -3.0), Rgb::new(0.0, 0.0, 1.0), "the bottom row down to the pole");
    }

    /// What filters of premultiplied colours say, and not of the hidden green.
    #[test]
    fn hidden_colours_do_not_bleed_in() {
        let (red, hidden) = ([1.0, 0.0, 0.0], [0.0, 9.0, 0.0]);
        let image = Image::with_alpha(2, 2, vec![red, hidden, hidden, red], vec![1.0, 0.0, 0.0, 0.5]).unwrap();
        let red = Rgb::from(red.map(f64::from));
        assert_eq!(image.bilinear_with_alpha(0.25, 0.75), (red, 1.0));
        assert_eq!(image.bilinear_with_alpha(0.75, 0.75), (Rgb::black(), 0.0), "nothing, and no NaN");
        assert_eq!(image.bilinear_with_alpha(0.5, 0.75), (red, 0.5));
        assert_eq!(image.bilinear_with_alpha(0.5, 0.5), (red, 0.375));
        assert_eq!(image.bilinear(0.5, 0.75), Rgb::new(0.5, 4.5, 0.0), "without a look at alpha");
        assert_eq!(image.bilinear_latlong(0.5, 0.75), red * 0.5, "a sky in front of black");
        // Covered by a half, a colour of its own each: twice as much of the one that is whole.
        let half = Image::with_alpha(2, 1, vec![[1.0; 3], [0.25; 3]], vec![1.0, 0.5]).unwrap();
        assert_eq!(half.bilinear_with_alpha(0.5, 0.5), (Rgb::gray(0.75), 0.75));
    }

    #[test]
    fn alpha_is_kept_only_where_something_is_missing() {
        let with = |alpha: [f32; 2]| Image::with_alpha(2, 1, vec![[0.3; 3]; 2], alpha.to_vec());
        assert_eq!(with([1.0, 1.0]), Image::new(2, 1, vec![[0.3; 3]; 2]));
        assert_eq!(with([1.25, -0.125]).unwrap().alpha(), Some(&[1.0, 0.0][..]), "a filter that rings");
        assert_eq!(with([1.0, f32::NAN]), Err(ImageError::NotFinite { column: 1, row: 0 }));
        let short = Image::with_alpha(2, 1, vec![[0.3; 3]; 2], vec![1.0]);
        assert_eq!(short, Err(ImageError::Size { width: 2, height: 1, count: 1 }));
    }

    #[test]
    fn any_number_is_somewhere() {
        let image = image(5, 3);
        let odd = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, -1e15, 1e15, -1e-300, 5e-324];
        for (a, b) in odd.iter().flat_map(|&a| odd.map(|b| (a, b))) {
            for color in [image.bilinear(a, b), image.bilinear_latlong(a, b)] {
                assert!(color.to_array().iter().all(|c| c.is_finite()), "{a} {b}");
            }
        }
        assert_eq!(image.bilinear(f64::NAN, f64::INFINITY), image.bilinear(0.0, 0.0));
        assert_eq!(image.bilinear_latlong(f64::NAN, f64::NAN), image.bilinear_latlong(0.0, 0.0));
        assert_eq!(image.bilinear_latlong(0.3, f64::INFINITY), image.bilinear_latlong(0.3, 1.0));
        assert_eq!(image.bilinear(1e15 + 0.125, 0.5), image.bilinear(0.125, 0.5), "an eighth is kept at 1e15");
        assert_eq!(image.bilinear(-1e-300, 0.5), image.bilinear(0.0, 0.5), "just left of 0 is just left of 1");
    }

    #[test]
    fn what_is_no_image_is_refused() {
        assert_eq!(Image::new(0, 3, vec![]), Err(ImageError::Size { width: 0, height: 3, count: 0 }));
        assert!(Image::new(usize::MAX, 3, vec![[0.0; 3]]).is_err());
        let broken = Image::new(2, 2, vec![[0.0; 3], [0.0; 3], [0.0; 3], [0.0, f32::NAN, 0.0]]);
        assert!(broken.unwrap_err().to_string().contains("column 1, row 1"));
    }

    #[test]
    fn centres_are_met_in_wide_images_too() {
        // As wide as any picture that is read may be; a power of two would divide without rounding.
        let count = (1usize << 26) - 1;
        for index in (0..count).step_by(99_991).chain([1, 2, count - 2, count - 1]) {
            assert_eq!(place((index as f64 + 0.5) / count as f64, count), (index as i64, 0.0));
        }
    }

    proptest! {
        #[test]
        fn a_centre_is_its_texel_to_the_bit(width in 1usize..400, height in 1usize..40, i in 0usize..400, j in 0usize..40, turns in -9i32..9) {
            let (image, column, row) = (image(width, height), i % width, j % height);
            let u = (column as f64 + 0.5) / width as f64 + f64::from(turns);
            let v = 1.0 - (row as f64 + 0.5) / height as f64;
            let expected = texel(&image, column, row);
            prop_assert_eq!(image.bilinear(u, v), expected);
            prop_assert_eq!(image.bilinear(u, v - f64::from(turns)), expected);
            prop_assert_eq!(image.bilinear_latlong(u, v), expected);
        }

        #[test]
        fn one_colour_stays_that_colour(width in 1usize..9, height in 1usize..9, c in prop::array::uniform3(-1e9f32..1e9), u in -2.0..2.0f64, v in -2.0..2.0f64) {
            // Products of 24 and 24 bits are exact, so is their sum.
            let image = Image::new(width, height, vec![c; width * height]).unwrap();
            prop_assert_eq!(image.bilinear(u, v).to_array(), c.map(f64::from));
            prop_assert_eq!(image.bilinear_latlong(u, v).to_array(), c.map(f64::from));
        }

        /// Among texels of alpha 1 the bits are those of an image without alpha; everywhere a colour is between its texels'.
        #[test]
        fn alpha_1_changes_no_bit(
            size in prop::array::uniform2(2usize..9),
            holes in prop::collection::vec(prop_oneof![Just(1.0f32), 0.0..1.0f32, Just(0.0)], 64),
            at in prop::array::uniform2(-2.0..2.0f64),
        ) {
            let ([width, height], [u, v]) = (size, at);
            let plain = image(width, height);
            let alpha: Vec<f32> = holes.iter().copied().cycle().take(width * height).collect();
            let image = Image::with_alpha(width, height, plain.pixels().to_vec(), alpha.clone()).unwrap();
            let (color, covered) = image.bilinear_with_alpha(u, v);
            prop_assert!((0.0..=1.0).contains(&covered));
            let around = image.around(u, v).texels;
            if around.as_flattened().iter().all(|&at| alpha[at] == 1.0) {
                prop_assert_eq!((color, covered), (plain.bilinear(u, v), 1.0));
            }
            let seen = around.as_flattened().iter().filter(|&&at| alpha[at] > 0.0).map(|&at| plain.color(at).g);
            let (low, high) = seen.fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), g| (low.min(g), high.max(g)));
            // Roundings of five products and sums, and of the quotient.
            let room = 1e-15 * low.abs().max(high.abs());
            prop_assert!(covered == 0.0 || (low - room..=high + room).contains(&color.g), "{} {} {}", low, color.g, high);
        }

        /// The plain formula with the four texels around, without any snapping.
        #[test]
        fn between_centres_it_is_bilinear(width in 2usize..9, height in 2usize..9, u in 0.0..1.0f64, v in 0.0..1.0f64) {
            let image = image(width, height);
            let (x, y) = (u * width as f64 - 0.5, (1.0 - v) * height as f64 - 0.5);
            let tent = |at: f64, centre: usize, count: usize| {
                let away = (at - centre as f64).abs();
                (1.0 - away.min(count as f64 - away)).max(0.0)
            };
            let mut expected = Rgb::black();
            for (row, column) in (0..height).flat_map(|row| (0..width).map(move |column| (row, column))) {
                let weight = tent(x, column, width) * tent(y, row, height);
                expected = expected + texel(&image, column, row) * weight;
            }
            // Two weights off by half a step of 2⁻²⁴ each, texels at most 63 apart.
            let off = (image.bilinear(u, v) - expected).to_array().map(f64::abs).into_iter().fold(0.0, f64::max);
            prop_assert!(off <= 64.0 * WEIGHT_STEP, "{}", off);
        }
    }
}
