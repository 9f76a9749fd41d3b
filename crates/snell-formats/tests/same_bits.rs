//! The same bits everywhere: over threads, tiles, lanes, with and without the tree, in parts, and node by node.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use snell::film::{Crop, Film, Rgb};
use snell::render::{LaneWidth, Options, render, trace_pixel};
use snell::scene::{Integrator, Material, Mesh, Scene, Sphere};
use snell::world::World;
use snell_formats::scene_file::{Syntax, parse};
use snell_formats::{Source, builtin, disk};

fn lecture(name: &str, size: u32) -> Scene {
    let text = builtin::find(name).unwrap();
    let mut scene = parse(&text, Syntax::Toml).unwrap();
    scene.render.size = [size, size];
    scene
}

fn picture(world: &World, options: &Options<'_>) -> Film {
    render(world, options).unwrap().film
}

fn hash(film: &Film) -> String {
    assert!(film.is_finished());
    disk::sha256(film.bytes())
}

/// A small generator of numbers (Knuth's MMIX constants): the same scenes on every machine.
struct Numbers(u64);

impl Numbers {
    /// From 0 to 1.
    fn next(&mut self) -> f64 {
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1u64 << 53) as f64
    }

    fn point(&mut self, spread: f64) -> [f64; 3] {
        [0; 3].map(|_| 50.0 + spread * (self.next() - 0.5))
    }
}

/// Many spheres and triangles: far and near, tiny and huge, touching, coinciding, coplanar, degenerate.
fn crowd(integrator: Integrator) -> Scene {
    let mut numbers = Numbers(7);
    let mut scene = lecture("lecture/default", 24);
    scene.render.integrator = integrator;
    scene.render.max_depth = 4;
    let colors = ["glass", "red", "green", "blue"];
    let sphere = |center, radius, i: usize| Sphere { name: None, center, radius, material: colors[i % 4].to_owned() };
    for i in 0..600 {
        let radius = [1e-9, 0.01, 0.5, 1.0, 3.0][i % 5];
        scene.spheres.push(sphere(numbers.point(60.0), radius, i));
    }
    // Three spheres in the same place, a row that touches, and a floor of radius 1e9.
    scene.spheres.extend((0..3).map(|i| sphere([40.0, 30.0, 40.0], 4.0, i)));
    scene.spheres.extend((0..8).map(|i| sphere([30.0 + 4.0 * i as f64, 70.0, 40.0], 2.0, i)));
    scene.spheres.push(sphere([50.0, -1e9, 50.0], 1e9, 3));
    let mut vertices = Vec::new();
    for i in 0..600 {
        let corner = numbers.point(60.0);
        let near = |n: &mut Numbers| {
            let mut p = corner;
            for c in &mut p {
                *c += 6.0 * (n.next() - 0.5);
            }
            p
        };
        let mut triangle = [corner, near(&mut numbers), near(&mut numbers)];
        match i % 5 {
            // Coplanar ones overlap at the same distance; some have no area.
            0 => triangle.iter_mut().for_each(|p| p[2] = 35.0),
            1 if i % 2 == 0 => triangle[2] = triangle[1],
            _ => {}
        }
        vertices.extend(triangle);
    }
    let faces = (0..600u32).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let mirror = Material { kr: Rgb::gray(0.5), kd: Rgb::gray(0.4), ..Material::default() };
    scene.materials.insert("mirror".to_owned(), mirror);
    scene.meshes.push(Mesh { vertices, faces, material: Some("mirror".to_owned()), ..Mesh::default() });
    scene
}

fn scenes() -> Vec<(String, Scene)> {
    let built_in = builtin::SCENES.iter().map(|(name, _)| ((*name).to_owned(), lecture(name, 40)));
    let crowds = [Integrator::Lecture, Integrator::Course2018, Integrator::Course2020]
        .map(|i| (format!("crowd with {i:?}"), crowd(i)));
    built_in.chain(crowds).collect()
}

