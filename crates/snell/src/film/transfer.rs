//! From linear light to the integers of a picture file, and back.

use crate::lanes::{Kernel, LaneWidth, Lanes, MAX_WIDTH, dispatch, pow};
use serde::{Deserialize, Serialize};

/// The curve from linear light to 8 and 16 bit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Transfer {
    /// None: the number is the brightness, as in the lecture and the course.
    Linear,
    /// The curve of IEC 61966-2-1, which screens expect.
    #[default]
    Srgb,
}

/// What happens to the fraction in 8 and 16 bit.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Serialize, Deserialize)]
#[cfg_attr(feature = "schemars", derive(schemars::JsonSchema))]
#[serde(rename_all = "lowercase")]
pub enum Rounding {
    /// To the nearest.
    #[default]
    Round,
    /// Cut off, as the course of 2018 does: `int(255·c)`.
    Truncate,
}

/// Turns linear radiance into integers from 0 to `max` (255 or 65535), clipped. NaN becomes 0.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Encoding {
    /// The curve.
    pub transfer: Transfer,
    /// What happens to the fraction.
    pub rounding: Rounding,
}

impl Encoding {
    /// One component.
    pub fn encode(self, linear: f64, max: u16) -> u16 {
        self.code(linear, f64::from(max)) as u16
    }

    /// Many components at once, with the same bits. `codes` are as many as `linear`.
    ///
    /// # Panics
    /// If they are not.
    pub fn encode_all(self, linear: &[f64], max: u16, codes: &mut [u16]) {
        assert_eq!(linear.len(), codes.len(), "a code for each component");
        dispatch(LaneWidth::default(), EncodeAll { encoding: self, linear, max, codes });
    }

    /// Whole numbers from 0 to `max`.
    #[inline(always)]
    fn code<L: Lanes>(self, linear: L, max: f64) -> L {
        let value = match self.transfer {
            Transfer::Linear => linear,
            Transfer::Srgb => srgb_of(linear),
        };
        let half = match self.rounding {
            Rounding::Truncate => 0.0,
            Rounding::Round => 0.5,
        };
        let scaled = L::splat(max) * value + L::splat(half);
        // NaN is not above 0.
        L::select(L::splat(0.0).lt(scaled), scaled, L::splat(0.0)).min(L::splat(max))
    }
}

struct EncodeAll<'a> {
    encoding: Encoding,
    linear: &'a [f64],
    max: u16,
    codes: &'a mut [u16],
}

impl Kernel for EncodeAll<'_> {
    type Output = ();

    #[inline(always)]
    fn run<L: Lanes>(self) {
        let Self { encoding, linear, max, codes } = self;
        let max = f64::from(max);
        let mut wide = [0.0; MAX_WIDTH];
        let (chunks, rest) = (linear.chunks_exact(L::WIDTH), linear.chunks_exact(L::WIDTH).remainder());
        let (some, last) = codes.split_at_mut(linear.len() - rest.len());
        for (values, codes) in chunks.zip(some.chunks_exact_mut(L::WIDTH)) {
            encoding.code(L::load(values), max).store(&mut wide[..L::WIDTH]);
            for (code, value) in codes.iter_mut().zip(wide) {
                // Cut off: it is not below 0.
                *code = value as u16;
            }
        }
        for (&value, code) in rest.iter().zip(last) {
            *code = encoding.code(value, max) as u16;
        }
    }
}

/// The curve of IEC 61966-2-1:1999, from linear light to the encoded value, both 0 to 1.
pub fn srgb(linear: f64) -> f64 {
    srgb_of(linear)
}

#[inline(always)]
fn srgb_of<L: Lanes>(linear: L) -> L {
    let number = L::splat;
    let power = number(1.055) * pow(linear, number(1.0 / 2.4)) - number(0.055);
    L::select(linear.le(number(0.003_130_8)), number(12.92) * linear, power)
}

/// The inverse of [`srgb`]: from the encoded value to linear light, both 0 to 1.
pub fn from_srgb(encoded: f64) -> f64 {
    if encoded <= 0.04045 { encoded / 12.92 } else { libm::pow((encoded + 0.055) / 1.055, 2.4) }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn linear(value: f64, rounding: Rounding) -> u16 {
        Encoding { transfer: Transfer::Linear, rounding }.encode(value, 255)
    }

    #[test]
    fn clips_rounds_and_truncates() {
        for (value, rounded, truncated) in
            [(-1.0, 0, 0), (0.0, 0, 0), (0.5, 128, 127), (0.999, 255, 254), (1.0, 255, 255), (7.0, 255, 255)]
        {
            assert_eq!(linear(value, Rounding::Round), rounded, "{value}");
            assert_eq!(linear(value, Rounding::Truncate), truncated, "{value}");
        }
        assert_eq!(linear(f64::NAN, Rounding::Round), 0);
        assert_eq!(linear(f64::INFINITY, Rounding::Truncate), 255);
    }

    #[test]
    fn all_at_once_are_as_one_by_one_at_every_width() {
        let mut linear: Vec<f64> = (0..4000).map(|i| f64::from(i) / 3500.0 - 0.05).collect();
        linear.extend([f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -0.0, 1e300, 1e-300, 0.003_130_8]);
        for (transfer, rounding) in
            [Transfer::Linear, Transfer::Srgb].into_iter().flat_map(|t| [(t, Rounding::Round), (t, Rounding::Truncate)])
        {
            for max in [255, 65535] {
                let encoding = Encoding { transfer, rounding };
                let one_by_one: Vec<u16> = linear.iter().map(|&value| encoding.encode(value, max)).collect();
                for width in LaneWidth::ALL {
                    let mut codes = vec![7; linear.len()];
                    dispatch(width, EncodeAll { encoding, linear: &linear, max, codes: &mut codes });
                    assert_eq!(codes, one_by_one, "{encoding:?}, {max}, {width:?}");
                }
            }
        }
    }

    #[test]
    fn srgb_has_the_published_values() {
        // IEC 61966-2-1: middle gray 0.2140 is 127.5/255 to four digits; the two branches meet.
        assert!((srgb(0.214_041) - 0.5).abs() < 1e-5);
        assert!((srgb(0.003_130_8) - srgb(0.003_130_81)).abs() < 1e-6);
        assert!((srgb(1.0) - 1.0).abs() < 1e-15);
    }

    #[test]
    fn every_code_comes_back() {
        let encoding = Encoding { transfer: Transfer::Srgb, rounding: Rounding::Round };
        for max in [255, 65535] {
            for code in 0..=max {
                let linear = from_srgb(f64::from(code) / f64::from(max));
                assert_eq!(encoding.encode(linear, max), code);
                // As textures keep it: the step between codes is 2⁻¹⁶ and more, a rounding 2⁻²⁵ and less.
                assert_eq!(encoding.encode(f64::from(linear as f32), max), code);
            }
        }
        assert_eq!((from_srgb(0.0), from_srgb(1.0)), (0.0, 1.0));
        // The standard's two branches meet to the digits that it gives.
        assert!((from_srgb(0.04045) - from_srgb(0.040_450_1)).abs() < 1e-7);
    }
}
