//! The first generation: the camera rays of a tile. They are made where they are needed, and never stored.

use super::carried::{Carried, CarriedByAll};
use super::queue::Generation;
use super::{Propagation, Tile, sampler};
use crate::geometry::{Sphere, Vec3, sphere};
use crate::lanes::{Columns, Lanes, Record, Row};
use crate::stage::{CameraFrame, JITTER};
use core::marker::PhantomData;

/// One ray for each pixel of a tile, row by row. They carry everything and come from nowhere.
#[derive(Clone, Debug)]
pub struct CameraRays<'a, P> {
    camera: &'a CameraFrame,
    /// For each pixel its place on the image plane: across and up.
    places: Columns<2>,
    /// The set of the solids in which they start.
    medium: u32,
    carried: CarriedByAll,
    /// The seed by which samples are spread; `None` where each is its pixel's point of the grid.
    jitter: Option<u32>,
    cone: Cone,
    propagation: PhantomData<P>,
}

/// A cone around all rays of a tile, with its tip in the eye.
#[derive(Clone, Copy, Debug, Default)]
struct Cone {
    axis: Vec3,
    /// Of the angle between its axis and its side.
    cos: f64,
    /// What may be lost in rounding, in scene units: rays pass the eye at this distance.
    off: f64,
    /// Distance of the image plane from the eye.
    near: f64,
}

impl<'a, P: Propagation> CameraRays<'a, P> {
    /// Of a camera that stands in these solids. Without a seed to spread them by, samples look through the points of the grid.
    pub fn new(camera: &'a CameraFrame, medium: u32, carried: CarriedByAll, jitter: Option<u32>) -> Self {
        let (places, cone) = (Columns::default(), Cone::default());
        Self { camera, places, medium, carried, jitter, cone, propagation: PhantomData }
    }

    /// Takes a sample of each pixel of a tile.
    pub fn aim(&mut self, tile: &Tile, sample: u32) {
        self.places.clear();
        self.places.resize(tile.pixel_count());
        let [across, up] = self.places.columns_mut();
        let width = tile.width as usize;
        let rows = across.chunks_mut(width).zip(up.chunks_mut(width));
        for ((across, up), y) in rows.zip(tile.rows()) {
            let Some(seed) = self.jitter else {
                up.fill(self.camera.up(y.into()));
                for (place, x) in across.iter_mut().zip(tile.columns()) {
                    *place = self.camera.across(x.into());
                }
                continue;
            };
            for ((across, up), x) in across.iter_mut().zip(up).zip(tile.columns()) {
                let [right, down] = sampler::offset(seed, [x, y], sample);
                (*across, *up) = (self.camera.across(f64::from(x) + right), self.camera.up(f64::from(y) + down));
            }
        }
        self.cone = Cone::around(self.camera, tile, if self.jitter.is_some() { JITTER } else { 0.0 });
    }
}

impl Cone {
    /// A cone that holds the four corners of a tile holds all between them, as it is convex.
    /// Samples are at most `jitter` of a pixel's width from its point of the grid.
    fn around(camera: &CameraFrame, tile: &Tile, jitter: f64) -> Self {
        let ends =
            |first: u32, count: u32| [f64::from(first) - jitter, f64::from(first + (count - 1) * tile.step) + jitter];
        let [left, right] = ends(tile.x, tile.width).map(|x| camera.across(x));
        let [top, bottom] = ends(tile.y, tile.height).map(|y| camera.up(y));
        let (middle, axis) = camera.rays::<f64>((left + right) * 0.5, (top + bottom) * 0.5);
        let corners = [(left, top), (right, top), (left, bottom), (right, bottom)];
        let cos =
            corners.map(|(across, up)| camera.rays::<f64>(across, up).1.dot(axis)).into_iter().fold(1.0, f64::min);
        // A point of the image plane is the sum of four vectors, each of a few roundings. Rays that start at the eye do not
        // pass it.
        let size = left.abs().max(right.abs()) + top.abs().max(bottom.abs());
        let lost = if camera.from_eye { 0.0 } else { camera.eye.length() + middle.length() + size };
        let off = 16.0 * f64::EPSILON * lost;
        Self { axis, cos, off, near: camera.near.abs() }
    }

    /// Can a ray in the cone meet the sphere? The angle between its axis and the centre is at most that of the cone plus that
    /// under which the sphere is seen: `cos φ >= cos(θ + ψ)`, `sin ψ = r/D`.
    fn may_meet(&self, eye: Vec3, sphere: &Sphere) -> bool {
        let to_center = sphere.center - eye;
        let (distance, radius) = (to_center.length(), sphere.radius * (1.0 + 2.0 * sphere::MARGIN) + 2.0 * self.off);
        let (sin_psi, sin_theta) = (radius / distance, (1.0 - self.cos * self.cos).max(0.0).sqrt());
        let cos_psi = (1.0 - sin_psi * sin_psi).max(0.0).sqrt();
        // The root loses half of the digits where angles are small; and rays have the direction that rounding left them.
        let slack = 1e-7 + self.off / self.near;
        let cos_phi = self.axis.dot(to_center) / distance;
        // All that is not surely outside may be met, also where a number is not one.
        let outside = sin_psi < 1.0 && self.cos > 0.0 && cos_phi < self.cos * cos_psi - sin_theta * sin_psi - slack;
        !outside
    }
}

