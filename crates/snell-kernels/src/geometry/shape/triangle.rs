//! Ray and triangle, watertight for triangles of any shape.
//!
//! Three questions are asked, each in the way that rounding harms least:
//!
//! 1. *Does the line go through?* Woop, Benthin and Wald (2013): seen along the ray, the corners are points in a plane, and the
//!    signs of three edge functions say whether the ray is between them. `fl(a·b) − fl(c·d)` has the sign of the exact value or
//!    is zero (rounding is monotonic), zero counts as inside, and both triangles of an edge see the same two corners: a ray
//!    cannot slip through a shared edge or corner. A corner is seen where it is to within 6 roundings of its distance
//!    ([`SEEN`]): a line that passes an edge at more than that is told right, however thin the triangle. Where products cancel
//!    to zero, as for a ray in the plane of the triangle, the signs say nothing; but the ray must also lie in the rectangle
//!    around the three points, which is decided without rounding, and with that is no farther outside than a rounding of the
//!    triangle's own size.
//! 2. *Where is its plane?* `t = n·(a − o)/(n·d)` with the area vector of the corners themselves, which is good for slivers too
//!    ([`area`](crate::geometry::area)). The weights of the edge functions would do for round triangles only: they err by `2⁻⁵³` times the
//!    aspect.
//! 3. *Where along it is the triangle?* Grazing rays meet a plane anywhere. The hit is moved into the triangle's own box, with
//!    room for what was rounded in 1, which a ray that goes through the triangle surely meets. So no tree of boxes can
//!    hide a hit, and none is refused.

use super::flat::meet_plane;
use super::{Numbers, Query, Shape, ShapeList, Surface, meet};
use crate::geometry::area::area_vector;
use crate::geometry::ray::{Heading, Ray, axes, main_axis};
use crate::geometry::{Bounds, Vec3};
use crate::lanes::{Lanes, Mask};

/// A triangle.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Triangle {
    /// Counter-clockwise seen from where its normal points.
    pub corners: [Vec3; 3],
}

/// Triangles that share vertices.
#[derive(Clone, Copy, Debug, Default)]
pub struct Triangles<'a> {
    /// The corners.
    pub vertices: &'a [Vec3],
    /// Three vertices per triangle.
    pub faces: &'a [[u32; 3]],
}

impl ShapeList<Triangle> for Triangles<'_> {
    fn count(self) -> usize {
        self.faces.len()
    }

    fn get(self, place: usize) -> Triangle {
        Triangle { corners: self.faces[place].map(|v| self.vertices[v as usize]) }
    }
}

impl Shape for Triangle {
    /// Three corners.
    const NUMBERS: usize = 9;
    const SHEARED: bool = true;
    const COMMON: bool = true;

    fn write(&self, put: impl FnMut(f64)) {
        self.corners.into_iter().flat_map(<[f64; 3]>::from).for_each(put);
    }

    fn read(number: impl Fn(usize) -> f64) -> Self {
        Self { corners: [0, 3, 6].map(|first| Vec3::new(number(first), number(first + 1), number(first + 2))) }
    }

    #[inline(always)]
    fn may_return(_two_sided: bool) -> bool {
        false
    }

    #[inline(always)]
    fn intersect<L: Lanes>(ray: &Ray<L>, shape: impl Numbers<L>, _query: &Query<L>) -> (L, L::Mask) {
        let k = ray.axes;
        let a = shape.vector(k);
        let b = shape.vector([k[0] + 3, k[1] + 3, k[2] + 3]);
        let c = shape.vector([k[0] + 6, k[1] + 6, k[2] + 6]);
        let hit = intersect(ray.origin, &ray.heading, [a, b, c]);
        (hit.t, hit.meets)
    }

    fn crossings(ray: &Ray<f64>, shape: impl Numbers<f64>, mut found: impl FnMut(f64)) {
        let (t, meets) = Self::intersect(ray, shape, &Query::everywhere());
        if meets {
            found(t);
        }
    }
}

impl Surface for Triangle {
    fn bounds(&self) -> Bounds {
        Bounds::of(self.corners)
    }

    fn enters(&self, origin: Vec3, dir: Vec3, _t: f64) -> bool {
        is_front(origin, dir, self.corners)
    }

    fn meets_at(&self, origin: Vec3, dir: Vec3, _t: f64) -> Option<f64> {
        meet(self, origin, dir)
    }

    fn normal(&self, _point: Vec3) -> Vec3 {
        normal(self.corners)
    }

    fn height(&self, origin: Vec3, _dir: Vec3, _t: f64) -> (Vec3, f64) {
        let normal = normal(self.corners);
        (normal, normal.dot(origin - self.corners[0]))
    }

