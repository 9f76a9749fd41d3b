//! Real optics (`integrator = "whitted"`) against truths that are known otherwise: by analysis, by symmetry, by counting.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod common;

use common::{alike, ball, furnace, glass, mesh, picture, straight_through, traced, tree};
use snell::film::Rgb;
use snell::geometry::{Affine, TriangleMesh, Vec3};
use snell::scene::{Lathe, Material, Scene, Shadows, Transform};
use snell::trace::RayKind;
use snell::world::World;
use snell_test_scenes::brilliant::Cut;
use snell_test_scenes::glass::{blocks, bubbles, cuboid, marbles, windows};
use snell_test_scenes::lecture;
use std::sync::Arc;

/// Nothing is lost and nothing is made: in a white room clear glass of any shape and nesting looks white, but for the
/// branches that were cut off, which are counted.
#[test]
fn a_white_furnace_stays_white() {
    let mut balls = furnace(24);
    glass(&mut balls, "crown", 1.5, 0);
    glass(&mut balls, "water", 1.33, 1);
    glass(&mut balls, "diamond", 2.42, 0);
    ball(&mut balls, [0.0; 3], 2.0, "crown");
    ball(&mut balls, [0.5, 0.2, 0.3], 1.0, "water");
    ball(&mut balls, [1.5, 1.0, 0.0], 1.2, "diamond");
    ball(&mut balls, [-1.0, -1.0, 0.5], 1.5, "water");
    let mut boxes = furnace(24);
    boxes.materials = balls.materials.clone();
    mesh(&mut boxes, cuboid([-2.0, -1.0, -1.0], [0.0, 1.0, 1.0]), "crown");
    mesh(&mut boxes, cuboid([0.0, -1.0, -1.0], [1.5, 1.0, 1.0]), "diamond");
    mesh(&mut boxes, cuboid([-1.0, -0.5, -0.5], [0.7, 2.0, 0.5]), "water");
    ball(&mut boxes, [-1.0, 0.0, 0.0], 0.5, "diamond");
    // Round and smoothed, many-faced, turned and repeated.
    let mut shapes = furnace(24);
    shapes.materials = balls.materials.clone();
    let smooth = Lathe {
        name: None,
        profile: vec![[0.0, -1.5], [1.2, -1.3], [0.4, 0.0], [1.3, 1.2], [1.1, 1.2], [0.3, 0.2], [0.0, 0.2]],
        segments: 17,
        smooth_angle: 60.0,
        material: "crown".to_owned(),
        inside: None,
        outside: None,
        transform: vec![Transform::Rotate { axis: [1.0, 0.0, 0.3], degrees: 25.0 }],
        instances: vec![
            vec![Transform::Move([-1.0, 0.0, 0.0])],
            vec![Transform::Scale([0.8, -0.8, 0.8]), Transform::Move([1.0, 0.3, 0.2])],
        ],
    };
    shapes.lathes.push(smooth);
    let stone = Cut::default().brilliant().solid.mesh();
    mesh(&mut shapes, stone.transformed(&Affine::scaling(Vec3::new(3.0, 3.0, 3.0))), "diamond");
    for scene in [balls, boxes, shapes] {
        for depth in [0, 1, 2, 5, 32] {
            let mut scene = scene.clone();
            scene.render.max_depth = depth;
            let world = World::new(&scene).unwrap();
            for pixel in 0..24 * 24 {
                let (radiance, tree) = traced(&scene, &world, pixel % 24, pixel / 24);
                assert_eq!(radiance, tree.sum());
                let whole = radiance + tree.lost;
                for channel in whole.to_array() {
                    // Up to some thousand rays, each with a few roundings of 1e-16.
                    assert!((channel - 1.0).abs() < 1e-12, "{channel} at {pixel}, depth {depth}");
                }
            }
        }
    }
}

#[test]
fn index_1_is_invisible_to_the_last_bit() {
    let mut scene = furnace(40);
    scene.background = Rgb::new(0.1, 0.2, 0.3);
    scene.ambient = Rgb::gray(0.5);
    glass(&mut scene, "nothing", 1.0, 0);
    glass(&mut scene, "crown", 1.5, -1);
    let red = Material { ka: Rgb::new(0.9, 0.1, 0.1), kr: Rgb::gray(0.4), ..Material::default() };
    scene.materials.insert("red".to_owned(), red);
    ball(&mut scene, [0.0, 0.0, -3.0], 2.0, "red");
    ball(&mut scene, [1.0, 1.0, 1.0], 0.7, "crown");
    let without = picture(&scene);
    ball(&mut scene, [-1.0, 0.0, 1.0], 1.2, "nothing");
    mesh(&mut scene, cuboid([-1.5, -2.0, 2.0], [0.3, 0.5, 3.0]), "nothing");
    let with = picture(&scene);
    assert!(with.pixels == without.pixels);
}

