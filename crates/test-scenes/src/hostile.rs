//! Scenes of thousands of primitives, each with one kind of trouble. A tree of eight children and leaves of eight has at
//! least three levels over them; the pictures are small, so that testing every ray against everything stays cheap.

use crate::build::{MATERIALS, Numbers, sphere, stage, triangles};
use snell::film::Rgb;
use snell::geometry::Vec3;
use snell::scene::Integrator::{Course2018, Course2020, Lecture};
use snell::scene::{Light, Mesh, Scene, Transform};

/// All of them, each in one model of light or another.
pub fn all() -> [(&'static str, Scene); 10] {
    [
        ("spheres", spheres()),
        ("triangles under the sun", triangles_under_the_sun()),
        ("spheres of 1e-9 and 1e9", tiny_and_huge()),
        ("touching spheres", touching()),
        ("all in the same places", coincident()),
        ("overlapping in one plane", coplanar()),
        ("slivers", slivers()),
        ("no area", degenerate()),
        ("smooth meshes", smooth()),
        ("scattered mirrors", scattered_mirrors()),
    ]
}

/// Of very different sizes, many inside others.
fn spheres() -> Scene {
    let (mut scene, mut numbers) = (stage(Course2020), Numbers(11));
    for i in 0..2400 {
        let radius = [0.01, 0.1, 0.5, 0.5, 0.5, 1.0, 4.0][i % 7];
        scene.spheres.push(sphere(numbers.point(70.0), radius, MATERIALS[i % 4]));
    }
    scene
}

/// With lights at infinity, one of them along an axis, and a sphere of glass.
fn triangles_under_the_sun() -> Scene {
    let (mut scene, mut numbers) = (stage(Course2018), Numbers(13));
    let sun = |direction| Light::from_direction(direction, Rgb::gray(0.5));
    scene.lights = vec![sun([1.0, 2.0, 3.0]), sun([0.0, 1.0, 0.0])];
    for color in MATERIALS {
        let corners = (0..600).flat_map(|i| {
            let (corner, edge) = (numbers.point(70.0), [0.5, 2.0, 8.0][i % 3]);
            [corner, numbers.around(corner, edge), numbers.around(corner, edge)]
        });
        scene.meshes.push(triangles(corners.collect(), color));
    }
    scene.spheres.push(sphere([45.0, 50.0, 70.0], 6.0, "glass"));
    scene
}

/// Four spheres of radius 1e-9 on or just beside the ray of every pixel, between a floor and a wall of radius 1e9.
pub fn tiny_and_huge() -> Scene {
    let (mut scene, mut numbers) = (stage(Lecture), Numbers(17));
    let camera = &scene.camera;
    let (eye, [right, up, back]) = (Vec3::from(camera.eye), camera.axes().unwrap());
    let [left, _, _, top] = camera.bounds.unwrap();
    let step = 4.0 / 23.0; // the bounds are [-2, 2, -2, 2], and the pixels of the edges lie on them
    for pixel in 0..576u32 {
        let (x, y) = (f64::from(pixel % 24), f64::from(pixel / 24));
        let on_plane = right * (left + x * step) + up * (top - y * step) + back * camera.image_plane();
        for i in 0..4 {
            let at = eye + on_plane * (4.0 + 12.0 * numbers.next());
            // Off the ray by up to 1.5 radii along each axis: some are hit in the middle, some at the rim, some missed.
            let center = numbers.around([at.x, at.y, at.z], 3e-9);
            scene.spheres.push(sphere(center, 1e-9, MATERIALS[i % 4]));
        }
    }
    scene.spheres.push(sphere([50.0, -1e9, 50.0], 1e9, "blue"));
    scene.spheres.push(sphere([50.0, 50.0, -1e9], 1e9, "glass"));
    scene
}

/// A lattice: every sphere touches six others at points that are exact in binary, and the lowest layer a floor.
fn touching() -> Scene {
    let mut scene = stage(Course2020);
    for i in 0..13 * 13 * 13u32 {
        let place = [i % 13, i / 13 % 13, i / 169].map(f64::from);
        let center = [38.0 + 2.0 * place[0], 38.0 + 2.0 * place[1], 36.0 + 2.0 * place[2]];
        scene.spheres.push(sphere(center, 1.0, MATERIALS[(i + i / 13 + i / 169) as usize % 4]));
    }
    let (a, b, c, d) = ([0.0, 37.0, 0.0], [0.0, 37.0, 90.0], [100.0, 37.0, 90.0], [100.0, 37.0, 0.0]);
    scene.meshes.push(triangles(vec![a, b, c, a, c, d], "green"));
    scene
}

/// The same sphere and the same triangle hundreds of times, of different materials: the first in the scene is seen.
fn coincident() -> Scene {
    let (mut scene, mut numbers) = (stage(Lecture), Numbers(19));
    for place in 0..5 {
        let center = numbers.point(40.0);
        let (a, b, c) = (numbers.point(50.0), numbers.point(50.0), numbers.point(50.0));
        for i in 0..240 {
            scene.spheres.push(sphere(center, 6.0, MATERIALS[(i + place) % 4]));
        }
        for i in 0..4 {
            // Turned and turned over: the same place, but not the same arithmetic.
            let orders = [[a, b, c], [b, c, a], [c, a, b], [c, b, a]];
            let corners = (0..60).flat_map(|k| orders[(i + k) % 4]);
            scene.meshes.push(triangles(corners.collect(), MATERIALS[(place + 1 + i) % 4]));
        }
    }
    scene
}

/// Three sheets of different grain in one plane along an axis and in one aslant, of whole-numbered corners, with spheres
/// that the planes cut.
fn coplanar() -> Scene {
    let (mut scene, mut numbers) = (stage(Course2018), Numbers(23));
    for aslant in [false, true] {
        let height = |x: f64, y: f64| if aslant { 130.0 - x - y } else { 25.0 };
        for (cell, color) in [(4.0, "red"), (5.0, "green"), (6.0, "blue")] {
            let count = (72.0 / cell) as u32;
            let corners = (0..count * count).flat_map(|i| {
                let (x, y) = (14.0 + cell * f64::from(i % count), 14.0 + cell * f64::from(i / count));
                let at = |dx: f64, dy: f64| [x + dx, y + dy, height(x + dx, y + dy)];
                [at(0.0, 0.0), at(cell, 0.0), at(cell, cell), at(0.0, 0.0), at(cell, cell), at(0.0, cell)]
            });
            scene.meshes.push(triangles(corners.collect(), color));
        }
    }
    for i in 0..60 {
        let [x, y, _] = numbers.point(60.0);
        let z = if i % 2 == 0 { 25.0 } else { 130.0 - x - y };
        scene.spheres.push(sphere([x, y, z], 2.0, MATERIALS[i % 4]));
    }
    scene
}

/// Triangles thirty long and down to 1e-9 wide, and a sphere of glass.
fn slivers() -> Scene {
    let (mut scene, mut numbers) = (stage(Lecture), Numbers(29));
    for color in MATERIALS {
        let corners = (0..600).flat_map(|i| {
            let width = [1.0, 0.3, 0.1, 1e-3, 1e-6, 1e-9][i % 6];
            let near = numbers.point(60.0);
            [near, numbers.around(near, width), numbers.around(near, 60.0)]
        });
        scene.meshes.push(triangles(corners.collect(), color));
    }
    scene.spheres.push(sphere([55.0, 50.0, 70.0], 6.0, "glass"));
    scene
}

/// Triangles that are a point or a line, exactly or nearly, among some that are not, and spheres of radius 0.
fn degenerate() -> Scene {
    let (mut scene, mut numbers) = (stage(Course2020), Numbers(31));
    for color in MATERIALS {
        let corners = (0..1000).flat_map(|i| {
            let (a, b) = (numbers.point(60.0), numbers.point(60.0));
            match i % 5 {
                0 => [a, a, a],
                1 => [a, b, b],
                2 => [a, b, [0, 1, 2].map(|k| f64::midpoint(a[k], b[k]))],
                3 => [a, b, numbers.around(b, 1e-14)],
                _ => [a, numbers.around(a, 9.0), numbers.around(a, 9.0)],
            }
        });
        scene.meshes.push(triangles(corners.collect(), color));
    }
    scene.spheres.extend((0..400).map(|i| sphere(numbers.point(60.0), [0.0, 1.0][i % 2], MATERIALS[i / 2 % 4])));
    scene
}

/// Balls of triangles, smooth, squashed and mirrored, that cut each other.
fn smooth() -> Scene {
    let mut scene = stage(Lecture);
    for (i, degrees) in [0.0, 33.0, 66.0].into_iter().enumerate() {
        let mut ball = octahedral_ball(10, MATERIALS[i + 1]);
        // At 5° some edges stay sharp, at 180° none.
        ball.smooth_angle = [180.0, 30.0, 5.0][i];
        ball.transform = vec![
            Transform::Scale([12.0, [9.0, -12.0, 4.0][i], 12.0]),
            Transform::Rotate { axis: [1.0, 2.0, 3.0], degrees },
            Transform::Move([38.0 + 12.0 * i as f64, 50.0, 40.0]),
        ];
        scene.meshes.push(ball);
    }
    scene.spheres.push(sphere([50.0, 62.0, 55.0], 5.0, "glass"));
    scene
}

/// A sphere of radius 1 of 8·n² triangles: an octahedron, each side cut n times, blown up.
fn octahedral_ball(n: u32, material: &str) -> Mesh {
    let mut mesh = Mesh { material: Some(material.to_owned()), ..Mesh::default() };
    for octant in 0..8u32 {
        let sign = [1, 2, 4].map(|bit| if octant & bit == 0 { 1.0 } else { -1.0 });
        let mut vertex = |i: u32, j: u32| {
            let at = [i, j, n - i - j].map(f64::from);
            let unit = Vec3::from([0, 1, 2].map(|k| sign[k] * at[k])).unit();
            let place = [unit.x, unit.y, unit.z];
            // Octants share the vertices of their edges, so that normals are smoothed over them. -0 is 0.
            let known = mesh.vertices.iter().position(|v| *v == place);
            known.unwrap_or_else(|| {
                mesh.vertices.push(place);
                mesh.vertices.len() - 1
            }) as u32
        };
        let outside = octant.count_ones().is_multiple_of(2);
        let mut face = |[a, b, c]: [u32; 3]| mesh.faces.push(if outside { [a, b, c] } else { [a, c, b] });
        for i in 0..n {
            for j in 0..n - i {
                let (a, b, c) = (vertex(i, j), vertex(i + 1, j), vertex(i, j + 1));
                face([a, b, c]);
                if i + j + 1 < n {
                    face([b, vertex(i + 1, j + 1), c]);
                }
            }
        }
    }
    mesh
}

/// Perfect mirrors in all directions, and some glass, in a closed room: after a bounce no two rays of a group go the same way.
fn scattered_mirrors() -> Scene {
    let (mut scene, mut numbers) = (stage(Lecture), Numbers(37));
    scene.render.max_depth = 5;
    for color in ["red", "green", "blue"] {
        scene.materials[color].kr = Rgb::gray(1.0);
    }
    for axis in 0..3 {
        for (middle, out) in [(0.0, -1.0), (110.0, 1.0)] {
            let mut center = [50.0; 3];
            center[axis] = middle + out * 1000.0;
            scene.spheres.push(sphere(center, 1000.0, "red"));
        }
    }
    scene.spheres.extend((0..1200).map(|i| sphere(numbers.point(70.0), 0.8, MATERIALS[i % 4])));
    let corners = (0..1200).flat_map(|_| {
        let corner = numbers.point(70.0);
        [corner, numbers.around(corner, 6.0), numbers.around(corner, 6.0)]
    });
    scene.meshes.push(triangles(corners.collect(), "green"));
    scene
}