    fn rises(&self, origin: Vec3, up: Vec3) -> f64 {
        self.corners.iter().map(|&corner| up.dot(corner - origin)).fold(f64::NEG_INFINITY, f64::max)
    }

    /// The weights of its second and third corner.
    fn uv(&self, point: Vec3) -> [f64; 2] {
        let [_, beta, gamma] = barycentric(self.corners, point);
        [beta, gamma]
    }

    fn distance(&self, point: Vec3) -> f64 {
        distance(self.corners, point)
    }

    fn tessellate(&self, put: &mut dyn FnMut([Vec3; 3])) {
        put(self.corners);
    }
}

/// Where a ray meets a triangle.
#[derive(Clone, Copy, Debug)]
pub struct TriangleHit<L: Lanes> {
    /// Distance along the ray.
    pub t: L,
    /// Does the line of the ray meet the triangle, from either side, before or behind its origin?
    pub meets: L::Mask,
}

/// How far from where it is a corner may be seen, relative to the distance of the farthest corner along any axis: with
/// `u = 2⁻⁵³`, `a − o` errs by `u` in each component, the shear by `u`, its product by `u`, and the sum by `u` of at most twice
/// as much.
pub const SEEN: f64 = 6.0 / (1u64 << 53) as f64;

/// Meets a ray with a triangle, from either side, edges included. `origin` and `vertices` are permuted as `heading` is; the
/// direction need not be of unit length. A triangle without area is not hit.
#[inline(always)]
pub fn intersect<L: Lanes>(origin: Vec3<L>, heading: &Heading<L>, vertices: [Vec3<L>; 3]) -> TriangleHit<L> {
    let zero = L::splat(0.0);
    let [a, b, c] = vertices;
    let corners = [a - origin, b - origin, c - origin];
    let seen = [heading.seen(corners[0]), heading.seen(corners[1]), heading.seen(corners[2])];
    let edges = Edges::new(seen);
    let inside = edges.inside();
    if !inside.any() {
        return TriangleHit { t: zero, meets: inside };
    }
    let [a, b, c] = corners;
    let low = Vec3::new(a.x.min(b.x).min(c.x), a.y.min(b.y).min(c.y), a.z.min(b.z).min(c.z));
    let high = Vec3::new(a.x.max(b.x).max(c.x), a.y.max(b.y).max(c.y), a.z.max(b.z).max(c.z));
    let (t, is_there) = meet_plane(heading, area_vector(vertices), a, low, high);
    TriangleHit { t, meets: inside & !edges.area().eq(zero) & around_origin(seen) & is_there }
}

/// The weights of the corners at the point where a line meets a triangle, which they are good for as far as it is round. Of no meaning
/// where the line misses it; not finite where it is seen edge on.
pub fn weights(origin: Vec3, heading: &Heading, vertices: [Vec3; 3]) -> [f64; 3] {
    let edges = Edges::new(vertices.map(|v| heading.seen(v - origin)));
    let area = edges.area();
    [edges.u / area, edges.v / area, edges.w / area]
}

/// Does the line meet the triangle from the side of its normal, so that this points against it? Where it is seen edge on, that is
/// decided by the edge functions, as whether it meets it at all, so that the faces of a solid are met in turns from outside and
/// from inside.
pub fn is_front(origin: Vec3, dir: Vec3, vertices: [Vec3; 3]) -> bool {
    // Below this cosine the edge functions of a sliver of 1 : 10⁹ may disagree with its normal.
    const EDGE_ON: f64 = 1.0 / (1u64 << 20) as f64;
    let n = area_vector(vertices);
    let along = n.dot(dir);
    if along * along > EDGE_ON * EDGE_ON * n.dot(n) * dir.dot(dir) {
        return along < 0.0;
    }
    let main = main_axis(dir);
    let k = axes(main);
    let heading = Heading::new(dir.permuted(k));
    let area = Edges::new(vertices.map(|v| heading.seen((v - origin).permuted(k)))).area();
    if area == 0.0 {
        return along < 0.0;
    }
    // Seen along the ray, the corners of a face that looks the same way turn left: u, v and w are negative of that. A ray that goes
    // backward along its main axis sees them mirrored, and so does an odd order of the axes.
    (area > 0.0) == ((dir.component(main) > 0.0) == (main != 1))
}

/// How far a point is from a triangle, to within some roundings of the distances to its corners.
pub fn distance(corners: [Vec3; 3], p: Vec3) -> f64 {
    let [a, b, c] = corners;
    let n = normal(corners);
    let k = axes(main_axis(n));
    // Seen along its normal the triangle is as large as it is.
    let above = intersect(p.permuted(k), &Heading::new(n.permuted(k)), corners.map(|v| v.permuted(k)));
    let to_segment = |a: Vec3, b: Vec3| {
        let (along, to_p) = (b - a, p - a);
        let share = (to_p.dot(along) / along.dot(along)).clamp(0.0, 1.0);
        (to_p - along * share).length()
    };
    let rim = to_segment(a, b).min(to_segment(b, c)).min(to_segment(c, a));
    if above.meets { rim.min(above.t.abs()) } else { rim }
}

