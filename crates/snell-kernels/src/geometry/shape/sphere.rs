//! Ray and sphere.

use super::{Departure, Numbers, Query, Shape, Surface};
use crate::geometry::ray::Ray;
use crate::geometry::{Bounds, Vec3};
use crate::lanes::{Lanes, Mask};
use core::f64::consts::{PI, TAU};

/// Beyond this ratio of (distance to the centre)² to radius² the textbook discriminant is given up: it has lost
/// 24 of its 53 bits there.
const FAR: f64 = (1u64 << 24) as f64;

/// How much larger than a sphere its box must be, relative to the radius, so that it holds every hit: the textbook
/// discriminant errs by a few units of `2⁻⁵³·FAR·r²`, directions of unit length to two roundings included, which moves the
/// surface by less than `2⁻²⁶·r`.
pub const MARGIN: f64 = 1.0 / FAR;

/// A sphere.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Sphere {
    /// Its middle.
    pub center: Vec3,
    /// Its radius; one of 0 is never hit.
    pub radius: f64,
}

impl Shape for Sphere {
    /// Centre, radius.
    const NUMBERS: usize = 4;
    const SHEARED: bool = false;
    const COMMON: bool = true;

    fn write(&self, put: impl FnMut(f64)) {
        let Vec3 { x, y, z } = self.center;
        [x, y, z, self.radius].into_iter().for_each(put);
    }

    fn read(number: impl Fn(usize) -> f64) -> Self {
        Self { center: Vec3::new(number(0), number(1), number(2)), radius: number(3) }
    }

    #[inline(always)]
    fn may_return(two_sided: bool) -> bool {
        two_sided
    }

    #[inline(always)]
    fn intersect<L: Lanes>(ray: &Ray<L>, shape: impl Numbers<L>, query: &Query<L>) -> (L, L::Mask) {
        let (center, radius) = (shape.vector([0, 1, 2]), shape.number(3));
        if query.two_sided {
            crossing(ray.origin, ray.heading.dir, center, radius, query.t_min, query.leaves)
        } else {
            intersect(ray.origin, ray.heading.dir, center, radius)
        }
    }

    fn crossings(ray: &Ray<f64>, shape: impl Numbers<f64>, mut found: impl FnMut(f64)) {
        let (center, radius) = (shape.vector([0, 1, 2]), shape.number(3));
        let before = f64::NEG_INFINITY;
        let (near, meets) = crossing::<f64>(ray.origin, ray.heading.dir, center, radius, before, false);
        let (far, _) = crossing::<f64>(ray.origin, ray.heading.dir, center, radius, near, false);
        if meets {
            found(near);
            found(far);
        }
    }
}

impl Surface for Sphere {
    /// With [`MARGIN`].
    fn bounds(&self) -> Bounds {
        let r = self.radius * (1.0 + MARGIN);
        let r = Vec3::new(r, r, r);
        Bounds { min: self.center - r, max: self.center + r }
    }

    fn is_flat(&self) -> bool {
        false
    }

    /// The near root is before the point that is nearest to the centre.
    fn enters(&self, origin: Vec3, dir: Vec3, t: f64) -> bool {
        t < (self.center - origin).dot(dir)
    }

    fn starts_at(&self, origin: Vec3, dir: Vec3, t: f64) -> bool {
        let v = (self.center - origin).dot(dir);
        !(v > 0.0 && t > v)
    }

    fn meets_at(&self, origin: Vec3, dir: Vec3, t: f64) -> Option<f64> {
        let middle = (self.center - origin).dot(dir);
        let before = if t < middle { f64::NEG_INFINITY } else { middle };
        let (t, meets) = crossing(origin, dir, self.center, self.radius, before, false);
        meets.then_some(t)
    }

    fn normal(&self, point: Vec3) -> Vec3 {
        (point - self.center).unit()
    }

    fn height(&self, origin: Vec3, dir: Vec3, t: f64) -> (Vec3, f64) {
        let at = origin + dir * t;
        (self.normal(at), self.normal(at).dot(origin - at))
    }

