//! Faces that are no surface of a solid: thin panes and interfaces between media, and solids that overlap.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod common;

use common::{alike, ball, furnace, glass, mesh, picture, straight_through, traced, tree};
use snell::film::Rgb;
use snell::geometry::{TriangleMesh, Vec3};
use snell::render::{Options, Settings, render};
use snell::scene::{Lathe, Material, Mesh, Plane, Scene, Shadows};
use snell::trace::RayKind;
use snell::world::World;
use snell_test_scenes::glass::cuboid;
use std::sync::Arc;

fn pane(scene: &mut Scene, eta: f64, thickness: f64) {
    let material = Material { ko: Rgb::gray(0.0), eta, thickness: Some(thickness), ..Material::default() };
    scene.materials.insert("pane".to_owned(), material);
}

/// One thin face does what two real ones do: the same line behind it, the same share through it and back.
#[test]
fn a_thin_face_is_a_slab_of_two() {
    for (eta, thickness, degrees) in [(1.5f64, 0.3, 0.0f64), (1.5, 0.3, 37.0), (1.33, 2.0, 80.0), (0.8, 0.5, 40.0)] {
        let (sin, cos) = libm::sincos(degrees.to_radians());
        let (origin, dir) = ([0.0, 0.0, 1.0], [sin, 0.0, -cos]);
        let absorption = Some(Rgb::new(0.0, 0.4, 2.0));
        let mut real = furnace(1);
        (real.render.max_depth, real.render.min_throughput) = (60, 0.0);
        glass(&mut real, "glass", eta, 0);
        real.materials["glass"].sigma_a = absorption;
        mesh(&mut real, cuboid([-300.0, -300.0, -thickness], [300.0, 300.0, 0.0]), "glass");
        let mut thin = furnace(1);
        pane(&mut thin, eta, thickness);
        thin.materials["pane"].sigma_a = absorption;
        thin.planes.push(Plane::new([0.0; 3], [0.0, 0.0, 1.0], [600.0, 600.0], "pane"));
        let (real, thin) = (tree(&real, origin, dir), tree(&thin, origin, dir));
        let ((exit, real_dir, _), (start, thin_dir, count)) = (straight_through(&real), straight_through(&thin));
        assert_eq!(count, 1);
        assert_eq!(thin_dir, thin.nodes[0].dir, "to the bit");
        // Snell's law twice: a few roundings, over the cosine inside, which is above 0.5.
        assert!((real_dir - thin_dir).length() < 1e-14);
        // Hits on triangles 600 wide are good to some roundings of 600.
        assert!((exit - start).cross(thin_dir).length() < 1e-12);
        // What goes up and what goes down in the end. Sixty reflections inside leave less than 0.3^60 of anything.
        let share = |tree: &snell::trace::RayTree, up: bool| {
            let leaving = tree
                .nodes
                .iter()
                .filter(|n| n.depth > 0 && n.hit.is_none() && n.cutoff.is_none() && (n.dir.z > 0.0) == up);
            leaving.fold(Rgb::black(), |sum, n| sum + n.throughput)
        };
        for up in [true, false] {
            let (real, thin) = (share(&real, up), share(&thin, up));
            assert!(common::close(real, thin, 1e-13), "{real:?} {thin:?} at {degrees} degrees, up: {up}");
        }
    }
}

/// The shifted ray starts in the plane of the pane, perhaps beyond the diagonal of its two triangles: it must not meet the
/// pane again there.
#[test]
fn a_pane_is_met_once_wherever_its_triangles_end() {
    let mut scene = furnace(60);
    pane(&mut scene, 1.5, 0.4);
    scene.planes.push(Plane::new([0.1, 0.2, 0.0], [0.9, 0.3, 1.0], [40.0, 40.0], "pane"));
    let world = World::new(&scene).unwrap();
    for pixel in 0..3600 {
        let (radiance, tree) = traced(&scene, &world, pixel % 60, pixel / 60);
        assert_eq!(tree.nodes.len(), 3, "the ray, its mirror image, and what goes through, at {pixel}");
        assert!(common::close(radiance + tree.lost, Rgb::gray(1.0), 1e-15));
    }
}

