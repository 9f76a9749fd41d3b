//! Ray and rectangle, or any parallelogram, which is what a map makes of it: watertight along edges that it shares with others of the
//! same corners, and with triangles.
//!
//! The three questions of the [triangle](super::triangle), with a fourth corner: the signs of four edge functions say whether the
//! line goes through, the area vector says where the plane is, and the hit is moved into the box of the corners.

use super::flat::meet_plane;
use super::{Numbers, Query, Shape, Surface, meet, triangle};
use crate::geometry::area::area_vector;
use crate::geometry::ray::{Ray, main_axis};
use crate::geometry::{Affine, Bounds, Vec3};
use crate::lanes::{Lanes, Mask};

/// A parallelogram.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Rectangle {
    /// Counter-clockwise from the lower left, where its texture starts, with that upright.
    pub corners: [Vec3; 4],
    /// 1 if it looks to where its corners are seen counter-clockwise, −1 if a mirror has swapped its sides.
    pub front: f64,
}

impl Rectangle {
    /// Around `center`, seen from where `normal` points. Its texture stands upright for `normal` along z; for one along ±y it is
    /// that of a floor or a ceiling with x to the right. A normal without direction makes corners that are not finite.
    pub fn new(center: Vec3, normal: Vec3, size: [f64; 2]) -> Self {
        let [u, v] = across(normal);
        let (u, v) = (u * size[0], v * size[1]);
        let corner = |[s, t]: [f64; 2]| center + u * (s - 0.5) + v * (t - 0.5);
        Self { corners: [[0.0, 0.0], [1.0, 0.0], [1.0, 1.0], [0.0, 1.0]].map(corner), front: 1.0 }
    }

    /// Its image.
    #[must_use]
    pub fn under(&self, map: &Affine) -> Self {
        let front = if map.mirrors() { -self.front } else { self.front };
        Self { corners: self.corners.map(|corner| map.apply(corner)), front }
    }

    /// Along its normal, twice as long as its area.
    fn area_vector(&self) -> Vec3 {
        let [a, b, _, d] = self.corners;
        area_vector([a, b, d]) * self.front
    }

    /// Has it an area?
    pub fn has_area(&self) -> bool {
        self.area_vector().unit().is_finite()
    }
}

/// Two unit vectors across a normal, to the right and up as it is seen from where it points.
pub fn across(normal: Vec3) -> [Vec3; 2] {
    let n = normal.unit();
    let right = Vec3::new(0.0, 1.0, 0.0).cross(n);
    let u = if right.length() == 0.0 { Vec3::new(1.0, 0.0, 0.0) } else { right.unit() };
    [u, n.cross(u)]
}

/// Twice the area that a ray spans with an edge, as it is seen along it: exactly the opposite of that of the edge the other way.
#[inline(always)]
fn edge<L: Lanes>(a: [L; 2], b: [L; 2]) -> L {
    b[0] * a[1] - b[1] * a[0]
}

#[inline(always)]
fn least<L: Lanes>([a, b, c, d]: [L; 4]) -> L {
    a.min(b).min(c.min(d))
}

#[inline(always)]
fn most<L: Lanes>([a, b, c, d]: [L; 4]) -> L {
    a.max(b).max(c.max(d))
}

impl Shape for Rectangle {
    /// Four corners, the sign of the front.
    const NUMBERS: usize = 13;
    const SHEARED: bool = true;
    const COMMON: bool = false;

    fn write(&self, put: impl FnMut(f64)) {
        self.corners.into_iter().flat_map(<[f64; 3]>::from).chain([self.front]).for_each(put);
    }

    #[inline(always)]
    fn read(number: impl Fn(usize) -> f64) -> Self {
        let corners = [0, 3, 6, 9].map(|first| Vec3::new(number(first), number(first + 1), number(first + 2)));
        Self { corners, front: number(12) }
    }

    #[inline(always)]
    fn may_return(_two_sided: bool) -> bool {
        false
    }

