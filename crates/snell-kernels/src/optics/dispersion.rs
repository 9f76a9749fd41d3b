//! Refractive index by wavelength.
//!
//! Wavelengths are in nm; inside the formulas they are in µm, since that is how their coefficients are published.

use crate::lanes::sqrt;
use alloc::borrow::Cow;

/// Fraunhofer's lines by which glasses are described, in nm: F (blue, hydrogen), d (yellow, helium), C (red, hydrogen).
pub const LINE_F_NM: f64 = 486.1327;
/// See [`LINE_F_NM`].
pub const LINE_D_NM: f64 = 587.5618;
/// See [`LINE_F_NM`].
pub const LINE_C_NM: f64 = 656.2725;

/// Light that people see, in nm: where a formula holds that was made from numbers for it.
pub const VISIBLE_NM: [f64; 2] = [380.0, 780.0];

/// How the index depends on the wavelength λ, in µm. Numbers of the formulas as refractiveindex.info has them.
#[derive(Clone, Debug, PartialEq)]
pub enum Formula {
    /// The same for all wavelengths.
    Constant(f64),
    /// `n = A + B/λ² + C/λ⁴` (Cauchy 1836).
    Cauchy([f64; 3]),
    /// Cauchy's formula of two terms through the index at the d line, with an Abbe number: `n_F - n_C = (n_d - 1)/V_d`.
    Abbe {
        /// Index at the d line.
        eta_d: f64,
        /// Abbe number `V_d`; infinity for no dispersion at all.
        abbe_number: f64,
    },
    /// `n² = 1 + c₁ + Σ Bλ²/(λ² - C²)` (Sellmeier 1871; formula 1): `c₁` and pairs `[B, C]`.
    Sellmeier(f64, Cow<'static, [[f64; 2]]>),
    /// The same with `C` for `C²` (formula 2), as Schott writes it.
    SellmeierSquared(f64, Cow<'static, [[f64; 2]]>),
    /// `n = 1 + c₁ + Σ B/(C - λ⁻²)`, for gases (formula 6).
    Gas(f64, Cow<'static, [[f64; 2]]>),
}

/// A formula and where it holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Dispersion {
    /// The formula.
    pub formula: Formula,
    /// Shortest and longest wavelength in nm for which it was made.
    pub range_nm: [f64; 2],
}

/// There is no index for this wavelength.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
pub enum NoIndex {
    /// The formula was not made for it.
    #[error("no refractive index is known at {wavelength_nm} nm, only from {} to {} nm", .range_nm[0], .range_nm[1])]
    OutOfRange {
        /// Asked for, in nm.
        wavelength_nm: f64,
        /// Shortest and longest wavelength in nm that may be asked for.
        range_nm: [f64; 2],
    },
    /// The coefficients make no refractive index of it.
    #[error("the coefficients give a refractive index of {eta} at {wavelength_nm} nm, which is not above 0")]
    NotPositive {
        /// Asked for, in nm.
        wavelength_nm: f64,
        /// What came out: NaN, infinite, 0 or less.
        eta: f64,
    },
}

impl Dispersion {
    /// The same index for all wavelengths.
    pub const fn constant(eta: f64) -> Self {
        Self { formula: Formula::Constant(eta), range_nm: [0.0, f64::INFINITY] }
    }

    /// Visible light by index at the d line and Abbe number: exactly `eta_d` at [`LINE_D_NM`], and everywhere where the
    /// Abbe number is infinite.
    pub const fn abbe(eta_d: f64, abbe_number: f64) -> Self {
        Self { formula: Formula::Abbe { eta_d, abbe_number }, range_nm: VISIBLE_NM }
    }

    /// The index at this wavelength, good to a few ulp.
    ///
    /// # Errors
    /// Outside of `range_nm` (both ends belong to it), and where the coefficients give no number above 0.
    pub fn eta(&self, wavelength_nm: f64) -> Result<f64, NoIndex> {
        let [shortest, longest] = self.range_nm;
        if !(shortest <= wavelength_nm && wavelength_nm <= longest) {
            return Err(NoIndex::OutOfRange { wavelength_nm, range_nm: self.range_nm });
        }
        let eta = self.formula.eta(wavelength_nm / 1000.0);
        if 0.0 < eta && eta < f64::INFINITY { Ok(eta) } else { Err(NoIndex::NotPositive { wavelength_nm, eta }) }
    }

    /// Abbe number `V_d = (n_d - 1)/(n_F - n_C)`: large for little dispersion, infinite for none.
    ///
    /// # Errors
    /// If one of the three lines is out of range.
    pub fn abbe_number(&self) -> Result<f64, NoIndex> {
        let (f, d, c) = (self.eta(LINE_F_NM)?, self.eta(LINE_D_NM)?, self.eta(LINE_C_NM)?);
        // 0/0 for a vacuum.
        Ok(if f == c { f64::INFINITY } else { (d - 1.0) / (f - c) })
    }
}

impl Formula {
    /// The index at a wavelength in µm, whatever comes out.
    fn eta(&self, wavelength: f64) -> f64 {
        let square = wavelength * wavelength;
        match self {
            Self::Constant(eta) => *eta,
            Self::Cauchy([a, b, c]) => a + (b + c / square) / square,
            Self::Abbe { eta_d, abbe_number } => {
                let inverse = |line_nm: f64| 1.0 / (line_nm / 1000.0 * (line_nm / 1000.0));
                let spread = (eta_d - 1.0) / abbe_number;
                // 0 at the d line and 1 between the lines F and C.
                let part = (1.0 / square - inverse(LINE_D_NM)) / (inverse(LINE_F_NM) - inverse(LINE_C_NM));
                eta_d + spread * part
            }
            Self::Sellmeier(first, terms) => {
                sqrt(terms.iter().fold(1.0 + first, |sum, [b, c]| sum + b * square / (square - c * c)))
            }
            Self::SellmeierSquared(first, terms) => {
                sqrt(terms.iter().fold(1.0 + first, |sum, [b, c]| sum + b * square / (square - c)))
            }
            // Small numbers first: what a gas adds to 1 keeps its digits.
            Self::Gas(first, terms) => 1.0 + terms.iter().fold(*first, |sum, [b, c]| sum + b / (c - 1.0 / square)),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn index_and_abbe_number_come_back(eta_d in 1.01..4.0f64, abbe_number in 10.0..100.0f64) {
            let glass = Dispersion::abbe(eta_d, abbe_number);
            prop_assert_eq!(glass.eta(LINE_D_NM), Ok(eta_d));
            // Two roundings of indices up to 4, 4e-16 each, in a difference of at least 0.01/100, and a few of the rest.
            let bound = abbe_number * (1e-15 / ((eta_d - 1.0) / abbe_number) + 1e-15);
            prop_assert!((glass.abbe_number().unwrap() - abbe_number).abs() < bound);
            prop_assert!(glass.eta(400.0).unwrap() > glass.eta(700.0).unwrap(), "blue is bent more");
        }

        #[test]
        fn without_dispersion_the_index_is_the_same_to_the_bit(eta in 1.0..4.0f64, wavelength_nm in 380.0..=780.0f64) {
            for glass in [Dispersion::constant(eta), Dispersion::abbe(eta, f64::INFINITY)] {
                prop_assert_eq!(glass.eta(wavelength_nm), Ok(eta));
                prop_assert_eq!(glass.abbe_number(), Ok(f64::INFINITY));
            }
        }

        /// The same glass in both of Sellmeier's forms, and by Cauchy's two terms.
        #[test]
        fn forms_agree(b in 0.5..3.0f64, c in 0.01..0.2f64, wavelength_nm in 380.0..780.0f64) {
            let of = |formula| Dispersion { formula, range_nm: VISIBLE_NM }.eta(wavelength_nm).unwrap();
            let first = of(Formula::Sellmeier(0.0, vec![[b, c]].into()));
            // c² is rounded in both: the same bits.
            prop_assert_eq!(first, of(Formula::SellmeierSquared(0.0, vec![[b, c * c]].into())));
            // λ²/(λ² - C²) = 1 + C²/λ² + C⁴/λ⁴ + ..., for n² instead of n.
            let series = of(Formula::Cauchy([1.0 + b, b * c * c, b * c * c * c * c]));
            let ratio = c * 1000.0 / wavelength_nm;
            let ratio2 = ratio * ratio;
            // What the series leaves out: a geometric one.
            let rest = b * ratio2 * ratio2 * ratio2 / (1.0 - ratio2);
            prop_assert!((first * first - series - rest).abs() < 1e-14);
        }
    }

    #[test]
    fn what_is_not_known_is_an_error_that_says_the_range() {
        let glass = Dispersion { formula: Formula::Cauchy([1.5, 0.004, 0.0]), range_nm: [400.0, 700.0] };
        assert!(glass.eta(400.0).is_ok() && glass.eta(700.0).is_ok(), "both ends belong to it");
        for wavelength_nm in [399.9, 700.1, 0.0, -500.0, f64::NAN, f64::INFINITY] {
            let message = glass.eta(wavelength_nm).unwrap_err().to_string();
            assert!(message.contains("only from 400 to 700 nm"), "{message}");
        }
        let infrared = Dispersion { range_nm: [2000.0, 14000.0], ..glass };
        assert!(infrared.abbe_number().unwrap_err().to_string().contains("486.1327 nm"));
        // A resonance at 500 nm: n² is negative just below.
        let formula = Formula::Sellmeier(0.0, vec![[1.0, 0.5]].into());
        let resonance = Dispersion { formula, range_nm: VISIBLE_NM };
        for wavelength_nm in [499.0, 500.0] {
            assert!(matches!(resonance.eta(wavelength_nm), Err(NoIndex::NotPositive { .. })));
        }
    }
}
