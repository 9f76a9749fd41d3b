//! Lights as the kernels see them.

use crate::color::Rgb;
use crate::geometry::Vec3;
use crate::lanes::Lanes;

/// A light.
#[derive(Clone, Copy, Debug)]
pub struct LightSource {
    /// Its position, or the direction towards it.
    pub at: Vec3,
    /// Does `at` hold a direction?
    pub at_infinity: bool,
    /// Its light, linear, 1 for white.
    pub color: Rgb,
    /// Where it shines, if not everywhere.
    pub spot: Option<Spot>,
}

/// Where a spot light shines.
#[derive(Clone, Copy, Debug)]
pub struct Spot {
    /// From the light to its target, of unit length.
    pub axis: Vec3,
    /// Cosine of the angle at which it ends.
    pub cos_end: f64,
    /// Cosine of the angle at which it begins to fade.
    pub cos_full: f64,
}

impl LightSource {
    /// The directions towards it from some points, and how far it is.
    #[inline(always)]
    pub fn seen_from<L: Lanes>(&self, point: Vec3<L>) -> (Vec3<L>, L) {
        if self.at_infinity {
            (self.at.splat(), L::splat(f64::INFINITY))
        } else {
            let to_light = self.at.splat() - point;
            (to_light.unit(), to_light.length())
        }
    }
}

impl Spot {
    /// The share of the light that goes against `wi`, which points towards it: 1 in the middle, 0 outside, and smooth between.
    #[inline(always)]
    pub fn falloff<L: Lanes>(&self, wi: Vec3<L>) -> L {
        let (zero, one) = (L::splat(0.0), L::splat(1.0));
        let cos = -self.axis.splat().dot(wi);
        let s = (cos - L::splat(self.cos_end)) / L::splat(self.cos_full - self.cos_end);
        let soft = s * s * (L::splat(3.0) - (s + s));
        let full = cos.gt(L::splat(self.cos_full)) | cos.eq(L::splat(self.cos_full));
        let dark = !cos.gt(L::splat(self.cos_end)) & !full;
        L::select(full, one, L::select(dark, zero, soft))
    }
}
