//! The exponential function that gives the same bits on every machine, many at a time.
//!
//! The last part of [`pow`](super::pow), which explains the method, and on its own.

use super::Lanes;
use core::f64::consts::LOG2_E;

/// `ln 2` in two parts. The first ends at 2⁻⁴⁰, so that its product with a number of 12 bits is exact.
pub(super) const LN_2: [f64; 2] = [0.693_147_180_559_208_2, 7.371_002_565_167_799e-13];

/// `exp(r) = 1 + r + r²/2 + r³ U(r)`: `U`, whose series is 1/6 + r/24 + ..., for |r| up to `½ ln 2` (Remez' algorithm in
/// 250 bits; error of `r³ U(r)` 2⁻⁶³ of `exp(r)`).
const EXP_EVEN: [f64; 5] = [
    0.166_666_666_666_666_8,
    0.008_333_333_333_318_543,
    0.000_198_412_698_933_065_66,
    2.755_723_748_915_401_5e-6,
    2.511_123_434_156_199_4e-8,
];
const EXP_ODD: [f64; 5] = [
    0.041_666_666_666_666_415,
    0.001_388_888_888_903_311_4,
    2.480_158_702_583_927_3e-5,
    2.755_752_595_694_014e-7,
    2.083_853_523_793_730_7e-9,
];

/// Added and taken away again, they round to a whole number, and to a multiple of 2⁻²⁸.
const TO_WHOLE: f64 = 6_755_399_441_055_744.0; // 1.5·2^52
const TO_28_BITS: f64 = 25_165_824.0; // 1.5·2^24

/// `e^x`.
///
/// Counting the roundings, the error is below 0.62 ulp, and 0.9 of their unit for results below the smallest normal
/// number, which round once more; the largest ones found over a million points were 0.574 and 0.752. 1 for 0 and -0, infinity from about 709.8 on, 0 below about -745.1, NaN for NaN. No
/// exponential of a number up to 0 exceeds 1.
#[inline(always)]
pub fn exp<L: Lanes>(x: L) -> L {
    // From ½ ln 2 on x is a multiple of 2^-54, as k ln 2 is: their difference, below ½, is exact.
    exp_of_sum(x, x, L::splat(0.0))
}

/// `exp(head + rest)`, where `sum` is that sum, rounded. A multiple of `ln 2`'s first part is taken from `head` and must
/// leave an exact number; `rest` is small.
#[inline(always)]
pub(super) fn exp_of_sum<L: Lanes>(sum: L, head: L, rest: L) -> L {
    let number = L::splat;
    let (ln_2, ln_2_rest) = (number(LN_2[0]), number(LN_2[1]));

    // sum = k ln 2 + r + rest, |r| <= ½ ln 2. As a multiple of 2^-28, r has exact 1 + r and r²; exp(rest) is 1 + rest, the
    // next term being below 2^-58.
    let k = (sum * number(LOG2_E) + number(TO_WHOLE)) - number(TO_WHOLE);
    let (remainder, remainder_rest) = (head - k * ln_2, rest - k * ln_2_rest);
    let r = ((remainder + remainder_rest) + number(TO_28_BITS)) - number(TO_28_BITS);
    let rest = (remainder - r) + remainder_rest;
    let rr = r * r;
    let tail = rr * number(0.5) + (r * rr) * (horner(rr, EXP_EVEN) + r * horner(rr, EXP_ODD));
    let one_r = number(1.0) + r;
    let power = one_r + (tail + rest * (one_r + tail));

    // Outside of these bounds, which lie a little outside of the range of doubles, all that was done is worth nothing.
    let power = L::select(sum.gt(number(710.0)), number(f64::INFINITY), power.times_exp2(k));
    L::select(sum.lt(number(-746.0)), number(0.0), power)
}

/// `c₀ + x (c₁ + x (c₂ + ...))`.
#[inline(always)]
pub(super) fn horner<L: Lanes, const N: usize>(x: L, coefficients: [f64; N]) -> L {
    // No `fold`: a closure may become a function of its own, without the instructions of the width.
    let mut sum = L::splat(coefficients[N - 1]);
    for i in (0..N - 1).rev() {
        sum = L::splat(coefficients[i]) + x * sum;
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::{ArrayLanes, Kernel, dispatch};
    use dashu_float::FBig;
    use proptest::prelude::*;

    fn exact(x: f64) -> FBig {
        FBig::try_from(x).unwrap().with_precision(220).value()
    }

    /// By how many units in the last place of the true value is `exp` off? For results in the range of doubles.
    fn error(x: f64) -> f64 {
        let truth = exact(x).exp();
        let binade = f64::from_bits((truth.to_f64().value().to_bits() >> 52).clamp(1, 2046) << 52);
        ((exact(exp(x)) - truth) / exact(binade)).to_f64().value().abs() / f64::EPSILON
    }

    fn check(x: f64) -> Result<(), TestCaseError> {
        let (found, error) = (exp(x), error(x));
        // Below what counting the roundings promises, 0.9 and 0.62.
        let bound = if found < f64::MIN_POSITIVE { 0.8 } else { 0.6 };
        prop_assert!(error < bound, "exp({x:e}) = {found:e}: {error} ulp off");
        prop_assert!(x > 0.0 || found <= 1.0, "exp({x:e}) = {found:e}, above 1");
        Ok(())
    }

    struct InEveryLane([f64; 8]);

    impl Kernel for InEveryLane {
        type Output = ();
        #[inline(always)]
        fn run<L: Lanes>(self) {
            let lanes = exp(L::load(&self.0));
            for i in 0..L::WIDTH {
                let (lane, plain) = (lanes.lane(i), exp(self.0[i]));
                assert!(lane.to_bits() == plain.to_bits() || (lane.is_nan() && plain.is_nan()));
            }
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn exponentials_are_right(small in -1.0..1.0f64, medium in -20.0..20.0f64, large in -745.0..709.7f64, shift in 0..60i32) {
            for x in [small, libm::ldexp(small, -shift), medium, large] {
                check(x)?;
            }
        }

        #[test]
        fn subnormal_results_are_right(x in -745.1..-708.4f64) {
            check(x)?;
        }

        /// Any pattern of bits, at every width.
        #[test]
        fn every_lane_has_the_bits_of_the_plain_number(
            x in prop::array::uniform8(prop_oneof![-750.0..710.0f64, any::<f64>()]),
        ) {
            for lanes in [1, 2, 4, 8] {
                dispatch(lanes, crate::instructions_of_this_machine!(), InEveryLane(x));
            }
            InEveryLane(x).run::<ArrayLanes<8>>();
        }
    }

    #[test]
    fn special_values_are_exact() {
        let pairs = [
            (0.0, 1.0),
            (-0.0, 1.0),
            (5e-324, 1.0),
            (f64::NEG_INFINITY, 0.0),
            (-746.5, 0.0),
            (f64::MIN, 0.0),
            (709.8, f64::INFINITY),
            (f64::MAX, f64::INFINITY),
            (f64::INFINITY, f64::INFINITY),
        ];
        for (x, expected) in pairs {
            assert_eq!(exp(x), expected, "exp({x:e})");
        }
        assert!(exp(f64::NAN).is_nan());
    }
}
