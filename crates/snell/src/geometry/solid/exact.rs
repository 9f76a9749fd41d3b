//! Exact answers about points and triangles (Shewchuk 1997, by the crate `robust`).
//!
//! The signs are those of the exact numbers, whatever the rounding, as long as products of three coordinates neither
//! overflow nor underflow: [`scaled`] sees to it, but for coordinates that are 2⁻³⁰⁰ of the largest.

use crate::geometry::Vec3;
use robust::{Coord, Coord3D, orient2d, orient3d};

/// The points by the power of two that brings the largest coordinate near 1: exact, except for what is tiny beside it.
pub(super) fn scaled(points: &[Vec3]) -> Vec<Vec3> {
    let largest = points.iter().filter(|p| p.is_finite()).flat_map(|p| [p.x, p.y, p.z]);
    let (_, exponent) = libm::frexp(largest.map(f64::abs).fold(0.0, f64::max));
    let by = |v: f64| libm::ldexp(v, -exponent);
    points.iter().map(|p| Vec3::new(by(p.x), by(p.y), by(p.z))).collect()
}

pub(super) fn sign(value: f64) -> i32 {
    i32::from(value > 0.0) - i32::from(value < 0.0)
}

/// 1 where the normal of the triangle points away from `p`, −1 where it points to the side of `p`, 0 in its plane.
pub(super) fn side([a, b, c]: [Vec3; 3], p: Vec3) -> i32 {
    let at = |v: Vec3| Coord3D { x: v.x, y: v.y, z: v.z };
    sign(orient3d(at(a), at(b), at(c), at(p)))
}

/// 1 where the way a, b, c turns left seen along an axis from its positive end, −1 right, 0 straight.
pub(super) fn turn(axis: usize, a: Vec3, b: Vec3, c: Vec3) -> i32 {
    let at = |v: Vec3| Coord { x: v.component((axis + 1) % 3), y: v.component((axis + 2) % 3) };
    sign(orient2d(at(a), at(b), at(c)))
}

/// An axis along which the triangle is seen with area; `None` if its corners lie on a line.
pub(super) fn broadside([a, b, c]: [Vec3; 3]) -> Option<usize> {
    // Along the longest component of the rounded normal it is nearly always seen.
    let normal = (b - a).cross(c - a);
    let mut axes = [0, 1, 2];
    axes.sort_by(|&i, &j| normal.component(j).abs().total_cmp(&normal.component(i).abs()));
    axes.into_iter().find(|&axis| turn(axis, a, b, c) != 0)
}

/// Do two triangles with area have a point in common?
pub(super) fn triangles_meet(s: [Vec3; 3], t: [Vec3; 3]) -> bool {
    let apart = |s: [Vec3; 3], t: [Vec3; 3]| {
        let sides = t.map(|p| side(s, p));
        sides == [1; 3] || sides == [-1; 3]
    };
    // Where they meet, an edge of one meets the other.
    let edge_meets = |s: [Vec3; 3], t| (0..3).any(|i| segment_meets(s[i], s[(i + 1) % 3], t));
    !apart(s, t) && !apart(t, s) && (edge_meets(s, t) || edge_meets(t, s))
}

/// Do a segment and a triangle with area have a point in common?
pub(super) fn segment_meets(p: Vec3, q: Vec3, t: [Vec3; 3]) -> bool {
    let [a, b, c] = t;
    match (side(t, p), side(t, q)) {
        (0, 0) => segment_meets_in_plane(p, q, t),
        (0, _) => inside_in_plane(p, t),
        (_, 0) => inside_in_plane(q, t),
        (above, below) if above == below => false,
        _ => {
            // From p to q: on which side of the line is each edge passed?
            let passed = [side([p, q, a], b), side([p, q, b], c), side([p, q, c], a)];
            passed.iter().all(|&s| s >= 0) || passed.iter().all(|&s| s <= 0)
        }
    }
}

/// Does a point of the plane lie in the triangle, edges included?
fn inside_in_plane(p: Vec3, t: [Vec3; 3]) -> bool {
    let Some(axis) = broadside(t) else { return false };
    let turns = [turn(axis, t[0], t[1], p), turn(axis, t[1], t[2], p), turn(axis, t[2], t[0], p)];
    turns.iter().all(|&s| s >= 0) || turns.iter().all(|&s| s <= 0)
}

fn segment_meets_in_plane(p: Vec3, q: Vec3, t: [Vec3; 3]) -> bool {
    let Some(axis) = broadside(t) else { return false };
    inside_in_plane(p, t) || inside_in_plane(q, t) || (0..3).any(|i| segments_cross(axis, p, q, t[i], t[(i + 1) % 3]))
}

