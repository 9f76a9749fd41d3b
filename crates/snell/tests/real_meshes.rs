//! Models of other people's making as glass: those with holes are refused, with the holes counted, and those without refract.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use snell::render::{Options, Rendered, Settings, render};
use snell::scene::Scene;
use snell::world::World;
use snell_formats::load::{Kind, load_text};
use snell_formats::{LoadOptions, Source, load};
use snell_test_scenes::real_files::data;
use std::path::Path;

const SKY: f64 = 0.5;

/// A model of `meshes/` as glass, before a grey sky; all of them are about 3 units tall.
fn as_glass(folder: &Path, model: &str) -> Scene {
    let text = format!(
        r#"
        snell = 1
        background = {SKY}
        render = {{ integrator = "whitted", size = [16, 16], max_depth = 16 }}
        camera = {{ eye = [3, 2, 10], look_at = [0, 0, 0], up = [0, 1, 0], bounds = [-0.2, 0.2, -0.2, 0.2], near = -1 }}
        material.glass = {{ ko = 0, eta = 1.5 }}
        mesh = [{{ file = "meshes/{model}", material = "glass" }}]
        "#
    );
    load_text(Source::new(model, text), Kind::Toml, folder, &LoadOptions::default()).unwrap().into_scene()
}

#[test]
fn open_meshes_are_refused_and_say_how_many_edges_are_open() {
    let Some(folder) = data() else { return };
    // Counted by others as well: `crates/snell-cli/tests/check.rs`.
    for (model, open) in [("stanford-bunny.obj", 223), ("teapot.obj", 160), ("suzanne.obj", 42)] {
        let problems = World::new(&as_glass(&folder, model)).unwrap_err();
        let said = format!("not a solid: it is open along {open} edges");
        assert!(problems.len() == 1 && problems[0].message.contains(&said), "{model}: {problems:?}");
    }
}

#[test]
fn closed_meshes_refract_and_neither_lose_nor_make_light() {
    let Some(folder) = data() else { return };
    for model in ["spot.obj", "armadillo.obj", "torusknot.obj"] {
        let Rendered { film, statistics } = picture(&as_glass(&folder, model), model);
        // The sky is all that there is, so that whatever is missing is behind branches that were cut off. These are counted
        // in units of 2⁻³², each rounded down; there are a few in a pixel.
        let seen = film.pixels.iter().map(|c| c.g / SKY).sum::<f64>() / film.pixels.len() as f64;
        let whole = seen + statistics.lost.share(film.pixels.len() as u64);
        assert!((whole - 1.0).abs() < 1e-8, "{model}: {whole}");
    }
}

#[test]
fn the_gears_of_the_standard_databases_refract() {
    let Some(folder) = data() else { return };
    let gears = folder.join("nff/gears-2.nff");
    let mut scene = load(gears.to_str().unwrap(), &LoadOptions::default()).unwrap().into_scene();
    scene.render.size = [16, 16];
    picture(&scene, "gears-2.nff");
}

/// With something refracted, and without an exit from anything that had not been entered: none of these meshes crosses itself.
fn picture(scene: &Scene, name: &str) -> Rendered {
    let rendered = render(&World::new(scene).unwrap(), &Settings::from(scene), &Options::default()).unwrap();
    let statistics = &rendered.statistics;
    assert!(statistics.rays.refracted > 50, "{name}: {:?}", statistics.rays);
    assert_eq!(statistics.stray.count, 0, "{name}: pixel {:?}", statistics.stray.first_pixel);
    rendered
}
