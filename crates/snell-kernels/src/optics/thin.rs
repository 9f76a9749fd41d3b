//! The thin face: one face that stands for a whole pane, with both of its sides and what goes to and fro between them.
//!
//! ```text
//!      wo      n
//!        `.    |        A ray that meets the face at p leaves it parallel to itself, a little aside,
//!   ───q───`.──p─────   as if it had gone through a pane of that thickness. The other side of the pane
//!       `.     |        is not in the scene: the ray goes on from q, in the plane of the face, on the
//!         `.   |        line on which it would leave the pane.
//!   ........`. |.....
//!             `.
//! ```
//!
//! `eta = eta_t / eta_i` is the index of the pane relative to what is on both sides of it; `c` is `cos_theta_i`, `g` is
//! `eta·cos_theta_t`, `D` is `eta² - 1 = g² - c²` (see [`fresnel`](super::fresnel), which also says their ranges).

use super::fresnel::{cos_theta_t, cosine, g};
use crate::geometry::Vec3;
use crate::lanes::Lanes;

/// How far aside, across its own direction, a ray leaves a pane, in the units of `thickness`:
/// `thickness·sin θ·(1 - cos θ/√(eta² - sin² θ))`, which is `thickness·sin(θ - θ_t)/cos θ_t`. Negative for a gap in a denser
/// medium, where it goes to the other side.
///
/// Written as `sin θ·D/(g (g + c))`, without a difference: good to a few ulp for the weakest panes too. Only where there
/// is a refracted ray.
#[inline(always)]
pub fn lateral_displacement<L: Lanes>(thickness: L, cos_theta_i: L, eta: L) -> L {
    let one = L::splat(1.0);
    let c = cosine(cos_theta_i);
    let g = g(c, eta);
    let sin_theta_i = ((one - c) * (one + c)).sqrt();
    thickness * (sin_theta_i * ((eta - one) * (eta + one)) / (g * (g + c)))
}

/// From where in the plane of the face the ray goes on, in its old direction: `p + thickness·(d_t/cos θ_t - d/cos θ)`, where
/// `d` and `d_t` are the ray's directions outside and inside of the pane.
///
/// `n` is on the side of `wo`, both of unit length. What `d` and `d_t` have across the face cancels, and along it is left
/// `thickness·(d + n cos θ)·(1/g - 1/c)`, where `1/g - 1/c = -D/(c g (c + g))`: for `eta` 1 this is `p` to the bit. Only
/// where there is a refracted ray: at grazing incidence and beyond the critical angle nothing goes through.
#[inline(always)]
pub fn origin_behind<L: Lanes>(p: Vec3<L>, n: Vec3<L>, wo: Vec3<L>, thickness: L, eta: L) -> Vec3<L> {
    let one = L::splat(1.0);
    let cos_theta_i = wo.dot(n);
    let c = cosine(cos_theta_i);
    let g = g(c, eta);
    let back = thickness * (((eta - one) * (eta + one)) / (c * g * (c + g)));
    p + (wo - n * cos_theta_i) * back
}

/// Path length through the pane once, in the units of `thickness`: what absorption needs. Infinite where there is no
/// refracted ray.
#[inline(always)]
pub fn slanted_pass<L: Lanes>(thickness: L, cos_theta_i: L, eta: L) -> L {
    thickness / cos_theta_t(cos_theta_i, eta)
}

