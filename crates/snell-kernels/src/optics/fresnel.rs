//! Fresnel's equations: how much of the light a smooth face between two dielectrics reflects.
//!
//! Everywhere `eta = eta_t / eta_i` (above 1 into the denser medium) and `cos_theta_i` is the cosine of the angle of
//! incidence, from 0 to 1; a rounding beyond is taken for the bound itself. `eta` is positive and neither so small nor so
//! large that its square is out of the range of doubles.
//!
//! With `c = cos_theta_i`, `g = eta·cos_theta_t` and `s² = 1 - c²`, after Cook and Torrance, "A reflectance model for
//! computer graphics", ACM TOG 1(1), 1982:
//!
//! ```text
//! g² = eta² - 1 + c²      Rs = ((g - c) / (g + c))²      Rp = Rs·((c·g - s²) / (c·g + s²))²      R = ½ (Rs + Rp)
//! ```
//!
//! Two differences there lose digits, and are written here in another way. `g²`, near the critical angle: see
//! `g_squared`. `g - c`, for weak faces and near the critical angle: `g² - c² = eta² - 1 = D`, so that
//! `(g - c)/(g + c) = D/(g + c)²`, and `(g + c)² = |D| + 2 m (c + g)` with `m` the smaller one of `c` and `g`. That is a
//! sum of positive terms: the quotient is good to a few ulp, never above 1, and 1 itself where `c` or `g` is 0, which
//! makes grazing incidence and total internal reflection exact without a case of their own.

use crate::lanes::Lanes;

/// The part of unpolarised light that a face reflects, from 0 to 1; the rest is refracted.
///
/// Exactly 1 for total internal reflection and for grazing incidence, exactly 0 for `eta` 1. For `eta` from 0.2 to 5 the
/// error is below 1.5e-15, and below 2.5e-15 of the number itself, next to the critical angle and for the weakest faces too
/// (found over 60 000 points: 7.5e-16 and 1.3e-15). Only within some ulp of the critical angle, where `g` is below 1e-7, the
/// error of `g²` weighs more: it adds `(4/c + 2c/s²)·2⁻⁷⁷c²/g`, which reaches 1e-15 at a `g` of some 1e-9.
#[inline(always)]
pub fn fresnel_dielectric<L: Lanes>(cos_theta_i: L, eta: L) -> L {
    let [rs, rp] = fresnel_polarized(cos_theta_i, eta);
    (rs + rp) * L::splat(0.5)
}

/// `[Rs, Rp]`: the same for light polarised perpendicular to the plane of incidence, and parallel to it.
#[inline(always)]
pub fn fresnel_polarized<L: Lanes>(cos_theta_i: L, eta: L) -> [L; 2] {
    let one = L::splat(1.0);
    let c = cosine(cos_theta_i);
    let g = g(c, eta);
    let d = (eta - one) * (eta + one);
    let d = d.max(-d);
    let amplitude = d / (d + L::splat(2.0) * (c.min(g) * (c + g)));
    // No face at all. For c = 0 the quotient would be 0/0.
    let amplitude = L::select(eta.eq(one), L::splat(0.0), amplitude);
    let rs = amplitude * amplitude;
    let (cg, ss) = (c * g, (one - c) * (one + c));
    let ratio = (cg - ss) / (cg + ss);
    [rs, rs * (ratio * ratio)]
}

/// Cosine of the angle of refraction, good to a few ulp up to the critical angle; 0 for total internal reflection.
#[inline(always)]
pub fn cos_theta_t<L: Lanes>(cos_theta_i: L, eta: L) -> L {
    g(cosine(cos_theta_i), eta) / eta
}

/// From which angle on, in radians, nothing is refracted; none into a denser medium.
pub fn critical_angle(eta: f64) -> Option<f64> {
    (eta <= 1.0).then(|| libm::asin(eta))
}

