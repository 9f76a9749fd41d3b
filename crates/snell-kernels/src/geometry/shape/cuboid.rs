//! Ray and box, or any parallelepiped, which is what a map makes of it: six faces that are one primitive.
//!
//! A box is the meeting of three slabs (Kay and Kajiya, *Ray Tracing Complex Scenes*, 1986). In coordinates in which its faces are at
//! −1 and 1 a line is between the faces of a slab from `(∓1 − oᵢ)/dᵢ` on, and in the box from the last entry to the first exit.
//! As with a sphere, what lies before the middle of that way is an entry and what lies behind it an exit, and a ray that leaves the
//! box meets nothing but its exit again, if that is ahead. So nothing is lost between two faces, and no edge has to be found.
//!
//! Each row of coordinates is across two edges of the box, `rᵢ = n/(n·aᵢ)` with the area vector `n` of these edges, which is good to
//! some roundings for a parallelogram of any shape. So the planes of the faces are where they are to within some roundings of the
//! size of the box and of its distance, however flat or skewed it is; its inverse as a matrix would lose digits with its condition.
//! Where a map has squashed it so that its faces are nearly parallel, its edges are known to that over the sine of the angle between
//! the faces only. So that no tree can hide what is hit there, the way is cut off at the box around it along the axes of the world.

use super::flat::box_along;
use super::{Departure, Numbers, Query, Shape, Surface, triangle};
use crate::geometry::area::area_vector;
use crate::geometry::ray::{Ray, inverse};
use crate::geometry::{Affine, Bounds, Vec3};
use crate::lanes::Lanes;

/// A parallelepiped: all `center + a·axes[0] + b·axes[1] + c·axes[2]` with `a`, `b` and `c` from −1 to 1.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Cuboid {
    /// Its middle.
    pub center: Vec3,
    /// From its middle to those of three faces.
    pub axes: [Vec3; 3],
    /// `rows[i]·(p − center)` is the coordinate of a point along `axes[i]`.
    rows: [Vec3; 3],
}

/// Where a line is in each of the slabs.
struct Slabs<L> {
    enter: [L; 3],
    leave: [L; 3],
    /// Is there a direction?
    is_way: [L; 3],
    /// And in the box around it along the axes of the world.
    around: [L; 2],
}

impl<L: Lanes> Slabs<L> {
    #[inline(always)]
    fn new(origin: Vec3<L>, dir: Vec3<L>, center: Vec3<L>, rows: [Vec3<L>; 3], extent: Vec3<L>) -> Self {
        let (one, zero, from_center) = (L::splat(1.0), L::splat(0.0), origin - center);
        let step = Vec3::new(inverse(dir.x), inverse(dir.y), inverse(dir.z));
        let around = box_along(step, -from_center - extent, extent - from_center);
        let mut slabs = Self { enter: [zero; 3], leave: [zero; 3], is_way: [zero; 3], around };
        for axis in 0..3 {
            let (o, d) = (rows[axis].dot(from_center), rows[axis].dot(dir));
            let step = inverse(d);
            // Beside a slab that is never left or entered, this is very far away, and on its very plane there.
            let side = L::select(step.lt(zero), -one, one);
            (slabs.enter[axis], slabs.leave[axis]) = ((-side - o) * step, (side - o) * step);
            slabs.is_way[axis] = d;
        }
        slabs
    }

    /// Where the line enters and leaves all of them.
    #[inline(always)]
    fn span(&self) -> [L; 2] {
        let ([a, b, c], [d, e, f], [enter, leave]) = (self.enter, self.leave, self.around);
        [a.max(b).max(c.max(enter)), d.min(e).min(f.min(leave))]
    }

    #[inline(always)]
    fn meets(&self, [enter, leave]: [L; 2]) -> L::Mask {
        let [x, y, z] = self.is_way;
        // A single point is no way through, and a direction that is none has no inverse.
        enter.lt(leave) & (x + y + z).eq(x + y + z)
    }
}

impl Cuboid {
    /// The box between two corners.
    pub fn new(min: Vec3, max: Vec3) -> Self {
        let half = (max - min) * 0.5;
        let axes = [Vec3::new(half.x, 0.0, 0.0), Vec3::new(0.0, half.y, 0.0), Vec3::new(0.0, 0.0, half.z)];
        Self::around(min + half, axes)
    }

    fn around(center: Vec3, axes: [Vec3; 3]) -> Self {
        let row = |own: Vec3, p: Vec3, q: Vec3| {
            let n = area_vector([Vec3::default(), p, q]);
            n * (1.0 / n.dot(own))
        };
        let [u, v, w] = axes;
        Self { center, axes, rows: [row(u, v, w), row(v, w, u), row(w, u, v)] }
    }

