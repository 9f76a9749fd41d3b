//! A picture in steps and in passes: always the bits of the whole.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use snell::film::{Crop, Film, Rgb};
use snell::render::{Options, Passes, Progress, Renderer, Settings, render, trace_pixel};
use snell::scene::{Integrator, Scene};
use snell::trace::Statistics;
use snell::world::World;
use snell_test_scenes::lecture;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};

/// Glass that disperses, with light that is lost.
fn glass(spp: u32) -> Scene {
    let mut scene = lecture("gallery/prism", 1);
    (scene.render.size, scene.render.spp, scene.render.max_depth, scene.render.bands) = ([13, 11], spp, 4, 3);
    scene
}

fn whole(scene: &Scene) -> (Film, Statistics) {
    let options = Options { threads: 1, ..Options::default() };
    let rendered = render(&World::new(scene).unwrap(), &Settings::from(scene), &options).unwrap();
    (rendered.film, rendered.statistics)
}

#[test]
fn steps_from_coarse_to_fine_end_in_the_same_picture() {
    for (name, spp, crop) in [
        ("lecture/default", 1, None),
        ("gallery/ball", 5, None),
        ("gallery/ball", 1, Some(Crop { x: 3, y: 5, width: 31, height: 17 })),
    ] {
        let mut scene = lecture(name, 40);
        scene.render.spp = spp;
        let (world, settings) = (Arc::new(World::new(&scene).unwrap()), Settings::from(&scene));
        let expected = render(&world, &settings, &Options { crop, ..Options::default() }).unwrap();
        for (coarsest, tiles, threads) in [(1, 1, 1), (8, 1, 1), (8, 3, 2), (64, 100, 2), (7, 2, 1)] {
            let passes = Passes::CoarseToFine { coarsest };
            let options = Options { crop, passes, tile_size: 8, threads, ..Options::default() };
            let mut renderer = Renderer::new(Arc::clone(&world), settings.clone(), &options).unwrap();
            let mut before = renderer.film().clone();
            while !renderer.is_finished() {
                let changed = renderer.step(tiles);
                assert!(!changed.is_empty() && changed.len() as u64 <= tiles, "{name}: {changed:?}");
                // What has changed is where it says.
                let film = renderer.film();
                let within = |x: u32, y: u32| {
                    changed.iter().any(|t| {
                        let spans = |start: u32, count: u32, at: u32| (start..start + count * t.step).contains(&at);
                        spans(t.x, t.width, x) && spans(t.y, t.height, y)
                    })
                };
                for (at, (new, old)) in film.pixels.iter().zip(&before.pixels).enumerate() {
                    let [x, y] = [at % film.width(), at / film.width()].map(|c| c as u32);
                    assert!(new == old || within(film.crop.x + x, film.crop.y + y), "{name}, {passes:?} at {x},{y}");
                }
                before = film.clone();
            }
            assert!(*renderer.film() == expected.film, "{name}, {passes:?}, {tiles} tiles a step");
            assert_eq!(renderer.statistics(), expected.statistics, "{name}, {passes:?}");
            assert!(renderer.step(1).is_empty());
            let Progress { pixels, total_pixels, rays } = renderer.progress();
            assert!(pixels == total_pixels && rays == expected.statistics.rays.total(), "{name}, {passes:?}");
        }
    }
}

#[test]
fn the_first_pass_already_fills_the_picture() {
    let mut scene = lecture("lecture/default", 40);
    scene.sky = None;
    scene.ambient = Rgb::gray(1.0);
    let (world, settings) = (World::new(&scene).unwrap(), Settings::from(&scene));
    let full = render(&world, &settings, &Options::default()).unwrap().film;
    let passes = Passes::CoarseToFine { coarsest: 8 };
    let mut renderer = Renderer::new(world, settings, &Options { passes, ..Options::default() }).unwrap();
    renderer.step(1);
    let film = renderer.film();
    assert_eq!(film.finished.iter().filter(|&&finished| finished).count(), 25);
    for (at, pixel) in film.pixels.iter().enumerate() {
        let [x, y] = [at % 40, at / 40].map(|c| c / 8 * 8);
        assert_eq!(*pixel, full.pixels[y * 40 + x]);
    }
}

