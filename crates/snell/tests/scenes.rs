//! What scenes are made of, against what is known otherwise: shapes and their places, cameras, lights, samples, patterns, skies.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod common;

use common::{alike, ball, close, furnace, glass, picture, tree};
use snell::film::Rgb;
use snell::geometry::Vec3;
use snell::render::{Options, Settings, render, trace_pixel};
use snell::scene::{Camera, Cuboid, Disc, Light, Material, Plane, Scene, Shadows, Sky, Sphere, Texture, Transform};
use snell::texture::Image;
use snell::world::World;
use std::f64::consts::PI;
use std::sync::Arc;

fn paint(scene: &mut Scene, name: &str, color: Rgb) {
    scene.materials.insert(name.to_owned(), Material { ka: color, kd: color, ..Material::default() });
}

fn dark_room(size: u32) -> Scene {
    let mut scene = furnace(size);
    (scene.background, scene.ambient) = (Rgb::gray(0.0), Rgb::gray(1.0));
    scene
}

/// The lecture's pixels sit on the corners of the grid: the outermost rows are `fov` apart, and pixels are square.
#[test]
fn an_angle_of_view_lies_between_the_outermost_rows() {
    for size in [[64, 48], [30, 90], [2, 2]] {
        let mut scene = furnace(2);
        scene.render.size = size;
        let camera = Camera { bounds: None, fov: Some(50.0), near: Some(-0.7), ..scene.camera.clone() };
        scene.camera = camera;
        let world = World::new(&scene).unwrap();
        let [last_x, last_y] = size.map(|n| n - 1);
        let tangent = |x: u32, y: u32| {
            let (_, d) = world.camera.ray(x, y);
            [d.x / -d.z, d.y / -d.z]
        };
        let ([left, top], [right, bottom]) = (tangent(0, 0), tangent(last_x, last_y));
        // Tangents below 2, each with a few roundings.
        assert!((top - libm::tan(25.0 * PI / 180.0)).abs() < 1e-15 && (bottom + top).abs() < 1e-15);
        let [step_x, step_y] = [(right - left) / f64::from(last_x), (top - bottom) / f64::from(last_y)];
        assert!((step_x / step_y - 1.0).abs() < 1e-14);
    }
}

/// A disc of its own, and what a map makes of it: an ellipse has the area π·a·b, and looks where it looked.
#[test]
fn a_disc_is_as_large_as_it_is() {
    for (scale, radii) in [([1.0; 3], [1.5, 1.5]), ([1.2, 0.5, -1.0], [1.8, 0.75])] {
        let mut scene = dark_room(16);
        paint(&mut scene, "white", Rgb::gray(1.0));
        let transform = vec![Transform::Scale(scale)];
        let text = r#"{ "normal": [0, 0, 1], "radius": 1.5, "material": "white" }"#;
        let disc: Disc = serde_json::from_str(text).unwrap();
        scene.discs.push(Disc { transform, ..disc });
        scene.render.spp = 256;
        let sum: f64 = picture(&scene).pixels.iter().map(|c| c.r).sum();
        // The picture is 4 wide between the outermost of 16 points, at distance 5; the disc is at 10.
        let pixel = 2.0 * 4.0 / 15.0;
        let area = PI * radii[0] * radii[1] / (pixel * pixel);
        // Each of some twenty pixels on its rim errs by less than one of its samples.
        assert!((sum - area).abs() < 20.0 / 256.0, "{sum} for {area}");
    }
}

/// What has no inside is refused if light is to go through it; a thin pane, or an interface, is not.
#[test]
fn a_transparent_sheet_needs_a_thickness() {
    let mut scene = dark_room(1);
    glass(&mut scene, "glass", 1.5, 0);
    scene.planes.push(Plane::new([0.0; 3], [0.0, 0.0, 1.0], [8.0, 4.0], "glass"));
    let problem = World::new(&scene).unwrap_err()[0].clone();
    let message = "`plane 1` is transparent but not a solid: it is open along 4 edges, the first from";
    assert!(problem.message.starts_with(message), "{problem}");
    scene.materials["glass"].thickness = Some(0.01);
    assert!(World::new(&scene).is_ok());
    scene.materials["glass"].thickness = None;
    scene.planes[0].inside = Some("glass".to_owned());
    assert!(World::new(&scene).is_ok());
}

