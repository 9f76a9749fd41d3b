//! The first generation: the camera rays of a tile. They are made where they are needed, and never stored.

use super::lecture::T_MIN;
use super::media::{Media, OUTSIDE, WHITE};
use super::queue::{Generation, Load, Weight};
use super::sampler;
use crate::film::{Crop, Rgb};
use crate::geometry::{Sphere, Vec3, sphere};
use crate::lanes::{Columns, Lanes};
use crate::scene::Integrator;
use crate::world::{CameraFrame, World};

/// One ray for each pixel of a tile, row by row. They carry everything and come from nowhere.
#[derive(Clone, Debug)]
pub(crate) struct CameraRays<'a> {
    camera: &'a CameraFrame,
    /// For each pixel its place on the image plane: across and up.
    places: Columns<2>,
    /// The set of the solids in which they start.
    medium: f64,
    /// No hit nearer than this counts.
    t_min: f64,
    /// The seed by which samples are spread; `None` where each is its pixel's point of the grid.
    spread: Option<u32>,
    cone: Cone,
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

impl<'a> CameraRays<'a> {
    pub fn new(world: &'a World) -> Self {
        let t_min = if world.render.integrator == Integrator::Whitted { 0.0 } else { T_MIN };
        let spread = (world.render.spp > 1).then_some(world.render.seed);
        let (places, cone) = (Columns::default(), Cone::default());
        Self { camera: &world.camera, places, medium: f64::from(OUTSIDE), t_min, spread, cone }
    }

    /// Takes a sample of each pixel of a tile.
    pub fn aim(&mut self, tile: &Crop, sample: u32, media: &Media<'_>) {
        self.medium = f64::from(media.eye());
        self.place(tile, sample);
    }

    fn place(&mut self, tile: &Crop, sample: u32) {
        self.places.clear();
        self.places.resize(tile.width as usize * tile.height as usize);
        let [across, up] = self.places.columns_mut();
        let rows = across.chunks_mut(tile.width as usize).zip(up.chunks_mut(tile.width as usize));
        for (y, (across, up)) in (tile.y..).zip(rows) {
            let Some(seed) = self.spread else {
                up.fill(self.camera.up(y.into()));
                for (x, place) in (tile.x..).zip(across) {
                    *place = self.camera.across(x.into());
                }
                continue;
            };
            for (x, (across, up)) in (tile.x..).zip(across.iter_mut().zip(up)) {
                let [right, down] = sampler::offset(seed, [x, y], sample);
                (*across, *up) = (self.camera.across(f64::from(x) + right), self.camera.up(f64::from(y) + down));
            }
        }
        self.cone = Cone::around(self.camera, tile);
    }
}

impl Cone {
    /// A cone that holds the four corners of a tile holds all between them, as it is convex.
    fn around(camera: &CameraFrame, tile: &Crop) -> Self {
        let ends = |start: u32, length: u32| {
            [f64::from(start) - camera.spread(), f64::from(start + (length - 1)) + camera.spread()]
        };
        let [left, right] = ends(tile.x, tile.width).map(|x| camera.across(x));
        let [top, bottom] = ends(tile.y, tile.height).map(|y| camera.up(y));
        let (middle, axis) = camera.rays::<f64>((left + right) * 0.5, (top + bottom) * 0.5);
        let corners = [(left, top), (right, top), (left, bottom), (right, bottom)];
        let cos =
            corners.map(|(across, up)| camera.rays::<f64>(across, up).1.dot(axis)).into_iter().fold(1.0, f64::min);
        // A point of the image plane is the sum of four vectors, each of a few roundings. Rays that start at the eye do not
        // pass it.
        let size = left.abs().max(right.abs()) + top.abs().max(bottom.abs());
        let lost = if camera.starts_at_eye() { 0.0 } else { camera.eye.length() + middle.length() + size };
        let off = 16.0 * f64::EPSILON * lost;
        Self { axis, cos, off, near: camera.near().abs() }
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

impl Generation for CameraRays<'_> {
    #[inline(always)]
    fn len(&self) -> usize {
        self.places.len()
    }

    #[inline(always)]
    fn counts(&self) -> [usize; 3] {
        [self.len(), 0, 0]
    }

    #[inline(always)]
    fn ways<L: Lanes>(&self, start: usize) -> (Vec3<L>, Vec3<L>) {
        let [across, up] = self.places.group(0, start);
        self.camera.rays(across, up)
    }

    #[inline(always)]
    fn loads<L: Lanes>(&self, start: usize) -> Load<L> {
        let white = Rgb::gray(1.0).splat();
        Load {
            weight: Weight { attenuation: white, factor: white },
            t_min: L::splat(self.t_min),
            source: L::splat(-1.0),
            parent: L::splat(0.0),
            pixel: L::ramp(start),
            medium: L::splat(self.medium),
            band: L::splat(f64::from(WHITE)),
            back: Vec3::default().splat(),
        }
    }

    #[inline(always)]
    fn pixel(&self, row: usize) -> usize {
        row
    }

    fn may_meet(&self, sphere: &Sphere) -> bool {
        self.cone.may_meet(self.camera.eye, sphere)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scene::{Camera, Render};
    use proptest::prelude::*;

    /// The rays of a tile, of a camera without a world.
    fn through<'a>(camera: &'a CameraFrame, tile: &Crop) -> CameraRays<'a> {
        let spread = (camera.spread() > 0.0).then_some(5);
        let (places, cone) = (Columns::default(), Cone::default());
        let mut rays = CameraRays { camera, places, medium: 0.0, t_min: 0.0, spread, cone };
        rays.place(tile, 3);
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
            spp in 1..3u32,
            integrator in prop::sample::select(vec![Integrator::Lecture, Integrator::Whitted]),
        ) {
            let moved = |p: [f64; 3]| p.map(|c| c + far);
            let bounds = [-1.0, 2.0, -2.0, 1.0];
            let camera = Camera::new(moved(eye), [far; 3], [0.1, 1.0, 0.2], bounds, near);
            let frame = CameraFrame::new(&camera, &Render { spp, ..Render::new(integrator, [64, 64]) });
            prop_assume!(frame.has_image_plane());
            let rays = through(&frame, &Crop { x: corner[0], y: corner[1], width: 4, height: 3 });
            let sphere = Sphere { center: moved(center).into(), radius };
            for row in 0..rays.len() {
                let (origin, dir) = rays.ways::<f64>(row);
                let (t, meets) = sphere::intersect(origin, dir, sphere.center, radius);
                prop_assert!(rays.may_meet(&sphere) || !meets || t < 0.0);
            }
        }
    }

    #[test]
    fn a_cone_leaves_something_out() {
        let camera = Camera::new([0.0, 0.0, 10.0], [0.0; 3], [0.0, 1.0, 0.0], [-1.0, 1.0, -1.0, 1.0], -1.0);
        let frame = CameraFrame::new(&camera, &Render::new(Integrator::Lecture, [64, 64]));
        let rays = through(&frame, &Crop { x: 0, y: 0, width: 16, height: 16 });
        assert!(!rays.may_meet(&Sphere { center: Vec3::default(), radius: 2.0 }));
        assert!(rays.may_meet(&Sphere { center: Vec3::new(-8.0, 8.0, 0.0), radius: 0.1 }));
        assert!(!rays.may_meet(&Sphere { center: Vec3::new(8.0, -8.0, 20.0), radius: 0.1 }), "behind the eye");
    }
}
