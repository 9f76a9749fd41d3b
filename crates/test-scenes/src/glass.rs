//! Glass, as real optics has it: nested, touching, overlapping, absorbing, in spheres and in meshes.

use crate::build::{Numbers, sphere, stage};
use snell::film::Rgb;
use snell::geometry::{TriangleMesh, tessellate};
use snell::scene::{Cuboid, Integrator, Lathe, Light, Material, Mesh, Plane, Scene, Shadows, Sky, Texture, Transform};
use snell::texture::Image;
use std::sync::Arc;

/// The stage with real optics, three glasses, and something to see through them.
fn stage_of_glass() -> Scene {
    let mut scene = stage(Integrator::Whitted);
    scene.background = Rgb::new(0.2, 0.3, 0.4);
    scene.render.max_depth = 8;
    scene.render.bands = 3;
    scene.render.min_throughput = 0.001;
    scene.render.shadows = Some(Shadows::Tinted);
    let clear = Material { ko: Rgb::gray(0.0), ..Material::default() };
    let green = Some(Rgb::new(0.5, 0.9, 0.6));
    let glasses = [
        ("crown", Material { eta: 1.5, ..clear.clone() }),
        ("water", Material { eta: 1.33, priority: 1, sigma_a: Some(Rgb::new(0.05, 0.01, 0.0)), ..clear.clone() }),
        ("flint", Material { eta: 1.8, attenuation_color: green, attenuation_distance: Some(8.0), ..clear.clone() }),
        (
            "milk",
            Material {
                eta: 1.4,
                ko: Rgb::gray(0.4),
                kd: Rgb::new(0.9, 0.8, 0.7),
                tinted_transmission: true,
                ..clear.clone()
            },
        ),
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
    scene.render.shadows = Some(Shadows::Opaque);
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

/// Thin panes, interfaces between media, planes, boxes and turned shapes with patterns, under a spot light and a gradient, with
/// several samples for each pixel.
pub fn windows() -> Scene {
    let mut scene = stage_of_glass();
    scene.background = Rgb::gray(0.0);
    scene.sky = Some(Sky {
        horizon: Some(Rgb::new(0.5, 0.4, 0.3)),
        zenith: Some(Rgb::new(0.1, 0.2, 0.5)),
        nadir: None,
        image: None,
        brightness: 1.0,
        rotate: 0.0,
        pixels: None,
    });
    (scene.render.spp, scene.render.seed) = (3, 5);
    let pane = Material { ko: Rgb::gray(0.0), eta: 1.5, thickness: Some(2.0), ..Material::default() };
    let film = Material {
        thickness: Some(0.0),
        sigma_a: Some(Rgb::gray(0.1)),
        tinted_transmission: true,
        ..scene.materials["milk"].clone()
    };
    scene.materials.extend([("pane".to_owned(), pane), ("film".to_owned(), film)]);
    let texels = (0..12).map(|i| [0.1 * i as f32, 0.5, 1.0 - 0.08 * i as f32]).collect();
    let image = Arc::new(Image::new(4, 3, texels).unwrap());
    let texture = |checker, pixels, repeat| Texture { checker, image: None, repeat, linear: false, pixels };
    scene.textures.insert("board".to_owned(), texture(Some([Rgb::gray(0.9), Rgb::gray(0.2)]), None, [7.0, 5.0]));
    scene.textures.insert("map".to_owned(), texture(None, Some(image), [2.0, 1.0]));
    for (name, texture) in [("board", "board"), ("map", "map")] {
        let texture = Some(texture.to_owned());
        let bright = Rgb::gray(1.0);
        scene.materials.insert(name.to_owned(), Material { texture, ka: bright, kd: bright, ..Material::default() });
    }
    let mut lamp = Light::at([50.0, 90.0, 80.0], Rgb::gray(0.8));
    (lamp.target, lamp.cone, lamp.edge) = (Some([50.0, 45.0, 50.0]), Some(30.0), Some(12.0));
    scene.lights.push(lamp);
    let turned =
        |degrees: f64, to: [f64; 3]| vec![Transform::Rotate { axis: [0.3, 1.0, 0.2], degrees }, Transform::Move(to)];
    let plane = |size: [f64; 2], material: &str, transform: Vec<Transform>| Plane {
        transform,
        ..Plane::new([0.0; 3], [0.0, 0.0, 1.0], size, material)
    };
    scene.planes.push(plane([60.0, 40.0], "board", turned(5.0, [50.0, 45.0, 20.0])));
    scene.planes.push(plane([14.0, 20.0], "pane", turned(50.0, [42.0, 45.0, 70.0])));
    let mut blinds = plane([4.0, 16.0], "film", turned(-30.0, [0.0; 3]));
    blinds.instances = [54.0, 57.0, 60.0].map(|x| vec![Transform::Move([x, 45.0, 68.0])]).into();
    scene.planes.push(blinds);
    // A block of water that ends at a block of flint: three interfaces.
    let side = |low: f64, high: f64, inside: &str, outside: Option<&str>| Lathe {
        name: None,
        profile: vec![[4.0, low], [4.0, high]],
        segments: 5,
        smooth_angle: 0.0,
        material: "crown".to_owned(),
        inside: Some(inside.to_owned()),
        outside: outside.map(str::to_owned),
        transform: turned(20.0, [56.0, 40.0, 50.0]),
        instances: vec![],
    };
    let disc = |profile: [[f64; 2]; 2], inside: &str, outside: Option<&str>| Lathe {
        profile: profile.to_vec(),
        ..side(0.0, 0.0, inside, outside)
    };
    scene.lathes = vec![
        side(0.0, 6.0, "flint", None),
        side(6.0, 11.0, "water", None),
        disc([[0.0, 0.0], [4.0, 0.0]], "flint", None),
        disc([[4.0, 6.0], [0.0, 6.0]], "flint", Some("water")),
        disc([[4.0, 11.0], [0.0, 11.0]], "water", None),
    ];
    scene.boxes.push(Cuboid {
        name: None,
        min: [-3.0; 3],
        max: [3.0, 5.0, 3.0],
        material: "map".to_owned(),
        transform: turned(35.0, [47.0, 42.0, 45.0]),
        instances: vec![],
    });
    let mut globe = sphere([0.0, 1.0, 0.0], 2.0, "map");
    globe.transform = vec![Transform::Scale([2.5; 3])];
    globe.instances = vec![turned(70.0, [40.0, 56.0, 55.0]), turned(-20.0, [52.0, 56.0, 60.0])];
    scene.spheres.push(globe);
    scene
}

/// A box of twelve triangles that look outward, without texture coordinates.
pub fn cuboid(min: [f64; 3], max: [f64; 3]) -> TriangleMesh {
    TriangleMesh { uvs: vec![], face_uvs: vec![], ..tessellate::cuboid(min.into(), max.into()) }
}
