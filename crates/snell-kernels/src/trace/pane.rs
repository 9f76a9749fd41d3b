//! Thin faces: one face is a whole pane (see [`thin`](crate::optics::thin)).

use crate::color::Rgb;
use crate::geometry::Vec3;
use crate::lanes::Lanes;
use crate::optics::absorption::transmittance_rgb;
use crate::optics::fresnel::fresnel_dielectric;
use crate::optics::thin::{origin_behind, slab, slanted_pass};

/// What a pane is.
#[derive(Clone, Copy, Debug)]
pub struct Pane<L: Lanes> {
    /// In scene units.
    pub thickness: L,
    /// Index relative to what is on both sides.
    pub eta: L,
    /// Absorption per scene unit.
    pub sigma_a: Rgb<L>,
}

/// What a pane does with light that meets it.
#[derive(Clone, Copy, Debug)]
pub struct Passage<L: Lanes> {
    /// The share that it reflects.
    pub reflectance: Rgb<L>,
    /// The share that goes through.
    pub transmittance: Rgb<L>,
}

impl<L: Lanes> Pane<L> {
    /// What goes back and what goes through, where a ray meets the pane at this cosine.
    #[inline(always)]
    pub fn passage(&self, cos_theta_i: L) -> Passage<L> {
        let r = fresnel_dielectric(cos_theta_i, self.eta);
        let length = slanted_pass(self.thickness, cos_theta_i, self.eta);
        // Beyond the critical angle nothing goes through, and nothing to absorb.
        let length = L::select(r.lt(L::splat(1.0)), length, L::splat(0.0));
        let tau = transmittance_rgb(self.sigma_a, length);
        let ([r_red, t_red], [r_green, t_green], [r_blue, t_blue]) = (slab(r, tau.r), slab(r, tau.g), slab(r, tau.b));
        Passage { reflectance: Rgb::new(r_red, r_green, r_blue), transmittance: Rgb::new(t_red, t_green, t_blue) }
    }

    /// From where a ray goes on that came from `wo` and met the pane at `point`. `normal` is on the side of `wo`.
    #[inline(always)]
    pub fn behind(&self, point: Vec3<L>, normal: Vec3<L>, wo: Vec3<L>) -> Vec3<L> {
        origin_behind(point, normal, wo, self.thickness, self.eta)
    }
}