/// Exact first: powers of two change exponents only.
#[test]
fn a_scene_scaled_by_a_power_of_two_gives_the_same_bits() {
    for scene in [bubbles(), marbles(), blocks(), windows()] {
        let mut scene = scene;
        scene.meshes.retain(|mesh| mesh.instances.is_empty());
        scene.planes.retain(|plane| plane.instances.is_empty());
        let expected = picture(&scene);
        for exponent in [-20, 20] {
            let factor = libm::exp2(f64::from(exponent));
            let found = picture(&scaled(&scene, |c| c * factor, factor));
            assert!(found.pixels == expected.pixels, "2^{exponent}");
        }
    }
}

/// By any other factor, or far away, the same picture but for a few pixels at silhouettes.
#[test]
fn a_scene_scaled_or_moved_is_the_same_picture() {
    for (name, mut scene) in [("blocks", blocks()), ("windows", windows())] {
        scene.meshes.retain(|mesh| mesh.instances.is_empty());
        // From where no ray runs along the planes in which faces meet.
        scene.camera.eye = [53.1, 57.3, 99.7];
        scene.render.size = [96, 96];
        let expected = picture(&scene);
        for (factor, offset) in [(1e6, 0.0), (1e-6, 0.0), (1.0, 1e5)] {
            let found = picture(&scaled(&scene, |c| c * factor + offset, factor));
            let (same, all) = (alike(&found, &expected), expected.pixels.len());
            assert!(same * 1000 >= all * 999, "{name} times {factor} plus {offset}: {same} of {all}");
        }
    }
}

fn scaled(scene: &Scene, map: impl Fn(f64) -> f64, factor: f64) -> Scene {
    let mut scene = scene.clone();
    (scene.camera.eye, scene.camera.look_at) = (scene.camera.eye.map(&map), scene.camera.look_at.map(&map));
    scene.camera.near = scene.camera.near.map(|near| near * factor);
    scene.camera.bounds = scene.camera.bounds.map(|bounds| bounds.map(|b| b * factor));
    for light in &mut scene.lights {
        light.position = light.position.map(|p| p.map(&map));
        light.target = light.target.map(|p| p.map(&map));
    }
    let offset = map(0.0);
    let place = |transform: &mut Vec<Transform>, instances: &mut Vec<Vec<Transform>>| {
        let steps = [Transform::Scale([factor; 3]), Transform::Move([offset; 3])];
        for instance in instances.iter_mut() {
            instance.extend(steps.clone());
        }
        if instances.is_empty() {
            transform.extend(steps);
        }
    };
    scene.planes.iter_mut().for_each(|p| place(&mut p.transform, &mut p.instances));
    scene.boxes.iter_mut().for_each(|b| place(&mut b.transform, &mut b.instances));
    scene.lathes.iter_mut().for_each(|l| place(&mut l.transform, &mut l.instances));
    for sphere in &mut scene.spheres {
        if sphere.transform.is_empty() {
            (sphere.center, sphere.radius) = (sphere.center.map(&map), sphere.radius * factor);
        } else {
            place(&mut sphere.transform, &mut sphere.instances);
        }
    }
    for mesh in &mut scene.meshes {
        let mut geometry = mesh.geometry.as_deref().unwrap().clone();
        for v in &mut geometry.vertices {
            *v = Vec3::new(map(v.x), map(v.y), map(v.z));
        }
        mesh.geometry = Some(Arc::new(geometry));
    }
    for material in scene.materials.values_mut() {
        material.sigma_a = material.sigma_a.map(|sigma| sigma * (1.0 / factor));
        material.thickness = material.thickness.map(|thickness| thickness * factor);
        material.attenuation_distance = material.attenuation_distance.map(|distance| distance * factor);
    }
    scene
}