    fn rises(&self, origin: Vec3, up: Vec3) -> f64 {
        up.dot(self.center - origin) + self.radius
    }

    /// A sphere that it touches bends away: it is met by all that goes inward.
    fn is_met(&self, from: &Departure, t: f64) -> bool {
        t > 0.0 || (from.origin - self.center).dot(from.dir) < 0.0
    }

    fn uv(&self, point: Vec3) -> [f64; 2] {
        uv(point - self.center)
    }

    fn distance(&self, point: Vec3) -> f64 {
        ((point - self.center).length() - self.radius).abs()
    }

    /// An octahedron.
    fn tessellate(&self, put: &mut dyn FnMut([Vec3; 3])) {
        let Self { center, radius } = *self;
        let ring = [[1.0, 0.0], [0.0, 1.0], [-1.0, 0.0], [0.0, -1.0], [1.0, 0.0]];
        let at = |[x, z]: [f64; 2]| center + Vec3::new(x, 0.0, z) * radius;
        let poles = [1.0, -1.0].map(|y| center + Vec3::new(0.0, y * radius, 0.0));
        for pair in ring.windows(2) {
            for pole in poles {
                put([pole, at(pair[0]), at(pair[1])]);
            }
        }
    }
}

/// Distance to where a ray enters a sphere, and whether it meets it at all, on whichever side of its origin.
///
/// With `T = C − o`, `v = T·d`: a hit where `disc = r² − (T·T − v²) > 0`, at `t = v − √disc`; `dir` of unit length.
/// Only the near root counts: a ray that starts inside does not hit. This very form is the course's; on its spheres of
/// radius 1e10 another rounding is visible in 8 bits. For small, far spheres it loses all digits, and `T·T − v²`, the
/// squared distance of the centre from the ray, is computed as `|T − v·d|²` (Haines, Günther, Akenine-Möller,
/// *Precision Improvements for Ray/Sphere Intersection*, Ray Tracing Gems, 2019, chapter 7).
#[inline(always)]
pub fn intersect<L: Lanes>(origin: Vec3<L>, dir: Vec3<L>, center: Vec3<L>, radius: L) -> (L, L::Mask) {
    let to_center = center - origin;
    let v = to_center.dot(dir);
    let r2 = radius * radius;
    let distance2 = to_center.dot(to_center);
    let mut off2 = distance2 - v * v;
    let far = distance2.gt(L::splat(FAR) * r2);
    if far.any() {
        let off = to_center - dir * v;
        off2 = L::select(far, off.dot(off), off2);
    }
    let disc = r2 - off2;
    // Zero is a tangent, and no hit. A negative `disc` makes `t` NaN.
    (v - disc.sqrt(), disc.gt(L::splat(0.0)))
}

/// Distance to where a ray crosses a sphere for the first time beyond `t_min`, from outside or from inside, and whether it
/// does. A ray that `leaves` the sphere, because it starts on it, crosses it again only on the far side, if it goes inward.
///
/// `|T − v·d|²` for the squared distance from the centre, as above: what the course needs of the textbook's form is not needed
/// here. `dir` of unit length.
#[inline(always)]
pub fn crossing<L: Lanes>(
    origin: Vec3<L>,
    dir: Vec3<L>,
    center: Vec3<L>,
    radius: L,
    t_min: L,
    leaves: L::Mask,
) -> (L, L::Mask) {
    let zero = L::splat(0.0);
    let to_center = center - origin;
    let v = to_center.dot(dir);
    let off = to_center - dir * v;
    let disc = radius * radius - off.dot(off);
    let half = disc.sqrt();
    let (near, far) = (v - half, v + half);
    let from_within = leaves | near.le(t_min);
    let t = L::select(from_within, far, near);
    (t, disc.gt(zero) & t.gt(t_min) & (!leaves | v.gt(zero)))
}

