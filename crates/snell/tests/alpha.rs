//! Textures with alpha: what is drawn where only a part of a surface is there, and what is behind where nothing is.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod common;

use common::{alike, ball, close, furnace, furnish, glass, leaves, mesh, picture, pictured, room, traced, tree};
use snell::explain::explain;
use snell::film::{Film, Rgb};
use snell::geometry::{Affine, TriangleMesh, Vec3};
use snell::render::{Options, Settings, render};
use snell::scene::{Integrator, Light, Material, Mesh, OpenMesh, Plane, Scene, Shadows, Transform, WarningCode};
use snell::trace::RayKind;
use snell::world::{CompiledScene, World};
use snell_test_scenes::glass::cuboid;
use snell_test_scenes::matrix::{THREADS, all_ways};
use std::sync::Arc;

/// Are they the same to the bit? Says how many pixels are not, and the first of them.
fn assert_same(a: &Film, b: &Film, what: &str) {
    let bits = |color: &Rgb| color.to_array().map(f64::to_bits);
    let different: Vec<usize> = (0..a.pixels.len()).filter(|&i| bits(&a.pixels[i]) != bits(&b.pixels[i])).collect();
    let first = different.first().map(|&i| (i, a.pixels[i], b.pixels[i]));
    assert!(different.is_empty(), "{what}: {} pixels differ, the first is {first:?}", different.len());
}

/// A surface of this alpha all over.
fn veil(scene: &mut Scene, alpha: f32) {
    pictured(scene, "veil", [3, 2], |x, y| ([0.3 * x as f32, 0.5, y as f32], alpha));
}

/// A picture whose left half is not there.
fn right_half(scene: &mut Scene) {
    pictured(scene, "half", [4, 1], |x, _| ([1.0; 3], (x / 2) as f32));
}

/// A square of 2 x 2 across the z axis.
fn card(z: f64, material: &str) -> Plane {
    Plane::new([0.0, 0.0, z], [0.0, 0.0, 1.0], [2.0, 2.0], material)
}

/// What the ray along −z through `(x, y)` sees.
fn seen(scene: &Scene, x: f64, y: f64) -> Rgb {
    tree(scene, [x, y, 9.0], [0.0, 0.0, -1.0]).sum()
}

/// Whatever it is put on, and wherever that stands: the picture is that of the room without it, to the bit, in all kinds of
/// shadows that look at alpha. Rays go on from where they came, as through a null interface.
#[test]
fn alpha_0_is_not_there_to_the_bit() {
    for (shadows, spp, outside) in [(Shadows::Tinted, 2, 1.0), (Shadows::Off, 1, 1.33)] {
        let mut empty = room();
        (empty.render.shadows, empty.render.spp, empty.eta_outside) = (Some(shadows), spp, outside);
        let mut furnished = empty.clone();
        veil(&mut furnished, 0.0);
        let look = Material { kr: Rgb::gray(0.5), emission: Rgb::gray(0.7), ..furnished.materials["veil"].clone() };
        furnished.materials["veil"] = look;
        furnish(&mut furnished, "veil");
        let expected = picture(&empty);
        // An instance lets hits be less exact everywhere, and mirrored rays start a little farther in front of a surface.
        assert!(alike(&picture(&furnished), &expected) == expected.pixels.len());
        furnished.lathes[0].instances.clear();
        assert_same(&picture(&furnished), &expected, &format!("{shadows:?}"));
        // A transparent body of the medium around it, painted with nothing.
        furnished.materials["veil"].ko = Rgb::gray(0.5);
        furnished.materials["veil"].eta = outside;
        furnished.planes.truncate(empty.planes.len());
        furnished.lathes.clear();
        assert_same(&picture(&furnished), &expected, &format!("{shadows:?}, a ball"));
    }
}

