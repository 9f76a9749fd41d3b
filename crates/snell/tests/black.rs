//! Why a whole picture is black, in words: each reason by a scene that has just that one.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

use snell::explain::black_picture;
use snell::geometry::bvh::Quality;
use snell::render::{Options, render};
use snell_formats::Source;
use snell_formats::load::{Kind, LoadOptions, load_text};
use std::path::Path;

const SCENE: &str = r#"
snell = 1
[render]
integrator = "whitted"
size = [24, 24]
[camera]
eye = [0, 0, 5]
look_at = [0, 0, 0]
up = [0, 1, 0]
fov = 40
[[light]]
name = "lamp"
position = [2, 2, 5]
color = 1.0
[material.m]
kd = 0.7
[[sphere]]
name = "ball"
center = [0, 0, 0]
radius = 1
material = "m"
"#;

/// What is said of the scene with these changes of its text; nothing of one that is not black.
fn said(changes: &[(&str, &str)]) -> Option<String> {
    let text = changes.iter().fold(SCENE.to_owned(), |text, (before, after)| {
        assert!(text.contains(before), "{before}");
        text.replace(before, after)
    });
    let loaded =
        load_text(Source::new("scene.toml", text), Kind::Toml, Path::new("."), &LoadOptions::default()).unwrap();
    let compiled = loaded.compile("scene", Quality::default(), 1).unwrap();
    let film = render(compiled.world(), &compiled.settings(), &Options::default()).unwrap().film;
    black_picture(&compiled, &film).map(|warning| warning.message)
}

#[test]
fn a_picture_that_is_not_black_has_no_reason() {
    assert_eq!(said(&[]), None);
    assert_eq!(said(&[("\"whitted\"", "\"lecture\"")]), None);
}

#[test]
fn each_reason_is_told() {
    let sphere = &SCENE[SCENE.find("[[sphere]]").unwrap()..];
    let light = &SCENE[SCENE.find("[[light]]").unwrap()..SCENE.find("[material.m]").unwrap()];
    let tiny = [("0, 5]", "0, 5e-9]"), ("[2, 2, 5]", "[2e-9, 2e-9, 5e-9]"), ("radius = 1", "radius = 1e-9")];
    let tiny_for = |model: &'static str| [&[("\"whitted\"", model)][..], &tiny].concat();
    for (changes, reason) in [
        (vec![(sphere, "")], "there is nothing in the scene"),
        (vec![(light, "")], "the scene has no lights, and there is no `ambient`"),
        (vec![("color = 1.0", "color = 0.0")], "its lights are black"),
        (vec![("kd = 0.7", "kd = 0.0")], "has no colour: ka, kd and ks of its material `m` are 0"),
        (vec![("[2, 2, 5]", "[0, 0, -50]")], "faces away from every light"),
        (vec![("look_at = [0, 0, 0]", "look_at = [0, 0, 9]")], "everything lies behind the camera"),
        (vec![("look_at = [0, 0, 0]", "look_at = [3, 0, 4]")], "looks past everything"),
        (tiny_for("\"lecture\""), "nothing nearer than 1e-5 counts in this model"),
        (tiny_for("\"course2018\""), "nothing nearer than 1e-5 counts in this model"),
    ] {
        let said = said(&changes).unwrap_or_default();
        assert!(said.starts_with("every pixel is black: ") && said.contains(reason), "{changes:?}: {said}");
    }
    // The same is seen in a model that overlooks nothing.
    assert_eq!(said(&tiny), None);
}
