//! Ray and disc, or any ellipse, which is what a map makes of it.
//!
//! Seen along the ray, the disc is the set of all `q + a·u + b·v` with `a² + b² ≤ 1`. The ray is the origin: by Cramer's rule
//! `a = (v × q)/(u × v)` and `b = (q × u)/(u × v)`, in the plane across the ray, and nothing need be divided to compare them
//! with 1. So the rim is where it is to within some roundings, however it is looked at.

use super::flat::meet_plane;
use super::rectangle::across;
use super::{Numbers, Query, Shape, Surface, meet};
use crate::geometry::area::area_vector;
use crate::geometry::ray::{Ray, main_axis};
use crate::geometry::{Affine, Bounds, Vec3};
use crate::lanes::elementary::sin_cos_degrees;
use crate::lanes::{Lanes, Mask};

/// Triangles of a tessellated disc.
const SEGMENTS: usize = 64;

/// An ellipse: all `center + a·right + b·up` with `a² + b² ≤ 1`.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Disc {
    /// Its middle.
    pub center: Vec3,
    /// From its middle to two points of its rim, conjugate to each other: across each other for a circle.
    pub radii: [Vec3; 2],
    /// 1 if it looks along `right × up`, −1 if a mirror has swapped its sides.
    pub front: f64,
}

impl Disc {
    /// A circle around `center`, seen from where `normal` points, with its texture as on a rectangle.
    pub fn new(center: Vec3, normal: Vec3, radius: f64) -> Self {
        Self { center, radii: across(normal).map(|axis| axis * radius), front: 1.0 }
    }

    /// Its image.
    #[must_use]
    pub fn under(&self, map: &Affine) -> Self {
        let front = if map.mirrors() { -self.front } else { self.front };
        Self { center: map.apply(self.center), radii: self.radii.map(|radius| map.turn(radius)), front }
    }

    fn area_vector(&self) -> Vec3 {
        let [u, v] = self.radii;
        area_vector([Vec3::default(), u, v]) * self.front
    }

    /// Has it an area?
    pub fn has_area(&self) -> bool {
        self.area_vector().unit().is_finite()
    }

    /// Its place in units of its radii.
    fn local(&self, point: Vec3) -> [f64; 2] {
        let ([u, v], p) = (self.radii, point - self.center);
        let n = area_vector([Vec3::default(), u, v]);
        let axis = main_axis(n);
        [p.cross(v), u.cross(p)].map(|part| part.component(axis) / n.component(axis))
    }
}

/// How far an ellipse reaches along each axis from its middle.
#[inline(always)]
fn extent<L: Lanes>([u, v]: [Vec3<L>; 2]) -> Vec3<L> {
    Vec3::new(
        dot([u.x, v.x], [u.x, v.x]).sqrt(),
        dot([u.y, v.y], [u.y, v.y]).sqrt(),
        dot([u.z, v.z], [u.z, v.z]).sqrt(),
    )
}

#[inline(always)]
fn cross<L: Lanes>(a: [L; 2], b: [L; 2]) -> L {
    a[0] * b[1] - a[1] * b[0]
}

#[inline(always)]
fn dot<L: Lanes>(a: [L; 2], b: [L; 2]) -> L {
    a[0] * b[0] + a[1] * b[1]
}

impl Shape for Disc {
    /// Middle, two radii, the sign of the front.
    const NUMBERS: usize = 10;
    const SHEARED: bool = true;
    const COMMON: bool = false;

    fn write(&self, put: impl FnMut(f64)) {
        let [u, v] = self.radii;
        [self.center, u, v].into_iter().flat_map(<[f64; 3]>::from).chain([self.front]).for_each(put);
    }

    #[inline(always)]
    fn read(number: impl Fn(usize) -> f64) -> Self {
        let [center, u, v] = [0, 3, 6].map(|first| Vec3::new(number(first), number(first + 1), number(first + 2)));
        Self { center, radii: [u, v], front: number(9) }
    }

    #[inline(always)]
    fn may_return(_two_sided: bool) -> bool {
        false
    }

    #[inline(always)]
    fn intersect<L: Lanes>(ray: &Ray<L>, shape: impl Numbers<L>, _query: &Query<L>) -> (L, L::Mask) {
        let (zero, heading, k) = (L::splat(0.0), &ray.heading, ray.axes);
        let to_center = shape.vector(k) - ray.origin;
        let u = shape.vector([k[0] + 3, k[1] + 3, k[2] + 3]);
        let v = shape.vector([k[0] + 6, k[1] + 6, k[2] + 6]);
        let [q, su, sv] = [heading.seen(to_center), heading.seen(u), heading.seen(v)];
        let (a, b, whole) = (cross(sv, q), cross(q, su), cross(su, sv));
        // Where the disc is seen edge on, all three are mere roundings: no point is farther than both radii together reach.
        let inside = (a * a + b * b).le(whole * whole) & dot(q, q).le(dot(su, su) + dot(sv, sv)) & !whole.eq(zero);
        if !inside.any() {
            return (zero, inside);
        }
        let (reach, nowhere) = (extent([u, v]), Vec3::new(zero, zero, zero));
        let normal = area_vector([nowhere, u, v]);
        let (t, meets) = meet_plane(heading, normal, to_center, to_center - reach, to_center + reach);
        (t, meets & inside)
    }

    fn crossings(ray: &Ray<f64>, shape: impl Numbers<f64>, mut found: impl FnMut(f64)) {
        let (t, meets) = Self::intersect(ray, shape, &Query::everywhere());
        if meets {
            found(t);
        }
    }
}

impl Surface for Disc {
    fn bounds(&self) -> Bounds {
        let reach = extent(self.radii);
        Bounds { min: self.center - reach, max: self.center + reach }
    }

    fn enters(&self, _origin: Vec3, dir: Vec3, _t: f64) -> bool {
        self.area_vector().dot(dir) < 0.0
    }

    fn meets_at(&self, origin: Vec3, dir: Vec3, _t: f64) -> Option<f64> {
        meet(self, origin, dir)
    }

    fn normal(&self, _point: Vec3) -> Vec3 {
        self.area_vector().unit()
    }

    fn height(&self, origin: Vec3, _dir: Vec3, _t: f64) -> (Vec3, f64) {
        let normal = self.area_vector().unit();
        (normal, normal.dot(origin - self.center))
    }

    fn rises(&self, origin: Vec3, up: Vec3) -> f64 {
        let [u, v] = self.radii.map(|radius| up.dot(radius));
        up.dot(self.center - origin) + (u * u + v * v).sqrt()
    }

    /// That of the rectangle around it.
    fn uv(&self, point: Vec3) -> [f64; 2] {
        self.local(point).map(|part| (0.5 + 0.5 * part).clamp(0.0, 1.0))
    }

    /// Beside an ellipse that is no circle, that of some point of its rim near by.
    fn distance(&self, point: Vec3) -> f64 {
        let ([a, b], [u, v]) = (self.local(point), self.radii);
        let shrink = 1.0 / (a * a + b * b).sqrt().max(1.0);
        (point - (self.center + u * (a * shrink) + v * (b * shrink))).length()
    }

    fn tessellate(&self, put: &mut dyn FnMut([Vec3; 3])) {
        let [u, v] = self.radii;
        let rim = |i: usize| {
            let (sin, cos) = sin_cos_degrees(360.0 * (i % SEGMENTS) as f64 / SEGMENTS as f64);
            self.center + u * cos + v * sin
        };
        (0..SEGMENTS).for_each(|i| put([self.center, rim(i), rim(i + 1)]));
    }
}
