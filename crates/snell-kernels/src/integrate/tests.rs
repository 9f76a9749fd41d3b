//! What it takes to add a model of light: this file, and nothing elsewhere.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use crate::color::Rgb;
use crate::geometry::bvh::{Bvh, Shapes, primitives::Primitives};
use crate::geometry::{Sphere, Vec3};
use crate::lanes::{Instructions, Kernel, Lanes, Mask, dispatch, record};
use crate::settings::{self, Settings, Shadows};
use crate::stage::{CameraFrame, CompiledMaterial, Stage, Surfaces};
use crate::trace::{Batch, Children, FirstSurface, Integrator, Most, RayKind, Tile, Tracer};
use alloc::sync::Arc;
use alloc::vec;
use alloc::vec::Vec;

record! {
    /// What a ray carries.
    Carried,
    /// Its columns.
    CarriedColumns { share: Rgb, }
}

/// Normals as colours: half of what is seen is the normal, the other half what a mirror would show.
#[derive(Clone, Copy, Debug)]
struct Normals;

impl Integrator for Normals {
    type Propagation = FirstSurface;
    type Carried = CarriedColumns;

    fn new(_settings: &Settings) -> Self {
        Self
    }

    fn from_camera<L: Lanes>() -> Carried<L> {
        Carried { share: Rgb::gray(1.0).splat() }
    }

    fn throughput<L: Lanes>(carried: &Carried<L>) -> Rgb<L> {
        carried.share
    }

    fn asks_for_light<L: Lanes>(_hits: &Batch<'_, L, FirstSurface>) -> L::Mask {
        L::Mask::from_bits(0)
    }

    #[inline(always)]
    fn scatter<L: Lanes>(
        self,
        hits: &Batch<'_, L, FirstSurface>,
        _state: &(),
        children: &mut Children<FirstSurface>,
    ) -> Rgb<L> {
        let (half, n) = (L::splat(0.5), hits.normal());
        let share = hits.carried::<CarriedColumns>().share * Rgb::new(half, half, half);
        let dir = crate::optics::snell::reflect(hits.wo(), n).unit();
        let mirror = hits.leaving(hits.point(), dir, ());
        children.push::<L, CarriedColumns>(RayKind::Mirror, hits.active, &mirror, &Carried { share });
        share * Rgb::new(n.x, n.y, n.z)
    }

    fn most(_material: &CompiledMaterial, _brightest: Rgb) -> Most {
        Most { local: Rgb::gray(0.0), children: Rgb::gray(0.5) }
    }
}

/// The pixels of a picture of five pixels in a row.
struct Row<'a>(&'a Stage, &'a Settings);

impl Kernel for Row<'_> {
    type Output = Vec<Rgb>;
    #[inline(always)]
    fn run<L: Lanes>(self) -> Vec<Rgb> {
        let mut tracer = Tracer::<L, (), Normals>::new(self.0, self.1, None, ());
        tracer.trace(&Tile { x: 0, y: 0, step: 1, width: 5, height: 1 }, 0..1).unwrap().sum().to_vec()
    }
}

#[test]
fn normals_as_colours() {
    // Through the middle of two balls that see each other: forth and back until the depth limit.
    let [x, y, z] = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]].map(Vec3::from);
    let (eye, bounds) = (Vec3::new(0.0, 0.0, 3.0), [-4.0, 4.0, -1.0, 1.0]);
    let camera = CameraFrame { eye, axes: [x, y, z], bounds, size: [5, 1], near: -3.0, from_eye: false };
    let balls = [-2.0, 8.0].map(|z| Sphere { center: Vec3::new(0.0, 0.0, z), radius: 1.0 });
    let shapes = Shapes { spheres: &balls, ..Shapes::default() };
    let tree = Arc::new(Bvh::new(Vec::new(), Primitives::default(), 0, &shapes, Vec::new()));
    let mut stage =
        Stage { spheres: balls.to_vec(), materials: vec![CompiledMaterial::BLACK], tree, ..Stage::new(camera) };
    stage.surfaces = Arc::new(Surfaces { material_of: vec![0; balls.len()], ..Surfaces::default() });
    let settings = Settings {
        integrator: settings::Integrator::Lecture,
        max_depth: 2,
        shadows: Shadows::Off,
        spp: 1,
        seed: 0,
        min_throughput: 0.0,
    };
    for lanes in [1, 2, 4, 8] {
        let pixels = dispatch(lanes, Instructions::default(), Row(&stage, &settings));
        // ½·z, then ¼·(−z) from the ball behind the camera, then ⅛·z.
        assert_eq!(pixels[2], Rgb::new(0.0, 0.0, 0.5 - 0.25 + 0.125));
        assert_eq!((pixels[0], pixels[4]), (Rgb::gray(0.0), Rgb::gray(0.0)), "beside them is nothing");
    }
}
