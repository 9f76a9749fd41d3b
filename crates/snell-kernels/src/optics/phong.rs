//! Phong's local colour (Phong 1975), as the lecture writes it.

use crate::color::Rgb;
use crate::geometry::Vec3;
use crate::lanes::{Lanes, Mask, pow};
use crate::optics::snell::reflect;

/// What one light adds to a surface that it reaches: `kd·I·(N·L)`, then, if `C·R > 0`, `ks·I·(C·R)^spow`.
///
/// `C` points towards the ray's origin (`wo`), `R` is the mirror image of the light's direction `wi`. Only for lanes in
/// `lit`, which must have `N·L > 0`. Returned as two terms so that they are added to the surface one after the other.
#[inline(always)]
pub fn light<L: Lanes>(
    lit: L::Mask,
    n: Vec3<L>,
    wo: Vec3<L>,
    wi: Vec3<L>,
    intensity: Rgb<L>,
    surface: &Surface<L>,
) -> [Rgb<L>; 2] {
    let none = Rgb::black();
    let diffuse = surface.kd * intensity * n.dot(wi);
    let cos_alpha = wo.dot(reflect(wi, n));
    let shines = lit & cos_alpha.gt(L::splat(0.0));
    let power = if shines.any() { pow(cos_alpha, surface.spow) } else { L::splat(0.0) };
    let highlight = surface.ks * intensity * power;
    [Rgb::select(lit, diffuse, none), Rgb::select(shines, highlight, none)]
}

/// Coefficients of the local colour.
#[derive(Clone, Copy, Debug)]
pub struct Surface<L: Lanes> {
    /// Diffuse reflectance.
    pub kd: Rgb<L>,
    /// Colour of the highlight.
    pub ks: Rgb<L>,
    /// Exponent of the highlight.
    pub spow: L,
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn straight_down_gives_both_terms_in_full() {
        let up = Vec3::new(0.0, 0.0, 1.0);
        let surface = Surface { kd: Rgb::new(0.5, 0.0, 0.0), ks: Rgb::new(0.0, 0.25, 0.0), spow: 32.0 };
        let white = Rgb::new(1.0, 1.0, 1.0);
        let [diffuse, highlight] = light(true, up, up, up, white, &surface);
        assert_eq!((diffuse, highlight), (surface.kd, surface.ks));
        let grazing = Vec3::new(0.8, 0.0, 0.6);
        let [diffuse, highlight] = light(true, up, up, grazing, white, &surface);
        assert_eq!(diffuse.r, 0.5 * 0.6);
        // cos α = 0.6 (the mirror image of the light against the view), to the power 32.
        assert!((highlight.g / (0.25 * 7.958_661_109_946_4e-8) - 1.0).abs() < 1e-13);
        let away = Vec3::new(0.8, 0.0, -0.6);
        assert_eq!(light(true, up, away, grazing, white, &surface)[1], Rgb::black(), "no highlight from behind");
    }
}