#[test]
fn threads_tiles_lanes_and_tree_do_not_matter() {
    for (name, scene) in scenes() {
        let world = World::new(&scene).unwrap();
        let expected = render(&world, &Options { threads: 1, ..Options::default() }).unwrap();
        let expected_hash = hash(&expected.film);
        for lanes in LaneWidth::ALL {
            for threads in [1, 2, 7] {
                for tile_size in [8, 16, 33] {
                    let rendered =
                        render(&world, &Options { threads, tile_size, lanes, ..Options::default() }).unwrap();
                    let what = format!("{name}, {threads} threads, tiles of {tile_size}, {lanes:?}");
                    assert_eq!(hash(&rendered.film), expected_hash, "{what}");
                    assert_eq!(rendered.statistics, expected.statistics, "{what}");
                }
            }
        }
        let brute = world.brute_force();
        for lanes in LaneWidth::ALL {
            let film = picture(&brute, &Options { lanes, ..Options::default() });
            assert_eq!(hash(&film), expected_hash, "{name}, brute force, {lanes:?}");
        }
    }
}

/// Four coplanar patches of triangles with whole-numbered corners, seen from near, far away from the origin: no box has
/// room to spare but the margin that it is given.
fn far_away(offset: f64, seed: u64, flat: bool) -> Scene {
    let mut numbers = Numbers(seed);
    let mut scene = lecture("lecture/default", 33);
    scene.spheres.clear();
    let at = |p: [f64; 3]| p.map(|c| c + offset);
    (scene.camera.eye, scene.camera.look_at) = (at([7.3, 9.1, 30.0]), at([8.0, 8.0, 0.0]));
    (scene.camera.near, scene.camera.bounds) = (-10.0, [-3.0, 3.0, -3.0, 3.0]);
    for (i, light) in scene.lights.iter_mut().enumerate() {
        light.position = Some(at([20.0 * i as f64, 25.0, 20.0]));
    }
    for (i, color) in ["glass", "red", "green", "blue"].into_iter().enumerate() {
        let whole = |n: &mut Numbers| (16.0 * n.next()).floor();
        let height = if flat { 0.0 } else { i as f64 };
        let vertices = (0..36).map(|_| at([whole(&mut numbers), whole(&mut numbers), height])).collect();
        let faces = (0..12).map(|f| [3 * f, 3 * f + 1, 3 * f + 2]).collect();
        scene.meshes.push(Mesh { vertices, faces, material: Some(color.to_owned()), ..Mesh::default() });
        let center = at([whole(&mut numbers), whole(&mut numbers), 1.0]);
        scene.spheres.push(Sphere { name: None, center, radius: 1.0, material: color.to_owned() });
    }
    scene
}

#[test]
fn the_tree_changes_nothing_far_from_the_origin_either() {
    for offset in [0.0, 1000.0, 4096.0, 1e6, -3e8] {
        for seed in 0..12 {
            let world = World::new(&far_away(offset, seed, seed % 2 == 0)).unwrap();
            let tree = picture(&world, &Options::default());
            assert!(tree.pixels.iter().any(|p| p.mean() > 0.1), "a black picture proves nothing");
            let brute = picture(&world.brute_force(), &Options::default());
            assert!(tree == brute, "offset {offset}, seed {seed}");
        }
    }
}

/// The same bits on every machine, and at every commit that does not mean to change them. To be replaced, with the reason
/// in the commit, by what the failing test prints.
#[test]
fn the_bits_are_those_of_the_first_light() {
    let film = |scene: Scene| picture(&World::new(&scene).unwrap(), &Options::default());
    let hashes = scenes().into_iter().map(|(_, scene)| hash(&film(scene)));
    assert_eq!(disk::sha256(hashes), "3ec8794c027227c2bd3e6ecbd8642d53f4842fa7493a87387f1a9fe00c26095b");
}

#[test]
fn the_crowd_is_worth_tracing() {
    // Otherwise the test above proves nothing.
    let world = World::new(&crowd(Integrator::Lecture)).unwrap();
    let rendered = render(&world, &Options::default()).unwrap();
    let rays = rendered.statistics.rays;
    assert!(rays.mirror > 500 && rays.refracted > 20 && rays.shadow > 1000, "{rays:?}");
    assert!(rendered.statistics.lost.rays > 0, "{:?}", rendered.statistics);
}