/// A soap bubble, panes in each other's way, panes within glass: nothing is lost and nothing is made.
#[test]
fn a_white_furnace_with_thin_faces_stays_white() {
    let mut scene = furnace(20);
    pane(&mut scene, 1.4, 0.05);
    glass(&mut scene, "water", 1.33, 0);
    ball(&mut scene, [-0.6, 0.0, 0.0], 1.2, "pane");
    ball(&mut scene, [0.8, 0.3, 0.0], 1.0, "water");
    scene.planes.push(Plane::new([0.5, 0.0, 0.0], [1.0, 0.2, 0.5], [1.0, 0.8], "pane"));
    scene.planes.push(Plane::new([0.0, -0.8, 0.5], [0.0, 1.0, 0.4], [3.0, 1.0], "pane"));
    for depth in [1, 3, 7] {
        scene.render.max_depth = depth;
        let world = World::new(&scene).unwrap();
        for pixel in 0..400 {
            let (radiance, tree) = traced(&scene, &world, pixel % 20, pixel / 20);
            // Some hundred rays, each with a few roundings of 1e-16.
            assert!(common::close(radiance + tree.lost, Rgb::gray(1.0), 1e-12), "{radiance:?} at {pixel}");
        }
    }
}

/// Straight through a pane a shadow loses what the pane mirrors and absorbs.
#[test]
fn a_pane_casts_a_faint_shadow() {
    let mut scene = furnace(1);
    scene.background = Rgb::gray(0.0);
    scene.render.shadows = Some(Shadows::Tinted);
    pane(&mut scene, 1.5, 2.0);
    scene.materials["pane"].sigma_a = Some(Rgb::new(0.0, 0.1, 0.2));
    let white = Material { kd: Rgb::gray(1.0), ..Material::default() };
    scene.materials.insert("white".to_owned(), white);
    scene.planes.push(Plane::new([0.0, -1.0, 0.0], [0.0, 1.0, 0.0], [20.0, 20.0], "white"));
    scene.planes.push(Plane::new([0.0, 3.0, 0.0], [0.0, 1.0, 0.0], [20.0, 20.0], "pane"));
    scene.lights = vec![snell::scene::Light::from_direction([0.0, 1.0, 0.0], Rgb::gray(1.0))];
    let r: f64 = 0.04;
    for (channel, sigma_a) in
        tree(&scene, [0.0, 1.0, 0.0], [0.0, -1.0, 0.0]).sum().to_array().into_iter().zip([0.0, 0.1, 0.2])
    {
        let tau = libm::exp(-2.0 * sigma_a);
        let expected = (1.0 - r) * (1.0 - r) * tau / (1.0 - r * r * tau * tau);
        assert!((channel - expected).abs() < 1e-15, "{channel} {expected}");
    }
}

/// The third way to model a glass of water: each of its surfaces is an interface between two media. It shows what the other
/// two ways show.
#[test]
fn interfaces_show_what_solids_show() {
    let base = || {
        let mut scene = furnace(60);
        (scene.background, scene.ambient) = (Rgb::gray(0.1), Rgb::gray(1.0));
        scene.render.shadows = Some(Shadows::Tinted);
        scene.lights = vec![snell::scene::Light::at([5.0, 6.0, 4.0], Rgb::gray(0.5))];
        let red = Material { ka: Rgb::new(1.0, 0.2, 0.1), kd: Rgb::gray(0.5), ..Material::default() };
        scene.materials.insert("red".to_owned(), red);
        glass(&mut scene, "glass", 1.5, 1);
        glass(&mut scene, "water", 1.33, 0);
        scene.materials["water"].sigma_a = Some(Rgb::new(0.3, 0.1, 0.0));
        ball(&mut scene, [0.7, 0.4, -4.0], 1.5, "red");
        scene.camera.eye = [1.0, 3.5, 10.0];
        scene
    };
    let lathe = |profile: &[[f64; 2]], material: &str, inside: Option<&str>, outside: Option<&str>| Lathe {
        name: None,
        profile: profile.to_vec(),
        segments: 7,
        smooth_angle: 0.0,
        material: material.to_owned(),
        inside: inside.map(str::to_owned),
        outside: outside.map(str::to_owned),
        transform: vec![],
        instances: vec![],
    };
    // A tumbler and what is in it, as solids: the water reaches into the glass.
    let mut solids = base();
    let tumbler = [[0.0, -1.5], [1.3, -1.5], [1.3, 1.5], [1.0, 1.5], [1.0, -1.2], [0.0, -1.2]];
    solids.lathes.push(lathe(&tumbler, "glass", None, None));
    solids.lathes.push(lathe(&[[0.0, -1.3], [1.1, -1.3], [1.1, 0.6], [0.0, 0.6]], "water", None, None));
    // As interfaces: air and glass, glass and water, water and air.
    let mut split = base();
    let dry = [[0.0, -1.5], [1.3, -1.5], [1.3, 1.5], [1.0, 1.5], [1.0, 0.6]];
    split.lathes.push(lathe(&dry, "glass", Some("glass"), None));
    split.lathes.push(lathe(&[[1.0, 0.6], [1.0, -1.2], [0.0, -1.2]], "glass", Some("glass"), Some("water")));
    split.lathes.push(lathe(&[[1.0, 0.6], [0.0, 0.6]], "water", Some("water"), None));
    let (a, b) = (picture(&solids), picture(&split));
    // Silhouettes aside, where a rounding decides.
    assert!(alike(&a, &b) * 1000 >= a.pixels.len() * 999, "{} of {}", alike(&a, &b), a.pixels.len());
    // With the eye in the water, which is found by counting faces.
    for scene in [&mut solids, &mut split] {
        scene.camera.eye = [0.1, 0.3, 0.5];
        scene.camera.bounds = Some([-0.1, 0.1, -0.1, 0.1]);
        scene.camera.near = Some(-0.1);
    }
    let (a, b) = (picture(&solids), picture(&split));
    assert!(alike(&a, &b) * 1000 >= a.pixels.len() * 999, "{} of {}", alike(&a, &b), a.pixels.len());
    let statistics =
        render(&World::new(&split).unwrap(), &Settings::from(&split), &Options::default()).unwrap().statistics;
    assert_eq!(statistics.stray.count, 0);
}