/// Do two segments of one plane cross? Those that lie on one line do not: then an end of one lies in the other, or the
/// triangle of which the second is an edge is met at another place.
fn segments_cross(axis: usize, p: Vec3, q: Vec3, a: Vec3, b: Vec3) -> bool {
    let (pa, pb) = (turn(axis, p, q, a), turn(axis, p, q, b));
    let (ap, aq) = (turn(axis, a, b, p), turn(axis, a, b, q));
    pa * pb <= 0 && ap * aq <= 0 && (pa, pb) != (0, 0)
}

/// Do two triangles of one plane that share the edge a-b lie on the same side of it?
pub(super) fn folded(a: Vec3, b: Vec3, c: Vec3, d: Vec3) -> bool {
    broadside([a, b, c]).is_some_and(|axis| turn(axis, a, b, c) == turn(axis, a, b, d)) && side([a, b, c], d) == 0
}

/// Are two triangles with area certainly apart, seen along an axis along which the first has area? Asked first, because in
/// one plane or near it, as in the triangles of a polygon, the exact answer takes twenty times as long.
pub(super) fn plainly_apart(s: [Vec3; 3], t: [Vec3; 3]) -> bool {
    let Some(axis) = broadside(s) else { return false };
    let parts = |s: [Vec3; 3], t: [Vec3; 3]| (0..3).any(|i| beyond(axis, s[i], s[(i + 1) % 3], s[(i + 2) % 3], &t));
    parts(s, t) || parts(t, s)
}

/// The same of two triangles that share their first corners: have they no other point in common?
pub(super) fn plainly_apart_elsewhere(s: [Vec3; 3], t: [Vec3; 3]) -> bool {
    let Some(axis) = broadside(s) else { return false };
    let parts =
        |[v, a, b]: [Vec3; 3], [_, c, d]: [Vec3; 3]| beyond(axis, v, a, b, &[c, d]) || beyond(axis, v, b, a, &[c, d]);
    parts(s, t) || parts(t, s)
}

/// Do all of these points lie on the other side of the line a-b than `own`?
fn beyond(axis: usize, a: Vec3, b: Vec3, own: Vec3, points: &[Vec3]) -> bool {
    let own = turn(axis, a, b, own);
    points.iter().all(|&p| turn(axis, a, b, p) * own < 0)
}

#[cfg(test)]
mod tests {
    use super::*;

    fn v(x: f64, y: f64, z: f64) -> Vec3 {
        Vec3::new(x, y, z)
    }

    #[test]
    fn triangles_meet_or_do_not() {
        let s = [v(0., 0., 0.), v(4., 0., 0.), v(0., 4., 0.)];
        let moved = |t: [Vec3; 3], by: Vec3| t.map(|p| p + by);
        let upright = [v(1., 1., -1.), v(1., 1., 1.), v(3., 3., 1.)];
        for (t, meets, why) in [
            (upright, true, "through it"),
            (moved(upright, v(0., 0., 1.)), true, "a corner on it"),
            (moved(upright, v(0., 0., 1.0 + f64::EPSILON)), false, "just above it"),
            (moved(upright, v(2.5, 2.5, 0.)), false, "beside it"),
            (moved(s, v(1., 1., 0.)), true, "overlapping in its plane"),
            (moved(s, v(4., 0., 0.)), true, "a corner at its corner"),
            (moved(s, v(4., 1e-9, 0.)), false, "beside it in its plane"),
            (moved(s, v(0., 0., 1e-300)), false, "in a plane next to it"),
            ([v(0.5, 0.5, 0.), v(1., 0.5, 0.), v(0.5, 1., 0.)], true, "within it"),
            ([v(-1., -1., 0.), v(9., -1., 0.), v(-1., 9., 0.)], true, "around it"),
        ] {
            assert_eq!(triangles_meet(s, t), meets, "{why}");
            assert_eq!(triangles_meet(t, s), meets, "{why}, the other way round");
        }
    }

    #[test]
    fn a_line_is_no_triangle_however_it_lies() {
        assert_eq!(broadside([v(0., 0., 0.), v(1., 3., 7.), v(2., 6., 14.)]), None);
        assert_eq!(broadside([v(0., 0., 0.), v(1., 0., 0.), v(1e9, 0., 1e-9)]), Some(1));
        // As f64, 0.3 and 0.9 are not three times 0.1 and 0.3.
        assert!(broadside([v(0., 0., 0.), v(0.1, 0.3, 0.), v(0.3, 0.9, 0.)]).is_some());
    }
}