/// `[R, T]`: the parts of the light that a pane sends back and lets through, with all reflections inside of it added up.
///
/// `r` is the reflectance of one face ([`fresnel_dielectric`](super::fresnel::fresnel_dielectric)), `tau` what one slanted
/// pass leaves, both from 0 to 1. Panes are thick against the wavelength, so powers add up, not amplitudes (no interference):
///
/// ```text
/// T = (1-r)² τ (1 + r²τ² + r⁴τ⁴ + ...) = (1-r)² τ / (1 - r²τ²)        R = r + (1-r)² r τ² (1 + ...) = r (1 + τ T)
/// ```
///
/// Both from 0 to 1, with errors of a few 1e-16; `R + T` is 1 for `tau` 1. `[1, 0]` for `r` 1, whatever `tau` is.
#[inline(always)]
pub fn slab<L: Lanes>(r: L, tau: L) -> [L; 2] {
    let one = L::splat(1.0);
    let entering = one - r;
    // 1 - rτ, of terms that are not negative: where it is small, its digits are those of 1 - r and 1 - τ.
    let kept = entering + r * (one - tau);
    let t = entering * (entering / kept) * (tau / (one + r * tau));
    let t = L::select(entering.eq(L::splat(0.0)), L::splat(0.0), t);
    [one.min(r * (one + tau * t)), t]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::ArrayLanes;
    use crate::optics::fresnel::fresnel_dielectric;
    use crate::optics::snell::refract;
    use proptest::prelude::*;

    const UP: Vec3 = Vec3::new(0.0, 0.0, 1.0);

    proptest! {
        /// Against `t·sin(θ - θ_t)/cos θ_t`, from angles.
        #[test]
        fn the_displacement_is_that_of_the_angles(theta in 0.0..1.5f64, eta in 1.01..3.0f64, thickness in 0.1..10.0f64) {
            let theta_t = libm::asin(libm::sin(theta) / eta);
            let expected = thickness * libm::sin(theta - theta_t) / libm::cos(theta_t);
            let found = lateral_displacement(thickness, libm::cos(theta), eta);
            // Both angles are good to 2e-16 times tan θ_t, below 7 here, and cos θ gives sin θ back to 2e-16/sin θ.
            let bound = thickness * (16.0 * 4e-16 / libm::cos(theta_t) + 4e-16 / theta.max(1e-8));
            prop_assert!((found - expected).abs() < bound, "{found} for {expected}");
        }

        /// Traced through both faces of a pane, a ray leaves on the line that starts at the new origin.
        #[test]
        fn the_ray_leaves_on_the_line_of_a_real_pane(
            slope in 0.0..0.998f64,
            phi in 0.0..6.3f64,
            eta in 0.3..3.0f64,
            thickness in 0.1..10.0f64,
        ) {
            // Both cosines above 0.06: away from the critical angle, where `refract` is good to 1e-15/cos θ_t.
            let s = slope * eta.min(1.0);
            let c = (1.0 - s * s).sqrt();
            let wo = Vec3::new(s * libm::cos(phi), s * libm::sin(phi), c);
            let p = Vec3::new(1.0, 2.0, 3.0);
            let (inside, enters) = refract(wo, UP, 1.0 / eta);
            prop_assert!(enters);
            let exit = p + inside * (thickness / -inside.z);
            let q = origin_behind(p, UP, wo, thickness, eta);
            prop_assert_eq!(q.z, p.z);
            let off = (exit - q).cross(wo).length();
            // Lengths up to thickness/0.06², each with a few 1e-16 and 1e-15/0.06 of its direction.
            prop_assert!(off < thickness / (0.06 * 0.06) * 2e-14 + 1e-14, "{off:e} off the line");
            let aside = (q - p).cross(wo).length();
            let displacement = lateral_displacement(thickness, wo.dot(UP), eta);
            // sin θ comes from wo here and from cos θ there, 4e-16/sin θ apart.
            prop_assert!((aside - displacement.abs()).abs() < 1e-12 * (1.0 + thickness / s.max(1e-3)));
            prop_assert!(((q - p).dot(wo) >= 0.0) == (eta >= 1.0) || aside < 1e-15);
        }

        /// The series, added up one reflection at a time.
        #[test]
        fn a_slab_adds_up_its_inner_reflections(r in 0.0..0.98f64, tau in 0.0..=1.0f64) {
            let (mut reflected, mut transmitted, mut inside) = (r, 0.0, 1.0 - r);
            while inside > 1e-18 {
                inside *= tau;
                transmitted += inside * (1.0 - r);
                inside *= r * tau;
                reflected += inside * (1.0 - r);
                inside *= r;
            }
            let [slab_r, slab_t] = slab(r, tau);
            // 0.98^2n = 1e-18 after some 1000 rounds, each with a rounding of at most 1e-16 of a sum below 1.
            prop_assert!((slab_r - reflected).abs() < 1e-13 && (slab_t - transmitted).abs() < 1e-13);
        }

        #[test]
        fn a_clear_slab_loses_nothing_and_no_slab_gains(r in 0.0..=1.0f64, bits in 1.0..53.0f64, tau in 0.0..=1.0f64) {
            let near_one = 1.0 - libm::exp2(-bits);
            for r in [r, near_one, 1.0 - near_one] {
                let [reflected, transmitted] = slab(r, 1.0);
                // Roundings of numbers up to 1, two in the sum and a few in T, which is small where R is not.
                prop_assert!((reflected + transmitted - 1.0).abs() < 5e-16);
                prop_assert!((reflected - 2.0 * r / (1.0 + r)).abs() < 5e-16);
                for tau in [tau, near_one] {
                    let [reflected, transmitted] = slab(r, tau);
                    prop_assert!((0.0..=1.0).contains(&reflected) && (0.0..=1.0).contains(&transmitted));
                    prop_assert!(reflected + transmitted <= 1.0 + 5e-16 && reflected >= r);
                }
            }
        }

        #[test]
        fn every_lane_has_the_bits_of_the_plain_number(
            r in prop::array::uniform4(prop_oneof![0.0..=1.0f64, Just(1.0)]),
            tau in prop::array::uniform4(prop_oneof![0.0..=1.0f64, Just(1.0)]),
        ) {
            type Four = ArrayLanes<4>;
            let lanes = slab(Four::from_fn(|i| r[i]), Four::from_fn(|i| tau[i]));
            for i in 0..4 {
                prop_assert_eq!(lanes.map(|x| x.lane(i)), slab(r[i], tau[i]));
            }
        }
    }

    #[test]
    fn limits_are_exact() {
        for tau in [0.0, 0.5, 1.0] {
            assert_eq!(slab(1.0, tau), [1.0, 0.0], "nothing enters");
            assert_eq!(slab(0.0, tau), [0.0, tau], "no faces");
        }
        assert_eq!(slab(0.25, 0.0), [0.25, 0.0], "black inside");
        let r = fresnel_dielectric(0.5, 1.0 / 1.5);
        assert_eq!(slab(r, 0.0), [1.0, 0.0], "total reflection");
        assert_eq!(slanted_pass(2.0, 0.5, 1.0 / 1.5), f64::INFINITY);
        assert_eq!(slanted_pass(2.0, 1.0, 1.5), 2.0);
    }

    #[test]
    fn an_index_of_one_changes_nothing_at_all() {
        let p = Vec3::new(0.1, 0.2, 0.3);
        for c in [1.0, 0.6, 1e-9] {
            let wo = Vec3::new((1.0f64 - c * c).sqrt(), 0.0, c);
            assert_eq!(origin_behind(p, UP, wo, 5.0, 1.0), p);
            assert_eq!(lateral_displacement(5.0, c, 1.0), 0.0);
        }
        assert_eq!(origin_behind(p, UP, UP, 5.0, 1.5), p, "straight through");
    }

    #[test]
    fn a_pane_of_window_glass_at_45_degrees() {
        // 10 mm of 1.5 at 45 degrees: 10·sin 45°·(1 - cos 45°/√(2.25 - 0.5)).
        let displacement = lateral_displacement(10.0, 0.5f64.sqrt(), 1.5);
        assert!((displacement - 10.0 * (0.5f64.sqrt() - 0.5 / 1.75f64.sqrt())).abs() < 1e-14);
    }
}
