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

/// How far outside of its box a triangle may be hit, relative to its distance: sixteen roundings. A hit is a few of them off,
/// and the boxes of the tree have room for more than this.
const SLACK: f64 = 1.0 / (1u64 << 49) as f64;

/// Meets a ray with a triangle, from either side, edges included. `origin` and `vertices` are permuted as `shear` wants
/// it; the direction need not be of unit length.
///
/// Woop, Benthin and Wald (2013): the vertices are moved into the frame in which the ray is the z axis, and the signs of
/// three two-dimensional edge functions decide. `fl(a·b) − fl(c·d)` has the sign of the exact value or is zero (rounding is
/// monotonic), zero counts as inside, and both triangles of an edge see the same two vertices: a ray cannot slip
/// through a shared edge or vertex. A triangle without area is not hit.
///
/// Where a ray lies in the plane of a triangle to within rounding, the edge functions are noise, and may call a ray inside
/// that passes far from it. So a hit must also lie in the triangle's own box; then no tree of boxes can hide it.
#[inline(always)]
pub fn intersect<L: Lanes>(origin: Vec3<L>, shear: &Shear<L>, vertices: [Vec3<L>; 3]) -> TriangleHit<L> {
    let zero = L::splat(0.0);
    let [a, b, c] = vertices;
    let corners = [a - origin, b - origin, c - origin];
    let (a, b, c) = (shear.apply(corners[0]), shear.apply(corners[1]), shear.apply(corners[2]));
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
    // Where the ray is at `t`, seen from its origin.
    let along = t / shear.0.z;
    let at = Vec3::new(-(shear.0.x * along), -(shear.0.y * along), along);
    let meets = inside & !det.eq(zero) & in_box(at, corners);
    TriangleHit { t, beta: v / det, gamma: w / det, meets }
}

/// Does a point lie in the box of three others, all seen from the origin of a ray, but for [`SLACK`]?
#[inline(always)]
fn in_box<L: Lanes>(at: Vec3<L>, [a, b, c]: [Vec3<L>; 3]) -> L::Mask {
    let (low_x, high_x) = (a.x.min(b.x).min(c.x), a.x.max(b.x).max(c.x));
    let (low_y, high_y) = (a.y.min(b.y).min(c.y), a.y.max(b.y).max(c.y));
    let (low_z, high_z) = (a.z.min(b.z).min(c.z), a.z.max(b.z).max(c.z));
    let far = high_x.max(-low_x).max(high_y.max(-low_y)).max(high_z.max(-low_z));
    let slack = L::splat(SLACK) * far;
    (low_x - slack).le(at.x)
        & at.x.le(high_x + slack)
        & (low_y - slack).le(at.y)
        & at.y.le(high_y + slack)
        & (low_z - slack).le(at.z)
        & at.z.le(high_z + slack)
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
        // In the plane of the triangle but for the rounding of its direction, and eleven units beside it.
        let oblique = [v(6.0, -3.0, -6.0), v(9.0, 2.0, 3.0), v(5.0, -5.0, 2.0)];
        let beside = v(0.0, 0.030_289_126_640_769_135, -0.999_541_179_145_381_4);
        assert!(hit(v(20.0, 20.0, 47.0), beside, oblique).is_none());
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