#[test]
fn an_interface_must_have_two_sides() {
    let mut scene = furnace(4);
    glass(&mut scene, "glass", 1.5, 0);
    let faces = vec![[0, 1, 2], [1, 2, 3]];
    let vertices = [[0., 0., 0.], [1., 0., 0.], [0., 1., 0.], [1., 1., 0.]].map(Vec3::from).to_vec();
    let geometry = Some(Arc::new(TriangleMesh { vertices, faces, ..TriangleMesh::default() }));
    let (material, inside) = (Some("glass".to_owned()), Some("glass".to_owned()));
    scene.meshes.push(Mesh { geometry, material, inside, ..Mesh::default() });
    let problem = World::new(&scene).unwrap_err()[0].clone();
    assert!(problem.message.contains("neighbouring faces look opposite ways"), "{problem}");
}

/// Solids of one priority and two media that cross each other: nobody has said which is there, and that is told with their names
/// and the place. One within the other is no such case, nor are two of one medium, nor two of which one has priority.
#[test]
fn an_overlap_without_a_priority_is_told() {
    let overlaps = |eta: f64, priority: i32, center: f64, radius: f64| {
        let mut scene = furnace(16);
        glass(&mut scene, "crown", 1.5, 0);
        glass(&mut scene, "other", eta, priority);
        ball(&mut scene, [0.0; 3], 1.0, "crown");
        ball(&mut scene, [center, 0.0, 0.0], radius, "other");
        scene.spheres[1].name = Some("second".to_owned());
        let world = World::new(&scene).unwrap();
        let found = render(&world, &Settings::from(&scene), &Options::default()).unwrap().statistics.overlaps;
        found.first.map(|overlap| {
            let mut names = overlap.primitives.map(|p| world.object_of(p).unwrap().name.clone());
            names.sort();
            (names, overlap.point)
        })
    };
    let (names, point) = overlaps(1.33, 0, 1.0, 1.0).unwrap();
    assert_eq!(names, ["second", "sphere 1"]);
    // Where one ends within the other: on one of the spheres, inside of the other one. A few roundings of numbers near 10.
    let (to_first, to_second) = (point.length(), (point - Vec3::new(1.0, 0.0, 0.0)).length());
    assert!(to_first.max(to_second) < 1.0 + 1e-13 && (to_first.max(to_second) - 1.0).abs() < 1e-13, "{point:?}");
    assert_eq!(overlaps(1.33, 1, 1.0, 1.0), None, "the other one has priority");
    assert_eq!(overlaps(1.5, 0, 1.0, 1.0), None, "the same medium");
    assert_eq!(overlaps(1.33, 0, 0.2, 0.5), None, "one within the other");
    assert_eq!(overlaps(1.33, 0, 2.5, 1.0), None, "beside each other");
}

/// A pane shows its mirror image and what is behind it, on both of its sides.
#[test]
fn a_pane_has_no_back() {
    let mut scene = furnace(1);
    pane(&mut scene, 1.5, 0.1);
    scene.planes.push(Plane::new([0.0; 3], [0.0, 0.0, 1.0], [4.0, 4.0], "pane"));
    let of = |from: f64| {
        let tree = tree(&scene, [0.3, 0.1, from], [-0.2, 0.1, -from]);
        tree.nodes.iter().map(|n| (n.kind, n.throughput)).collect::<Vec<(RayKind, Rgb)>>()
    };
    assert_eq!(of(1.0), of(-1.0));
    assert_eq!(of(1.0).len(), 3);
}

