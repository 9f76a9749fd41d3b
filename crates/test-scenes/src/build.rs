//! What scenes are put together from.

use snell::scene::{Integrator, Mesh, Scene, Sphere};
use snell_formats::builtin;
use snell_formats::scene_file::{Syntax, parse};

/// The materials of the lecture's scene: glass, and mirrors that are red, green and blue.
pub const MATERIALS: [&str; 4] = ["glass", "red", "green", "blue"];

/// A built-in scene as a square picture of `size` pixels.
pub fn lecture(name: &str, size: u32) -> Scene {
    at_size(parse(&builtin::find(name).unwrap(), Syntax::Toml).unwrap(), size)
}

/// The scene as a square picture of `size` pixels.
pub fn at_size(mut scene: Scene, size: u32) -> Scene {
    scene.render.size = [size, size];
    scene
}

/// The lecture's scene without its spheres, small.
pub fn stage(integrator: Integrator) -> Scene {
    let mut scene = lecture("lecture/default", 24);
    scene.render.integrator = integrator;
    scene.render.max_depth = 4;
    scene.spheres.clear();
    scene
}

pub fn sphere(center: [f64; 3], radius: f64, material: &str) -> Sphere {
    Sphere::new(center, radius, material)
}

/// Triangles that share no vertices.
pub fn triangles(corners: Vec<[f64; 3]>, material: &str) -> Mesh {
    let faces = (0..corners.len() as u32 / 3).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    Mesh { vertices: corners, faces, material: Some(material.to_owned()), ..Mesh::default() }
}

/// A small generator of numbers (Knuth's MMIX constants): the same scenes on every machine.
pub struct Numbers(pub u64);

impl Numbers {
    /// From 0 to 1.
    pub fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    /// In a cube of this edge around `middle`.
    pub fn around(&mut self, middle: [f64; 3], edge: f64) -> [f64; 3] {
        middle.map(|c| c + edge * (self.next() - 0.5))
    }

    /// In a cube of this edge around the middle of the lecture's scenes.
    pub fn point(&mut self, edge: f64) -> [f64; 3] {
        self.around([50.0; 3], edge)
    }
}
