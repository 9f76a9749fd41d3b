//! Light on its way to a surface: through plates of glass, and from lamps that stand on something.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod common;

use common::{ball, furnace, glass, mesh, tree};
use snell::film::Rgb;
use snell::geometry::{Affine, TriangleMesh, Vec3};
use snell::optics::fresnel::fresnel_dielectric;
use snell::optics::thin::slab;
use snell::scene::{Integrator, Light, Material, Mesh, Plane, Scene, Shadows, Transform, WarningCode};
use snell::world::World;
use snell_test_scenes::glass::cuboid;
use std::sync::Arc;

/// Absorption times thickness of the plate whose picture the documentation has.
const DEPTH: f64 = 0.5;
const ETA: f64 = 1.5;

/// A white floor under nothing yet, lit from straight above.
fn floor() -> Scene {
    let mut scene = furnace(1);
    scene.background = Rgb::gray(0.0);
    scene.materials.insert("white".to_owned(), Material { kd: Rgb::gray(1.0), ..Material::default() });
    scene.planes.push(Plane::new([0.0, -20.0, 0.0], [0.0, 1.0, 0.0], [40.0, 40.0], "white"));
    scene.lights = vec![Light::from_direction([0.0, 1.0, 0.0], Rgb::gray(1.0))];
    glass(&mut scene, "glass", ETA, 0);
    scene
}

fn tinted(scene: &mut Scene, depth: f64) {
    scene.materials["glass"].sigma_a = Some(Rgb::gray(depth));
}

/// How a plate of thickness 1 is turned, so that the light meets it at this angle.
fn turned(degrees: f64) -> Affine {
    Affine::rotation(Vec3::new(1.0, 0.0, 0.0), degrees).unwrap()
}

fn plate() -> TriangleMesh {
    cuboid([-9.0, -0.5, -9.0], [9.0, 0.5, 9.0])
}

/// What of the light reaches the floor in its middle.
fn passed(scene: &Scene) -> f64 {
    // Beside the middle, where no edge of two triangles is.
    tree(scene, [0.3, -19.9, 0.2], [0.0, -1.0, 0.0]).sum().r
}

/// What a plate lets through: over the refracted way with two faces, the same with all inner reflections, and over the straight
/// way.
fn expected(degrees: f64, depth: f64) -> [f64; 3] {
    let (sin, cos) = libm::sincos(degrees.to_radians());
    let r = fresnel_dielectric(cos, ETA);
    let tau = libm::exp(-depth / (1.0 - (sin / ETA) * (sin / ETA)).sqrt());
    let faces = (1.0 - r) * (1.0 - r);
    [faces * tau, slab(r, tau)[1], faces * libm::exp(-depth / cos)]
}

#[test]
fn a_plate_absorbs_over_the_refracted_way() {
    // By the straight way 0.305 of the light passes the plate at 60 degrees: that says how much it absorbs.
    let r = fresnel_dielectric(0.5, ETA);
    let depth = 0.5 * libm::log((1.0 - r) * (1.0 - r) / 0.305);
    for (found, known) in expected(60.0, depth).into_iter().zip([0.4495, 0.4506, 0.305]) {
        // Four digits are known.
        assert!((found - known).abs() < 5e-5, "{found} for {known}");
    }
    for degrees in [0.0, 30.0, 60.0, 80.0] {
        let mut scene = floor();
        tinted(&mut scene, depth);
        mesh(&mut scene, plate().transformed(&turned(degrees)), "glass");
        let (found, [known, ..]) = (passed(&scene), expected(degrees, depth));
        // Hits are good to a clearance, 1e-12 here, of a way of at least 1; at 80 degrees that is 6 times as long.
        assert!((found - known).abs() < 1e-11, "{found} for {known} at {degrees}");
    }
}