/// Where all of a picture that a card shows is there, nothing tells that it has holes elsewhere.
#[test]
fn alpha_1_changes_no_bit() {
    let with = |alpha: bool| {
        let mut scene = room();
        let colors = |x: usize, y: usize| [0.1 * x as f32, 0.2 * y as f32, 0.5];
        pictured(&mut scene, "leaf", [8, 4], |x, y| (colors(x, y), if alpha && x < 2 { 0.0 } else { 1.0 }));
        scene.materials["leaf"].kr = Rgb::gray(0.4);
        scene.materials["leaf"].emission = Rgb::new(0.1, 0.0, 0.3);
        // From the fourth column on: none of the four texels around is a hole.
        let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]];
        let geometry = TriangleMesh {
            vertices: corners.map(|[x, y]| Vec3::new(x, y, 0.2 * x)).to_vec(),
            faces: vec![[0, 1, 2], [0, 2, 3]],
            uvs: corners.map(|[x, y]| [0.7 + 0.2 * x, 0.5 + 0.3 * y]).to_vec(),
            face_uvs: vec![[0, 1, 2], [0, 2, 3]],
            ..TriangleMesh::default()
        };
        mesh(&mut scene, geometry, "leaf");
        let places = [[-1.6, -0.3, 1.5], [-1.6, -0.5, -1.0], [0.5, 0.3, -1.0], [1.0, -1.5, 1.0]];
        scene.meshes[0].instances = places.map(|to| vec![Transform::Scale([0.5; 3]), Transform::Move(to)]).to_vec();
        scene.meshes[0].smooth_angle = 40.0;
        scene
    };
    assert_same(&picture(&with(true)), &picture(&with(false)), "");
}

/// A share of the card and a share of what is behind it, and nothing else: on both sides of it, in glass, in air and in water.
#[test]
fn half_a_card_shows_half_of_what_is_behind() {
    for outside in [1.0, 1.5] {
        let mut scene = furnace(1);
        (scene.ambient, scene.eta_outside, scene.background) = (Rgb::gray(1.0), outside, Rgb::new(0.0, 0.25, 1.0));
        pictured(&mut scene, "veil", [1, 1], |_, _| ([1.0, 0.5, 0.0], 0.375));
        scene.planes.push(card(0.0, "veil"));
        let expected = Rgb::new(1.0, 0.5, 0.0) * 0.375 + scene.background * 0.625;
        for (from, towards) in [([0.3, 0.1, 5.0], [0.0, 0.1, -1.0]), ([-0.3, 0.6, -5.0], [0.1, 0.0, 1.0])] {
            let tree = tree(&scene, from, towards);
            assert_eq!(tree.sum(), expected, "exact: the numbers have few digits");
            assert_eq!(tree.nodes.len(), 2, "the card mirrors nothing");
            assert_eq!(tree.nodes[1].dir, tree.nodes[0].dir, "straight on");
        }
    }
    // In a block of glass, seen straight on: what two faces leave of it.
    let mut scene = furnace(1);
    (scene.background, scene.ambient, scene.render.max_depth) = (Rgb::gray(0.0), Rgb::gray(1.0), 6);
    glass(&mut scene, "glass", 1.5, 0);
    mesh(&mut scene, cuboid([-2.0, -2.0, -1.0], [2.0, 2.0, 1.0]), "glass");
    veil(&mut scene, 0.5);
    scene.planes.push(card(0.0, "veil"));
    let straight = tree(&scene, [0.3, 0.1, 5.0], [0.0, 0.0, -1.0]);
    let onward = straight.nodes.iter().rfind(|node| node.kind == RayKind::Refracted && node.depth == 3).unwrap();
    // One rounding or two for each of three surfaces.
    assert!((onward.throughput.g - 0.96 * 0.5 * 0.96).abs() < 1e-15, "{onward:?}");
    let inside: Vec<f64> = straight.nodes.iter().filter(|node| node.depth == 2).map(|node| node.eta).collect();
    assert_eq!(inside, [1.5], "glass on both sides of it, and no gap of air that mirrors");
}

/// In air a veil is a pane without thickness, of index 1 and so much opacity: another way through the engine, and the same picture.
#[test]
fn a_veil_is_a_pane_of_nothing() {
    let with = |alpha: f32, pane: bool| {
        let mut scene = room();
        pictured(&mut scene, "veil", [3, 2], |x, y| ([0.3 * x as f32, 0.5, y as f32], if pane { 1.0 } else { alpha }));
        let look = Material { ks: Rgb::gray(0.3), kr: Rgb::gray(0.4), ..scene.materials["veil"].clone() };
        let (ko, thickness) = if pane { (f64::from(alpha), Some(0.0)) } else { (1.0, None) };
        scene.materials["veil"] = Material { ko: Rgb::gray(ko), thickness, ..look };
        furnish(&mut scene, "veil");
        // In glass a pane of index 1 is a gap, and a veil is not.
        scene.planes.remove(3);
        scene.lathes[0].instances.truncate(2);
        scene
    };
    for alpha in [0.125, 0.5, 0.75] {
        let (veil, pane) = (picture(&with(alpha, false)), picture(&with(alpha, true)));
        assert!(alike(&veil, &pane) == veil.pixels.len(), "{} of {}", alike(&veil, &pane), veil.pixels.len());
    }
}