/// Where on a map of the world the point of a sphere lies that is in this direction from its centre; `y` points north.
///
/// `u` is the longitude as a part of a turn, 0 ≤ `u` < 1, eastward: seen from outside with north up, it grows to the right, so
/// that the map is not mirrored. The map's centre (`u` = ½) looks to +z, its seam (`u` = 0) to −z; +x is at `u` = ¾. `v` is
/// the latitude, from the south pole (0) over the equator (½) to the north pole (1).
///
/// The direction may have any length. At the poles `u` is ½; the zero vector is at (½, ½). The error is a few units in the
/// last place of 1, at the poles too.
pub fn uv(direction: Vec3) -> [f64; 2] {
    let Vec3 { x, y, z } = direction;
    if x == 0.0 && z == 0.0 {
        return [
            0.5,
            if y > 0.0 {
                1.0
            } else if y < 0.0 {
                0.0
            } else {
                0.5
            },
        ];
    }
    let turn = 0.5 + libm::atan2(x, z) / TAU;
    // Halved where a sum of squares could be too large. An arc tangent keeps the digits that an arc sine loses near the poles.
    let scale = if x.abs().max(z.abs()) > 1.0 { 0.5 } else { 1.0 };
    let from_south = libm::atan2(libm::hypot(scale * x, scale * z), -scale * y);
    [if turn >= 1.0 { 0.0 } else { turn }, from_south / PI]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn both_sides_are_crossed() {
        let (center, x) = (Vec3::default(), Vec3::new(1.0, 0.0, 0.0));
        let at = |x: f64| Vec3::new(x, 0.0, 0.0);
        let hit = |from: f64, dir: Vec3, t_min: f64, leaves: bool| {
            let (t, meets) = crossing::<f64>(at(from), dir, center, 2.0, t_min, leaves);
            meets.then_some(t)
        };
        assert_eq!(hit(-5.0, x, 0.0, false), Some(3.0), "into it");
        assert_eq!(hit(0.5, x, 0.0, false), Some(1.5), "out of it");
        assert_eq!(hit(-5.0, x, 3.0, false), Some(7.0), "out of it, after it has been entered");
        assert_eq!(hit(5.0, x, 0.0, false), None, "behind");
        assert_eq!(hit(-2.0, x, 0.0, true), Some(4.0), "through it");
        assert_eq!(hit(2.0, x, 0.0, true), None, "away from it");
    }

    fn hit(origin: [f64; 3], dir: [f64; 3], center: [f64; 3], radius: f64) -> Option<f64> {
        let (t, meets) = intersect::<f64>(origin.into(), Vec3::from(dir).unit(), center.into(), radius);
        (meets && t > 1e-5).then_some(t)
    }

    #[test]
    fn near_root_only() {
        assert_eq!(hit([0.0; 3], [0.0, 0.0, 1.0], [0.0, 0.0, 10.0], 2.0), Some(8.0));
        assert_eq!(hit([0.0, 0.0, 10.0], [0.0, 0.0, 1.0], [0.0, 0.0, 10.0], 2.0), None, "from inside");
        assert_eq!(hit([0.0, 0.0, 20.0], [0.0, 0.0, 1.0], [0.0, 0.0, 10.0], 2.0), None, "behind");
        assert_eq!(hit([2.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, 0.0, 10.0], 2.0), None, "tangent");
        assert_eq!(hit([0.0; 3], [0.0, 0.0, 1.0], [0.0, 0.0, 10.0], 0.0), None, "radius 0 is invisible");
    }

    #[test]
    fn a_tiny_far_sphere_is_not_noise() {
        // Radius 1e-6 at distance 1e6: the textbook discriminant has lost all digits here (error about 1e-4).
        let center = [0.0, 0.0, 1e6];
        assert!(hit([0.5e-6, 0.0, 0.0], [0.0, 0.0, 1.0], center, 1e-6).is_some());
        assert!(hit([1.5e-6, 0.0, 0.0], [0.0, 0.0, 1.0], center, 1e-6).is_none());
    }
}