/// The plate at 60 degrees in all the forms in which it may come.
#[test]
fn a_plate_is_a_plate_whatever_it_is_made_of() {
    let [known, _, straight] = expected(60.0, DEPTH);
    let plate = plate().transformed(&turned(60.0));
    let with = |change: &dyn Fn(&mut Scene)| {
        let mut scene = floor();
        tinted(&mut scene, DEPTH);
        change(&mut scene);
        passed(&scene)
    };
    // As a file in single precision has it.
    let single = |mut mesh: TriangleMesh| {
        for v in &mut mesh.vertices {
            *v = Vec3::from([v.x, v.y, v.z].map(|x| f64::from(x as f32)));
        }
        mesh
    };
    let found = with(&|scene| mesh(scene, single(plate.clone()), "glass"));
    // Its faces turn by 1e-7, the step of single precision, over ways of 1.2.
    assert!((found - known).abs() < 1e-6, "single precision: {found} for {known}");
    // With normals smoothed, which are those of its faces.
    let found = with(&|scene| {
        mesh(scene, plate.clone(), "glass");
        scene.meshes[0].smooth_angle = 30.0;
    });
    assert!((found - known).abs() < 1e-11, "smoothed: {found} for {known}");
    // In a place of its own, turned and scaled there.
    let found = with(&|scene| {
        let small = cuboid([-90.0, -1.0, -90.0], [90.0, 1.0, 90.0]);
        let (geometry, material) = (Some(Arc::new(small)), Some("glass".to_owned()));
        let place = vec![Transform::Scale([0.1, 0.5, 0.1]), Transform::Rotate { axis: [1.0, 0.0, 0.0], degrees: 60.0 }];
        scene.meshes.push(Mesh { geometry, material, instances: vec![place], ..Mesh::default() });
    });
    assert!((found - known).abs() < 1e-11, "placed: {found} for {known}");
    // As two plates of half the thickness, with a gap of air, and touching; and in water, which is denser than air.
    for gap in [0.25f64, 0.0] {
        let found = with(&|scene| {
            for side in [-1.0, 1.0] {
                let [near, far] = [gap / 2.0, gap / 2.0 + 0.5].map(|y| side * y);
                let half = cuboid([-9.0, near.min(far), -9.0], [9.0, near.max(far), 9.0]);
                mesh(scene, half.transformed(&turned(60.0)), "glass");
            }
        });
        // Four faces instead of two.
        let r = fresnel_dielectric(0.5, ETA);
        let known = if gap > 0.0 { known * (1.0 - r) * (1.0 - r) } else { known };
        assert!((found - known).abs() < 1e-11, "gap {gap}: {found} for {known}");
    }
    // Between clear layers of another index the way in the middle bends as if they were not there.
    let found = with(&|scene| {
        glass(scene, "flint", 1.8, 0);
        for (low, high, material) in [(-0.9, -0.5, "flint"), (-0.5, 0.5, "glass"), (0.5, 0.7, "flint")] {
            mesh(scene, cuboid([-9.0, low, -9.0], [9.0, high, 9.0]).transformed(&turned(60.0)), material);
        }
    });
    let [outer, inner] =
        [fresnel_dielectric(0.5, 1.8), fresnel_dielectric(0.5, 1.8 / ETA)].map(|r| (1.0 - r) * (1.0 - r));
    let r = fresnel_dielectric(0.5, ETA);
    let sandwich = known / ((1.0 - r) * (1.0 - r)) * outer * inner;
    assert!((found - sandwich).abs() < 1e-11, "between flint: {found} for {sandwich}");
    // A wedge of a tenth of a degree is none: straight on, and the length between its faces is another by 2e-3 at most.
    let found = with(&|scene| {
        let mut wedge = cuboid([-9.0, -0.5, -9.0], [9.0, 0.5, 9.0]);
        for v in wedge.vertices.iter_mut().filter(|v| v.y > 0.0) {
            v.y += v.z * libm::tan(0.1f64.to_radians());
        }
        mesh(scene, wedge.transformed(&turned(60.0)), "glass");
    });
    assert!((found - straight).abs() < 5e-3, "a wedge: {found} for {straight}");
}

