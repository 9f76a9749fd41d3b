//! Ray and triangle, watertight.

use super::Vec3;
use super::ray::Shear;
use crate::lanes::{Lanes, Mask};

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug)]
pub struct TriangleHit<L: Lanes> {
    /// Distance along the ray.
    pub t: L,
    /// Weight of the second vertex.
    pub beta: L,
    /// Weight of the third vertex; the first has `1 − beta − gamma`.
    pub gamma: L,
    /// Does the line of the ray meet the triangle, from either side, before or behind its origin?
    pub meets: L::Mask,
}

/// Meets a ray with a triangle, from either side, edges included. `origin` and `vertices` are permuted as `shear` wants
/// it; the direction need not be of unit length.
///
/// Woop, Benthin and Wald (2013): the vertices are moved into the frame in which the ray is the z axis, and the signs of
/// three two-dimensional edge functions decide. `fl(a·b) − fl(c·d)` has the sign of the exact value or is zero (rounding is
/// monotonic), zero counts as inside, and both triangles of an edge see the same two vertices: a ray cannot slip
/// through a shared edge or vertex. A triangle seen edge on, or without area, is not hit.
#[inline(always)]
pub fn intersect<L: Lanes>(origin: Vec3<L>, shear: &Shear<L>, vertices: [Vec3<L>; 3]) -> TriangleHit<L> {
    let zero = L::splat(0.0);
    let [a, b, c] = vertices;
    let (a, b, c) = (shear.apply(a - origin), shear.apply(b - origin), shear.apply(c - origin));
    let u = c.x * b.y - c.y * b.x;
    let v = a.x * c.y - a.y * c.x;
    let w = b.x * a.y - b.y * a.x;
    let front = u.ge(zero) & v.ge(zero) & w.ge(zero);
    let back = u.le(zero) & v.le(zero) & w.le(zero);
    let inside = front | back;
    if !inside.any() {
        return TriangleHit { t: zero, beta: zero, gamma: zero, meets: inside };
    }
    let det = u + v + w;
    let t = (u * a.z + v * b.z + w * c.z) / det;
    TriangleHit { t, beta: v / det, gamma: w / det, meets: inside & !det.eq(zero) }
}

/// Unit normal by the right-hand rule; not finite where the triangle has no area.
#[inline(always)]
pub fn normal<L: Lanes>([a, b, c]: [Vec3<L>; 3]) -> Vec3<L> {
    (b - a).cross(c - a).unit()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::ray::{axes, main_axis};
    use proptest::prelude::*;

    fn hit(origin: Vec3, dir: Vec3, vertices: [Vec3; 3]) -> Option<(f64, f64, f64)> {
        let k = axes(main_axis(dir));
        let h = intersect(origin.permuted(k), &Shear::new(dir.permuted(k)), vertices.map(|v| v.permuted(k)));
        (h.meets && h.t > 0.0).then_some((h.t, h.beta, h.gamma))
    }

    fn v(x: f64, y: f64, z: f64) -> Vec3 {
        Vec3::new(x, y, z)
    }

    #[test]
    fn known_answers() {
        let unit = [v(0.0, 0.0, 5.0), v(1.0, 0.0, 5.0), v(0.0, 1.0, 5.0)];
        let dir = v(0.0, 0.0, 1.0);
        assert_eq!(hit(v(0.25, 0.5, 0.0), dir, unit), Some((5.0, 0.25, 0.5)));
        assert_eq!(hit(v(0.25, 0.5, 9.0), -dir, unit), Some((4.0, 0.25, 0.5)), "the back side too");
        assert_eq!(hit(v(0.5, 0.5, 0.0), dir, unit), Some((5.0, 0.5, 0.5)), "the edge is inside");
        assert!(hit(v(0.6, 0.6, 0.0), dir, unit).is_none());
        assert!(hit(v(0.2, 0.2, 6.0), dir, unit).is_none(), "behind");
        let flat = [unit[0], unit[1], unit[1]];
        assert!(hit(v(0.5, 0.0, 0.0), dir, flat).is_none(), "no area, no hit");
        assert!(!normal(flat).is_finite());
        assert_eq!(normal(unit), dir);
    }

    proptest! {
        /// A fan of triangles around a vertex has no hole: rays aimed at its edges and its centre hit, far from the
        /// origin too, where a tolerance in scene units would fail.
        #[test]
        fn a_fan_never_leaks(
            offset in prop::array::uniform3(-1e6..1e6f64),
            eye in prop::array::uniform3(-1.0..1.0f64),
            corners in 3usize..9,
            along in 0.0..=1.0f64,
            edge in 0usize..9,
        ) {
            let offset = Vec3::from(offset);
            let center = offset + v(0.1, 0.2, 0.3);
            let rim: Vec<Vec3> = (0..corners)
                .map(|k| {
                    let (sin, cos) = crate::lanes::elementary::sin_cos_degrees(360.0 * k as f64 / corners as f64);
                    offset + v(2.0 * cos, 2.0 * sin, 0.4 * cos)
                })
                .collect();
            let origin = offset + Vec3::from(eye) + v(0.0, 0.0, 5.0);
            // At `along` near 1 the ray may pass outside the rim, which is no leak.
            let target = center + (rim[edge % corners] - center) * (along * 0.99);
            let dir = (target - origin).unit();
            let hits = (0..corners)
                .filter(|&k| hit(origin, dir, [center, rim[k], rim[(k + 1) % corners]]).is_some())
                .count();
            prop_assert!(hits >= 1);
        }
    }
}
