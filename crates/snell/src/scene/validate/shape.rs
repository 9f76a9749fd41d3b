//! Checks of shapes and of where they stand.

use super::{Findings, Step};
use crate::geometry::Vec3;
use crate::scene::{Mesh, Scene, Transform, WarningCode};

pub(super) fn spheres(scene: &Scene, found: &mut Findings) {
    for (i, sphere) in scene.spheres.iter().enumerate() {
        found.numbers(&place!["sphere", i, "center"], &sphere.center);
        found.not_negative(place!["sphere", i, "radius"], sphere.radius, "a radius");
        if sphere.radius == 0.0 {
            let at = place!["sphere", i, "radius"];
            found.warning(WarningCode::InvisibleSphere, at, "a sphere of radius 0 is invisible");
        }
        known_material(scene, found, place!["sphere", i, "material"], &sphere.material);
        placed(found, "sphere", i, &sphere.transform, &sphere.instances);
    }
}

fn known_material(scene: &Scene, found: &mut Findings, at: Vec<Step>, name: &str) {
    if !scene.materials.contains_key(name) {
        let known = super::names(scene.materials.keys());
        let message = format!("no material is called `{name}`");
        found.problem(at, message, &format!("materials of this scene: {known}; or add [material.{name}]"));
    }
}

/// The steps that put a shape in its place, or in several.
fn placed(found: &mut Findings, kind: &str, i: usize, transform: &[Transform], instances: &[Vec<Transform>]) {
    for (k, step) in transform.iter().enumerate() {
        transform_step(found, place![kind, i, "transform", k], step);
    }
    for (n, steps) in instances.iter().enumerate() {
        for (k, step) in steps.iter().enumerate() {
            transform_step(found, place![kind, i, "instances", n, k], step);
        }
    }
}

/// The materials on both sides of faces that are interfaces.
fn interface(scene: &Scene, found: &mut Findings, kind: &str, i: usize, sides: (Option<&String>, Option<&String>)) {
    let (inside, outside) = sides;
    for (key, name) in [("inside", inside), ("outside", outside)] {
        let Some(name) = name else { continue };
        known_material(scene, found, place![kind, i, key], name);
    }
    if outside.is_some() && (inside.is_none() || inside == outside) {
        let message = "`outside` needs another material `inside`: between the two is the interface";
        found.problem(place![kind, i, "outside"], message, "for a solid give neither of them");
    }
}

fn transform_step(found: &mut Findings, at: Vec<Step>, step: &Transform) {
    let fine = match step {
        Transform::Rotate { axis, degrees } => found.numbers(&at, axis) && found.number(at.clone(), *degrees),
        Transform::Scale(v) | Transform::Move(v) => found.numbers(&at, v),
    };
    if fine && step.map().is_none() {
        found.problem(at, "a rotation needs an axis, read [0, 0, 0]", "[0, 1, 0] turns about the y axis");
    }
}

pub(super) fn meshes(scene: &Scene, found: &mut Findings) {
    for (i, mesh) in scene.meshes.iter().enumerate() {
        let at = |key: &str| place!["mesh", i, key];
        found.not_negative(at("smooth_angle"), mesh.smooth_angle, "an angle");
        if let Some(name) = &mesh.material {
            known_material(scene, found, at("material"), name);
        }
        for (slot, name) in &mesh.materials {
            known_material(scene, found, place!["mesh", i, "materials", slot.as_str()], name);
        }
        placed(found, "mesh", i, &mesh.transform, &mesh.instances);
        let sides = (mesh.inside.as_ref(), mesh.outside.as_ref());
        interface(scene, found, "mesh", i, sides);
        if mesh.open.is_some() && mesh.inside.is_some() {
            let message = "faces with media on both sides need not be closed, so that `open` says nothing";
            found.problem(at("open"), message, "remove `open`, or `inside`");
        }
        let written_out = !mesh.vertices.is_empty() || !mesh.faces.is_empty();
        match (mesh.file.is_some(), written_out) {
            (true, true) => {
                found.problem(at("file"), "a mesh has a file or vertices and faces, not both", "remove one of them");
            }
            (false, false) if mesh.geometry.is_none() => {
                let help = "add `file = \"model.obj\"`, or `vertices` and `faces`";
                found.problem(place!["mesh", i], "a mesh needs a file, or vertices and faces", help);
            }
            (false, true) => inline_mesh(mesh, i, found),
            _ => {}
        }
    }
}