/// Many samples measure areas: a white disc has that of a circle.
#[test]
fn samples_measure_the_area_of_a_disc() {
    let mut scene = dark_room(16);
    paint(&mut scene, "white", Rgb::gray(1.0));
    ball(&mut scene, [0.0; 3], 2.5, "white");
    scene.render.spp = 64;
    let film = picture(&scene);
    let sum: f64 = film.pixels.iter().map(|c| c.r).sum();
    // The picture is 4 wide between the outermost of 16 points; the ball is seen under sin θ = 2.5/10, at distance 5.
    let (pixel, radius) = (4.0 / 15.0, 5.0 * 0.25 / (1.0 - 0.0625f64).sqrt());
    let area = PI * radius * radius / (pixel * pixel);
    // The edge crosses some 35 pixels. 64 points, one in each cell of 8 by 8, miss at most about one of 8 cells crossed; the
    // signs of that are random: √35·0.5/8.
    assert!((sum - area).abs() < 0.4, "{sum} {area}");
}

/// One sample is the point of the grid; the mean of several is that of their trees, to the bit; another seed is other samples.
#[test]
fn samples_are_their_trees_mean() {
    let mut scene = dark_room(12);
    paint(&mut scene, "red", Rgb::new(0.9, 0.1, 0.2));
    glass(&mut scene, "glass", 1.5, 0);
    ball(&mut scene, [0.0, 0.0, -3.0], 2.0, "red");
    ball(&mut scene, [0.4, 0.3, 1.0], 1.0, "glass");
    for spp in [1, 3, 4] {
        scene.render.spp = spp;
        let world = World::new(&scene).unwrap();
        let rendered = render(&world, &Settings::from(&scene), &Options::default()).unwrap();
        assert_eq!(rendered.statistics.rays.camera, u64::from(spp) * 144);
        for pixel in 0..144 {
            let traced = trace_pixel(&world, &Settings::from(&scene), pixel % 12, pixel / 12).unwrap();
            assert_eq!(traced.samples.len(), spp as usize);
            let film = rendered.film.pixels[pixel as usize];
            assert_eq!((traced.sum(), traced.radiance), (film, film));
        }
    }
    let one = picture(&scene);
    scene.render.seed = 1;
    assert!(picture(&scene).pixels != one.pixels);
}

/// A sphere that is moved, turned and made larger is the sphere that it looks like, to the bit where the steps are exact.
#[test]
fn a_placed_sphere_is_another_sphere() {
    let mut written = dark_room(24);
    glass(&mut written, "glass", 1.5, 0);
    paint(&mut written, "red", Rgb::new(0.9, 0.1, 0.2));
    let mut placed = written.clone();
    written.spheres =
        vec![Sphere::new([0.5, -0.25, 0.0], 0.75, "glass"), Sphere::new([-1.0, 0.5, -1.0], 0.75, "glass")];
    let half = Transform::Scale([0.5, 0.5, -0.5]);
    let turn = Transform::Rotate { axis: [0.0, 0.0, 1.0], degrees: 90.0 };
    placed.spheres = vec![Sphere {
        transform: vec![half],
        instances: vec![vec![Transform::Move([0.5, -0.25, 0.0])], vec![turn, Transform::Move([-1.0, 0.5, -1.0])]],
        ..Sphere::new([0.0; 3], 1.5, "glass")
    }];
    for scene in [&mut written, &mut placed] {
        ball(scene, [0.0, 0.0, -4.0], 2.0, "red");
    }
    assert!(picture(&written).pixels == picture(&placed).pixels);
    placed.spheres[0].transform = vec![Transform::Scale([1.0, 2.0, 1.0])];
    let problem = World::new(&placed).unwrap_err()[0].clone();
    assert!(problem.message.contains("must stay a sphere"), "{problem}");
}