/// A ball with holes has a near wall and a far one, each once.
#[test]
fn a_ball_has_two_walls() {
    let mut scene = furnace(1);
    (scene.ambient, scene.background) = (Rgb::gray(1.0), Rgb::gray(0.0));
    veil(&mut scene, 0.5);
    ball(&mut scene, [0.0; 3], 1.0, "veil");
    for triangles in [false, true] {
        if triangles {
            scene.planes.push(card(-5.0, "veil"));
        }
        for x in [0.0, 0.7, 0.999_999] {
            let tree = tree(&scene, [x, 0.0, 9.0], [0.0, 0.0, -1.0]);
            let left: Vec<f64> = tree.nodes.iter().map(|node| node.throughput.g).collect();
            let expected = if triangles { &[1.0, 0.5, 0.25, 0.125][..] } else { &[1.0, 0.5, 0.25] };
            assert_eq!(left, expected, "{x}");
        }
    }
}

/// Nothing is lost and nothing is made: white leaves in a white room, in front of, behind and within glass, smoothed and mirrored.
#[test]
fn a_white_furnace_with_holes_stays_white() {
    let mut scene = leaves();
    (scene.background, scene.ambient, scene.lights) = (Rgb::gray(1.0), Rgb::gray(1.0), vec![]);
    for material in scene.materials.values_mut() {
        (material.sigma_a, material.ka, material.kr) = (None, Rgb::gray(1.0), Rgb::gray(0.0));
    }
    pictured(&mut scene, "leaf", [5, 4], |x, y| ([1.0; 3], ((x * y) % 5) as f32 / 4.0));
    scene.textures["leaf"].repeat = [3.0, 3.0];
    // A decal on a pane and on a body of glass.
    let pane = Material { eta: 1.4, thickness: Some(0.05), ..scene.materials["leaf"].clone() };
    scene.materials.insert("pane".to_owned(), pane);
    let body = Material { eta: 1.4, ko: Rgb::gray(0.9), ..scene.materials["leaf"].clone() };
    scene.materials.insert("body".to_owned(), body);
    scene.planes.push(Plane::new([-0.4, -0.2, 2.5], [0.3, 0.0, 1.0], [1.0, 1.0], "pane"));
    ball(&mut scene, [0.9, -0.2, 2.0], 0.6, "body");
    for depth in [0, 1, 4, 9] {
        scene.render.max_depth = depth;
        let world = World::new(&scene).unwrap();
        let mut white = 0;
        for pixel in 0..48 * 48 {
            let (radiance, tree) = traced(&scene, &world, pixel % 48, pixel / 48);
            white += u32::from(tree.lost == Rgb::gray(0.0));
            // Some hundred rays, each with a few roundings of 1e-16.
            assert!(close(radiance + tree.lost, Rgb::gray(1.0), 1e-12), "{radiance:?} at {pixel}, depth {depth}");
        }
        assert!(white > 300, "{white} at depth {depth}");
    }
}

/// Widths of lanes, threads, tiles, and no tree: the same bits. And all of them are numbers.
#[test]
fn leaves_have_the_same_bits_everywhere() {
    let mut scene = leaves();
    all_ways("leaves", &scene, THREADS);
    scene.render.shadows = Some(Shadows::Opaque);
    all_ways("leaves with opaque shadows", &scene, &[2]);
    assert!(picture(&scene).pixels.iter().all(|pixel| pixel.to_array().iter().all(|c| c.is_finite())));
}