#[test]
fn what_was_cancelled_goes_on_to_the_same_picture_and_statistics() {
    let scene = glass(3);
    let (film, statistics) = whole(&scene);
    let (world, settings) = (Arc::new(World::new(&scene).unwrap()), Settings::from(&scene));
    for passes in [Passes::WholeTiles, Passes::CoarseToFine { coarsest: 4 }] {
        let (cancel, calls) = (AtomicBool::new(false), AtomicU32::new(0));
        // Every second tile tells the others to stop, wherever they are.
        let progress = |_| {
            if calls.fetch_add(1, Ordering::Relaxed) % 2 == 1 {
                cancel.store(true, Ordering::Relaxed);
            }
        };
        let options = Options {
            threads: 2,
            tile_size: 4,
            passes,
            progress: Some(&progress),
            cancel: Some(&cancel),
            ..Options::default()
        };
        let mut renderer = Renderer::new(Arc::clone(&world), settings.clone(), &options).unwrap();
        let mut stops = 0;
        while !renderer.is_finished() {
            renderer.step(u64::MAX);
            stops += u32::from(cancel.swap(false, Ordering::Relaxed));
        }
        assert!(stops > 3, "stopped {stops} times");
        assert!(*renderer.film() == film, "{passes:?}");
        assert_eq!(renderer.statistics(), statistics, "{passes:?}");
    }
}

#[test]
fn what_pixels_have_lost_adds_up_to_what_the_picture_has_lost() {
    const UNIT: f64 = (1u64 << 32) as f64;
    for spp in [1, 3] {
        let scene = glass(spp);
        let (world, settings) = (Arc::new(World::new(&scene).unwrap()), Settings::from(&scene));
        let begin = |passes| {
            Renderer::new(Arc::clone(&world), settings.clone(), &Options { passes, ..Options::default() }).unwrap()
        };
        assert!(begin(Passes::WholeTiles).lost().is_none());
        let mut renderer = begin(Passes::CoarseToFine { coarsest: 4 });
        assert!(renderer.lost().unwrap().iter().all(|&units| units == 0));
        renderer.step(u64::MAX);
        let (lost, Statistics { lost: all, rays, .. }) = (renderer.lost().unwrap(), renderer.statistics());
        assert!(all.rays > 0);
        assert_eq!(lost.iter().sum::<u64>() as f64 / UNIT / rays.camera as f64, all.share(rays.camera));
        assert_eq!(*lost.iter().max().unwrap() as f64 / UNIT / f64::from(spp), all.worst(spp));
        for (at, &units) in lost.iter().enumerate() {
            let trace = trace_pixel(&world, &settings, at as u32 % 13, at as u32 / 13).unwrap();
            let ended = trace.samples.iter().flat_map(|tree| &tree.nodes).filter(|node| node.cutoff.is_some());
            // Bands of light have channels below 0.
            let expected: f64 =
                ended.clone().map(|ray| Rgb::from(ray.throughput.to_array().map(f64::abs)).mean()).sum();
            // Each ray is rounded down to a whole unit; a sum in another order differs by less.
            let rays = ended.count() as f64;
            assert!((expected - units as f64 / UNIT).abs() <= 2.0 * rays / UNIT, "pixel {at}, {spp} samples");
        }
    }
}

#[test]
fn a_world_is_rendered_with_the_models_of_light_it_was_compiled_for() {
    let scene = lecture("lecture/default", 8);
    let world = World::new(&scene).unwrap();
    let other = |integrator| Settings { integrator, ..Settings::from(&scene) };
    assert!(render(&world, &other(Integrator::Course2020), &Options::default()).is_ok());
    let refused = render(&world, &other(Integrator::Whitted), &Options::default()).unwrap_err();
    assert!(refused.to_string().contains("Whitted"), "{refused}");
    assert!(trace_pixel(&world, &other(Integrator::Whitted), 1, 1).is_none());
}
