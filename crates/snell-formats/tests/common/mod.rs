//! Rooms, glasses and ways of looking at them that several test files share.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]
#![allow(dead_code, reason = "not every test file needs everything")]

use snell::film::{Film, Rgb};
use snell::geometry::{TriangleMesh, Vec3};
use snell::render::{Options, render, trace_pixel};
use snell::scene::{Camera, Integrator, Material, Mesh, Render, Scene, Sphere, Transfer};
use snell::trace::{RayKind, RayTree};
use snell::world::World;
use std::io::Write;
use std::path::{Path, PathBuf};
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
    render(&World::new(scene).unwrap(), &Options::default()).unwrap().film
}

/// A pixel of one sample, and its tree.
pub fn traced(world: &World, x: u32, y: u32) -> (Rgb, RayTree) {
    let mut pixel = trace_pixel(world, x, y).unwrap();
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
    traced(&World::new(&scene).unwrap(), 0, 0).1
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

/// The real files that are tested with but not part of the project: `SNELL_DATA`, or `shared/data` beside the clone.
pub fn data() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    present(std::env::var_os("SNELL_DATA").map_or(beside, PathBuf::from))
}

/// Small inputs that went wrong once, in `shared/cases` beside the clone.
pub fn cases() -> Option<PathBuf> {
    present(Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/cases"))
}

fn present(folder: PathBuf) -> Option<PathBuf> {
    if folder.is_dir() {
        return Some(folder);
    }
    // Not by `eprintln!`, which the test harness hides where a test passes.
    let line = format!("SKIPPED: the real files are not there ({}); set SNELL_DATA\n", folder.display());
    std::io::stderr().write_all(line.as_bytes()).unwrap();
    None
}