/// A hundred cards with nothing in the way cost no depth, whatever is around them; what covers a part of the view costs one.
#[test]
fn holes_cost_no_depth() {
    let mut scene = furnace(1);
    (scene.ambient, scene.render.max_depth, scene.render.min_throughput) = (Rgb::gray(1.0), 0, 0.0);
    right_half(&mut scene);
    scene.materials.insert("end".to_owned(), Material { ka: Rgb::new(1.0, 0.0, 0.0), ..Material::default() });
    for number in 0..100 {
        scene.planes.push(card(-0.01 * f64::from(number), "half"));
    }
    scene.planes.push(card(-1.0, "end"));
    assert_eq!(seen(&scene, -0.5, 0.1), Rgb::new(1.0, 0.0, 0.0), "through a hundred holes");
    assert_eq!(seen(&scene, 0.5, 0.1), Rgb::gray(1.0), "the first card");
    veil(&mut scene, 0.5);
    scene.planes.iter_mut().take(3).for_each(|plane| plane.material = "veil".to_owned());
    for depth in 0..4 {
        scene.render.max_depth = depth;
        let tree = tree(&scene, [-0.5, 0.1, 9.0], [0.0, 0.0, -1.0]);
        let left = if depth < 3 { libm::exp2(-f64::from(depth + 1)) } else { 0.0 };
        assert_eq!(tree.lost, Rgb::gray(left), "three veils, of which depth {depth} shows the first ones");
    }
}

/// Half of a leaf makes half of a shadow where shadows are tinted, none where it is not there, and a whole one where it is all
/// there. Opaque shadows are those of whole cards. The explanation names what is in the way, and only that.
#[test]
fn shadows_are_as_dense_as_what_casts_them() {
    let mut scene = furnace(1);
    scene.background = Rgb::gray(0.0);
    scene.lights = vec![Light::from_direction([0.0, 0.0, 1.0], Rgb::gray(1.0))];
    scene.materials.insert("white".to_owned(), Material { kd: Rgb::gray(1.0), ..Material::default() });
    scene.planes.push(Plane::new([0.0, 0.0, -1.0], [0.0, 0.0, 1.0], [9.0, 9.0], "white"));
    // Not there, half there, all there, from left to right.
    pictured(&mut scene, "leaf", [3, 1], |x, _| ([0.5; 3], 0.5 * x as f32));
    scene.planes.push(Plane { name: Some("leaf".to_owned()), ..card(0.0, "leaf") });
    for (shadows, expected) in
        [(Shadows::Tinted, [1.0, 0.5, 0.0]), (Shadows::Opaque, [0.0; 3]), (Shadows::Off, [1.0; 3])]
    {
        scene.render.shadows = Some(shadows);
        for (x, light) in [-2.0 / 3.0, 0.0, 2.0 / 3.0].into_iter().zip(expected) {
            // From the side, below the card.
            let tree = tree(&scene, [x, 3.0, -0.7], [0.0, -10.0, -1.0]);
            assert_eq!(tree.nodes[0].contribution, Rgb::gray(light), "{shadows:?} at {x}");
            let Some(hit) = &tree.nodes[0].hit else { panic!("{shadows:?} at {x}: the floor is missed") };
            let between = hit.lights[0].between.len();
            let named = if shadows == Shadows::Off { 0 } else { usize::from(shadows == Shadows::Opaque || x > -0.5) };
            assert_eq!(between, named, "{shadows:?} at {x}: {hit:?}");
        }
    }
    // Behind a whole leaf stands another thing, which is not what blocks the light.
    scene.render.shadows = Some(Shadows::Tinted);
    glass(&mut scene, "glass", 1.5, 0);
    scene.spheres.push(snell::scene::Sphere::new([2.0 / 3.0, 0.0, 2.0], 0.5, "glass"));
    scene.camera = snell::scene::Camera::new(
        [2.0 / 3.0, 3.0, -0.7],
        [2.0 / 3.0, 0.0, -1.0],
        [0.0, 0.0, 1.0],
        [-1.0, 1.0, -1.0, 1.0],
        -1.0,
    );
    let compiled = CompiledScene::new("leaf", scene.clone()).unwrap();
    let (found, _) = explain(&compiled, 0, 0).unwrap();
    let light = &found.samples[0].nodes[0].local.as_ref().unwrap().lights[0];
    assert_eq!((light.blocked_by.as_deref(), light.through.len()), (Some("leaf"), 0));
    // Several veils between: each takes its share, also from within glass.
    scene.planes[1].material = "veil".to_owned();
    veil(&mut scene, 0.5);
    scene.planes.push(card(0.5, "veil"));
    scene.spheres.clear();
    assert_eq!(tree(&scene, [0.7, 3.0, -0.7], [0.0, -10.0, -1.0]).nodes[0].contribution, Rgb::gray(0.25));
}

