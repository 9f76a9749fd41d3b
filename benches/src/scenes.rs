//! The scenes, by name.

use crate::flake::{self, Ball};
use crate::{knot, spheres};
use snell::film::Rgb;
use snell::geometry::TriangleMesh;
use snell::scene::{Camera, Integrator, Light, Material, Mesh, Render, Scene, Shadows, Sphere};
use snell_formats::{LoadOptions, load};
use std::f64::consts::PI;
use std::sync::Arc;

/// A scene by its name, with a square picture of `size` pixels a side:
///
/// | name | what |
/// | --- | --- |
/// | `default` | the lecture's default scene, depth 6 |
/// | `flake:L` | sphereflake of L levels on a ground, 3 lights, depth 4 |
/// | `knot` | a million triangles on a ground, depth 2 |
/// | `glass:SHADOWS` | a knot of 100 000 triangles, of glass, over a chessboard, depth 7, shadows `off` or `tinted` |
/// | `spheres:N` | N spheres scattered in a cube, depth 2 |
///
/// # Errors
/// When there is no such scene.
pub fn find(name: &str, size: u32) -> Result<Scene, String> {
    let unknown = || format!("no scene is called `{name}`: try default, flake:5, knot, glass:off, spheres:1000");
    let number = |text: &str| text.parse::<u32>().map_err(|_| unknown());
    match name.split_once(':') {
        None if name == "default" => lecture(size),
        None if name == "knot" => Ok(knot_on_ground(Arc::new(knot::on_ground()), size)),
        Some(("glass", "off")) => Ok(glass_knot(Shadows::Off, size)),
        Some(("glass", "tinted")) => Ok(glass_knot(Shadows::Tinted, size)),
        Some(("flake", levels)) => Ok(sphereflake(number(levels)?, size)),
        Some(("spheres", count)) => Ok(scattered(number(count)?, size)),
        _ => Err(unknown()),
    }
}

fn lecture(size: u32) -> Result<Scene, String> {
    let loaded = load("lecture/default", &LoadOptions::default()).map_err(|reports| format!("{reports:?}"))?;
    let mut scene = loaded.into_scene();
    scene.render.size = [size, size];
    Ok(scene)
}

/// Colours, lights and camera as in `peers/povray.py`.
fn sphereflake(levels: u32, size: u32) -> Scene {
    let intensity = Rgb::gray(1.0 / 3f64.sqrt());
    let (ball, ground) = (Rgb::new(1.0, 0.9, 0.7), Rgb::new(1.0, 0.75, 0.33));
    let shiny = Material { kd: ball * 0.5, ks: Rgb::gray(0.5), kr: Rgb::gray(0.5), spow: 37.0, ..Material::default() };
    let mut scene = scene(4, camera([2.1, 1.3, 1.7], 45.0, size), size);
    scene.lights = [[4.0, 3.0, 2.0], [1.0, -4.0, 4.0], [-3.0, 1.0, 5.0]].map(|at| light(at, intensity)).to_vec();
    scene.materials =
        [("shiny".to_owned(), shiny), ("ground".to_owned(), Material { kd: ground * 0.8, ..Material::default() })]
            .into();
    scene.spheres = flake::balls(levels).iter().map(|ball| sphere(ball, "shiny")).collect();
    scene.meshes = vec![mesh(Arc::new(knot::square(12.0, -0.5)), "ground")];
    scene
}

/// The mesh of [`knot::on_ground`], a part mirror.
pub fn knot_on_ground(geometry: Arc<TriangleMesh>, size: u32) -> Scene {
    let mut scene = scene(2, camera([6.0, -5.0, 4.5], 50.0, size), size);
    scene.lights = vec![light(KNOT_LIGHT, Rgb::gray(0.9))];
    scene.materials = [("grey".to_owned(), part_mirror())].into();
    scene.meshes = vec![mesh(geometry, "grey")];
    scene
}