/// Weights of the corners of a triangle at a point on it, each from 0 to 1; they add up to 1 but for a rounding.
///
/// The areas are those of the shadow on the coordinate plane that the triangle faces most, where it is largest. A point that
/// lies beside the triangle, as hits do by a rounding, gets the weights of a place in it. A triangle without area gives its
/// first corner.
pub fn barycentric(corners: [Vec3; 3], point: Vec3) -> [f64; 3] {
    let [a, b, c] = corners;
    // Seen from a corner, so that far from the origin no digits are lost.
    let (ab, ac, ap) = (b - a, c - a, point - a);
    let whole = ab.cross(ac);
    let size = [whole.x.abs(), whole.y.abs(), whole.z.abs()];
    let axis = (0..3).fold(0, |best, axis| if size[axis] > size[best] { axis } else { best });
    let share = |part: Vec3, most: f64| {
        let share = part.component(axis) / whole.component(axis);
        // NaN becomes 0 too: no area, or numbers that are none.
        if share > 0.0 { share.min(most) } else { 0.0 }
    };
    let beta = share(ap.cross(ac), 1.0);
    let gamma = share(ab.cross(ap), 1.0 - beta);
    [1.0 - beta - gamma, beta, gamma]
}

/// For each corner twice the area that the ray spans with the other two, as they are seen along it.
struct Edges<L> {
    u: L,
    v: L,
    w: L,
}

impl<L: Lanes> Edges<L> {
    #[inline(always)]
    fn new([a, b, c]: [[L; 2]; 3]) -> Self {
        Self { u: c[0] * b[1] - c[1] * b[0], v: a[0] * c[1] - a[1] * c[0], w: b[0] * a[1] - b[1] * a[0] }
    }

    #[inline(always)]
    fn inside(&self) -> L::Mask {
        let (Self { u, v, w }, zero) = (self, L::splat(0.0));
        (u.ge(zero) & v.ge(zero) & w.ge(zero)) | (u.le(zero) & v.le(zero) & w.le(zero))
    }

    #[inline(always)]
    fn area(&self) -> L {
        self.u + self.v + self.w
    }
}

/// Is the ray, the origin of the plane in which three points are seen, in the rectangle around them?
#[inline(always)]
fn around_origin<L: Lanes>([a, b, c]: [[L; 2]; 3]) -> L::Mask {
    let zero = L::splat(0.0);
    let [low_x, low_y] = [a[0].min(b[0]).min(c[0]), a[1].min(b[1]).min(c[1])];
    let [high_x, high_y] = [a[0].max(b[0]).max(c[0]), a[1].max(b[1]).max(c[1])];
    low_x.le(zero) & high_x.ge(zero) & low_y.le(zero) & high_y.ge(zero)
}

/// Unit normal by the right-hand rule; not finite where the triangle has no area.
#[inline(always)]
pub fn normal<L: Lanes>(corners: [Vec3<L>; 3]) -> Vec3<L> {
    area_vector(corners).unit()
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn hit(origin: Vec3, dir: Vec3, vertices: [Vec3; 3]) -> Option<(f64, f64, f64)> {
        let k = axes(main_axis(dir));
        let (origin, heading, vertices) =
            (origin.permuted(k), Heading::new(dir.permuted(k)), vertices.map(|v| v.permuted(k)));
        let (hit, [_, beta, gamma]) = (intersect(origin, &heading, vertices), weights(origin, &heading, vertices));
        (hit.meets && hit.t > 0.0).then_some((hit.t, beta, gamma))
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

    #[test]
    fn a_point_is_as_far_from_a_triangle_as_geometry_has_it() {
        let corners = [[0.0, 0.0, 1.0], [4.0, 0.0, 1.0], [0.0, 3.0, 1.0]].map(Vec3::from);
        for (point, expected) in [
            ([1.0, 1.0, 3.0], 2.0),
            ([1.0, 1.0, 1.0], 0.0),
            ([2.0, 1.5, -1.0], 2.0),
            ([2.0, -3.0, 1.0], 3.0),
            ([-3.0, -4.0, 1.0], 5.0),
            ([7.0, 0.0, 5.0], 5.0),
            // Beyond the long edge, across which (3, 4) points.
            ([2.0 + 0.6, 1.5 + 0.8, 1.0], 1.0),
        ] {
            let found = distance(corners, point.into());
            // A few roundings of numbers up to 7.
            assert!((found - expected).abs() < 4e-15, "{found} from {point:?}");
        }
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