/// A pane displaces by `d = t·sin θ·(1 − cos θ/√(n² − sin² θ))` and leaves the direction what it was.
#[test]
fn a_pane_displaces_by_the_formula() {
    let mut scene = furnace(1);
    glass(&mut scene, "pane", 1.5, 0);
    mesh(&mut scene, cuboid([-50.0, -50.0, -2.0], [50.0, 50.0, 0.0]), "pane");
    for degrees in [0.0, 10.0, 30.0, 45.0, 60.0, 80.0] {
        let (sin, cos) = snell::lanes::elementary::sin_cos_degrees(degrees);
        let dir = Vec3::new(sin, 0.0, -cos);
        let (origin, out, count) = straight_through(&tree(&scene, [-3.0 * sin, 0.01, 3.0 * cos], [sin, 0.0, -cos]));
        assert_eq!(count, 2, "{degrees}");
        // A few roundings of numbers of order one.
        assert!((out - dir).length() < 1e-14);
        let expected = 2.0 * sin * (1.0 - cos / (1.5f64 * 1.5 - sin * sin).sqrt());
        let from_axis = origin - Vec3::new(0.0, 0.01, 0.0);
        let displaced = (from_axis - dir * from_axis.dot(dir)).length();
        // As above, of numbers up to 12.
        assert!((displaced - expected).abs() < 1e-13, "{degrees}: {displaced}, not {expected}");
    }
}

/// The least deviation of a prism is `2·asin(n·sin(A/2)) − A`, at the symmetric passage.
#[test]
fn a_prism_deviates_least_at_the_symmetric_passage() {
    let mut scene = furnace(1);
    glass(&mut scene, "prism", 1.5168, 0);
    // An equilateral prism with its axis along z, one unit from axis to corner.
    let corner = |degrees: f64, z: f64| {
        let (sin, cos) = snell::lanes::elementary::sin_cos_degrees(degrees);
        Vec3::new(cos, sin, z)
    };
    let vertices = [90.0, 210.0, 330.0].iter().flat_map(|&d| [corner(d, -9.0), corner(d, 9.0)]).collect();
    let faces = vec![[0, 4, 2], [1, 3, 5], [0, 2, 3], [0, 3, 1], [2, 4, 5], [2, 5, 3], [4, 0, 1], [4, 1, 5]];
    mesh(&mut scene, TriangleMesh { vertices, faces, ..TriangleMesh::default() }, "prism");
    let least = 2.0 * libm::asin(1.5168 * 0.5) - std::f64::consts::FRAC_PI_3;
    let deviation = |incidence: f64| {
        // Onto the middle of the left face, whose normal points to 150 degrees.
        let (sin, cos) = libm::sincos(5.0 * std::f64::consts::FRAC_PI_6 + incidence - std::f64::consts::PI);
        let at = Vec3::new(-0.433_012_701_892_219_3, 0.25, 0.0);
        let start = at - Vec3::new(cos, sin, 0.0);
        let (_, out, count) = straight_through(&tree(&scene, [start.x, start.y, 0.003], [cos, sin, 0.0]));
        assert_eq!(count, 2);
        libm::acos(out.dot(Vec3::new(cos, sin, 0.0)))
    };
    let symmetric = libm::asin(1.5168 * 0.5);
    // acos of numbers near 0.78: a few 1e-16 of the cosine, times 1/sin.
    assert!((deviation(symmetric) - least).abs() < 1e-14);
    for off in [-0.2, -0.05, -0.01, 0.01, 0.05, 0.2] {
        assert!(deviation(symmetric + off) > least + 1e-6, "{off}");
    }
}

/// A ball lens: `nR/(2(n − 1))` from its centre, for rays near the axis.
#[test]
fn a_ball_lens_has_its_focal_length() {
    let mut scene = furnace(1);
    for n in [1.33, 1.5, 1.8] {
        glass(&mut scene, "ball", n, 0);
        scene.spheres.clear();
        ball(&mut scene, [0.0; 3], 2.0, "ball");
        let focus = |height: f64| {
            let (origin, dir, count) = straight_through(&tree(&scene, [height, 0.0, 9.0], [0.0, 0.0, -1.0]));
            assert_eq!(count, 2);
            // Where it crosses the axis, from the centre.
            -(origin.z + dir.z * (-origin.x / dir.x))
        };
        let expected = n * 2.0 / (2.0 * (n - 1.0));
        // The aberration grows with h²; its coefficient is of order one here. The rest is rounding: 1e-16/h.
        let h = 1e-4;
        assert!((focus(h) - expected).abs() < 10.0 * h * h, "{n}: {} {expected}", focus(h));
        assert!(focus(1.0) < focus(0.5) && focus(0.5) < focus(0.1), "farther out it focuses nearer");
    }
}