/// The eye under a wide interface, far from its edges, is in the water.
#[test]
fn a_camera_under_an_interface_is_under_water() {
    let mut scene = furnace(8);
    glass(&mut scene, "water", 1.33, 0);
    scene.materials["water"].sigma_a = Some(Rgb::gray(0.1));
    let mut surface = Plane::new([0.0; 3], [0.0, 1.0, 0.0], [100.0, 100.0], "water");
    surface.inside = Some("water".to_owned());
    scene.planes.push(surface);
    let tree = tree(&scene, [0.0, -3.0, 0.0], [0.0, 1.0, 0.0]);
    let (r, tau) = ((0.33f64 / 2.33) * (0.33 / 2.33), libm::exp(-0.3));
    assert!((tree.nodes[0].eta - 1.33).abs() < 1e-15);
    let statistics =
        render(&World::new(&scene).unwrap(), &Settings::from(&scene), &Options::default()).unwrap().statistics;
    assert_eq!(statistics.stray.count, 0, "the sea has no other shore");
    let out = tree.nodes.iter().find(|n| n.kind == RayKind::Refracted).unwrap();
    // A few roundings.
    assert!((out.throughput.g - (1.0 - r) * tau).abs() < 1e-14, "{:?}", out.throughput);
}

/// A mirror image turns faces over: what was inside stays inside.
#[test]
fn a_mirrored_interface_is_what_it_was() {
    let mut scene = furnace(30);
    scene.background = Rgb::new(0.1, 0.3, 0.8);
    glass(&mut scene, "glass", 1.5, 0);
    let red = Material { emission: Rgb::new(0.9, 0.1, 0.1), ..Material::default() };
    scene.materials.insert("red".to_owned(), red);
    ball(&mut scene, [0.0, 0.5, -4.0], 1.5, "red");
    let lathe = |inside: Option<&str>, factor: f64| Lathe {
        name: None,
        profile: vec![[0.0, -1.0], [1.2, -0.6], [0.9, 1.0], [0.0, 1.3]],
        segments: 12,
        smooth_angle: 0.0,
        material: "glass".to_owned(),
        inside: inside.map(str::to_owned),
        outside: None,
        transform: vec![snell::scene::Transform::Scale([factor, 1.0, 1.0])],
        instances: vec![],
    };
    let mut film = |inside: Option<&str>, factor: f64| {
        scene.lathes = vec![lathe(inside, factor)];
        let world = World::new(&scene).unwrap();
        let rendered = render(&world, &Settings::from(&scene), &Options::default()).unwrap();
        assert_eq!(rendered.statistics.stray.count, 0, "{inside:?} {factor}");
        rendered.film
    };
    let solid = film(None, 1.0);
    for film in [film(None, -1.0), film(Some("glass"), 1.0), film(Some("glass"), -1.0)] {
        // Rounding decides at silhouettes.
        assert!(alike(&film, &solid) * 100 >= 900 * 99, "{} of 900", alike(&film, &solid));
    }
}

/// At an edge a pane shifts rays beside their face: each wall of a bubble of many faces is gone through once all the same.
#[test]
fn a_bubble_of_panes_has_two_walls_everywhere() {
    let mut scene = furnace(48);
    pane(&mut scene, 1.4, 0.08);
    let profile = (0..=12).map(|i| {
        let (sin, cos) = libm::sincos(std::f64::consts::PI * f64::from(i) / 12.0);
        [if i % 12 == 0 { 0.0 } else { sin }, -cos]
    });
    scene.lathes.push(Lathe {
        name: None,
        profile: profile.collect(),
        segments: 20,
        smooth_angle: 60.0,
        material: "pane".to_owned(),
        inside: None,
        outside: None,
        transform: vec![],
        instances: vec![],
    });
    let world = World::new(&scene).unwrap();
    let (mut seen, mut twice) = (0, 0);
    for pixel in 0..48 * 48 {
        let (x, y) = (f64::from(pixel % 48) - 23.5, f64::from(pixel / 48) - 23.5);
        // Within four fifths of its outline, which has a radius of 1/√99·5·47/4 pixels.
        if (x * x + y * y).sqrt() < 4.7 {
            let (_, tree) = traced(&scene, &world, pixel % 48, pixel / 48);
            seen += 1;
            twice += u32::from(straight_through(&tree).2 == 2);
        }
    }
    assert!(seen > 50 && twice == seen, "{twice} of {seen}");
}