    #[inline(always)]
    fn intersect<L: Lanes>(ray: &Ray<L>, shape: impl Numbers<L>, _query: &Query<L>) -> (L, L::Mask) {
        let (zero, heading, k) = (L::splat(0.0), &ray.heading, ray.axes);
        let a = shape.vector(k);
        let b = shape.vector([k[0] + 3, k[1] + 3, k[2] + 3]);
        let c = shape.vector([k[0] + 6, k[1] + 6, k[2] + 6]);
        let d = shape.vector([k[0] + 9, k[1] + 9, k[2] + 9]);
        let [ra, rb, rc, rd] = [a - ray.origin, b - ray.origin, c - ray.origin, d - ray.origin];
        let [sa, sb, sc, sd] = [heading.seen(ra), heading.seen(rb), heading.seen(rc), heading.seen(rd)];
        let edges = [edge(sa, sb), edge(sb, sc), edge(sc, sd), edge(sd, sa)];
        let inside = least(edges).ge(zero) | most(edges).le(zero);
        if !inside.any() {
            return (zero, inside);
        }
        let [xs, ys] = [[sa[0], sb[0], sc[0], sd[0]], [sa[1], sb[1], sc[1], sd[1]]];
        let around = least(xs).le(zero) & most(xs).ge(zero) & least(ys).le(zero) & most(ys).ge(zero);
        let area = (edges[0] + edges[1]) + (edges[2] + edges[3]);
        let [xs, ys, zs] = [[ra.x, rb.x, rc.x, rd.x], [ra.y, rb.y, rc.y, rd.y], [ra.z, rb.z, rc.z, rd.z]];
        let (low, high) = (Vec3::new(least(xs), least(ys), least(zs)), Vec3::new(most(xs), most(ys), most(zs)));
        let (t, meets) = meet_plane(heading, area_vector([a, b, d]), ra, low, high);
        (t, meets & inside & around & !area.eq(zero))
    }

    fn crossings(ray: &Ray<f64>, shape: impl Numbers<f64>, mut found: impl FnMut(f64)) {
        let (t, meets) = Self::intersect(ray, shape, &Query::everywhere());
        if meets {
            found(t);
        }
    }
}

impl Surface for Rectangle {
    fn bounds(&self) -> Bounds {
        Bounds::of(self.corners)
    }

    fn enters(&self, origin: Vec3, dir: Vec3, _t: f64) -> bool {
        let [a, b, _, d] = self.corners;
        triangle::is_front(origin, dir, [a, b, d]) == (self.front > 0.0)
    }

    fn meets_at(&self, origin: Vec3, dir: Vec3, _t: f64) -> Option<f64> {
        meet(self, origin, dir)
    }

    fn normal(&self, _point: Vec3) -> Vec3 {
        self.area_vector().unit()
    }

    fn height(&self, origin: Vec3, _dir: Vec3, _t: f64) -> (Vec3, f64) {
        let normal = self.area_vector().unit();
        (normal, normal.dot(origin - self.corners[0]))
    }

    fn rises(&self, origin: Vec3, up: Vec3) -> f64 {
        self.corners.iter().map(|&corner| up.dot(corner - origin)).fold(f64::NEG_INFINITY, f64::max)
    }

    /// From its lower left corner to the right and up.
    fn uv(&self, point: Vec3) -> [f64; 2] {
        let [a, b, _, d] = self.corners;
        // Seen from a corner, so that far from the origin no digits are lost; on the coordinate plane that it faces most.
        let (ab, ad, ap) = (b - a, d - a, point - a);
        let axis = main_axis(self.area_vector());
        let whole = ab.cross(ad).component(axis);
        [ap.cross(ad), ab.cross(ap)].map(|part| {
            let share = part.component(axis) / whole;
            // NaN becomes 0 too.
            if share > 0.0 { share.min(1.0) } else { 0.0 }
        })
    }

    fn distance(&self, point: Vec3) -> f64 {
        let [a, b, c, d] = self.corners;
        triangle::distance([a, b, c], point).min(triangle::distance([a, c, d], point))
    }

    fn tessellate(&self, put: &mut dyn FnMut([Vec3; 3])) {
        let [a, b, c, d] = self.corners;
        put([a, b, c]);
        put([a, c, d]);
    }
}