/// A card between the eye and a light exactly behind it: what covers is in its own shadow, and what does not shows the light's way.
#[test]
fn a_light_exactly_behind_shines_through_holes_only() {
    let mut scene = furnace(1);
    scene.background = Rgb::gray(0.5);
    scene.lights = vec![Light::at([0.0, 0.0, -5.0], Rgb::gray(1.0)), Light::at([0.0, 0.0, -0.0], Rgb::gray(1.0))];
    veil(&mut scene, 0.25);
    scene.planes.push(card(0.0, "veil"));
    assert_eq!(seen(&scene, 0.0, 0.0), Rgb::gray(0.375), "three quarters of the background, and no light");
}

/// Two things in exactly one place: through the hole of one the other is seen, whichever comes first in the scene.
#[test]
fn through_a_hole_what_is_in_the_same_place_is_seen() {
    let (red, white) = (Rgb::new(1.0, 0.0, 0.0), Rgb::gray(1.0));
    for card_first in [true, false] {
        for tilt in [0.0, 0.3] {
            let mut scene = furnace(1);
            (scene.ambient, scene.background) = (Rgb::gray(1.0), Rgb::gray(0.0));
            right_half(&mut scene);
            pictured(&mut scene, "left", [4, 1], |x, _| ([1.0, 0.0, 0.0], 1.0 - (x / 2) as f32));
            scene.materials.insert("red".to_owned(), Material { ka: red, ..Material::default() });
            let place = |material: &str| Plane { normal: [tilt, 0.1 * tilt, 1.0], ..card(0.0, material) };
            for other in ["left", "red"] {
                let both = ["half", other];
                let order = if card_first { both } else { [both[1], both[0]] };
                scene.planes = order.map(place).to_vec();
                // Three hundred holes in the same place, behind one another in the list.
                scene.planes.splice(1..1, vec![place("half"); 300]);
                assert_eq!(seen(&scene, -0.5, 0.1), red, "{order:?}, tilted by {tilt}");
                if other == "left" {
                    assert_eq!(seen(&scene, 0.5, 0.1), white, "{order:?}, tilted by {tilt}");
                }
            }
        }
    }
    // On a pond: where the leaf is not there the water is met, and where it is, the leaf is seen, from above and from below.
    let mut scene = furnace(1);
    (scene.ambient, scene.background) = (Rgb::gray(1.0), Rgb::gray(0.0));
    right_half(&mut scene);
    glass(&mut scene, "water", 1.33, 0);
    mesh(&mut scene, cuboid([-3.0, -3.0, -2.0], [3.0, 3.0, 0.0]), "water");
    scene.planes.push(card(0.0, "half"));
    for (from, towards) in [(5.0, -1.0), (-5.0, 1.0)] {
        let whole = tree(&scene, [0.5, 0.1, from], [0.0, 0.0, towards]);
        // What is behind the faces of the water is seen through one of them, or through none.
        let r: f64 = (0.33 / 2.33) * (0.33 / 2.33);
        let least = if from > 0.0 { 1.0 } else { 1.0 - r };
        assert!(whole.sum().g >= least - 1e-15 && whole.sum().g <= 1.0, "{:?}", whole.sum());
        let hole = tree(&scene, [-0.5, 0.1, from], [0.0, 0.0, towards]);
        let enters: Vec<_> = hole.nodes.iter().filter(|node| node.depth == 1).map(|node| node.eta).collect();
        assert_eq!(enters, [1.0, 1.33], "the mirror image and the way into the water");
    }
}

