//! From linear light to the integers of a picture file, and back.

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
        let value = match self.transfer {
            Transfer::Linear => linear,
            Transfer::Srgb => srgb(linear),
        };
        let scaled = f64::from(max) * value;
        let whole = match self.rounding {
            Rounding::Truncate => scaled,
            Rounding::Round => (scaled + 0.5).floor(),
        };
        // The cast truncates, turns NaN into 0 and clips.
        (whole.clamp(0.0, f64::from(max))) as u16
    }
}

/// The curve of IEC 61966-2-1:1999, from linear light to the encoded value, both 0 to 1.
pub fn srgb(linear: f64) -> f64 {
    if linear <= 0.003_130_8 { 12.92 * linear } else { 1.055 * libm::pow(linear, 1.0 / 2.4) - 0.055 }
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