    /// Its image.
    #[must_use]
    pub fn under(&self, map: &Affine) -> Self {
        Self::around(map.apply(self.center), self.axes.map(|axis| map.turn(axis)))
    }

    /// Has it a volume?
    pub fn has_volume(&self) -> bool {
        self.rows.iter().all(|row| row.is_finite())
    }

    /// Its corners: bit i of the number says on which side of axis i.
    pub fn corners(&self) -> [Vec3; 8] {
        core::array::from_fn(|number| {
            let side = |bit: usize| if number >> bit & 1 == 1 { 1.0 } else { -1.0 };
            self.center + self.axes[0] * side(0) + self.axes[1] * side(1) + self.axes[2] * side(2)
        })
    }

    /// How far it reaches along each axis of the world from its middle.
    fn extent(&self) -> Vec3 {
        let [u, v, w] = self.axes;
        let reach = |axis: usize| u.component(axis).abs() + v.component(axis).abs() + w.component(axis).abs();
        Vec3::new(reach(0), reach(1), reach(2))
    }

    fn local(&self, point: Vec3) -> [f64; 3] {
        self.rows.map(|row| row.dot(point - self.center))
    }

    fn slabs(&self, origin: Vec3, dir: Vec3) -> Slabs<f64> {
        Slabs::new(origin, dir, self.center, self.rows, self.extent())
    }

    /// Where a line enters and leaves it, whether or not it does so in this order.
    fn span(&self, origin: Vec3, dir: Vec3) -> [f64; 2] {
        self.slabs(origin, dir).span()
    }

    /// The outward normal of a face.
    fn normal_of(&self, (axis, side): Face) -> Vec3 {
        self.rows[axis].unit() * side
    }

    /// How far a point is in front of the plane of a face.
    fn above(&self, (axis, side): Face, point: Vec3) -> f64 {
        (side * self.local(point)[axis] - 1.0) / self.rows[axis].length()
    }

    /// The face, among some, whose plane is nearest to a point.
    fn nearest(&self, point: Vec3, faces: impl Iterator<Item = Face>) -> Face {
        let off = |face: &Face| self.above(*face, point).abs();
        faces.min_by(|a, b| off(a).total_cmp(&off(b))).unwrap_or((0, 1.0))
    }

    /// The faces through which a ray in this direction leaves it, or enters it.
    fn ahead(&self, dir: Vec3, leaves: bool) -> impl Iterator<Item = Face> {
        let along = self.rows.map(|row| row.dot(dir));
        let side = move |axis: usize| if (along[axis] > 0.0) == leaves { 1.0 } else { -1.0 };
        (0..3).filter(move |&axis| along[axis] != 0.0).map(move |axis| (axis, side(axis)))
    }
}

#[inline(always)]
fn of_ray<L: Lanes>(ray: &Ray<L>, shape: impl Numbers<L>) -> Slabs<L> {
    let rows = [shape.vector([3, 4, 5]), shape.vector([6, 7, 8]), shape.vector([9, 10, 11])];
    Slabs::new(ray.origin, ray.heading.dir, shape.vector([0, 1, 2]), rows, shape.vector([12, 13, 14]))
}

/// A face: the number of its axis, and 1 or −1 for its side.
type Face = (usize, f64);

impl Shape for Cuboid {
    /// Middle, rows, extent, axes.
    const NUMBERS: usize = 24;
    const SHEARED: bool = false;
    const COMMON: bool = false;

    fn write(&self, put: impl FnMut(f64)) {
        let vectors = [self.center].into_iter().chain(self.rows).chain([self.extent()]).chain(self.axes);
        vectors.flat_map(<[f64; 3]>::from).for_each(put);
    }

    #[inline(always)]
    fn read(number: impl Fn(usize) -> f64) -> Self {
        let vector = |first: usize| Vec3::new(number(first), number(first + 1), number(first + 2));
        Self { center: vector(0), rows: [3, 6, 9].map(vector), axes: [15, 18, 21].map(vector) }
    }

    #[inline(always)]
    fn may_return(_two_sided: bool) -> bool {
        true
    }

    #[inline(always)]
    fn intersect<L: Lanes>(ray: &Ray<L>, shape: impl Numbers<L>, query: &Query<L>) -> (L, L::Mask) {
        let slabs = of_ray(ray, shape);
        let span @ [enter, leave] = slabs.span();
        let from_within = query.leaves | enter.le(query.t_min);
        let t = L::select(from_within, leave, enter);
        // In a corner a ray within may have less of its way ahead than behind it. Where what is near a start is looked at again, it is
        // enough that there is something ahead.
        let ahead = if query.two_sided { leave } else { enter + leave };
        (t, slabs.meets(span) & t.gt(query.t_min) & (!query.leaves | ahead.gt(L::splat(0.0))))
    }

