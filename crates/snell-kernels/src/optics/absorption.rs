//! Absorption inside a medium: the law of Bouguer, Lambert and Beer.
//!
//! Over every equal length the same part of the light is lost, so that `exp(-sigma_a·distance)` is left (Bouguer, "Essai
//! d'optique", 1729). People say instead which colour is left of white after which distance (as glTF's
//! `KHR_materials_volume` does).

use crate::color::Rgb;
use crate::lanes::{Lanes, exp};

/// Absorption per scene unit of a medium that leaves `attenuation_color` of white light after `attenuation_distance`:
/// `-ln(color)/distance`.
///
/// Colours are from 0 to 1, the distance is above 0, in scene units. A channel of 1 gives exactly 0 and one of 0
/// infinity; an infinite distance means a clear medium, 0 in all channels.
pub fn sigma_a(attenuation_color: Rgb, attenuation_distance: f64) -> Rgb {
    let per_unit = |color: f64| {
        if color == 1.0 || attenuation_distance == f64::INFINITY {
            0.0
        } else {
            -libm::log(color) / attenuation_distance
        }
    };
    Rgb::new(per_unit(attenuation_color.r), per_unit(attenuation_color.g), per_unit(attenuation_color.b))
}

/// The part of the light that is left after `distance` scene units.
///
/// From 0 to 1, with an error of less than 0.62 ulp (see [`exp`]) and `½ ulp·sigma_a·distance`. Exactly 1 where either
/// number is 0, whatever the other is, infinity included.
#[inline(always)]
pub fn transmittance<L: Lanes>(sigma_a: L, distance: L) -> L {
    let zero = L::splat(0.0);
    // 0·∞ is no number, but nothing is lost where nothing absorbs.
    exp(L::select(sigma_a.eq(zero) | distance.eq(zero), zero, -(sigma_a * distance)))
}

/// [`transmittance`] of each channel.
#[inline(always)]
pub fn transmittance_rgb<L: Lanes>(sigma_a: Rgb<L>, distance: L) -> Rgb<L> {
    Rgb::new(transmittance(sigma_a.r, distance), transmittance(sigma_a.g, distance), transmittance(sigma_a.b, distance))
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// After its distance the colour is there, after n times that its n-th power.
        #[test]
        fn the_colour_comes_back(color in prop::array::uniform3(1e-6..=1.0f64), distance in 1e-3..1e3f64) {
            let sigma_a = sigma_a(color.into(), distance);
            for times in [1i32, 2, 5] {
                let left = transmittance_rgb(sigma_a, f64::from(times) * distance).to_array();
                for (left, color) in left.into_iter().zip(color) {
                    let power = (0..times).fold(1.0, |power, _| power * color);
                    // Four roundings of the exponent, which is at most 5·14; and those of the product and of exp.
                    prop_assert!((left / power - 1.0).abs() < 70.0 * 5e-16 + 7e-16);
                }
            }
        }

        /// Two distances in a row are one.
        #[test]
        fn ways_add_up(sigma_a in 0.0..10.0f64, first in 0.0..3.0f64, second in 0.0..3.0f64) {
            let together = transmittance(sigma_a, first + second);
            let one_by_one = transmittance(sigma_a, first) * transmittance(sigma_a, second);
            // Two roundings in each of three exponents up to 60.
            prop_assert!((together / one_by_one - 1.0).abs() < 60.0 * 7e-16 + 7e-16);
            prop_assert!((0.0..=1.0).contains(&together));
        }
    }

    #[test]
    fn bounds_are_exact_and_never_nan() {
        assert_eq!(sigma_a(Rgb::new(1.0, 0.0, 1.0), 2.0), Rgb::new(0.0, f64::INFINITY, 0.0));
        assert_eq!(sigma_a(Rgb::new(1.0, 0.0, 0.5), f64::INFINITY), Rgb::gray(0.0));
        assert!(sigma_a(Rgb::gray(1.0), 2.0).r.is_sign_positive());
        for (sigma_a, distance, left) in [
            (0.0, 0.0, 1.0),
            (0.0, f64::INFINITY, 1.0),
            (f64::INFINITY, 0.0, 1.0),
            (f64::INFINITY, 1e-300, 0.0),
            (1.0, f64::INFINITY, 0.0),
            (1e-300, 1.0, 1.0),
        ] {
            assert_eq!(transmittance(sigma_a, distance), left, "{sigma_a} over {distance}");
        }
        // One part in e is left after 1/sigma_a.
        assert!((transmittance(0.25, 4.0) - 0.367_879_441_171_442_33).abs() < 1e-16);
        assert!(transmittance(f64::NAN, 1.0).is_nan() && transmittance(1.0, f64::NAN).is_nan());
    }
}
