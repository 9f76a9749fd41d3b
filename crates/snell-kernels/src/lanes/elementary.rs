//! Elementary functions that give the same bits on every machine.
//!
//! They rest on the pure-Rust `libm` crate (a port of musl's and `FreeBSD`'s code, errors below 1 ulp); the
//! functions of `std` call the platform's library and differ from machine to machine.

use core::f64::consts::PI;

/// Sine and cosine of an angle in degrees; exact at every multiple of 90, where a rotation should be exact.
pub fn sin_cos_degrees(degrees: f64) -> (f64, f64) {
    // Exact, and small angles stay small: -180 to 180.
    let turn = libm::remainder(degrees, 360.0);
    if turn == 0.0 {
        (0.0, 1.0)
    } else if turn == 90.0 {
        (1.0, 0.0)
    } else if turn.abs() == 180.0 {
        (0.0, -1.0)
    } else if turn == -90.0 {
        (-1.0, 0.0)
    } else {
        libm::sincos(turn * (PI / 180.0))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quarter_turns_are_exact_and_the_rest_is_right() {
        assert_eq!(sin_cos_degrees(-90.0), (-1.0, 0.0));
        assert_eq!(sin_cos_degrees(450.0), (1.0, 0.0));
        assert_eq!(sin_cos_degrees(-0.0), (0.0, 1.0));
        assert_eq!(sin_cos_degrees(-180.0), (0.0, -1.0));
        let (sin, cos) = sin_cos_degrees(-30.0);
        // One rounding of the angle and one of the function: a few ulp of 1.
        assert!((sin + 0.5).abs() < 4e-16 && (cos - 0.75f64.sqrt()).abs() < 4e-16);
    }
}
