//! Worlds that share geometry with those of scenes like theirs are the worlds that they would be alone.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod common;

use common::{ball, furnace, glass, mesh};
use snell::film::Rgb;
use snell::render::{Options, Settings, render, trace_pixel};
use snell::scene::{Camera, Light, Material, Scene, Sky, Transform};
use snell::world::World;
use snell_test_scenes::glass::cuboid;
use std::sync::Arc;

/// Changes a scene.
type Edit = fn(&mut Scene);

fn camera(scene: &mut Scene, change: impl Fn(f64) -> f64) {
    scene.camera.eye = scene.camera.eye.map(change);
}

/// What needs no other tree, whatever the scene.
const KEEPS: [(&str, Edit); 9] = [
    ("nothing", |_| {}),
    ("camera", |scene| camera(scene, |c| 1.1 * c + 0.01)),
    ("camera and all it sees", |scene| {
        scene.camera.look_at = scene.camera.look_at.map(|c| c + 0.1);
        scene.camera.up = [0.1, 1.0, 0.2];
    }),
    ("lights", |scene| {
        scene.lights.push(Light::at([3.0, 4.0, 5.0], Rgb::new(0.1, 0.2, 0.3)));
        scene.ambient = Rgb::gray(0.3);
    }),
    ("a light less", |scene| drop(scene.lights.pop())),
    ("the sky", |scene| {
        scene.background = Rgb::gray(0.0);
        let [horizon, zenith] = [Rgb::new(0.2, 0.3, 0.4), Rgb::new(0.5, 0.1, 0.7)].map(Some);
        scene.sky = Some(Sky { horizon, zenith, nadir: None, image: None, rotate: 0.0, brightness: 1.0, pixels: None });
    }),
    ("colours", |scene| scene.materials.values_mut().for_each(|m| m.kd = Rgb::new(m.kd.b, 0.4, m.kd.r))),
    ("glasses", |scene| {
        for material in scene.materials.values_mut() {
            material.eta *= 1.1;
            material.sigma_a = None;
            material.priority += 1;
        }
    }),
    ("settings", |scene| {
        scene.render.max_depth = 3;
        scene.render.bands = 3;
        scene.eta_outside = 1.1;
    }),
];

/// What may need one.
const MAY_REBUILD: [(&str, Edit); 6] = [
    ("a camera far away", |scene| camera(scene, |c| 1e3 * (c + 1.0))),
    ("glass", |scene| scene.materials.values_mut().for_each(|m| m.ko = Rgb::gray(0.5))),
    ("no glass", |scene| scene.materials.values_mut().for_each(|m| m.ko = Rgb::gray(1.0))),
    ("panes", |scene| scene.materials.values_mut().for_each(|m| m.thickness = Some(0.01))),
    ("another place", |scene| scene.spheres.iter_mut().for_each(|sphere| sphere.center[0] += 0.1)),
    ("another material", |scene| {
        let first = scene.materials.keys().next().cloned();
        for sphere in &mut scene.spheres {
            sphere.material.clone_from(first.as_ref().unwrap());
        }
    }),
];

/// Is the edited world the new one? And does it share its tree, if both can be built?
fn compare(name: &str, edit: &str, before: &Scene, change: Edit) -> Option<bool> {
    let mut after = before.clone();
    change(&mut after);
    let world = World::new(before).unwrap();
    let (edited, new) = match (world.edited(before, &after), World::new(&after)) {
        (Ok(edited), Ok(new)) => (edited, new),
        (edited, new) => {
            assert_eq!(edited.err(), new.err(), "{name}, {edit}");
            return None;
        }
    };
    assert_eq!(edited.warnings, new.warnings, "{name}, {edit}");
    let picture = |world: &World| render(world, &Settings::from(&after), &Options::default()).unwrap();
    let [edited_picture, new_picture] = [&edited, &new].map(picture);
    assert!(edited_picture.film.pixels == new_picture.film.pixels, "{name}, {edit}: other pixels");
    assert_eq!(edited_picture.statistics, new_picture.statistics, "{name}, {edit}");
    Some(Arc::ptr_eq(&edited.stage.tree, &world.stage.tree))
}

/// Solids that touch, a mesh, a camera within glass.
fn stage() -> Scene {
    let mut scene = furnace(24);
    glass(&mut scene, "crown", 1.5, 0);
    glass(&mut scene, "flint", 1.7, 0);
    scene.materials.insert("wall".to_owned(), Material { kd: Rgb::gray(0.5), ..Material::default() });
    ball(&mut scene, [0.0; 3], 1.0, "crown");
    mesh(&mut scene, cuboid([-1.5, -1.5, -1.0], [-0.5, 1.5, 1.0]), "flint");
    mesh(&mut scene, cuboid([-9.0, -3.0, -9.0], [9.0, -1.5, 9.0]), "wall");
    scene.lights.push(Light::at([2.0, 5.0, 4.0], Rgb::gray(0.8)));
    scene
}