    fn crossings(ray: &Ray<f64>, shape: impl Numbers<f64>, mut found: impl FnMut(f64)) {
        let slabs = of_ray(ray, shape);
        let span @ [enter, leave] = slabs.span();
        if slabs.meets(span) {
            found(enter);
            found(leave);
        }
    }
}

impl Surface for Cuboid {
    fn bounds(&self) -> Bounds {
        let extent = self.extent();
        Bounds { min: self.center - extent, max: self.center + extent }
    }

    fn is_flat(&self) -> bool {
        false
    }

    /// A line that passes an edge by a rounding enters nothing.
    fn enters(&self, origin: Vec3, dir: Vec3, t: f64) -> bool {
        let [enter, leave] = self.span(origin, dir);
        enter < leave && t - enter < leave - t
    }

    fn starts_at(&self, origin: Vec3, dir: Vec3, t: f64) -> bool {
        let [enter, leave] = self.span(origin, dir);
        let middle = 0.5 * (enter + leave);
        !(middle > 0.0 && t > middle)
    }

    fn meets_at(&self, origin: Vec3, dir: Vec3, t: f64) -> Option<f64> {
        let slabs = self.slabs(origin, dir);
        let span @ [enter, leave] = slabs.span();
        slabs.meets(span).then_some(if t - enter < leave - t { enter } else { leave })
    }

    /// Of the nearest face.
    fn normal(&self, point: Vec3) -> Vec3 {
        let faces = (0..3).flat_map(|axis| [(axis, -1.0), (axis, 1.0)]);
        self.normal_of(self.nearest(point, faces))
    }

    fn normal_along(&self, point: Vec3, dir: Vec3, within: bool, tolerance: f64) -> Vec3 {
        let [enter, leave] = self.span(point, dir);
        let leaves = within || 0.5 * (enter + leave) < -tolerance;
        self.normal_of(self.nearest(point, self.ahead(dir, leaves)))
    }

    fn height(&self, origin: Vec3, dir: Vec3, t: f64) -> (Vec3, f64) {
        let face = self.nearest(origin + dir * t, self.ahead(dir, !self.enters(origin, dir, t)));
        (self.normal_of(face), self.above(face, origin))
    }

    fn rises(&self, origin: Vec3, up: Vec3) -> f64 {
        up.dot(self.center - origin) + self.axes.iter().map(|&axis| up.dot(axis).abs()).sum::<f64>()
    }

    /// By the faces through which it would go out: where the ray is surely behind all of them it is within, and meets what is ahead.
    /// Where it is not known to be behind one, it meets that if it came from behind it, as in the corner of a room, and does not
    /// meet the box if it came from before it, as at an edge seen from outside.
    fn is_met_again(&self, from: &Departure, t: f64) -> bool {
        for face in self.ahead(from.dir, true) {
            if self.above(face, from.origin) >= -0.125 * from.tolerance {
                return self.normal_of(face).dot(from.wo) < 0.0;
            }
        }
        t > 0.0 && !self.enters(from.origin, from.dir, t)
    }

    /// Each side shows the whole texture, as the rectangle that looks the same way does.
    fn uv(&self, point: Vec3) -> [f64; 2] {
        let faces = (0..3).flat_map(|axis| [(axis, -1.0), (axis, 1.0)]);
        let (axis, side) = self.nearest(point, faces);
        let [x, y, z] = self.local(point).map(|coordinate| (0.5 + 0.5 * coordinate).clamp(0.0, 1.0));
        match (axis, side > 0.0) {
            (0, false) => [z, y],
            (0, true) => [1.0 - z, y],
            (1, false) => [x, z],
            (1, true) => [x, 1.0 - z],
            (_, false) => [1.0 - x, y],
            (_, true) => [x, y],
        }
    }

    /// From its surface.
    fn distance(&self, point: Vec3) -> f64 {
        let inside = (0..3).flat_map(|axis| [(axis, -1.0), (axis, 1.0)]).map(|face| -self.above(face, point));
        let depth = inside.fold(f64::INFINITY, f64::min);
        if depth >= 0.0 {
            return depth;
        }
        let mut distance = f64::INFINITY;
        self.tessellate(&mut |corners| distance = distance.min(triangle::distance(corners, point)));
        distance
    }

    fn tessellate(&self, put: &mut dyn FnMut([Vec3; 3])) {
        let corners = self.corners();
        let sides = [[0, 4, 6, 2], [5, 1, 3, 7], [0, 1, 5, 4], [6, 7, 3, 2], [1, 0, 2, 3], [4, 5, 7, 6]];
        for [a, b, c, d] in sides.map(|side: [usize; 4]| side.map(|corner| corners[corner])) {
            put([a, b, c]);
            put([a, c, d]);
        }
    }
}
