//! One mesh in many places.

use crate::build::{MATERIALS, Numbers, sphere, stage};
use snell::geometry::{TriangleMesh, Vec3};
use snell::scene::{Integrator, Mesh, Scene, Transform};
use std::sync::Arc;

/// Forty rings among spheres, turned, squeezed and mirrored, some in others: held once each kind (`held_once`), or each
/// written out in its place, which must look the same but for roundings.
pub fn instances(offset: f64, held_once: bool) -> Scene {
    let (mut scene, mut numbers) = (stage(Integrator::Lecture), Numbers(29));
    let away = |p: [f64; 3]| p.map(|c| c + offset);
    let ring = Arc::new(ring());
    for (color, smooth_angle) in [("red", 0.0), ("blue", 60.0)] {
        let mesh = Mesh {
            geometry: Some(Arc::clone(&ring)),
            material: Some(color.to_owned()),
            smooth_angle,
            transform: vec![Transform::Rotate { axis: [1.0, 0.0, 0.0], degrees: 30.0 }],
            ..Mesh::default()
        };
        let places = (0..20).map(|_| {
            let mut stretch = || if numbers.next() < 0.5 { 0.5 + 2.0 * numbers.next() } else { -1.5 };
            // A mean of normals is not what it was where they are stretched.
            let scale = if smooth_angle > 0.0 { [stretch(); 3] } else { [stretch(), stretch(), stretch()] };
            let turn = Transform::Rotate { axis: [1.0, numbers.next(), 2.0], degrees: 360.0 * numbers.next() };
            vec![Transform::Scale(scale), turn, Transform::Move(away(numbers.point(50.0)))]
        });
        if held_once {
            scene.meshes.push(Mesh { instances: places.collect(), ..mesh });
        } else {
            let placed = |place: Vec<Transform>| [mesh.transform.clone(), place].concat();
            scene.meshes.extend(places.map(|place| Mesh { transform: placed(place), ..mesh.clone() }));
        }
    }
    for i in 0..40 {
        scene.spheres.push(sphere(away(numbers.point(50.0)), 2.0, MATERIALS[i % 4]));
    }
    (scene.camera.eye, scene.camera.look_at) = (away(scene.camera.eye), away(scene.camera.look_at));
    for light in &mut scene.lights {
        light.position = light.position.map(away);
    }
    scene
}

/// A torus of radii 3 and 1 with 24 by 12 squares.
fn ring() -> TriangleMesh {
    let (around, across) = (24u32, 12u32);
    let mut mesh = TriangleMesh::default();
    for i in 0..around * across {
        let degrees = |k: u32, n: u32| 360.0 * f64::from(k) / f64::from(n);
        let (sin_u, cos_u) = snell::lanes::elementary::sin_cos_degrees(degrees(i / across, around));
        let (sin_v, cos_v) = snell::lanes::elementary::sin_cos_degrees(degrees(i % across, across));
        mesh.vertices.push(Vec3::new((3.0 + cos_v) * cos_u, (3.0 + cos_v) * sin_u, sin_v));
        let at = |i: u32, j: u32| (i % around) * across + j % across;
        let (u, v) = (i / across, i % across);
        mesh.faces.push([at(u, v), at(u + 1, v), at(u + 1, v + 1)]);
        mesh.faces.push([at(u, v), at(u + 1, v + 1), at(u, v + 1)]);
    }
    mesh
}