/// Boxes in places are the boxes that are written there.
#[test]
fn a_placed_box_is_another_box() {
    let mut written = dark_room(40);
    glass(&mut written, "glass", 1.5, 0);
    paint(&mut written, "red", Rgb::new(0.9, 0.1, 0.2));
    ball(&mut written, [0.0, 0.0, -4.0], 2.0, "red");
    let mut placed = written.clone();
    let cuboid = |min: [f64; 3], max: [f64; 3]| Cuboid {
        name: None,
        min,
        max,
        material: "glass".to_owned(),
        transform: vec![],
        instances: vec![],
    };
    written.boxes = vec![cuboid([0.0, -1.0, 0.0], [1.0, 1.0, 0.5]), cuboid([-1.5, 0.25, 0.0], [-0.5, 1.25, 1.0])];
    let mut both = cuboid([-0.5; 3], [0.5; 3]);
    both.instances = vec![
        vec![Transform::Scale([1.0, 2.0, 0.5]), Transform::Move([0.5, 0.0, 0.25])],
        vec![Transform::Move([-1.0, 0.75, 0.5])],
    ];
    placed.boxes = vec![both];
    let (a, b) = (picture(&written), picture(&placed));
    // Instances are met in their own space: roundings decide at silhouettes.
    assert!(alike(&a, &b) * 1000 >= 1600 * 999, "{} of 1600", alike(&a, &b));
}

/// A spot light lights a disc on the floor, and glass under it is no obstacle to its sharp edge.
#[test]
fn a_spot_light_ends_at_its_cone() {
    let mut scene = dark_room(1);
    scene.ambient = Rgb::gray(0.0);
    paint(&mut scene, "white", Rgb::gray(1.0));
    scene.planes.push(Plane::new([0.0; 3], [0.0, 1.0, 0.0], [20.0, 20.0], "white"));
    let mut lamp = Light::at([0.0, 2.0, 0.0], Rgb::gray(1.0));
    (lamp.target, lamp.cone) = (Some([0.0; 3]), Some(45.0));
    scene.lights = vec![lamp];
    let lit = |scene: &Scene, x: f64| tree(scene, [x, 1.0, 0.0], [0.0, -1.0, 0.0]).sum().r;
    let cos = |x: f64| 2.0 / (4.0 + x * x).sqrt();
    for x in [0.0, 1.0, 1.99] {
        assert!((lit(&scene, x) - cos(x)).abs() < 1e-15);
    }
    assert_eq!((lit(&scene, 2.01), lit(&scene, 5.0)), (0.0, 0.0));
    scene.lights[0].edge = Some(45.0);
    let soft = lit(&scene, 1.0);
    assert!(soft > 0.1 && soft < 0.9 * cos(1.0), "{soft}");
    assert!((lit(&scene, 0.0) - 1.0).abs() < 1e-15);
}

/// Squares of a board, from the lower left: they do not move when the board is seen in a mirror of glass or at an angle.
#[test]
fn a_checkerboard_has_its_squares_where_it_should() {
    let mut scene = dark_room(1);
    let (light, dark) = (Rgb::new(0.9, 0.8, 0.7), Rgb::new(0.1, 0.2, 0.3));
    let texture =
        Texture { checker: Some([light, dark]), image: None, repeat: [4.0, 2.0], linear: false, pixels: None };
    scene.textures.insert("board".to_owned(), texture);
    paint(&mut scene, "board", Rgb::gray(1.0));
    scene.materials["board"].texture = Some("board".to_owned());
    scene.planes.push(Plane::new([0.0; 3], [0.0, 0.0, 1.0], [8.0, 4.0], "board"));
    for column in 0..4 {
        for row in 0..2 {
            let (x, y) = (-3.0 + 2.0 * f64::from(column), -1.0 + 2.0 * f64::from(row));
            let expected = if (column + row) % 2 == 0 { light } else { dark };
            assert_eq!(tree(&scene, [x, y, 3.0], [0.0, 0.0, -1.0]).sum(), expected, "column {column}, row {row}");
            assert_eq!(tree(&scene, [x + 2.0, y + 1.0, 1.0], [-2.0, -1.0, -1.0]).sum(), expected);
        }
    }
}

