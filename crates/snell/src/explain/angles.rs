//! Angles at a surface.

use crate::geometry::Vec3;
use crate::trace::Hit;

/// Angles between a ray and the normal.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Angles {
    /// Before the surface.
    pub before: f64,
    /// Behind it, where anything goes through.
    pub behind: Option<f64>,
    /// Is everything reflected?
    pub total_reflection: bool,
}

/// The angles at a hit, by Snell's law for the indices there.
pub(super) fn angles(dir: Vec3, hit: &Hit) -> Angles {
    let cos = (-dir.dot(hit.normal)).clamp(0.0, 1.0);
    let [before, behind] = hit.eta;
    let sin = ((1.0 - cos) * (1.0 + cos)).sqrt() * before / behind;
    // Where both are the same nothing is behind, or nothing is bent.
    let goes_through = before.to_bits() != behind.to_bits();
    let degrees = |radians: f64| radians * (180.0 / std::f64::consts::PI);
    Angles {
        before: degrees(libm::acos(cos)),
        behind: (goes_through && sin <= 1.0).then(|| degrees(libm::asin(sin))),
        total_reflection: goes_through && sin > 1.0,
    }
}
