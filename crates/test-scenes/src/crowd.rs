//! The scenes of the first engine. The crowd is part of the golden hash: it must stay as it is.

use crate::build::{MATERIALS, Numbers, lecture, sphere, triangles};
use snell::film::Rgb;
use snell::scene::{Integrator, Material, Scene};

/// Many spheres and triangles: far and near, tiny and huge, touching, coinciding, coplanar, degenerate.
pub fn crowd(integrator: Integrator) -> Scene {
    let mut numbers = Numbers(7);
    let mut scene = lecture("lecture/default", 24);
    scene.render.integrator = integrator;
    scene.render.max_depth = 4;
    for i in 0..600 {
        let radius = [1e-9, 0.01, 0.5, 1.0, 3.0][i % 5];
        scene.spheres.push(sphere(numbers.point(60.0), radius, MATERIALS[i % 4]));
    }
    // Three spheres in the same place, a row that touches, and a floor of radius 1e9.
    scene.spheres.extend((0..3).map(|i| sphere([40.0, 30.0, 40.0], 4.0, MATERIALS[i])));
    scene.spheres.extend((0..8).map(|i| sphere([30.0 + 4.0 * i as f64, 70.0, 40.0], 2.0, MATERIALS[i % 4])));
    scene.spheres.push(sphere([50.0, -1e9, 50.0], 1e9, "blue"));
    let mut corners = Vec::new();
    for i in 0..600 {
        let corner = numbers.point(60.0);
        let mut triangle = [corner, numbers.around(corner, 6.0), numbers.around(corner, 6.0)];
        match i % 5 {
            // Coplanar ones overlap at the same distance; some have no area.
            0 => triangle.iter_mut().for_each(|p| p[2] = 35.0),
            1 if i % 2 == 0 => triangle[2] = triangle[1],
            _ => {}
        }
        corners.extend(triangle);
    }
    let mirror = Material { kr: Rgb::gray(0.5), kd: Rgb::gray(0.4), ..Material::default() };
    scene.materials.insert("mirror".to_owned(), mirror);
    scene.meshes.push(triangles(corners, "mirror"));
    scene
}

/// Four coplanar patches of triangles with whole-numbered corners, seen from near, far away from the origin: no box has
/// room to spare but the margin that it is given.
pub fn far_away(offset: f64, seed: u64, flat: bool) -> Scene {
    let mut numbers = Numbers(seed);
    let mut scene = lecture("lecture/default", 33);
    scene.spheres.clear();
    let at = |p: [f64; 3]| p.map(|c| c + offset);
    (scene.camera.eye, scene.camera.look_at) = (at([7.3, 9.1, 30.0]), at([8.0, 8.0, 0.0]));
    (scene.camera.near, scene.camera.bounds) = (Some(-10.0), Some([-3.0, 3.0, -3.0, 3.0]));
    for (i, light) in scene.lights.iter_mut().enumerate() {
        light.position = Some(at([20.0 * i as f64, 25.0, 20.0]));
    }
    for (i, color) in MATERIALS.into_iter().enumerate() {
        let whole = |n: &mut Numbers| (16.0 * n.next()).floor();
        let height = if flat { 0.0 } else { i as f64 };
        let corners = (0..36).map(|_| at([whole(&mut numbers), whole(&mut numbers), height])).collect();
        scene.meshes.push(triangles(corners, color));
        let center = at([whole(&mut numbers), whole(&mut numbers), 1.0]);
        scene.spheres.push(sphere(center, 1.0, color));
    }
    scene
}

/// A room whose walls are huge mirror spheres, full of glass of index 1: rays never get out, and most split in two, so
/// that `max_depth` decides how many there are.
pub fn hall_of_mirrors(max_depth: u32) -> Scene {
    let mut scene = lecture("lecture/default", 24);
    scene.render.max_depth = max_depth;
    scene.materials["red"].kr = Rgb::gray(1.0);
    let glass = &mut scene.materials["glass"];
    (glass.eta, glass.kr) = (1.0, Rgb::gray(1.0));
    scene.spheres.clear();
    for axis in 0..3 {
        for (middle, out) in [(-20.0, -1.0), (120.0, 1.0)] {
            let mut center = [50.0; 3];
            center[axis] = middle + out * 1000.0;
            scene.spheres.push(sphere(center, 1000.0, "red"));
        }
    }
    for i in 0..64 {
        let grid = |step: i32| f64::from((i / step) % 4) * 25.0;
        scene.spheres.push(sphere([12.0 + grid(1), 12.0 + grid(4), grid(16)], 12.0, "glass"));
    }
    scene
}