/// Paint that lies on a wall or on glass, to within rounding: what is only half there shows half of the wall, and nothing of what is
/// behind that; and glass is met behind it, from outside and from within, whichever is nearer by a rounding.
#[test]
fn what_lies_on_something_hides_its_share_of_it() {
    let turn = Transform::Rotate { axis: [0.7, 1.0, 0.2], degrees: 31.0 };
    for (turned, moved) in [(false, 0.0), (true, 0.0), (true, 1e4)] {
        let steps = if turned { vec![turn.clone(), Transform::Move([moved, 0.0, 0.0])] } else { vec![] };
        let map = steps.iter().fold(Affine::IDENTITY, |map, step| map.then(step.map().unwrap()));
        let look = |scene: &Scene, from: [f64; 3], to: [f64; 3]| {
            let [from, to] = [from, to].map(|at| map.apply(Vec3::from(at)));
            tree(scene, from.into(), (to - from).into())
        };
        let mut scene = furnace(1);
        (scene.ambient, scene.background, scene.render.min_throughput) = (Rgb::gray(1.0), Rgb::gray(100.0), 0.0);
        pictured(&mut scene, "paint", [1, 1], |_, _| ([0.0; 3], 0.5));
        scene.materials.insert("wall".to_owned(), Material { ka: Rgb::gray(1.0), ..Material::default() });
        // Twice the paint, which is one in one place.
        scene.planes = [card(0.0, "paint"), card(0.0, "paint"), card(0.0, "wall")].to_vec();
        // A power of two, by which products are exact: in axes of its own the wall is as far away as the paint to the bit.
        scene.planes[2].size = [8.0, 8.0];
        scene.planes.iter_mut().for_each(|plane| plane.transform = steps.clone());
        for (x, slant) in [(0.3, 0.0), (-0.4, 2.0), (0.35, 30.0), (0.25, 500.0)] {
            let seen = look(&scene, [x - slant, 0.1, 1.0], [x, 0.1, 0.0]).sum();
            // Where the wall is nearer by a rounding, it is all that is seen.
            let allowed: &[f64] = if turned { &[0.5, 1.0] } else { &[0.5] };
            assert!(allowed.iter().any(|&share| close(seen, Rgb::gray(share), 1e-15)), "{seen:?} {x} {slant} {moved}");
        }
        for inside in [false, true] {
            let mut scene = scene.clone();
            scene.background = Rgb::gray(1.0);
            glass(&mut scene, "glass", 1.5, 0);
            scene.planes.truncate(1);
            mesh(&mut scene, cuboid([-3.0, -3.0, -2.0], [3.0, 3.0, 0.0]), "glass");
            scene.meshes[0].transform = steps.clone();
            for (x, slant) in [(0.3, 0.0), (-0.4, 2.0), (0.35, 0.5), (0.25, 1.0)] {
                let from = if inside { -1.0 } else { 1.0 };
                let tree = look(&scene, [x - slant, 0.1, from], [x, 0.1, 0.0]);
                let first = tree.nodes[0].hit.as_ref().unwrap();
                assert_eq!((first.eta[0], first.eta[1]), if inside { (1.5, 1.5) } else { (1.0, 1.0) }, "the paint");
                let second: Vec<_> = tree.nodes.iter().filter(|node| node.depth == 1).collect();
                let eta = second[0].hit.as_ref().unwrap().eta;
                assert!(second.len() == 1 && eta == if inside { [1.5, 1.0] } else { [1.0, 1.5] }, "{second:?}");
                // All that is white is seen once, but for the black half that is met first, and again from within.
                assert_eq!(second[0].throughput, Rgb::gray(0.5));
            }
            let statistics =
                render(&World::new(&scene).unwrap(), &Settings::from(&scene), &Options::default()).unwrap().statistics;
            assert_eq!(statistics.stray.count, 0);
        }
    }
}

/// On both sides the same, mirrored; and a card in whose plane the eye is is not seen.
#[test]
fn a_card_has_two_sides_and_no_edge() {
    let mut scene = furnace(33);
    (scene.ambient, scene.background) = (Rgb::gray(1.0), Rgb::new(0.0, 0.2, 0.4));
    pictured(&mut scene, "leaf", [7, 5], |x, y| ([0.1 * x as f32, 1.0, 0.1], ((3 * x + y) % 4) as f32 / 3.0));
    scene.planes.push(Plane::new([0.0; 3], [0.0, 0.0, 1.0], [3.1, 3.1], "leaf"));
    let front = picture(&scene);
    scene.camera.eye = [0.0, 0.0, -10.0];
    let mut back = picture(&scene);
    back.pixels.chunks_mut(33).for_each(<[Rgb]>::reverse);
    // Rounded differently, as rays go the other way.
    assert!(alike(&front, &back) == 33 * 33, "{}", alike(&front, &back));
    scene.planes[0].normal = [1.0, 0.0, 0.0];
    assert!(picture(&scene).pixels.iter().all(|&pixel| pixel == scene.background), "edge on");
}

