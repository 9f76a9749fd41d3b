//! Rooms, glasses and ways of looking at them that several test files share.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]
#![allow(dead_code, reason = "not every test file needs everything")]

use snell::film::{Film, Rgb};
use snell::geometry::{TriangleMesh, Vec3};
use snell::render::{Options, Settings, render, trace_pixel};
use snell::scene::{
    Camera, Integrator, Lathe, Light, Material, Mesh, Plane, Render, Scene, Sphere, Texture, Transfer, Transform,
};
use snell::texture::Image;
use snell::trace::{RayKind, RayTree};
use snell::world::World;
use std::sync::Arc;

/// An empty white room, seen along −z.
pub fn furnace(size: u32) -> Scene {
    let render = Render { transfer: Transfer::Linear, ..Render::new(Integrator::Whitted, [size, size]) };
    let camera = Camera::new([0.0, 0.0, 10.0], [0.0; 3], [0.0, 1.0, 0.0], [-2.0, 2.0, -2.0, 2.0], -5.0);
    Scene { background: Rgb::gray(1.0), ..Scene::new(render, camera) }
}

pub fn glass(scene: &mut Scene, name: &str, eta: f64, priority: i32) {
    let material = Material { ko: Rgb::gray(0.0), eta, priority, ..Material::default() };
    scene.materials.insert(name.to_owned(), material);
}

pub fn ball(scene: &mut Scene, center: [f64; 3], radius: f64, material: &str) {
    scene.spheres.push(Sphere::new(center, radius, material));
}

pub fn mesh(scene: &mut Scene, geometry: TriangleMesh, material: &str) {
    let geometry = Some(Arc::new(geometry));
    scene.meshes.push(Mesh { geometry, material: Some(material.to_owned()), ..Mesh::default() });
}

pub fn picture(scene: &Scene) -> Film {
    render(&World::new(scene).unwrap(), &Settings::from(scene), &Options::default()).unwrap().film
}

/// A pixel of one sample, and its tree.
pub fn traced(scene: &Scene, world: &World, x: u32, y: u32) -> (Rgb, RayTree) {
    let mut pixel = trace_pixel(world, &Settings::from(scene), x, y).unwrap();
    (pixel.radiance, pixel.samples.remove(0))
}

/// The tree of the ray that starts at `origin` in direction `dir`: a picture of one pixel.
pub fn tree(scene: &Scene, origin: [f64; 3], dir: [f64; 3]) -> RayTree {
    let mut scene = scene.clone();
    scene.render.size = [1, 1];
    let (eye, dir) = (Vec3::from(origin), Vec3::from(dir).unit());
    let look_at = eye + dir;
    let up = if dir.y.abs() > 0.9 { [0.0, 0.0, 1.0] } else { [0.0, 1.0, 0.0] };
    scene.camera = Camera::new(origin, look_at.into(), up, [-1.0, 1.0, -1.0, 1.0], -1.0);
    traced(&scene, &World::new(&scene).unwrap(), 0, 0).1
}

/// Origin and direction of the ray that was refracted at every interface, and how often.
pub fn straight_through(tree: &RayTree) -> (Vec3, Vec3, usize) {
    let (mut at, mut count) = (0, 0);
    while let Some(next) = tree.nodes.iter().position(|n| n.parent == Some(at) && n.kind == RayKind::Refracted) {
        (at, count) = (next, count + 1);
    }
    (tree.nodes[at].origin, tree.nodes[at].dir, count)
}

/// Are two colours the same to within this in each channel?
pub fn close(a: Rgb, b: Rgb, tolerance: f64) -> bool {
    (a - b).to_array().iter().all(|d| d.abs() <= tolerance)
}

/// How many pixels of two pictures are the same to within 1e-9.
pub fn alike(a: &Film, b: &Film) -> usize {
    a.pixels.iter().zip(&b.pixels).filter(|(a, b)| close(**a, **b, 1e-9)).count()
}

/// Gives a scene a material with a picture of so many columns and rows on it, which `texel` makes: a colour and an alpha.
pub fn pictured(
    scene: &mut Scene,
    name: &str,
    [width, height]: [usize; 2],
    texel: impl Fn(usize, usize) -> ([f32; 3], f32),
) {
    let texels = (0..width * height).map(|at| texel(at % width, at / width));
    let (pixels, alpha) = texels.unzip();
    let image = Arc::new(Image::with_alpha(width, height, pixels, alpha).unwrap());
    let texture = Texture { checker: None, image: None, repeat: [1.0, 1.0], linear: false, pixels: Some(image) };
    scene.textures.insert(name.to_owned(), texture);
    let material =
        Material { ka: Rgb::gray(1.0), kd: Rgb::gray(1.0), texture: Some(name.to_owned()), ..Material::default() };
    scene.materials.insert(name.to_owned(), material);
}

