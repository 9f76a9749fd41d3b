//! Lights as the kernels see them.

use crate::color::Rgb;
use crate::geometry::Vec3;
use crate::lanes::Lanes;
use crate::lanes::elementary::sin_cos_degrees;
use crate::scene::Light;

/// A light.
#[derive(Clone, Copy, Debug)]
pub(crate) struct LightSource {
    /// Its position, or the direction towards it.
    pub at: Vec3,
    /// Does `at` hold a direction?
    pub at_infinity: bool,
    pub color: Rgb,
    pub spot: Option<Spot>,
}

/// Where a spot light shines.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Spot {
    /// From the light to its target, of unit length.
    axis: Vec3,
    /// Cosines of the angles at which it ends, and at which it begins to fade.
    cos_end: f64,
    cos_full: f64,
}

impl LightSource {
    /// Of a light that has been validated.
    pub fn new(light: &Light) -> Self {
        let at_infinity = light.direction.is_some();
        let at: Vec3 = light.direction.or(light.position).unwrap_or_default().into();
        let spot = light.target.zip(light.cone).map(|(target, cone)| Spot {
            axis: (Vec3::from(target) - at).unit(),
            cos_end: sin_cos_degrees(cone).1,
            cos_full: sin_cos_degrees(cone - light.edge.unwrap_or(0.0)).1,
        });
        Self { at: if at_infinity { at.unit() } else { at }, at_infinity, color: light.color, spot }
    }
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spot_light_fades_at_its_edge_only() {
        let light = |edge: Option<f64>| Light {
            name: None,
            position: Some([0.0, 3.0, 0.0]),
            direction: None,
            target: Some([0.0; 3]),
            cone: Some(60.0),
            edge,
            color: Rgb::gray(1.0),
        };
        let share = |edge: Option<f64>, degrees: f64| {
            let (sin, cos) = sin_cos_degrees(degrees);
            LightSource::new(&light(edge)).spot.map(|spot| spot.falloff::<f64>(Vec3::new(sin, cos, 0.0)))
        };
        assert_eq!(share(None, 59.9), Some(1.0));
        assert_eq!(share(None, 60.1), Some(0.0));
        assert_eq!(share(Some(30.0), 29.9), Some(1.0));
        assert_eq!(share(Some(30.0), 60.1), Some(0.0));
        assert_eq!(share(Some(60.0), 0.0), Some(1.0));
        // cos is halfway between those of 30 and 60 degrees: smoothstep gives a half.
        let half = libm::acos(f64::midpoint(sin_cos_degrees(30.0).1, 0.5)).to_degrees();
        assert!(share(Some(30.0), half).is_some_and(|s| (s - 0.5).abs() < 1e-14));
    }
}