/// The rainbow: the largest deviation back of rays with one reflection within a drop; `cos i = √((n² − 1)/3)`, 42.0° for water.
#[test]
fn the_primary_rainbow_is_where_descartes_found_it() {
    let n = 1.333;
    let mut scene = furnace(1);
    scene.render.min_throughput = 0.0;
    scene.render.max_depth = 3;
    glass(&mut scene, "water", n, 0);
    ball(&mut scene, [0.0; 3], 1.0, "water");
    let angle = |height: f64| {
        let tree = tree(&scene, [height, 0.0, 3.0], [0.0, 0.0, -1.0]);
        let child = |parent: usize, kind: RayKind| {
            tree.nodes.iter().position(|n| n.parent == Some(parent) && n.kind == kind).unwrap()
        };
        let inside = child(0, RayKind::Refracted);
        let out = child(child(inside, RayKind::Mirror), RayKind::Refracted);
        // Against the sun: the ray came along −z.
        libm::acos(tree.nodes[out].dir.z).to_degrees()
    };
    let i = libm::acos(((n * n - 1.0) / 3.0f64).sqrt());
    let expected = (4.0 * libm::asin(libm::sin(i) / n) - 2.0 * i).to_degrees();
    let largest = (600..1000).map(|k| angle(f64::from(k) / 1000.0)).fold(0.0, f64::max);
    // Sampled every thousandth of a radius at a maximum: the rest is of second order.
    assert!((largest - expected).abs() < 1e-3 && (41.9..42.2).contains(&expected), "{largest} {expected}");
}

/// Clear shells of rising index, one in the other: straight on, each interface lets `1 − ((a − b)/(a + b))²` through.
#[test]
fn thirty_nested_shells_let_their_computed_share_through() {
    let mut scene = furnace(1);
    scene.render.max_depth = 64;
    let mut through = 1.0;
    let mut before = 1.0;
    for shell in 0..30 {
        let eta = 1.0 + 0.02 * f64::from(shell + 1);
        glass(&mut scene, &format!("shell {shell}"), eta, 0);
        ball(&mut scene, [0.0; 3], 30.0 - f64::from(shell), &format!("shell {shell}"));
        let r = (before - eta) / (before + eta);
        through *= (1.0 - r * r) * (1.0 - r * r);
        before = eta;
    }
    let tree = tree(&scene, [0.0, 0.0, 50.0], [0.0, 0.0, -1.0]);
    let (_, dir, count) = straight_through(&tree);
    assert_eq!((count, dir), (60, Vec3::new(0.0, 0.0, -1.0)));
    let deepest = tree.nodes.iter().filter(|n| n.kind == RayKind::Refracted).map(|n| n.depth).max();
    assert_eq!(deepest, Some(60));
    let last = tree.nodes.iter().find(|n| n.depth == 60 && n.kind == RayKind::Refracted).unwrap();
    // Sixty products, a rounding or two each.
    assert!((last.throughput.r - through).abs() < 1e-14, "{} {through}", last.throughput.r);
}

/// Straight through a slab of thickness d white light is left with `attenuation_color`, and twice as thick with its square.
#[test]
fn absorption_is_the_colour_at_the_thickness() {
    for (thickness, power) in [(1.0, 1), (2.0, 2)] {
        let mut scene = furnace(1);
        let color = Rgb::new(0.8, 0.5, 0.25);
        let (attenuation_color, attenuation_distance) = (Some(color), Some(1.0));
        let material = Material { ko: Rgb::gray(0.0), attenuation_color, attenuation_distance, ..Material::default() };
        scene.materials.insert("dye".to_owned(), material);
        mesh(&mut scene, cuboid([-9.0, -9.0, -thickness], [9.0, 9.0, 0.0]), "dye");
        // Index 1, so that nothing is reflected: what absorbs is there all the same.
        let seen = tree(&scene, [0.3, 0.2, 5.0], [0.0, 0.0, -1.0]).sum();
        for (seen, color) in seen.to_array().into_iter().zip(color.to_array()) {
            let expected = if power == 1 { color } else { color * color };
            // exp(−ln) of numbers near 1: a few roundings.
            assert!((seen - expected).abs() < 1e-15, "{seen} {expected}");
        }
    }
}

