//! What it takes to add a model of light: this file, and nothing elsewhere.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use crate::color::Rgb;
use crate::lanes::{Kernel, LaneWidth, Lanes, Mask, dispatch, record};
use crate::scene::{self, Camera, Material, Render, Scene, Sphere};
use crate::trace::{Batch, Children, FirstSurface, Integrator, Most, RayKind, Settings, Tile, Tracer};
use crate::world::{CompiledMaterial, World};

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
struct Row<'a>(&'a World, &'a Settings);

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
    let camera = Camera::new([0.0, 0.0, 3.0], [0.0; 3], [0.0, 1.0, 0.0], [-4.0, 4.0, -1.0, 1.0], -3.0);
    let scene = Scene {
        materials: [("any".to_owned(), Material::default())].into(),
        spheres: vec![Sphere::new([0.0, 0.0, -2.0], 1.0, "any"), Sphere::new([0.0, 0.0, 8.0], 1.0, "any")],
        ..Scene::new(Render { max_depth: 2, ..Render::new(scene::Integrator::Lecture, [5, 1]) }, camera)
    };
    let (world, settings) = (World::new(&scene).unwrap(), Settings::of(&scene));
    for width in LaneWidth::ALL {
        let pixels = dispatch(width, Row(&world, &settings));
        // ½·z, then ¼·(−z) from the ball behind the camera, then ⅛·z.
        assert_eq!(pixels[2], Rgb::new(0.0, 0.0, 0.5 - 0.25 + 0.125));
        assert_eq!((pixels[0], pixels[4]), (Rgb::gray(0.0), Rgb::gray(0.0)), "beside them is nothing");
    }
}