#[test]
fn a_crop_is_a_part_of_the_whole() {
    let world = World::new(&lecture("lecture/default", 40)).unwrap();
    let whole = picture(&world, &Options::default());
    let crop = Crop { x: 7, y: 11, width: 20, height: 9 };
    let part = picture(&world, &Options { crop: Some(crop), ..Options::default() });
    for y in 0..9 {
        for x in 0..20 {
            assert_eq!(part.pixels[y * 20 + x], whole.pixels[(y + 11) * 40 + x + 7]);
        }
    }
    let outside = Crop { x: 30, y: 0, width: 11, height: 1 };
    assert!(render(&world, &Options { crop: Some(outside), ..Options::default() }).is_err());
}

#[test]
fn the_recorded_tree_of_every_pixel_adds_up_to_the_film() {
    for (name, scene) in scenes() {
        let world = World::new(&scene).unwrap();
        let rendered = render(&world, &Options::default()).unwrap();
        let mut rays = 0;
        let [width, height] = scene.render.size;
        for y in 0..height {
            for x in 0..width {
                let (radiance, tree) = trace_pixel(&world, x, y).unwrap();
                let film = rendered.film.pixels[(y * width + x) as usize];
                assert_eq!((tree.sum(), radiance), (film, film), "{name} at {x},{y}");
                for (i, node) in tree.nodes.iter().enumerate() {
                    match node.parent {
                        None => assert_eq!((i, node.depth), (0, 0)),
                        Some(parent) => assert_eq!(tree.nodes[parent].depth + 1, node.depth),
                    }
                }
                rays += tree.nodes.len() as u64;
            }
        }
        let counts = rendered.statistics.rays;
        assert_eq!(rays, counts.camera + counts.mirror + counts.refracted, "{name}");
        assert_eq!(rays, rendered.statistics.depth.iter().sum::<u64>(), "{name}");
    }
}

/// A room whose walls are huge mirror spheres, full of glass of index 1: rays never get out, and most split in two.
fn hall_of_mirrors() -> Scene {
    let mut scene = lecture("lecture/default", 24);
    scene.render.max_depth = 12;
    scene.materials["red"].kr = Rgb::gray(1.0);
    let glass = &mut scene.materials["glass"];
    (glass.eta, glass.kr) = (1.0, Rgb::gray(1.0));
    let sphere = |center, radius, material: &str| Sphere { name: None, center, radius, material: material.to_owned() };
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

#[test]
fn a_generation_that_is_split_changes_nothing() {
    let world = World::new(&hall_of_mirrors()).unwrap();
    let whole = render(&world, &Options { tile_size: 33, threads: 1, ..Options::default() }).unwrap();
    let largest = whole.statistics.depth.iter().max().copied().unwrap();
    assert!(largest > 1 << 17, "one tile, a budget of 2^16 rays, and not split: {:?}", whole.statistics.depth);
    for (x, y) in [(12, 12), (5, 20), (18, 7)] {
        let (alone, _) = trace_pixel(&world, x, y).unwrap();
        assert_eq!(alone, whole.film.pixels[(y * 24 + x) as usize]);
    }
    let small = render(&world, &Options { tile_size: 8, ..Options::default() }).unwrap();
    assert!(small.film == whole.film && small.statistics == whole.statistics);
}

#[test]
fn cancelling_keeps_what_is_done() {
    use std::sync::atomic::{AtomicBool, Ordering};
    let world = World::new(&lecture("lecture/default", 64)).unwrap();
    let whole = picture(&world, &Options::default());
    let cancel = AtomicBool::new(false);
    let progress = |p: snell::render::Progress| cancel.store(p.pixels >= 512, Ordering::Relaxed);
    let options = Options { threads: 1, progress: Some(&progress), cancel: Some(&cancel), ..Options::default() };
    let part = picture(&world, &options);
    assert_eq!(part.finished.iter().filter(|&&f| f).count(), 512);
    for (i, &finished) in part.finished.iter().enumerate() {
        assert_eq!(part.pixels[i], if finished { whole.pixels[i] } else { Rgb::gray(0.0) });
    }
}

#[test]
fn a_scene_survives_being_written_to_the_bit() {
    let scene = crowd(Integrator::Course2020);
    let text = snell_formats::scene_file::to_text(&scene, Syntax::Json).unwrap();
    assert!(parse(&Source::new("crowd", text), Syntax::Json).unwrap() == scene);
}