/// A map on a globe is read as on a map: east on the right, north on top. Turning the globe turns the map.
#[test]
fn a_map_lies_on_a_globe() {
    let mut scene = dark_room(1);
    let (west, east, south, north) = ([1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0], [1.0, 1.0, 1.0]);
    // Four columns and two rows; what is in front are the columns in the middle.
    let texels = vec![[0.5; 3], north, north, [0.5; 3], south, west, east, [0.5; 3]];
    let pixels = Some(Arc::new(Image::new(4, 2, texels).unwrap()));
    let texture = Texture { checker: None, image: None, repeat: [1.0, 1.0], linear: false, pixels };
    scene.textures.insert("map".to_owned(), texture);
    paint(&mut scene, "map", Rgb::gray(1.0));
    scene.materials["map"].texture = Some("map".to_owned());
    ball(&mut scene, [1.0, 2.0, 3.0], 1.0, "map");
    // Through the centre of a texel: 45 degrees to the left or right, 45 up or down, of the way to +z.
    let seen = |scene: &Scene, right: f64, up: f64| {
        let half = 0.5f64.sqrt();
        let d = Vec3::new(right * half * half, up * half, half * half);
        let p = Vec3::new(1.0, 2.0, 3.0) + d * 3.0;
        tree(scene, [p.x, p.y, p.z], [-d.x, -d.y, -d.z]).sum()
    };
    let near = |color: Rgb, texel: [f32; 3]| close(color, Rgb::from(texel.map(f64::from)), 1e-12);
    assert!(near(seen(&scene, -1.0, 1.0), north) && near(seen(&scene, 1.0, 1.0), north));
    assert!(near(seen(&scene, -1.0, -1.0), west) && near(seen(&scene, 1.0, -1.0), east));
    let to_origin = Transform::Move([-1.0, -2.0, -3.0]);
    let turn = Transform::Rotate { axis: [0.0, 1.0, 0.0], degrees: 90.0 };
    scene.spheres[0].transform = vec![to_origin, turn, Transform::Move([1.0, 2.0, 3.0])];
    // Turned a quarter to the right seen from the front: what was on the left is now on the right.
    assert!(near(seen(&scene, 1.0, -1.0), west), "{:?}", seen(&scene, 1.0, -1.0));
}

/// A panorama around the scene: up is up, and right of the middle is to the right.
#[test]
fn a_sky_is_seen_where_it_is() {
    let mut scene = furnace(1);
    scene.background = Rgb::gray(0.0);
    let texels = vec![
        [0.0, 0.0, 1.0],
        [0.0, 0.0, 2.0],
        [0.0, 0.0, 3.0],
        [0.0, 0.0, 4.0],
        [1.0, 0.0, 0.0],
        [2.0, 0.0, 0.0],
        [3.0, 0.0, 0.0],
        [4.0, 0.0, 0.0],
    ];
    let sky = Sky {
        horizon: None,
        zenith: None,
        nadir: None,
        image: None,
        brightness: 0.5,
        rotate: 0.0,
        pixels: Some(Arc::new(Image::new(4, 2, texels).unwrap())),
    };
    scene.sky = Some(sky);
    let half = 0.5f64.sqrt();
    let seen = |scene: &Scene, right: f64, up: f64| tree(scene, [0.0; 3], [right * half, up, -half]).sum();
    assert!(close(seen(&scene, -1.0, 1.0), Rgb::new(0.0, 0.0, 1.0), 1e-12));
    assert!(close(seen(&scene, 1.0, 1.0), Rgb::new(0.0, 0.0, 1.5), 1e-12));
    assert!(close(seen(&scene, 1.0, -1.0), Rgb::new(1.5, 0.0, 0.0), 1e-12));
    // Turned a quarter about the vertical, counter-clockwise from above: what was in front right is now in front left.
    if let Some(sky) = &mut scene.sky {
        sky.rotate = 90.0;
    }
    assert!(close(seen(&scene, -1.0, -1.0), Rgb::new(1.5, 0.0, 0.0), 1e-12));
}