/// A block of water in a block of glass: overlapping, where the higher priority wins, or with faces that coincide.
#[test]
fn water_in_glass_looks_the_same_overlapping_or_touching() {
    let base = |size: u32| {
        let mut scene = furnace(size);
        scene.background = Rgb::gray(0.1);
        scene.ambient = Rgb::gray(1.0);
        let red = Material { ka: Rgb::new(1.0, 0.2, 0.1), ..Material::default() };
        scene.materials.insert("red".to_owned(), red);
        ball(&mut scene, [0.7, 0.4, -4.0], 1.5, "red");
        scene.camera.eye = [1.0, 1.5, 10.0];
        scene
    };
    // The liquid reaches into the wall, and the wall is there.
    let mut overlap = base(60);
    glass(&mut overlap, "glass", 1.5, 1);
    glass(&mut overlap, "water", 1.33, 0);
    mesh(&mut overlap, cuboid([-1.5, -1.5, -1.0], [0.0, 1.5, 1.0]), "glass");
    mesh(&mut overlap, cuboid([-0.5, -1.2, -0.8], [1.5, 1.2, 0.8]), "water");
    // The liquid ends where the wall begins.
    let mut touching = base(60);
    touching.materials = overlap.materials.clone();
    mesh(&mut touching, cuboid([-1.5, -1.5, -1.0], [0.0, 1.5, 1.0]), "glass");
    mesh(&mut touching, cuboid([0.0, -1.2, -0.8], [1.5, 1.2, 0.8]), "water");
    let (a, b) = (picture(&overlap), picture(&touching));
    let close = |a: Rgb, b: Rgb| (a - b).to_array().iter().all(|d| d.abs() < 1e-9);
    let same = a.pixels.iter().zip(&b.pixels).filter(|(a, b)| close(**a, **b)).count();
    // Silhouettes aside, where a rounding decides.
    assert!(same * 1000 >= a.pixels.len() * 999, "{same} of {}", a.pixels.len());
}

#[test]
fn an_open_transparent_mesh_is_refused_and_says_where() {
    let mut open = cuboid([-1.0; 3], [1.0; 3]);
    open.faces.pop();
    let mut scene = furnace(8);
    glass(&mut scene, "glass", 1.5, 0);
    mesh(&mut scene, open, "glass");
    let problem = World::new(&scene).unwrap_err()[0].clone();
    assert!(problem.message.contains("not a solid: it is open along 3 edges"), "{problem}");
    scene.meshes[0].open = Some(snell::scene::OpenMesh::Fill);
    let filled = picture(&scene);
    scene.meshes[0].geometry = Some(Arc::new(cuboid([-1.0; 3], [1.0; 3])));
    let close = |a: Rgb, b: Rgb| (a - b).to_array().iter().all(|d| d.abs() < 1e-9);
    assert!(filled.pixels.iter().zip(&picture(&scene).pixels).all(|(a, b)| close(*a, *b)));
    scene.materials["glass"].ko = Rgb::gray(1.0);
    World::new(&scene).unwrap();
}

/// The camera within glass sees what the way out of it shows, and no face between the eye and the image plane.
#[test]
fn a_camera_in_water_looks_out_through_one_face() {
    let mut scene = furnace(16);
    glass(&mut scene, "water", 1.33, 0);
    ball(&mut scene, [0.0, 0.0, 10.0], 8.0, "water");
    let world = World::new(&scene).unwrap();
    let (_, tree) = traced(&scene, &world, 8, 8);
    let r = (0.33f64 / 2.33) * (0.33 / 2.33);
    let first = tree.nodes.iter().find(|n| n.kind == RayKind::Refracted).unwrap();
    // Nearly straight on: the reflectance has no slope there.
    assert!((first.throughput.r - (1.0 - r)).abs() < 1e-3 && first.depth == 1);
    let whole = tree.sum() + tree.lost;
    assert!((whole.g - 1.0).abs() < 1e-12);
}

