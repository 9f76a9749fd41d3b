//! Glass, as real optics has it: nested, touching, overlapping, absorbing, in spheres and in meshes.

use crate::build::{Numbers, sphere, stage};
use snell::film::Rgb;
use snell::geometry::{TriangleMesh, Vec3};
use snell::scene::{Integrator, Material, Mesh, Scene, Shadows, Transform};
use std::sync::Arc;

/// The stage with real optics, three glasses, and something to see through them.
fn stage_of_glass() -> Scene {
    let mut scene = stage(Integrator::Whitted);
    scene.background = Rgb::new(0.2, 0.3, 0.4);
    scene.render.max_depth = 8;
    scene.render.bands = 3;
    scene.render.min_throughput = 0.001;
    scene.render.shadows = Shadows::Tinted;
    let clear = Material { ko: Rgb::gray(0.0), ..Material::default() };
    let green = Some(Rgb::new(0.5, 0.9, 0.6));
    let glasses = [
        ("crown", Material { eta: 1.5, ..clear.clone() }),
        ("water", Material { eta: 1.33, priority: 1, sigma_a: Some(Rgb::new(0.05, 0.01, 0.0)), ..clear.clone() }),
        ("flint", Material { eta: 1.8, attenuation_color: green, attenuation_distance: Some(8.0), ..clear.clone() }),
        ("milk", Material { eta: 1.4, ko: Rgb::gray(0.4), kd: Rgb::new(0.9, 0.8, 0.7), dyed: true, ..clear.clone() }),
        ("nothing", clear.clone()),
        ("prism", Material { glass: Some("SF11".to_owned()), ..clear }),
        ("lamp", Material { emission: Rgb::new(0.9, 0.8, 0.5), ..Material::default() }),
    ];
    scene.materials.extend(glasses.map(|(name, material)| (name.to_owned(), material)));
    scene
}

const GLASSES: [&str; 6] = ["crown", "water", "flint", "milk", "nothing", "prism"];

/// Spheres of all glasses in and through each other, and the camera within two of them.
pub fn bubbles() -> Scene {
    let (mut scene, mut numbers) = (stage_of_glass(), Numbers(31));
    for i in 0..60 {
        let name = if i % 7 == 6 { "red" } else { GLASSES[i % 6] };
        scene.spheres.push(sphere(numbers.point(60.0), 2.0 + 6.0 * numbers.next(), name));
    }
    // One in the other, sharing a point of their surfaces, or all of it.
    for (center, radius, glass) in
        [(50.0, 9.0, "crown"), (51.0, 8.0, "water"), (50.0, 9.0, "flint"), (50.0, 3.0, "lamp")]
    {
        scene.spheres.push(sphere([center, 50.0, 70.0], radius, glass));
    }
    let eye = scene.camera.eye;
    scene.spheres.push(sphere(eye, 8.0, "water"));
    scene.spheres.push(sphere([eye[0], eye[1], eye[2] - 6.0], 3.0, "crown"));
    scene
}

/// A few spheres, for whose shadows no tree is asked.
pub fn marbles() -> Scene {
    let mut scene = stage_of_glass();
    scene.render.shadows = Shadows::Opaque;
    for (i, glass) in GLASSES.into_iter().enumerate() {
        scene.spheres.push(sphere([36.0 + 7.0 * i as f64, 45.0 + 3.0 * i as f64, 60.0], 5.0, glass));
    }
    scene.spheres.push(sphere([50.0, 50.0, 30.0], 9.0, "red"));
    scene
}

/// Boxes of all glasses: standing on each other and on an opaque ground, with faces, edges and corners in common and through
/// each other; and one that stands in several places.
pub fn blocks() -> Scene {
    let mut scene = stage_of_glass();
    let mut add = |min: [f64; 3], max: [f64; 3], material: &str| {
        let geometry = Some(Arc::new(cuboid(min, max)));
        scene.meshes.push(Mesh { geometry, material: Some(material.to_owned()), ..Mesh::default() });
    };
    add([20.0, 30.0, 20.0], [80.0, 34.0, 80.0], "blue");
    add([40.0, 34.0, 50.0], [50.0, 44.0, 60.0], "crown");
    add([50.0, 34.0, 50.0], [60.0, 44.0, 60.0], "flint");
    add([44.0, 44.0, 50.0], [54.0, 54.0, 60.0], "water");
    add([42.0, 42.0, 48.0], [52.0, 52.0, 58.0], "flint");
    add([60.0, 44.0, 60.0], [66.0, 50.0, 66.0], "milk");
    add([30.0, 34.0, 62.0], [38.0, 42.0, 70.0], "nothing");
    let place = |x: f64, scale: f64| {
        let turn = Transform::Rotate { axis: [1.0, 2.0, 0.5], degrees: 40.0 };
        vec![Transform::Scale([scale, 1.0, 1.0]), turn, Transform::Move([x, 58.0, 55.0])]
    };
    scene.meshes.push(Mesh {
        geometry: Some(Arc::new(cuboid([-3.0; 3], [3.0; 3]))),
        material: Some("crown".to_owned()),
        instances: vec![place(38.0, 1.0), place(50.0, -1.5), place(62.0, 0.5)],
        ..Mesh::default()
    });
    scene.spheres.push(sphere([46.0, 39.0, 55.0], 2.5, "water"));
    scene.spheres.push(sphere([50.0, 50.0, 20.0], 12.0, "red"));
    scene
}

/// A box of twelve triangles that look outward.
pub fn cuboid(min: [f64; 3], max: [f64; 3]) -> TriangleMesh {
    let corner = |i: u32| {
        let pick = |axis: usize| if i >> axis & 1 == 0 { min[axis] } else { max[axis] };
        Vec3::new(pick(0), pick(1), pick(2))
    };
    let sides = [[0, 2, 3, 1], [4, 5, 7, 6], [0, 1, 5, 4], [2, 6, 7, 3], [0, 4, 6, 2], [1, 3, 7, 5]];
    let faces = sides.iter().flat_map(|&[a, b, c, d]| [[a, b, c], [a, c, d]]).collect();
    TriangleMesh { vertices: (0..8).map(corner).collect(), faces, ..TriangleMesh::default() }
}