/// At which angle, in radians, light polarised parallel to the plane of incidence is not reflected (Brewster 1815).
pub fn brewster_angle(eta: f64) -> f64 {
    libm::atan(eta)
}

/// A cosine that a rounding moved out of its range, moved back. NaN stays.
#[inline(always)]
pub(super) fn cosine<L: Lanes>(c: L) -> L {
    L::splat(0.0).max(L::splat(1.0).min(c))
}

/// `eta·cos_theta_t`, 0 for total internal reflection.
#[inline(always)]
pub(super) fn g<L: Lanes>(c: L, eta: L) -> L {
    L::splat(0.0).max(g_squared(c, eta)).sqrt()
}

/// `eta² - 1 + c²`, good to a few ulp; next to the critical angle to 2⁻⁷⁶ of `c²`.
///
/// The two squares add up to nearly 1 there, and their roundings would be all that is left: an error of 1e-16 in `g²` is
/// one of 1e-8 in `g`, and in the reflectance. So with `m` the larger one of `c` and `eta` and `l` the smaller one,
/// `g² = (m - 1)(m + 1) + l²`. `m` is above ½ there, `m - 1` is exact, and both products have the size of what they cancel
/// to. Each factor is split into a head of 26 bits and the rest, so that products of heads are exact (Dekker 1971, as in
/// `lanes::pow`), and so is their sum, of numbers of opposite sign within a factor of two (Sterbenz). What follows is
/// below 2⁻²⁴ of them.
#[inline(always)]
fn g_squared<L: Lanes>(c: L, eta: L) -> L {
    let (one, two) = (L::splat(1.0), L::splat(2.0));
    let (m, l) = (eta.max(c), eta.min(c));
    let (below, above) = (m - one, m + one);
    let above_lost = m - (above - one);
    let (below_head, above_head, l_head) = (below.head(), above.head(), l.head());
    let (below_rest, above_rest, l_rest) = (below - below_head, above - above_head, l - l_head);
    let heads = below_head * above_head + l_head * l_head;
    let mixed = ((heads + below_head * above_rest) + below_rest * above_head) + two * (l_head * l_rest);
    mixed + ((below_rest * above_rest + l_rest * l_rest) + below * above_lost)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::ArrayLanes;
    use core::f64::consts::FRAC_PI_2;
    use dashu_float::FBig;
    use proptest::prelude::*;

    fn exact(x: f64) -> FBig {
        FBig::try_from(x).unwrap().with_precision(300).value()
    }

    /// `[R, T]` in 300 bits from the amplitudes, as in Born and Wolf, "Principles of Optics", section 1.5: `T` is not
    /// made from `R`. None for total internal reflection.
    fn true_reflectance(c: f64, eta: f64) -> Option<[FBig; 2]> {
        let (c, eta, one, two) = (exact(c), exact(eta), exact(1.0), exact(2.0));
        let radicand = &one - (&one - &c * &c) / (&eta * &eta);
        if radicand <= exact(0.0) {
            return None;
        }
        let ct = radicand.powf(&exact(0.5));
        let (s, p) = (&c + &eta * &ct, &eta * &c + &ct);
        let (rs, rp) = ((&c - &eta * &ct) / &s, (&eta * &c - &ct) / &p);
        let (ts, tp) = (&two * &c / &s, &two * &c / &p);
        let r = (&rs * &rs + &rp * &rp) / &two;
        let t = &eta * &ct / &c * (&ts * &ts + &tp * &tp) / &two;
        Some([r, t])
    }

    fn f64_of(x: &FBig) -> f64 {
        x.to_f64().value()
    }

    /// How far the reflectance is off: in all, and as a part of it.
    fn errors(c: f64, eta: f64) -> [f64; 2] {
        let found = fresnel_dielectric(c, eta);
        assert!((0.0..=1.0).contains(&found), "R({c:e}, {eta:e}) = {found:e}");
        let Some([r, t]) = true_reflectance(c, eta) else {
            assert_eq!(found, 1.0, "total reflection at {c:e}, {eta:e}");
            return [0.0; 2];
        };
        let sum = f64_of(&(&r + &t - exact(1.0)));
        // 300 bits, of which the critical angle costs half.
        assert!(sum.abs() < 1e-40, "R + T - 1 = {sum:e}");
        let off = (exact(found) - &r).to_f64().value().abs();
        [off, off / f64_of(&r)]
    }

    /// What the error of `g²`, 2⁻⁷⁶c², makes of `R ≈ 1 - 4g/c - 2cg/s²`, its value for small `g`: `δg = δg²/2g`.
    fn next_to_critical(c: f64, eta: f64) -> f64 {
        let (c_exact, eta_exact) = (exact(c), exact(eta));
        let g = f64_of(&(&eta_exact * &eta_exact - exact(1.0) + &c_exact * &c_exact)).max(0.0).sqrt();
        let slope = 4.0 / c + 2.0 * c / (1.0 - c * c);
        if 0.0 < g && g < 1e-7 { slope * libm::exp2(-77.0) * c * c / g } else { 0.0 }
    }

    fn check(c: f64, eta: f64) -> Result<(), TestCaseError> {
        let ([absolute, relative], more) = (errors(c, eta), next_to_critical(c, eta));
        // As documented.
        let fine = absolute < 1.5e-15 + more && relative < 2.5e-15 + more;
        prop_assert!(fine, "R({c:e}, {eta:e}): {absolute:e}, {relative:e}; {more:e} more allowed");
        Ok(())
    }

    /// A point that chance has found, with a `g` of 2e-9: its error is above 1.5e-15.
    #[test]
    fn next_to_the_critical_angle_the_error_of_g_counts() {
        let (c, eta) = (0.288_338_824_610_594_9, 0.957_528_444_602_133_3);
        assert!(check(c, eta).is_ok());
        assert!(errors(c, eta)[0] > 1.5e-15 && next_to_critical(c, eta) < 1e-14);
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(2000))]

        #[test]
        fn right_for_all_angles_and_indices(c in 1e-9..=1.0f64, eta in 0.2..5.0f64, steps in 1..1u64 << 40, shift in 0..40u32) {
            check(c, eta)?;
            check(c * c * c, eta)?;
            // Faces that are nearly none.
            for weak in [1f64.to_bits() - (steps >> shift).max(1), 1f64.to_bits() + (steps >> shift).max(1)] {
                check(c, f64::from_bits(weak))?;
            }
        }

        /// Up to the last bit before and after the critical angle.
        #[test]
        fn right_near_the_critical_angle(
            eta in prop_oneof![0.2..1.0f64, (1.0..53.0f64).prop_map(|bits| 1.0 - libm::exp2(-bits))],
            steps in -64..64i64,
            far in 0..1u64 << 40,
        ) {
            let c = ((1.0 - eta) * (1.0 + eta)).sqrt();
            check(f64::from_bits((c.to_bits() as i64 + steps) as u64), eta)?;
            check(f64::from_bits(c.to_bits() + far).min(1.0), eta)?;
            check(f64::from_bits(c.to_bits() - far), eta)?;
        }

        /// The same face from its other side: `R(θ_i, eta) = R(θ_t, 1/eta)`.
        #[test]
        fn both_sides_reflect_the_same(c in 1e-2..=1.0f64, eta in 1.1..4.0f64) {
            let back = fresnel_dielectric(cos_theta_t(c, eta), 1.0 / eta);
            // cos_theta_t and 1/eta are off by 2e-16 and 1e-16 of themselves, which makes up to 6e-16 in the g² of the way
            // back: (c/eta)² there. And 1 - R is at most 2 c (1 + eta²)/√(eta² - 1). Plus what both results are off.
            let bound = 2.0 * c * (1.0 + eta * eta) / (eta * eta - 1.0).sqrt() * 3e-16 * (eta / c) * (eta / c) + 3e-15;
            prop_assert!((back - fresnel_dielectric(c, eta)).abs() < bound);
        }

        #[test]
        fn every_lane_has_the_bits_of_the_plain_number(
            c in prop::array::uniform4(prop_oneof![0.0..=1.0f64, Just(0.0), Just(1.0)]),
            eta in prop::array::uniform4(prop_oneof![0.2..4.0f64, Just(1.0)]),
        ) {
            type Four = ArrayLanes<4>;
            let lanes = fresnel_dielectric(Four::from_fn(|i| c[i]), Four::from_fn(|i| eta[i]));
            for i in 0..4 {
                prop_assert_eq!(lanes.lane(i).to_bits(), fresnel_dielectric(c[i], eta[i]).to_bits());
            }
        }
    }

    #[test]
    fn bounds_are_exact() {
        for c in [0.0, 1e-300, 1e-9, 0.5, 1.0, 1.0 + f64::EPSILON, -1e-17] {
            assert_eq!(fresnel_dielectric(c, 1.0), 0.0, "no face");
        }
        for eta in [0.1, 0.7, 1.0 - f64::EPSILON, 1.0 + f64::EPSILON, 1.5, 4.0] {
            assert_eq!(fresnel_dielectric(0.0, eta), 1.0, "grazing");
        }
        // Glass to air at 60 degrees.
        assert_eq!(fresnel_dielectric(0.5, 1.0 / 1.5), 1.0);
        assert_eq!(cos_theta_t(0.5, 1.0 / 1.5), 0.0);
        assert!(fresnel_dielectric(f64::NAN, 1.5).is_nan(), "a NaN is not made a number");
    }

    #[test]
    fn straight_through_it_is_the_square_of_the_contrast() {
        for n in [1.333_f64, 1.5, 1.5168, 2.417, 4.0] {
            let contrast = (n - 1.0) / (n + 1.0);
            for eta in [n, 1.0 / n] {
                // A few roundings, and that of 1/n counts 2n/(n² - 1) times 2, below 7 for water.
                assert!((fresnel_dielectric(1.0, eta) / (contrast * contrast) - 1.0).abs() < 3e-15);
            }
        }
    }

    #[test]
    fn at_brewsters_angle_only_one_half_of_rs_is_left() {
        for eta in [1.333_f64, 1.5, 2.417, 1.0 / 1.5] {
            let angle = brewster_angle(eta);
            let [rs, rp] = fresnel_polarized(libm::cos(angle), eta);
            // Roundings of angle and cosine move rp's zero by 2e-16, and rp is the square of that times a small number.
            assert!(rp < 1e-30, "{rp:e}");
            assert_eq!(fresnel_dielectric(libm::cos(angle), eta), 0.5 * (rs + rp));
            let contrast = (eta * eta - 1.0) / (eta * eta + 1.0);
            assert!((rs - contrast * contrast).abs() < 1e-15);
            assert!((angle + brewster_angle(1.0 / eta) - FRAC_PI_2).abs() < 3e-16, "the refracted ray stands across");
        }
    }

    #[test]
    fn the_critical_angle_parts_some_from_all() {
        for eta in [1.0 / 1.333, 1.0 / 1.5, 1.0 / 2.417] {
            let angle = critical_angle(eta).unwrap();
            assert!(fresnel_dielectric(libm::cos(angle - 1e-15), eta) < 1.0);
            assert_eq!(fresnel_dielectric(libm::cos(angle + 1e-15), eta), 1.0);
        }
        // 41.81 degrees for glass, the well-known figure.
        assert!((critical_angle(1.0 / 1.5).unwrap().to_degrees() - 41.81).abs() < 0.005);
        assert_eq!(critical_angle(1.5), None);
        assert_eq!(critical_angle(1.0), Some(FRAC_PI_2));
    }
}