/// Without dispersion nothing splits: the same bits. With next to none, the same picture.
#[test]
fn dispersion_that_goes_to_nothing_leaves_no_trace() {
    let mut scene = furnace(24);
    scene.background = Rgb::new(0.2, 0.5, 0.9);
    glass(&mut scene, "glass", 1.5, 0);
    ball(&mut scene, [0.0; 3], 1.5, "glass");
    mesh(&mut scene, cuboid([-2.0, -1.0, 1.0], [0.5, 1.0, 2.0]), "glass");
    let plain = picture(&scene);
    let glass = scene.materials["glass"].clone();
    scene.materials["glass"] = Material { eta: 1.0, cauchy: Some([1.5, 0.0, 0.0]), ..glass.clone() };
    assert!(picture(&scene).pixels == plain.pixels);
    scene.materials["glass"] = Material { abbe: Some(1e13), ..glass.clone() };
    // Branches end at other places when they are split.
    scene.render.min_throughput = 0.0;
    scene.render.max_depth = 7;
    let faint = picture(&scene);
    scene.materials["glass"] = glass;
    let none = picture(&scene);
    for (a, b) in faint.pixels.iter().zip(&none.pixels) {
        assert!((*a - *b).to_array().iter().all(|d| d.abs() < 1e-9), "{a:?} {b:?}");
    }
}

#[test]
fn a_white_furnace_stays_white_with_dispersion() {
    let mut scene = furnace(12);
    scene.render.max_depth = 8;
    scene.render.bands = 7;
    scene.materials.insert(
        "flint".to_owned(),
        Material { ko: Rgb::gray(0.0), glass: Some("N-SF11".to_owned()), ..Material::default() },
    );
    ball(&mut scene, [0.0; 3], 1.5, "flint");
    ball(&mut scene, [1.0, 0.5, 1.0], 0.8, "flint");
    let world = World::new(&scene).unwrap();
    for pixel in 0..144 {
        let (_, tree) = traced(&scene, &world, pixel % 12, pixel / 12);
        let whole = tree.sum() + tree.lost;
        // As without dispersion; the weights of the bands add up to one exactly.
        assert!(whole.to_array().iter().all(|c| (c - 1.0).abs() < 1e-12), "{whole:?} at {pixel}");
    }
}

/// An opaque surface in the same place as glass is seen, whichever stands first in the scene.
#[test]
fn glass_on_something_opaque_shows_it() {
    let mut scene = furnace(8);
    scene.ambient = Rgb::gray(1.0);
    scene.background = Rgb::gray(0.0);
    glass(&mut scene, "glass", 1.5, 0);
    scene.materials.insert("red".to_owned(), Material { ka: Rgb::new(1.0, 0.0, 0.0), ..Material::default() });
    for order in [["glass", "red"], ["red", "glass"]] {
        scene.spheres.clear();
        scene.meshes.clear();
        for material in order {
            ball(&mut scene, [0.0; 3], 1.5, material);
        }
        let middle = picture(&scene).pixels[8 * 4 + 4];
        assert_eq!(middle, Rgb::new(1.0, 0.0, 0.0), "{order:?}");
        scene.spheres.clear();
        for material in order {
            let bottom = if material == "glass" { [-1.0, 0.0] } else { [-3.0, -1.0] };
            mesh(&mut scene, cuboid([-1.5, -1.5, bottom[0]], [1.5, 1.5, bottom[1]]), material);
        }
        let middle = picture(&scene).pixels[8 * 4 + 4];
        // Through one face, and what comes back from it.
        assert!(middle.r > 0.95 && middle.r < 1.0 && middle.g == 0.0, "{order:?}: {middle:?}");
    }
}

#[test]
fn nothing_at_all_is_the_background() {
    let mut scene = furnace(4);
    scene.background = Rgb::new(0.1, 0.2, 0.3);
    assert!(picture(&scene).pixels.iter().all(|&c| c == scene.background));
    // A face without area is nothing.
    let vertices = [Vec3::default(); 3].to_vec();
    scene.materials.insert("m".to_owned(), Material::default());
    mesh(&mut scene, TriangleMesh { vertices, faces: vec![[0, 1, 2]], ..TriangleMesh::default() }, "m");
    assert!(picture(&scene).pixels.iter().all(|&c| c == scene.background));
}

