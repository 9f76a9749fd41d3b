//! Powers that give the same bits on every machine, many at a time.
//!
//! `x^y = exp(y ln x)`, where `ln x` needs some 12 bits more than a double has, because `y ln x` may be 745 and its
//! absolute error becomes the relative error of the power. So the logarithm and the product are carried as unevaluated
//! sums of two doubles: a head of 26 bits, whose products with other heads are exact (Dekker, "A floating-point technique
//! for extending the available precision", Numer. Math. 18, 1971), and the rest. How to reduce the arguments and which
//! series to use: Muller, "Elementary Functions", 3rd edition, 2016, chapters 4 and 11. No table, no branch: every lane
//! does the same work.

use super::Lanes;
use super::exp::{LN_2, exp_of_sum, horner};

/// √2 rounded to a multiple of 2⁻²⁵, and how much its logarithm exceeds `½ ln 2`.
const CENTER: f64 = 1.414_213_567_972_183_2;
const CENTER_EXCESS: f64 = 3.959_153_211_809_186e-9;

/// Where the centres 1 and √2 are equally far: the fourth root of 2.
const BETWEEN_CENTERS: f64 = 1.189_207_115_002_721;

/// `2 atanh(s/2) = s + s³/12 + s⁵ T(s²)`: `T`, whose series is 1/80 + w/448 + w²/2304 + ..., for w up to 0.02988 (Remez'
/// algorithm in 250 bits; relative error of the polynomial 2⁻⁵⁵).
const ATANH_EVEN: [f64; 3] = [0.012_499_999_999_999_999, 0.000_434_027_777_478_107_04, 1.877_729_660_612_527e-5];
const ATANH_ODD: [f64; 3] = [0.002_232_142_857_143_625_5, 8.877_845_181_781_089e-5, 4.150_507_229_081_94e-6];