/// A picture on glass is paint: where it is not there the glass is what it was, and is tinted by the picture as far as that is there.
#[test]
fn a_decal_leaves_the_glass_what_it_is() {
    let of = |ko: f64, alpha: Option<f32>, thickness: Option<f64>, tinted_transmission: bool| {
        let mut scene = room();
        scene.render.min_throughput = 0.0;
        glass(&mut scene, "decal", 1.5, 1);
        if let Some(alpha) = alpha {
            pictured(&mut scene, "decal", [1, 1], |_, _| ([0.5, 0.25, 1.0], alpha));
        }
        let look = Material {
            ko: Rgb::gray(ko),
            ks: Rgb::gray(0.0),
            eta: 1.5,
            thickness,
            tinted_transmission,
            ..scene.materials["decal"].clone()
        };
        scene.materials["decal"] = Material { ka: Rgb::gray(1.0), kd: Rgb::gray(1.0), ..look };
        ball(&mut scene, [0.4, 0.2, 2.0], 1.0, "decal");
        picture(&scene)
    };
    let none = Some(0.0);
    for thickness in [None, Some(0.1)] {
        assert_same(&of(0.8, none, thickness, false), &of(0.0, None, thickness, false), "");
        assert_same(&of(0.8, none, thickness, true), &of(0.0, None, thickness, true), "");
        // ko·a: half of 0.5 is 0.25.
        assert_same(&of(0.5, Some(0.5), thickness, false), &of(0.25, Some(1.0), thickness, false), "");
    }
    // Only a pane has glass where an opaque picture is not: it mirrors something there.
    let [bare, pane] = [None, Some(0.0)].map(|thickness| of(1.0, none, thickness, false));
    let mut empty = room();
    empty.render.min_throughput = 0.0;
    assert_same(&bare, &picture(&empty), "");
    assert!(alike(&pane, &picture(&empty)) < pane.pixels.len());
    assert_same(&pane, &of(0.0, None, Some(0.0), false), "");
}

/// A transparent mesh that is drawn opaque, since it is open, has holes like any other.
#[test]
fn an_open_mesh_that_is_opaque_has_holes() {
    let mut scene = furnace(1);
    (scene.ambient, scene.background) = (Rgb::gray(1.0), Rgb::gray(0.25));
    veil(&mut scene, 0.5);
    (scene.materials["veil"].ko, scene.materials["veil"].eta) = (Rgb::gray(0.1), 1.5);
    let corners = [[-1.0, -1.0], [1.0, -1.0], [0.0, 1.0]];
    let geometry = Arc::new(TriangleMesh {
        vertices: corners.map(|[x, y]| Vec3::new(x, y, 0.0)).to_vec(),
        faces: vec![[0, 1, 2]],
        uvs: vec![[0.5, 0.25]; 3],
        face_uvs: vec![[0, 1, 2]],
        ..TriangleMesh::default()
    });
    let (geometry, material, open) = (Some(geometry), Some("veil".to_owned()), Some(OpenMesh::Opaque));
    scene.meshes.push(Mesh { geometry, material, open, ..Mesh::default() });
    let expected = Rgb::new(f64::from(0.3f32), 0.5, 1.0) * 0.5 + Rgb::gray(0.125);
    // `f32` colours times a half, added once.
    assert!(close(seen(&scene, 0.0, 0.0), expected, 1e-15), "{:?}", seen(&scene, 0.0, 0.0));
}

/// The models of the lecture draw a surface wherever it is, as they always did, and say so.
#[test]
fn other_models_say_that_they_do_not_draw_alpha() {
    for integrator in [Integrator::Lecture, Integrator::Course2018, Integrator::Course2020] {
        let with = |alpha: f32| {
            let mut scene = room();
            scene.render.integrator = integrator;
            pictured(&mut scene, "leaf", [4, 4], |x, y| ([x as f32, y as f32, 0.5], if x == y { alpha } else { 1.0 }));
            furnish(&mut scene, "leaf");
            scene
        };
        let warned = |scene: &Scene| {
            let warnings = World::new(scene).unwrap().warnings;
            let of_alpha = warnings.into_iter().filter(|warning| warning.message.contains("alpha"));
            of_alpha.map(|warning| (warning.code, warning.place)).collect::<Vec<_>>()
        };
        let place = ["texture", "leaf", "image"].map(snell::scene::Step::from).to_vec();
        assert_eq!(warned(&with(0.0)), [(WarningCode::NotInThisModel, place)]);
        assert_eq!(warned(&with(1.0)), []);
        assert_same(&picture(&with(0.0)), &picture(&with(1.0)), "");
    }
    assert!(World::new(&leaves()).unwrap().warnings.is_empty(), "it is drawn");
}