/// No size and no place is another.
#[test]
fn plates_of_all_sizes_let_the_same_light_through() {
    let [known, ..] = expected(60.0, DEPTH);
    for (factor, offset) in [(1e-9, 0.0), (1e9, 0.0), (1.0, 1e6)] {
        let mut scene = floor();
        tinted(&mut scene, DEPTH / factor);
        let map = turned(60.0).then(Affine::scaling(Vec3::new(factor, factor, factor)));
        let map = map.then(Affine::translation(Vec3::new(offset, offset, offset)));
        mesh(&mut scene, plate().transformed(&map), "glass");
        let at = |p: [f64; 3]| p.map(|c| c * factor + offset);
        scene.planes = vec![Plane::new(at([0.0, -3.0, 0.0]), [0.0, 1.0, 0.0], [40.0 * factor; 2], "white")];
        scene.render.size = [1, 1];
        let bounds = [-factor, factor, -factor, factor];
        scene.camera = snell::scene::Camera::new(
            at([0.3, -2.8, 0.2]),
            at([0.3, -3.0, 0.2]),
            [0.0, 0.0, 1.0],
            bounds,
            -0.1 * factor,
        );
        let found = common::traced(&scene, &World::new(&scene).unwrap(), 0, 0).0.r;
        // Far away coordinates are known to 1e-10, and the normals of the plate as well.
        let tolerance = if offset == 0.0 { 1e-11 } else { 1e-8 };
        assert!((found - known).abs() < tolerance, "{found} for {known}, times {factor} plus {offset}");
    }
}

/// The table of the documentation is what the engine draws, and what is true.
#[test]
fn the_published_error_of_tinted_shadows_is_that_of_plates() {
    let page = include_str!("../../../docs/models.md");
    let number = |cell: &str| cell.trim().trim_end_matches(['°', '%', ' ']).replace('−', "-").parse::<f64>().unwrap();
    let mut count = 0;
    for line in page.lines().filter(|line| line.contains('°') && line.matches('|').count() == 9) {
        let cells: Vec<f64> = line.split('|').skip(1).take(8).map(number).collect();
        let degrees = cells[0];
        for (depth, cells) in [(0.0, &cells[1..4]), (DEPTH, &cells[4..7])] {
            let mut scene = floor();
            tinted(&mut scene, depth);
            mesh(&mut scene, plate().transformed(&turned(degrees)), "glass");
            let (drawn, [_, exact, _]) = (passed(&scene), expected(degrees, depth));
            // Four digits are printed, and of percent one.
            assert!((drawn - cells[0]).abs() < 5e-5 && (exact - cells[1]).abs() < 5e-5, "{line}");
            assert!((100.0 * (drawn / exact - 1.0) - cells[2]).abs() < 0.05, "{line}");
        }
        let [_, exact, straight] = expected(degrees, DEPTH);
        assert!((100.0 * (straight / exact - 1.0) - cells[7]).abs() < 0.05, "{line}");
        count += 1;
    }
    assert_eq!(count, 4);
}

#[test]
fn glass_has_no_black_shadow_unless_it_is_asked_for() {
    let mut scene = floor();
    mesh(&mut scene, plate(), "glass");
    assert!(passed(&scene) > 0.9, "tinted where nothing is said");
    scene.render.shadows = Some(Shadows::Opaque);
    assert_eq!(passed(&scene), 0.0);
    (scene.render.shadows, scene.render.integrator) = (None, Integrator::Lecture);
    assert_eq!(passed(&scene), 0.0, "the lecture's shadows are black behind glass");
}

/// A lamp with a light, `away` beyond its surface, at some scale.
fn lamp(scale: f64, away: f64, shape: &str) -> Scene {
    let mut scene = floor();
    scene.planes[0] = Plane::new([0.0, -3.0 * scale, 0.0], [0.0, 1.0, 0.0], [40.0 * scale; 2], "white");
    let camera = snell::scene::Camera::new([0.0, 0.0, 10.0], [0.0; 3], [0.0, 1.0, 0.0], [-2.0, 2.0, -2.0, 2.0], -5.0);
    scene.camera = snell::scene::Camera {
        eye: camera.eye.map(|c| c * scale),
        bounds: camera.bounds.map(|bounds| bounds.map(|b| b * scale)),
        near: camera.near.map(|near| near * scale),
        ..camera
    };
    // Where the surface is: a third along, which is no number that rounds well.
    let third = scale / 3.0;
    match shape {
        "sphere" => {
            ball(&mut scene, [0.0; 3], third, "white");
            scene.spheres[0].name = Some("bulb".to_owned());
        }
        "placed" => {
            let (geometry, material) = (Some(Arc::new(cuboid([-1.0; 3], [1.0; 3]))), Some("white".to_owned()));
            let scaling = vec![Transform::Scale([third; 3])];
            let instances = vec![vec![Transform::Scale([third; 3]), Transform::Move([9.0 * scale, 0.0, 0.0])], scaling];
            scene.meshes.push(Mesh { name: Some("bulb".to_owned()), geometry, material, instances, ..Mesh::default() });
        }
        _ => {
            mesh(&mut scene, cuboid([-third; 3], [third; 3]), "white");
            scene.meshes[0].name = Some("bulb".to_owned());
        }
    }
    let name = Some("lamp".to_owned());
    scene.lights.push(Light { name, ..Light::at([0.0, third + away, 0.0], Rgb::gray(1.0)) });
    scene
}