#[test]
fn a_gradient_goes_by_the_sine_of_the_elevation() {
    let mut scene = furnace(1);
    scene.background = Rgb::gray(0.0);
    let (horizon, zenith) = (Rgb::new(1.0, 0.5, 0.0), Rgb::new(0.0, 0.0, 1.0));
    let (image, pixels) = (None, None);
    scene.sky = Some(Sky {
        horizon: Some(horizon),
        zenith: Some(zenith),
        nadir: None,
        image,
        brightness: 1.0,
        rotate: 0.0,
        pixels,
    });
    let at = |degrees: f64| {
        let (sin, cos) = libm::sincos(degrees * PI / 180.0);
        tree(&scene, [0.0; 3], [0.0, sin, -cos]).sum()
    };
    assert!(close(at(30.0), horizon * 0.5 + zenith * 0.5, 1e-15));
    assert!(close(at(89.999), zenith, 1e-4) && close(at(-70.0), horizon, 1e-15));
}

/// Published coefficients, written into a scene, are the catalogue's glass to the bit.
#[test]
fn sellmeiers_coefficients_are_the_glass() {
    let mut scene = dark_room(24);
    scene.background = Rgb::new(0.2, 0.5, 0.9);
    paint(&mut scene, "red", Rgb::new(0.9, 0.1, 0.2));
    ball(&mut scene, [0.0, 0.0, -4.0], 2.0, "red");
    ball(&mut scene, [0.0; 3], 1.5, "glass");
    let clear = Material { ko: Rgb::gray(0.0), ..Material::default() };
    let named = Material { glass: Some("N-BK7".to_owned()), ..clear.clone() };
    // Schott's data sheet of N-BK7, 2014.
    let pairs = vec![[1.039_612_12, 0.006_000_698_67], [0.231_792_344, 0.020_017_914_4], [1.010_469_45, 103.560_653]];
    let written = Material { sellmeier: Some(pairs), ..clear };
    let mut film = |material: &Material| {
        scene.materials.insert("glass".to_owned(), material.clone());
        picture(&scene).pixels
    };
    assert!(film(&named) == film(&written));
}

#[test]
fn what_is_not_built_yet_is_named() {
    let mut scene = furnace(2);
    scene.render.shadows = Some(Shadows::Caustic);
    let problem = World::new(&scene).unwrap_err()[0].clone();
    assert!(problem.message.contains("not built yet"), "{problem}");
}

/// A light with a pattern in its way: glass with `tinted_transmission` colours the light that goes through by its texture.
#[test]
fn a_pattern_on_glass_dyes_shadows() {
    let mut scene = dark_room(1);
    (scene.ambient, scene.render.shadows) = (Rgb::gray(0.0), Some(Shadows::Tinted));
    paint(&mut scene, "white", Rgb::gray(1.0));
    let colors = [Rgb::new(1.0, 0.0, 0.0), Rgb::new(0.0, 0.0, 1.0)];
    let texture = Texture { checker: Some(colors), image: None, repeat: [2.0, 1.0], linear: false, pixels: None };
    scene.textures.insert("stained".to_owned(), texture);
    let stained = Material {
        ko: Rgb::gray(0.0),
        kd: Rgb::gray(1.0),
        tinted_transmission: true,
        thickness: Some(0.0),
        texture: Some("stained".to_owned()),
        ..Material::default()
    };
    scene.materials.insert("stained".to_owned(), stained);
    scene.planes.push(Plane::new([0.0; 3], [0.0, 1.0, 0.0], [20.0, 20.0], "white"));
    scene.planes.push(Plane::new([0.0, 2.0, 0.0], [0.0, 1.0, 0.0], [4.0, 4.0], "stained"));
    scene.lights = vec![Light::from_direction([0.0, 1.0, 0.0], Rgb::gray(1.0))];
    let world_at = |x: f64| tree(&scene, [x, 1.0, 0.0], [0.0, -1.0, 0.0]).sum();
    assert_eq!((world_at(-1.0), world_at(1.0)), (colors[0], colors[1]));
}