/// A floor, a red wall and balls of glass under two lights, seen along −z; the walls of the room set its size.
pub fn room() -> Scene {
    let mut scene = furnace(48);
    scene.background = Rgb::new(0.2, 0.3, 0.5);
    scene.ambient = Rgb::gray(0.3);
    scene.lights =
        vec![Light::at([4.0, 6.0, 7.0], Rgb::gray(0.6)), Light::from_direction([-1.0, 2.0, 1.0], Rgb::gray(0.4))];
    glass(&mut scene, "glass", 1.5, 0);
    scene.materials["glass"].sigma_a = Some(Rgb::new(0.3, 0.1, 0.05));
    let paint =
        |kd: Rgb, kr: f64| Material { ka: kd, kd, ks: Rgb::gray(0.2), kr: Rgb::gray(kr), ..Material::default() };
    scene.materials.insert("floor".to_owned(), paint(Rgb::gray(0.7), 0.2));
    scene.materials.insert("wall".to_owned(), paint(Rgb::new(0.8, 0.2, 0.1), 0.0));
    scene.planes.push(Plane::new([0.0, -2.0, 0.0], [0.0, 1.0, 0.0], [20.0, 20.0], "floor"));
    scene.planes.push(Plane::new([0.0, 0.0, -6.0], [0.0, 0.0, 1.0], [20.0, 20.0], "wall"));
    ball(&mut scene, [-1.6, -0.5, -1.0], 1.4, "glass");
    ball(&mut scene, [2.2, 0.0, -2.0], 0.9, "glass");
    scene
}

/// Puts things of a material into the [`room`]: a card in front of glass, one within it and one behind, two that cross, two in one
/// plane, a smoothed tent in three places of which one is a mirror image, a ball, and one seen edge on.
pub fn furnish(scene: &mut Scene, material: &str) {
    let card = |center: [f64; 3], normal: [f64; 3], size: [f64; 2]| Plane::new(center, normal, size, material);
    scene.planes.extend([
        card([-1.6, -0.3, 1.5], [0.2, 0.1, 1.0], [1.7, 1.5]),
        card([-1.6, -0.5, -1.0], [0.3, 0.2, 1.0], [1.1, 1.3]),
        card([-1.2, -0.6, -4.0], [-0.1, 0.2, -1.0], [4.0, 3.0]),
        card([1.0, 0.9, 0.0], [1.0, 0.0, 1.0], [1.0, 1.0]),
        card([1.0, 0.9, 0.0], [-1.0, 0.0, 1.0], [1.0, 1.0]),
        card([2.0, 0.0, 1.0], [0.0, 0.0, 1.0], [1.2, 1.0]),
        card([2.3, 0.2, 1.0], [0.0, 0.0, 1.0], [1.2, 1.0]),
        card([0.0, 0.0, 2.0], [1.0, 0.0, 0.0], [1.0, 1.0]),
    ]);
    scene.lathes.push(Lathe {
        name: Some("tent".to_owned()),
        profile: vec![[0.8, -0.5], [0.6, 0.1], [0.0, 0.5]],
        segments: 7,
        smooth_angle: 70.0,
        material: material.to_owned(),
        inside: None,
        outside: None,
        transform: vec![Transform::Rotate { axis: [1.0, 0.0, 0.3], degrees: 25.0 }],
        instances: vec![
            vec![Transform::Move([0.2, -1.4, 0.5])],
            vec![Transform::Scale([0.8, -0.8, 0.8]), Transform::Move([1.7, -1.2, 0.3])],
            vec![Transform::Scale([0.5, 0.6, 0.5]), Transform::Move([2.2, 0.0, -2.0])],
        ],
    });
    ball(scene, [0.0, 1.3, -1.0], 0.7, material);
}

/// The [`room`] with leaves of all alphas in it, twice around and three times up on everything.
pub fn leaves() -> Scene {
    let mut scene = room();
    // Patches of three by three texels, of which a third is not there, and a third is all there.
    pictured(&mut scene, "leaf", [15, 12], |x, y| {
        let alpha = (0.9 * ((3 * (x / 3) + 2 * (y / 3)) % 7) as f32 / 3.0 - 0.4).clamp(0.0, 1.0);
        ([0.06 * x as f32, 0.9, 0.08 * y as f32], alpha)
    });
    scene.textures["leaf"].repeat = [2.0, 3.0];
    furnish(&mut scene, "leaf");
    scene
}