/// Where the light of the knot's scene stands.
pub const KNOT_LIGHT: [f64; 3] = [8.0, -2.0, 9.0];

/// Everything as in `peers/povray.py`; a branch that weighs less than 1/255 ends, as it does there.
fn glass_knot(shadows: Shadows, size: u32) -> Scene {
    let mut scene = scene(7, camera([6.0, -5.0, 4.5], 50.0, size), size);
    (scene.render.integrator, scene.render.shadows) = (Integrator::Whitted, Some(shadows));
    scene.render.min_throughput = 1.0 / 255.0;
    scene.background = Rgb::new(0.4, 0.55, 0.8);
    scene.lights = vec![light([8.0, -2.0, 9.0], Rgb::gray(0.8)), light([-4.0, -8.0, 7.0], Rgb::gray(0.5))];
    let plain = |color: Rgb| Material { kd: color * 0.8, ..Material::default() };
    let glass = Material { ko: Rgb::gray(0.0), eta: 1.5, ..Material::default() };
    let [white, black] = [Rgb::gray(0.9), Rgb::new(0.15, 0.15, 0.2)].map(plain);
    scene.materials = [("glass", glass), ("white", white), ("black", black)].map(|(n, m)| (n.to_owned(), m)).into();
    let knot = Mesh { smooth_angle: 60.0, ..mesh(Arc::new(knot::knot(500, 100, 0.45)), "glass") };
    let [white, black] = knot::chessboard(32, -1.6).map(Arc::new);
    scene.meshes = vec![knot, mesh(white, "white"), mesh(black, "black")];
    scene
}

fn scattered(count: u32, size: u32) -> Scene {
    let mut scene = scene(2, camera([2.4, 1.6, 2.0], 45.0, size), size);
    scene.lights = vec![light([4.0, 1.0, 5.0], Rgb::gray(0.8))];
    scene.materials = [("grey".to_owned(), part_mirror())].into();
    scene.spheres = spheres::scattered(count).iter().map(|ball| sphere(ball, "grey")).collect();
    scene
}

fn scene(max_depth: u32, camera: Camera, size: u32) -> Scene {
    Scene::new(Render { max_depth, ..Render::new(Integrator::Course2018, [size, size]) }, camera)
}

/// A camera that looks at the origin, z up, with a field of view in degrees. Other programs look through the middles of
/// pixels and Snell through a grid whose corners are the corners of `bounds`: these lie half a pixel further in.
fn camera(eye: [f64; 3], fov: f64, size: u32) -> Camera {
    let edge = libm::tan(fov / 2.0 * PI / 180.0) * (1.0 - 1.0 / f64::from(size));
    // Nothing of these scenes is nearer to the eye than 1.
    Camera::new(eye, [0.0; 3], [0.0, 0.0, 1.0], [-edge, edge, -edge, edge], -1.0)
}

fn light(position: [f64; 3], color: Rgb) -> Light {
    Light::at(position, color)
}

fn part_mirror() -> Material {
    Material { kd: Rgb::gray(0.6), ks: Rgb::gray(0.3), kr: Rgb::gray(0.3), spow: 32.0, ..Material::default() }
}

fn sphere(ball: &Ball, material: &str) -> Sphere {
    Sphere::new(ball.center.into(), ball.radius, material)
}

fn mesh(geometry: Arc<TriangleMesh>, material: &str) -> Mesh {
    Mesh { material: Some(material.to_owned()), geometry: Some(geometry), ..Mesh::default() }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_scene_can_be_built_and_an_unknown_one_is_named() {
        for (name, primitives) in [("default", 4), ("flake:2", 93), ("spheres:100", 100), ("glass:off", 108_192)] {
            let (world, _) = crate::build(&find(name, 8).unwrap(), 1).unwrap();
            assert_eq!(world.primitive_count(), primitives, "{name}");
        }
        assert!(find("flake:many", 8).unwrap_err().contains("flake:many"));
    }
}