impl<P: Propagation> Generation<P> for CameraRays<'_, P> {
    #[inline(always)]
    fn len(&self) -> usize {
        self.places.len()
    }

    #[inline(always)]
    fn counts(&self) -> [usize; 3] {
        [self.places.len(), 0, 0]
    }

    #[inline(always)]
    fn lines<L: Lanes>(&self, start: usize) -> (Vec3<L>, Vec3<L>) {
        let [across, up] = self.places.group(0, start);
        self.camera.rays(across, up)
    }

    #[inline(always)]
    fn sources<L: Lanes>(&self, _start: usize) -> L {
        L::splat(-1.0)
    }

    #[inline(always)]
    fn parents<L: Lanes>(&self, _start: usize) -> L {
        L::splat(0.0)
    }

    #[inline(always)]
    fn pixels<L: Lanes>(&self, start: usize) -> L {
        L::ramp(start)
    }

    #[inline(always)]
    fn travel<L: Lanes>(&self, _start: usize) -> Row<P::Travel, L> {
        P::from_camera(self.medium)
    }

    #[inline(always)]
    fn carried<L: Lanes, T: Record>(&self, _start: usize) -> Row<T, L> {
        self.carried.rows::<L, T>()
    }

    #[inline(always)]
    fn copy_carried<L: Lanes>(&self, mask: L::Mask, _start: usize, to: &mut Carried) {
        to.push_same::<L>(mask, &self.carried);
    }

    fn may_meet(&self, sphere: &Sphere) -> bool {
        self.cone.may_meet(self.camera.eye, sphere)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::trace::FirstSurface;
    use proptest::prelude::*;

    /// A camera that looks at a point, of 64 pixels by 64.
    fn frame(eye: [f64; 3], look_at: [f64; 3], bounds: [f64; 4], near: f64, from_eye: bool) -> CameraFrame {
        let w = (Vec3::from(eye) - Vec3::from(look_at)).unit();
        let u = Vec3::new(0.1, 1.0, 0.2).cross(w).unit();
        CameraFrame { eye: eye.into(), axes: [u, w.cross(u), w], bounds, size: [64, 64], near, from_eye }
    }

    /// The rays of a tile.
    fn through<'a>(camera: &'a CameraFrame, tile: &Tile, jitter: Option<u32>) -> CameraRays<'a, FirstSurface> {
        let mut rays = CameraRays::new(camera, 0, CarriedByAll::new::<()>(&()), jitter);
        rays.aim(tile, 3);
        rays
    }

    proptest! {
        /// No ray of a tile meets a sphere that its cone leaves out.
        #[test]
        fn the_cone_leaves_out_only_what_no_ray_meets(
            eye in prop::array::uniform3(-9.0..9.0f64),
            far in prop_oneof![Just(0.0), Just(1e4), Just(-1e9)],
            center in prop::array::uniform3(-9.0..9.0f64),
            radius in prop_oneof![1e-6..1e-3f64, 0.1..9.0f64],
            corner in prop::array::uniform2(0..60u32),
            near in -3.0..-0.1f64,
            jitter in prop::option::of(0..9u32),
            step in 1..5u32,
            from_eye in any::<bool>(),
        ) {
            let moved = |p: [f64; 3]| p.map(|c| c + far);
            let bounds = [-1.0, 2.0, -2.0, 1.0];
            let frame = frame(moved(eye), [far; 3], bounds, near, from_eye);
            prop_assume!(frame.has_image_plane());
            let tile = Tile { x: corner[0], y: corner[1], step, width: 1 + 3 / step, height: 1 + 2 / step };
            let sphere = Sphere { center: moved(center).into(), radius };
            let rays = through(&frame, &tile, jitter);
            for row in 0..rays.len() {
                let (origin, dir) = rays.lines::<f64>(row);
                let (t, meets) = sphere::intersect(origin, dir, sphere.center, radius);
                prop_assert!(rays.may_meet(&sphere) || !meets || t < 0.0);
            }
        }
    }

    #[test]
    fn a_cone_leaves_something_out() {
        let mut frame = frame([0.0, 0.0, 10.0], [0.0; 3], [-1.0, 1.0, -1.0, 1.0], -1.0, false);
        frame.axes = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Vec3::from);
        let rays = through(&frame, &Tile { x: 0, y: 0, step: 1, width: 16, height: 16 }, None);
        let may_meet = |center: Vec3, radius: f64| rays.may_meet(&Sphere { center, radius });
        assert!(!may_meet(Vec3::default(), 2.0));
        assert!(may_meet(Vec3::new(-8.0, 8.0, 0.0), 0.1));
        assert!(!may_meet(Vec3::new(8.0, -8.0, 20.0), 0.1), "behind the eye");
    }
}