#[test]
fn a_light_on_the_surface_of_its_own_lamp_is_told() {
    let warnings = |scene: &Scene| {
        let warnings = World::new(scene).unwrap().warnings;
        warnings.into_iter().filter(|w| w.code == WarningCode::LightOnSurface).collect::<Vec<_>>()
    };
    for scale in [1e-9, 1.0, 1e9] {
        for shape in ["sphere", "mesh", "placed"] {
            for away in [0.0, 1e-16 * scale] {
                let found = warnings(&lamp(scale, away, shape));
                assert_eq!(found.len(), 1, "{shape} at {scale:e}: {found:?}");
                let message = &found[0].message;
                assert!(message.contains("`lamp`") && message.contains("`bulb`"), "{message}");
            }
            // The scene is some 60 units large.
            for away in [6e-8, -6e-8, 0.01] {
                assert_eq!(warnings(&lamp(scale, away * scale, shape)), [], "{shape} at {scale:e}, {away} away");
            }
        }
    }
    // How far, and where in the scene.
    let found = warnings(&lamp(1.0, 4.0 * f64::EPSILON, "mesh")).remove(0);
    assert!(found.message.contains(": 8.8"), "4 times 2.22e-16: {}", found.message);
    assert_eq!(
        snell::scene::Problem { place: found.place, message: String::new(), help: None, remedy: None }.to_string(),
        "light[1].position: "
    );
    // Nobody's business where there are no shadows.
    let mut scene = lamp(1.0, 0.0, "sphere");
    scene.render.shadows = Some(Shadows::Off);
    assert_eq!(warnings(&scene), []);
    // But in all models of light.
    (scene.render.shadows, scene.render.integrator) = (None, Integrator::Lecture);
    assert_eq!(warnings(&scene).len(), 1);
    scene.lights[1].name = None;
    assert!(warnings(&scene)[0].message.contains("`light 2`"));
    // A light at infinity is nowhere, and a sphere without a size is nothing.
    scene.lights[1] = Light::from_direction([0.0, 1.0 / 3.0, 0.0], Rgb::gray(1.0));
    assert_eq!(warnings(&scene), []);
    scene.lights[1] = Light::at([0.0; 3], Rgb::gray(1.0));
    scene.spheres[0].radius = 0.0;
    assert_eq!(warnings(&scene), []);
}

/// Two plates of dispersive glass in a white room, between which light goes to and fro until a ray carries too little. Into
/// however many bands it splits: each ray may carry as little of its band as a white one of white.
#[test]
fn a_ray_of_a_band_ends_where_a_white_one_would() {
    let mean = |bands: u32| {
        let mut scene = furnace(2);
        (scene.render.bands, scene.render.min_throughput) = (bands, 0.0015);
        let glass = Material { ko: Rgb::gray(0.0), glass: Some("SF11".to_owned()), ..Material::default() };
        scene.materials.insert("glass".to_owned(), glass);
        for z in [0.0, 0.5] {
            let plate = cuboid([-9.0, -9.0, z], [9.0, 9.0, z + 0.3]);
            mesh(&mut scene, plate.transformed(&turned(40.0)), "glass");
        }
        let film = common::picture(&scene);
        film.pixels.iter().map(|c| c.mean()).sum::<f64>() / film.pixels.len() as f64
    };
    let white = mean(1);
    assert!((white - 0.988).abs() < 1e-3, "a threshold that takes something: {white}");
    for bands in [2, 16, 64] {
        let found = mean(bands);
        // As its index is another, a band may end a bounce before white does: less than the threshold, and few ways are so
        // near to it. Compared with the whole of white, 16 bands would leave 0.967 and 64 bands 0.938.
        assert!((found - white).abs() < 1e-3, "{found} with {bands} bands, {white} with white");
    }
}
