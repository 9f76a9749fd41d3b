//! A checkerboard.

use libm::floor;

/// Is the square of a board of unit squares that holds `(u, v)` a dark one? The one from (0, 0) to (1, 1) is not; a square
/// holds its lower and left edges. What is not finite counts as an even row or column.
pub fn checker(u: f64, v: f64) -> bool {
    is_odd(floor(u)) != is_odd(floor(v))
}

/// Of whole numbers of any size: from 2⁵³ on all are even. Halving is exact.
fn is_odd(whole: f64) -> bool {
    let half = 0.5 * whole;
    // NaN is in no order.
    floor(half) < half
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    #[test]
    fn squares_around_the_origin_alternate() {
        for (u, v, dark) in [
            (0.0, 0.0, false),
            (-0.0, -0.0, false),
            (0.5, 0.5, false),
            (1.0, 0.5, true),
            (-0.5, 0.5, true),
            (-0.5, -0.5, false),
            (-1.0, 0.0, true),
            (-1.5, 0.0, false),
            (-1e-300, 0.0, true),
        ] {
            assert_eq!(checker(u, v), dark, "{u} {v}");
        }
    }

    #[test]
    fn huge_and_broken_numbers_have_a_colour() {
        let last_odd = 9_007_199_254_740_991.0; // 2⁵³ − 1
        assert!(checker(last_odd, 0.0) && checker(-last_odd, 0.0));
        for even in [2.0 * last_odd, 1e300, -1e300, f64::MAX, f64::INFINITY, f64::NEG_INFINITY, f64::NAN] {
            assert!(!checker(even, 0.5) && checker(0.5 + 1.0, even), "{even}");
        }
    }

    proptest! {
        /// Integer arithmetic, where it reaches, says the same; numbers are eighths, so that one more is exact.
        #[test]
        fn a_step_to_the_side_changes_the_colour(i in -1_000_000_000_000i64..1_000_000_000_000, j in -800i64..800) {
            let (u, v) = (i as f64 / 8.0, j as f64 / 8.0);
            prop_assert_eq!(checker(u, v), (i.div_euclid(8) + j.div_euclid(8)).rem_euclid(2) == 1);
            prop_assert_ne!(checker(u, v), checker(u + 1.0, v));
            prop_assert_ne!(checker(u, v), checker(u, v - 1.0));
        }
    }
}