/// `base^exponent` for `base >= 0`.
///
/// Counting the roundings, the error is below 0.7 ulp; the largest one found over 199 million points (highlights, bases
/// near 1, and all ranges of bases and results) was 0.581 ulp, against 113 bits. Results below the smallest normal number
/// round once more: below 0.9 of their unit, found 0.757. For exponents from 0, no power of a base up to 1 exceeds 1.
///
/// Zeros, infinities and NaN give what IEEE 754 says: 1 for `exponent` 0 and for `base` 1 whatever the other is, else NaN
/// for a NaN, 0 or infinity where they are the limit. A base below 0 counts as 0.
#[inline(always)]
pub fn pow<L: Lanes>(base: L, exponent: L) -> L {
    let number = L::splat;
    let (ln_2, ln_2_rest) = (number(LN_2[0]), number(LN_2[1]));

    // base = m·2^e, subnormal bases after a scaling that is exact; m between 2^-¼ and 2^¾.
    let subnormal = base.lt(number(f64::MIN_POSITIVE));
    let (m, e) = L::select(subnormal, base * number(18_014_398_509_481_984.0), base).split_exponent();
    let e = L::select(subnormal, e - number(54.0), e);

    // The nearer centre c, 1 or about √2 = 2^½: s = 2 (m - c) / (m + c), |s| < 0.173. m - c is exact (Sterbenz), and so is
    // m + c in two parts, of which the first has 27 bits.
    let upper = number(BETWEEN_CENTERS).le(m);
    let c = L::select(upper, number(CENTER), number(1.0));
    let e = L::select(upper, e + number(0.5), e);
    let excess = L::select(upper, number(CENTER_EXCESS), number(0.0));
    let numerator = (m - c) + (m - c);
    let (m_head, reciprocal) = (m.head(), number(1.0) / (m + c));
    let (sum_head, sum_rest) = (m_head + c, m - m_head);
    let s_head = (numerator * reciprocal).head();
    let s_rest = ((numerator - s_head * sum_head) - s_head * sum_rest) * reciprocal;
    let s = s_head + s_rest;

    // ln(m/c) = 2 atanh(s/2) = s + s·(s²/12 + s⁴ T(s²)); w = s², and the bracket in two parts.
    let (w_head, w_rest) = (s_head * s_head, s_rest * (s_head + s));
    let w = w_head + w_rest;
    let ww = w * w;
    let twelfth = number(1.0 / 12.0);
    let u_head = (w_head * twelfth).head();
    let u_rest = ((w_head - number(12.0) * u_head) + w_rest) * twelfth
        + ww * (horner(ww, ATANH_EVEN) + w * horner(ww, ATANH_ODD));
    let su = s_head * u_head;

    // ln(base) = e ln 2 + s + su + small, then as head and rest.
    let small = ((s_rest + s_rest * u_head) + s * u_rest) + (e * ln_2_rest + excess);
    let whole = e * ln_2;
    let ln = ((whole + s_head) + su) + small;
    let ln_head = ln.head();
    let ln_rest = (((whole - ln_head) + s_head) + su) + small;

    // The logarithm of the power: rounded, which decides what is too large or too small, and in two parts.
    let infinity = number(f64::INFINITY);
    let ordinary = number(0.0).lt(base) & base.lt(infinity);
    let power_ln = exponent * L::select(ordinary, ln, (base - number(1.0)) * infinity);
    let exponent_head = exponent.head();
    let product_head = exponent_head * ln_head;
    let product_rest = (exponent - exponent_head) * ln_head + exponent * ln_rest;

    let power = exp_of_sum(power_ln, product_head, product_rest);
    L::select(exponent.eq(number(0.0)) | base.eq(number(1.0)), number(1.0), power)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::ArrayLanes;
    use dashu_float::FBig;
    use proptest::prelude::*;

    fn exact(x: f64) -> FBig {
        FBig::try_from(x).unwrap().with_precision(220).value()
    }

    /// By how many units in the last place of the true power is `pow` off? All that is above the range of doubles counts
    /// as the number that would follow the largest.
    fn error(base: f64, exponent: f64) -> f64 {
        let beyond = exact(2.0) * exact(f64::from_bits(2046 << 52));
        let found = pow(base, exponent);
        let found = if found == f64::INFINITY { beyond.clone() } else { exact(found) };
        let power = exact(base).powf(&exact(exponent)).min(beyond);
        let binade = f64::from_bits((power.to_f64().value().to_bits() >> 52).clamp(1, 2046) << 52);
        ((found - power) / exact(binade)).to_f64().value().abs() / f64::EPSILON
    }

    fn check(base: f64, exponent: f64) -> Result<(), TestCaseError> {
        let (found, error) = (pow(base, exponent), error(base, exponent));
        // Below what counting the roundings promises, 0.9 and 0.7.
        let bound = if found < f64::MIN_POSITIVE { 0.8 } else { 0.6 };
        prop_assert!(error < bound, "{base:e}^{exponent:e} = {found:e}: {error} ulp off");
        prop_assert!(base > 1.0 || exponent < 0.0 || found <= 1.0, "{base:e}^{exponent:e} = {found:e}, above 1");
        Ok(())
    }

    fn positive() -> impl Strategy<Value = f64> {
        (1..f64::INFINITY.to_bits()).prop_map(f64::from_bits)
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(1000))]

        /// Highlights: cosines, and exponents from mat to polished.
        #[test]
        fn highlights_are_right(base in 1e-6..=1.0f64, exponent in 0.0..2000.0f64) {
            check(base, exponent)?;
            check(base, exponent.floor())?;
            check(base, exponent / 100.0)?;
        }

        /// Near 1 from both sides, where the logarithm has few digits to lose.
        #[test]
        fn powers_of_numbers_near_1_are_right(steps in 1..1u64 << 45, shift in 0..45u32, ln in -740.0..700.0f64) {
            for bits in [1f64.to_bits() - (steps >> shift).max(1), 1f64.to_bits() + (steps >> shift).max(1)] {
                let base = f64::from_bits(bits);
                check(base, ln / libm::log(base))?;
            }
        }

        /// All positive bases, with results from infinite over subnormal to 0.
        #[test]
        fn powers_are_right_over_the_whole_range(base in positive(), ln in -750.0..720.0f64) {
            prop_assume!(base != 1.0);
            check(base, ln / libm::log(base))?;
        }

        #[test]
        fn subnormal_bases_and_powers_are_right(fraction in 1..1u64 << 52, shift in 0..52u32, ln in -746.0..-707.0f64) {
            let base = f64::from_bits((fraction >> shift).max(1));
            check(base, -ln / 750.0)?;
            check(base, ln / libm::log(base))?;
        }

        /// Any pattern of bits, in every lane what the plain number gives.
        #[test]
        fn every_lane_has_the_bits_of_the_plain_number(
            bases in prop::array::uniform4(prop_oneof![0.0..=1.0f64, any::<f64>()]),
            exponents in prop::array::uniform4(prop_oneof![0.0..1000.0f64, any::<f64>()]),
        ) {
            type Four = ArrayLanes<4>;
            let powers = pow(Four::from_fn(|i| bases[i]), Four::from_fn(|i| exponents[i]));
            for i in 0..4 {
                let plain = pow(bases[i], exponents[i]);
                let lane = powers.lane(i);
                prop_assert!(lane.to_bits() == plain.to_bits() || (lane.is_nan() && plain.is_nan()));
            }
        }
    }

    #[test]
    fn special_values_are_those_of_ieee_754() {
        let bases =
            [0.0, 5e-324, 1e-310, f64::MIN_POSITIVE, 0.5, 1.0 - f64::EPSILON / 2.0, 1.0, 1.0 + f64::EPSILON, 2.0];
        let bases = bases.into_iter().chain([1e300, f64::MAX, f64::INFINITY, f64::NAN]);
        let exponents =
            [0.0, 5e-324, 1e-300, 1e-20, 0.5, 1.0, 3.0, 1e15, 1e17, 1e300, f64::MAX, f64::INFINITY, f64::NAN];
        for base in bases {
            for exponent in exponents.into_iter().flat_map(|y| [y, -y]) {
                let (found, expected) = (pow(base, exponent), libm::pow(base, exponent));
                let same = found.to_bits() == expected.to_bits() || (found.is_nan() && expected.is_nan());
                // An ordinary power, of which libm may miss the last bit.
                let ordinary = expected != 1.0 && f64::MIN_POSITIVE < expected && expected < f64::INFINITY;
                let fine = same || (ordinary && error(base, exponent) < 0.6);
                assert!(fine, "{base:e}^{exponent:e} = {found:e}, not {expected:e}");
            }
        }
        for below in [-0.0, -5e-324, -0.5, -1.0, -1e300, f64::NEG_INFINITY] {
            assert_eq!([2.5, 0.0, -2.5].map(|y| pow(below, y)), [0.0, 1.0, f64::INFINITY], "{below} counts as 0");
        }
    }

    #[test]
    fn powers_that_are_doubles_are_met() {
        for k in -1074..1024 {
            assert_eq!(pow(2.0, f64::from(k)), libm::ldexp(1.0, k));
            assert_eq!(pow(4.0, 0.5 * f64::from(k)), libm::ldexp(1.0, k));
        }
        for base in 1..1000u64 {
            let whole = base as f64;
            for exponent in (1..).take_while(|&y| base.checked_pow(y).is_some_and(|power| power < 1 << 53)).take(60) {
                assert_eq!(pow(whole, f64::from(exponent)), base.pow(exponent) as f64);
                assert_eq!(pow(base.pow(exponent) as f64, 1.0), base.pow(exponent) as f64);
            }
        }
    }
}