fn inline_mesh(mesh: &Mesh, i: usize, found: &mut Findings) {
    for (k, vertex) in mesh.vertices.iter().enumerate() {
        found.numbers(&place!["mesh", i, "vertices", k], vertex);
    }
    let count = mesh.vertices.len();
    if mesh.faces.is_empty() {
        found.problem(place!["mesh", i, "vertices"], "a mesh with vertices needs faces", "like `faces = [[0, 1, 2]]`");
    }
    for (k, face) in mesh.faces.iter().enumerate() {
        if let Some(bad) = face.iter().find(|&&v| v as usize >= count) {
            let message = format!("face asks for vertex {bad}, but there are {count}, counted from 0");
            found.problem(place!["mesh", i, "faces", k], message, "");
        }
    }
    if mesh.material.is_none() {
        let help = "add `material = \"name\"`";
        found.problem(place!["mesh", i], "a mesh that is written out needs a material", help);
    }
}

fn normal(found: &mut Findings, at: Vec<Step>, normal: [f64; 3]) {
    if found.numbers(&at, &normal) && !Vec3::from(normal).unit().is_finite() {
        found.problem(at, "normal is (0, 0, 0), or too short to be one", "[0, 1, 0] looks up");
    }
}

pub(super) fn planes(scene: &Scene, found: &mut Findings) {
    for (i, plane) in scene.planes.iter().enumerate() {
        let at = |key: &str| place!["plane", i, key];
        found.numbers(&at("center"), &plane.center);
        normal(found, at("normal"), plane.normal);
        for size in plane.size {
            found.positive(at("size"), size, "a width or height", "");
        }
        known_material(scene, found, at("material"), &plane.material);
        interface(scene, found, "plane", i, (plane.inside.as_ref(), plane.outside.as_ref()));
        placed(found, "plane", i, &plane.transform, &plane.instances);
    }
}

pub(super) fn boxes(scene: &Scene, found: &mut Findings) {
    for (i, cuboid) in scene.boxes.iter().enumerate() {
        let at = |key: &str| place!["box", i, key];
        let numbers = found.numbers(&at("min"), &cuboid.min) && found.numbers(&at("max"), &cuboid.max);
        if numbers && cuboid.min.iter().zip(cuboid.max).any(|(&min, max)| min >= max) {
            let message = format!("min {:?} must be below max {:?} in every coordinate", cuboid.min, cuboid.max);
            found.problem(at("max"), message, "a box has a volume; a flat one is a plane");
        }
        known_material(scene, found, at("material"), &cuboid.material);
        placed(found, "box", i, &cuboid.transform, &cuboid.instances);
    }
}

pub(super) fn discs(scene: &Scene, found: &mut Findings) {
    for (i, disc) in scene.discs.iter().enumerate() {
        let at = |key: &str| place!["disc", i, key];
        found.numbers(&at("center"), &disc.center);
        normal(found, at("normal"), disc.normal);
        found.positive(at("radius"), disc.radius, "a radius", "");
        known_material(scene, found, at("material"), &disc.material);
        interface(scene, found, "disc", i, (disc.inside.as_ref(), disc.outside.as_ref()));
        placed(found, "disc", i, &disc.transform, &disc.instances);
    }
}

/// Rings of more corners, and longer profiles, are models and belong into files.
const MOST_SEGMENTS: u32 = 4096;
const MOST_POINTS: usize = 4096;

pub(super) fn lathes(scene: &Scene, found: &mut Findings) {
    for (i, lathe) in scene.lathes.iter().enumerate() {
        let at = |key: &str| place!["lathe", i, key];
        if !(2..=MOST_POINTS).contains(&lathe.profile.len()) {
            let message = format!("a profile has 2 to {MOST_POINTS} points, read {}", lathe.profile.len());
            found.problem(at("profile"), message, "like [[0, 0], [1, 0], [0, 2]] for a cone");
        }
        for (k, point) in lathe.profile.iter().enumerate() {
            let place = place!["lathe", i, "profile", k];
            if found.numbers(&place, point) && point[0] < 0.0 {
                found.problem(place, format!("a radius must not be negative, read {}", point[0]), "");
            }
        }
        if !(3..=MOST_SEGMENTS).contains(&lathe.segments) {
            let message = format!("expected 3 to {MOST_SEGMENTS} corners of a ring, read {}", lathe.segments);
            found.problem(at("segments"), message, "");
        }
        found.not_negative(at("smooth_angle"), lathe.smooth_angle, "an angle");
        known_material(scene, found, at("material"), &lathe.material);
        interface(scene, found, "lathe", i, (lathe.inside.as_ref(), lathe.outside.as_ref()));
        placed(found, "lathe", i, &lathe.transform, &lathe.instances);
    }
}
