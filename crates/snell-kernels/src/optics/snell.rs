//! Mirror and Snell's law, in the lecture's vector form.
//!
//! ```text
//!        wo   n         wo: where the ray came from
//!          \  |  wi     wi: where it goes on
//!           \ | /       all point away from the surface
//!   ─────────\|/─────────
//!             \
//!              wi (refracted)
//! ```

use crate::geometry::Vec3;
use crate::lanes::Lanes;

/// The mirror direction `2(N·wo)N − wo`.
#[inline(always)]
pub fn reflect<L: Lanes>(wo: Vec3<L>, n: Vec3<L>) -> Vec3<L> {
    n * (L::splat(2.0) * n.dot(wo)) - wo
}

/// The refracted direction, and whether there is one (none: total internal reflection).
///
/// `mu = eta_i / eta_t`, `n` on the side of `wo`. With `c = wo·n`:
/// `α = −μ`, `β = μc − √(1 − μ² + μ²c²)`, `T = α·wo + β·n`. In this very form `μ = 1` gives back `−wo` exactly,
/// because `√(c²) = c` in binary arithmetic.
#[inline(always)]
pub fn refract<L: Lanes>(wo: Vec3<L>, n: Vec3<L>, mu: L) -> (Vec3<L>, L::Mask) {
    let cos_theta_i = wo.dot(n);
    let mu2 = mu * mu;
    let radicand = L::splat(1.0) - mu2 + mu2 * (cos_theta_i * cos_theta_i);
    let beta = mu * cos_theta_i - radicand.sqrt();
    (wo * (-mu) + n * beta, radicand.ge(L::splat(0.0)))
}

/// The lecture's way through a glass sphere in one step: where a ray that enters at `p` with normal `n` leaves again, in
/// which direction, and whether it does.
///
/// `T1 = refract(wo, n)`, `exit = p + 2((C − p)·T1)·T1`, `T2 = refract(−T1, unit(C − exit))`.
/// `eta_outside`, `eta_inside` are the two indices.
#[inline(always)]
pub fn through_sphere<L: Lanes>(
    p: Vec3<L>,
    n: Vec3<L>,
    wo: Vec3<L>,
    center: Vec3<L>,
    eta_outside: L,
    eta_inside: L,
) -> (Vec3<L>, Vec3<L>, L::Mask) {
    let (inside, entered) = refract(wo, n, eta_outside / eta_inside);
    let exit = p + inside * (L::splat(2.0) * (center - p).dot(inside));
    let n_inside = (center - exit).unit();
    let (outside, left) = refract(-inside, n_inside, eta_inside / eta_outside);
    (exit, outside, entered & left)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lanes::elementary::sin_cos_degrees;
    use proptest::prelude::*;

    /// The direction towards where a ray came from that arrives at `degrees` from the normal (0, 0, 1).
    fn arriving(degrees: f64) -> Vec3 {
        let (sin, cos) = sin_cos_degrees(degrees);
        Vec3::new(-sin, 0.0, cos)
    }

    const UP: Vec3 = Vec3::new(0.0, 0.0, 1.0);

    proptest! {
        /// `eta_i sin θ_i = eta_t sin θ_t`, in the plane of incidence, of unit length, and the same way back.
        #[test]
        fn snells_law_both_ways(degrees in 0.0..89.9f64, mu in 0.4..1.0f64) {
            let wo = arriving(degrees);
            let (wi, ok) = refract(wo, UP, mu);
            prop_assert!(ok && wi.z < 0.0 && wi.y == 0.0);
            prop_assert!((wi.x - mu * -wo.x).abs() < 4e-16);
            prop_assert!((wi.length() - 1.0).abs() < 1e-15);
            let (back, ok) = refract(wi, -UP, 1.0 / mu);
            // Into the thinner medium errors grow with 1/cos θ_t, here at most 600.
            prop_assert!(!ok || (back - wo).length() < 1e-12);
        }

        #[test]
        fn equal_indices_change_nothing_at_all(degrees in 0.0..=90.0f64) {
            let wo = arriving(degrees);
            let (wi, ok) = refract(wo, UP, 1.0);
            prop_assert!(ok);
            prop_assert_eq!(wi, -wo);
        }

        /// The lecture's second derivation, with angles: `T = (μ cos θ_i − cos θ_t)N − μW`.
        #[test]
        fn the_form_with_angles_agrees(degrees in 0.0..80.0f64, mu in 0.3..1.0f64) {
            let wo = arriving(degrees);
            let cos_theta_i = wo.z;
            let sin_theta_t = mu * (1.0 - cos_theta_i * cos_theta_i).sqrt();
            let cos_theta_t = (1.0 - sin_theta_t * sin_theta_t).sqrt();
            let angles = UP * (mu * cos_theta_i - cos_theta_t) - wo * mu;
            let (wi, _) = refract(wo, UP, mu);
            // 1 − s² is off by a few ε, and its root cos θ_t by that over 2 cos θ_t; cos θ_t > 0.17 here.
            prop_assert!((wi - angles).length() < 4.0 * f64::EPSILON / 0.17);
        }
    }

    #[test]
    fn beyond_the_critical_angle_nothing_leaves() {
        // Glass 1.5 to air: 41.81 degrees.
        assert!(refract(arriving(41.8), UP, 1.5).1);
        assert!(!refract(arriving(41.9), UP, 1.5).1);
    }

    #[test]
    fn a_mirror_turns_the_tangential_part() {
        assert_eq!(reflect(Vec3::new(0.6, 0.0, 0.8), UP), Vec3::new(-0.6, 0.0, 0.8));
    }

    #[test]
    fn through_a_sphere_the_ray_stays_symmetric() {
        // A ray that enters at height h leaves at the same distance from the centre, deviated towards the axis twice.
        let center = Vec3::new(0.0, 0.0, 0.0);
        let p = Vec3::new(0.6, 0.0, 0.8);
        let (exit, dir, ok) = through_sphere(p, p, UP, center, 1.0, 1.5);
        assert!(ok && (exit.length() - 1.0).abs() < 1e-15);
        let impact = exit.cross(dir).length();
        assert!((impact - 0.6).abs() < 1e-15, "the impact parameter is kept: {impact}");
        // Total deviation 2(θ_i − θ_t) with sin θ_i = 0.6, sin θ_t = 0.4.
        let deviation = 2.0 * (libm::asin(0.6) - libm::asin(0.4));
        assert!((libm::acos(-dir.z) - deviation).abs() < 1e-15);
    }
}