/// The wall of an opaque sphere is lit by a light within it, and not by one behind it.
#[test]
fn an_opaque_sphere_has_an_inside() {
    for shadows in [Shadows::Opaque, Shadows::Tinted] {
        let mut scene = furnace(4);
        scene.render.shadows = Some(shadows);
        scene.materials.insert("white".to_owned(), Material { kd: Rgb::gray(1.0), ..Material::default() });
        ball(&mut scene, [0.0; 3], 100.0, "white");
        let mut light = lecture("lecture/default", 1).lights[0].clone();
        for (position, lit) in [([0.0, 0.0, 20.0], true), ([0.0, 0.0, -200.0], false)] {
            light.position = Some(position);
            scene.lights = vec![light.clone()];
            assert!(picture(&scene).pixels.iter().all(|c| (c.r > 0.5) == lit && (lit || c.r == 0.0)), "{shadows:?}");
        }
    }
}

/// A hollow box turned inside out by a mirror, or by its file, is still hollow.
#[test]
fn a_mirrored_hollow_box_is_hollow() {
    let mut hollow = cuboid([-2.0; 3], [2.0; 3]);
    let inner = cuboid([-1.0; 3], [1.0; 3]);
    hollow.faces.extend(inner.faces.iter().map(|&[a, b, c]| [a + 8, c + 8, b + 8]));
    hollow.vertices.extend(inner.vertices);
    let mirror = vec![Transform::Scale([-1.0, 1.0, 1.0])];
    for (transform, instances) in [(vec![], vec![]), (mirror.clone(), vec![]), (vec![], vec![mirror])] {
        let mut scene = furnace(1);
        glass(&mut scene, "glass", 1.5, 0);
        mesh(&mut scene, hollow.clone(), "glass");
        (scene.meshes[0].transform, scene.meshes[0].instances) = (transform, instances);
        let (_, dir, count) = straight_through(&tree(&scene, [0.1, 0.2, 5.0], [0.0, 0.0, -1.0]));
        assert_eq!((count, dir), (4, Vec3::new(0.0, 0.0, -1.0)));
    }
}

/// A gel has the index of what is around it, and is seen all the same, by rays and by light.
#[test]
fn a_gel_dyes_what_goes_through() {
    let mut scene = furnace(1);
    let gel =
        Material { ko: Rgb::gray(0.0), kd: Rgb::new(0.9, 0.4, 0.1), tinted_transmission: true, ..Material::default() };
    scene.materials.insert("gel".to_owned(), gel.clone());
    mesh(&mut scene, cuboid([-1.0; 3], [1.0; 3]), "gel");
    assert_eq!(tree(&scene, [0.1, 0.2, 5.0], [0.0, 0.0, -1.0]).sum(), gel.kd);
    // The light falls through it onto a floor.
    scene.background = Rgb::gray(0.0);
    scene.render.shadows = Some(Shadows::Tinted);
    scene.materials.insert("floor".to_owned(), Material { kd: Rgb::gray(1.0), ..Material::default() });
    mesh(&mut scene, cuboid([-9.0, -3.0, -9.0], [9.0, -2.0, 9.0]), "floor");
    let mut light = lecture("lecture/default", 1).lights[0].clone();
    (light.position, light.direction, light.color) = (None, Some([0.0, 1.0, 0.0]), Rgb::gray(1.0));
    scene.lights = vec![light];
    let floor = tree(&scene, [0.3, -1.5, 0.2], [0.0, -1.0, 0.0]).sum();
    assert_eq!(floor, gel.kd);
}

/// The table of the documentation, computed anew with the engine's own refraction.
#[test]
fn the_published_table_of_angles_is_exact() {
    let page = include_str!("../../../docs/models.md");
    let angle = |cell: &str| cell.trim().trim_end_matches('°').parse::<f64>().unwrap();
    let rows = page.lines().filter(|line| line.contains('°') && line.matches('|').count() == 4);
    let mut count = 0;
    for line in rows.filter(|line| line.chars().nth(2).is_some_and(|c| c.is_ascii_digit())) {
        let [theta, small, exact] = [1, 2, 3].map(|i| angle(line.split('|').nth(i).unwrap()));
        let (sin, cos) = libm::sincos(theta.to_radians());
        let (inside, _) = snell::optics::snell::refract(Vec3::new(-sin, cos, 0.0), Vec3::new(0.0, 1.0, 0.0), 1.0 / 1.5);
        // One digit is printed.
        assert!((libm::atan2(inside.x, -inside.y).to_degrees() - exact).abs() < 0.05, "{line}");
        assert!((theta / 1.5 - small).abs() < 0.05, "{line}");
        count += 1;
    }
    assert_eq!(count, 10);
}
