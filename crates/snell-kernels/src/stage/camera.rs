//! The placed camera: which ray belongs to which pixel.

use crate::geometry::{Bounds, Vec3};
use crate::lanes::Lanes;

/// How far from its point of the grid a sample of a pixel may be, in pixels, where there are several.
pub const JITTER: f64 = 0.5;

/// A camera with its axes, ready to make rays.
#[derive(Clone, Debug)]
pub struct CameraFrame {
    /// Where the eye is.
    pub eye: Vec3,
    /// Right, up, and backwards, of unit length.
    pub axes: [Vec3; 3],
    /// Left, right, bottom, top.
    pub bounds: [f64; 4],
    /// Width and height of the picture in pixels.
    pub size: [u32; 2],
    /// Where the image plane is, along the axis that points backwards.
    pub near: f64,
    /// Do rays start at the eye, and not on the image plane?
    pub from_eye: bool,
}

impl CameraFrame {
    /// Origin and direction of the ray through a pixel, (0, 0) on top left.
    pub fn ray(&self, x: u32, y: u32) -> (Vec3, Vec3) {
        self.rays(self.across(x.into()), self.up(y.into()))
    }

    /// How far right of the middle of the image plane a column of pixels is, or a place between two.
    pub fn across(&self, x: f64) -> f64 {
        let [left, right, ..] = self.bounds;
        left + share(x, self.size[0]) * (right - left)
    }

    /// How far above the middle of the image plane a row of pixels is, or a place between two.
    pub fn up(&self, y: f64) -> f64 {
        let [.., bottom, top] = self.bounds;
        top - share(y, self.size[1]) * (top - bottom)
    }

    /// Origins and directions of the rays through some points of the image plane.
    #[inline(always)]
    pub fn rays<L: Lanes>(&self, across: L, up: L) -> (Vec3<L>, Vec3<L>) {
        if self.from_eye {
            // Without the eye's place, which would cost digits far from the origin.
            return (self.eye.splat(), self.direction(across, up).unit());
        }
        let origin = self.point(across, up);
        (origin, (origin - self.eye.splat()).unit())
    }

    /// All places where camera rays start.
    pub fn starts(&self) -> Bounds {
        if self.from_eye { Bounds::of([self.eye]) } else { Bounds::of(self.outermost(JITTER)) }
    }

    /// Is the image plane where `near` puts it, to three digits, in spite of rounding? Very near to the eye, or with the eye very
    /// far from the origin if rays start on the plane, it is not, and rays have wrong directions or none.
    pub fn has_image_plane(&self) -> bool {
        let middle = if self.from_eye { self.direction(0.0, 0.0) } else { self.point(0.0, 0.0) - self.eye };
        (middle.length() / self.near + 1.0).abs() < 1e-3
    }

    /// The four corners of the picture on the image plane.
    pub fn corners(&self) -> [Vec3; 4] {
        self.corners_of(self.bounds)
    }

    /// The corners of all that samples look through which are up to so many pixels from their points of the grid.
    pub fn outermost(&self, jitter: f64) -> [Vec3; 4] {
        let [mut left, mut right, mut bottom, mut top] = self.bounds;
        if jitter > 0.0 {
            let [last_column, last_row] = self.size.map(|n| f64::from(n - 1) + jitter);
            [left, right] = [self.across(-jitter), self.across(last_column)];
            [top, bottom] = [self.up(-jitter), self.up(last_row)];
        }
        self.corners_of([left, right, bottom, top])
    }

    fn corners_of(&self, [left, right, bottom, top]: [f64; 4]) -> [Vec3; 4] {
        [self.point(left, bottom), self.point(right, bottom), self.point(left, top), self.point(right, top)]
    }

    /// From the eye to a point of the image plane.
    #[inline(always)]
    fn direction<L: Lanes>(&self, px: L, py: L) -> Vec3<L> {
        let [u, v, w] = self.axes;
        (w * self.near).splat() + u.splat() * px + v.splat() * py
    }

    #[inline(always)]
    fn point<L: Lanes>(&self, px: L, py: L) -> Vec3<L> {
        let [u, v, w] = self.axes;
        (self.eye + w * self.near).splat() + u.splat() * px + v.splat() * py
    }
}

/// How far along a row of `count` pixels: 0 at the first, 1 at the last, the middle where there is only one.
fn share(place: f64, count: u32) -> f64 {
    if count == 1 { 0.5 + place } else { place / f64::from(count - 1) }
}