#[test]
fn an_edited_world_is_the_new_one() {
    let (mut kept, mut rebuilt) = (0, 0);
    for (name, scene) in snell_test_scenes::all().into_iter().chain([("touching".into(), stage())]) {
        let placed = scene.meshes.iter().any(|mesh| !mesh.instances.is_empty());
        for (edit, change) in KEEPS {
            let shares = compare(&name, edit, &scene, change);
            let moves = edit.starts_with("camera");
            assert!(placed && moves || shares != Some(false), "{name}, {edit}: the tree was built anew");
            kept += usize::from(shares == Some(true));
        }
        for (edit, change) in MAY_REBUILD {
            rebuilt += usize::from(compare(&name, edit, &scene, change) == Some(false));
        }
    }
    assert!(kept > 200 && rebuilt > 20, "{kept} kept, {rebuilt} built anew");
}

/// Plates of glass that are nearly in one place, seen at their edges and corners from far away and then from near by, in units of 1e-9 to 1e9:
/// which of them may touch depends on the tolerance, and that on the camera.
#[test]
fn plates_that_nearly_touch_are_what_they_are_from_there() {
    for unit in [1e-9, 1.0, 1e9] {
        for gap in [0.0, 1e-14, 1e-13, 1e-12, 1e-11] {
            let mut scene = furnace(1);
            glass(&mut scene, "crown", 1.5, 0);
            glass(&mut scene, "flint", 1.7, 0);
            for (material, low) in [("crown", 0.0), ("flint", 0.5 + gap)] {
                let corners = [[-1.0, low, -1.0], [1.0, low + 0.5, 1.0]].map(|corner| corner.map(|c| c * unit));
                mesh(&mut scene, cuboid(corners[0], corners[1]), material);
            }
            let looking = |from: [f64; 3], at: [f64; 3]| {
                let (eye, at) = (from.map(|c| c * unit), at.map(|c| c * unit));
                Camera::new(eye, at, [0.1, 1.0, 0.2], [-unit, unit, -unit, unit], -2.0 * unit)
            };
            scene.camera = looking([40.0, 30.0, 50.0], [0.0; 3]);
            let world = World::new(&scene).unwrap();
            for at in [[1.0, 0.5, 1.0], [0.3, 0.5, 1.0], [1.0, 0.5 + gap, -0.2], [0.2, 0.0, 1.0], [1.0, 1.0 + gap, 1.0]]
            {
                for from in [[2.0, 0.6, 3.0], [3.0, 0.5, 2.0], [-2.0, 0.5 + 1e-3, 3.0], [0.4, 4.0, 0.3]] {
                    let mut after = scene.clone();
                    after.camera = looking(from, at);
                    let [edited, new] = [world.edited(&scene, &after), World::new(&after)].map(Result::unwrap);
                    assert!(Arc::ptr_eq(&edited.stage.tree, &world.stage.tree));
                    let settings = Settings::from(&after);
                    let [edited, new] = [&edited, &new].map(|world| trace_pixel(world, &settings, 0, 0).unwrap());
                    assert_eq!(edited, new, "{gap} apart in units of {unit}, from {from:?} at {at:?}");
                }
            }
        }
    }
}

/// Two materials of one glass in a mesh may become another glass together, and not apart.
#[test]
fn what_was_one_glass_may_not_become_two() {
    let mut scene = stage();
    glass(&mut scene, "also flint", 1.7, 0);
    let cut = scene.meshes.remove(0);
    let mut geometry = cut.geometry.as_deref().unwrap().clone();
    geometry.slots = vec!["a".to_owned(), "b".to_owned()];
    geometry.face_slots = (0..geometry.faces.len() as u32).map(|face| face % 2).collect();
    mesh(&mut scene, geometry, "flint");
    let both = scene.meshes.last_mut().unwrap();
    both.material = None;
    both.materials = [("a", "flint"), ("b", "also flint")].map(|(a, b)| (a.to_owned(), b.to_owned())).into();
    let shares = |change: Edit| compare("two slots", "", &scene, change);
    assert_eq!(shares(|scene| scene.materials.values_mut().for_each(|m| m.eta += 0.1)), Some(true));
    assert_eq!(shares(|scene| scene.materials["flint"].eta += 0.1), None, "refused, as if it were new");
}

/// A mesh that was not a solid was fine while opaque.
#[test]
fn an_open_mesh_is_refused_when_it_becomes_glass() {
    let mut scene = stage();
    let mut open = cuboid([2.0, 0.0, 0.0], [3.0, 1.0, 1.0]);
    open.faces.pop();
    mesh(&mut scene, open, "wall");
    scene.meshes[0].transform = vec![Transform::Move([0.1, 0.0, 0.0])];
    assert_eq!(compare("open", "", &scene, |scene| scene.materials["wall"].ko = Rgb::gray(0.0)), None);
    assert_eq!(compare("open", "", &scene, |scene| scene.materials["wall"].kd = Rgb::gray(0.1)), Some(true));
}
