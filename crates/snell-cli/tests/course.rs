//! The course's own files: pictures to the byte, and drivers that students wrote.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod common;

use common::{run, snell, stderr};
use snell_test_scenes::real_files::data;
use std::path::{Path, PathBuf};

#[test]
fn the_course_pictures_come_out_to_the_byte() {
    let Some(data) = data() else { return };
    let folder = tempfile::tempdir().unwrap();
    for name in ["2018-p3/driver00", "2018-p4/driver00", "2020/driver02"] {
        let driver = data.join("course").join(name);
        let (scene, picture) = (driver.with_extension("txt"), driver.with_extension("ppm"));
        for ppm in ["text.ppm", "bytes.ppm"] {
            let mut arguments = vec!["render", "-q", scene.to_str().unwrap(), "-o", ppm];
            arguments.extend((ppm == "bytes.ppm").then_some("--binary"));
            run(folder.path(), &arguments);
            // Tolerance 0: every pixel of every channel.
            run(folder.path(), &["diff", ppm, picture.to_str().unwrap()]);
        }
    }
}

fn drivers(folder: &Path, found: &mut Vec<PathBuf>) {
    for entry in std::fs::read_dir(folder).unwrap().flatten() {
        let path = entry.path();
        if path.is_dir() {
            drivers(&path, found);
        } else if path.extension().is_some_and(|e| e == "txt") {
            found.push(path);
        }
    }
}

/// Drivers with Ko and eta on their spheres, besides all of set 5.
const LECTURE: &[&str] = &[
    "set-2/driver00.txt",
    "set-3/raytracer/TXT/Scene1.txt",
    "set-3/raytracer/TXT/Scene2.txt",
    "set-4/drivers/driver01.txt",
    "set-4/drivers/driver02.txt",
];

/// The share of pixels that are not black.
fn lit(npy: &Path) -> f64 {
    let picture = snell_formats::picture::read(npy).unwrap();
    let lit = picture.pixels.iter().filter(|p| p.mean() > 0.0).count();
    lit as f64 / picture.pixels.len() as f64
}

/// Small, so that the test is quick: the readers are what is tested.
const SMALL: &[&str] = &["--size", "48x48"];

#[test]
fn every_driver_of_the_students_renders_but_three() {
    let Some(data) = data() else { return };
    let folder = tempfile::tempdir().unwrap();
    let root = data.join("course/unpaired");
    let mut found = Vec::new();
    drivers(&root, &mut found);
    found.sort();
    assert!(found.len() >= 35, "{} drivers", found.len());
    for driver in found {
        let name = driver.strip_prefix(&root).unwrap().to_str().unwrap().replace('\\', "/");
        let shown = driver.to_str().unwrap();
        let output = snell(folder.path(), &[&["render", shown, "-o", "direct.npy"], SMALL].concat());
        let said = stderr(&output);
        let refused = match name.as_str() {
            "set-2/driver01.txt" => Some(("`Vision.obj` is not there", "driver01.txt:22:1")),
            "set-3/raytracer/TXT/driver06.txt" => Some(("`ellelltri.obj` is not there", "driver06.txt:11:1")),
            "set-1/drivers/driverFW.txt" => Some(("takes 7 values, read 6", "driverFW.txt:10:1")),
            _ => None,
        };
        assert_eq!(output.status.code(), Some(if refused.is_some() { 3 } else { 0 }), "{name}\n{said}");
        if let Some((message, place)) = refused {
            assert!(said.contains(message) && said.contains(place), "{name}\n{said}");
            continue;
        }
        let dialect = match name.as_str() {
            n if n.starts_with("set-1/") => "2019",
            n if n.starts_with("set-5/") || LECTURE.contains(&n) => "lecture",
            _ => "2018",
        };
        let info = common::stdout(&run(folder.path(), &["info", shown]));
        assert!(info.contains(&format!("  dialect     {dialect}\n")), "{name}\n{info}");
        assert!(lit(&folder.path().join("direct.npy")) > 0.01, "{name} is black");
        // As a scene file it is the same picture, to the bit.
        run(folder.path(), &["convert", shown, "-o", "scene.toml", "--force"]);
        run(folder.path(), &[&["render", "-q", "scene.toml", "-o", "converted.npy"], SMALL].concat());
        run(folder.path(), &["diff", "direct.npy", "converted.npy"]);
    }
}

#[test]
fn models_without_a_texture_or_material_are_warned_of() {
    let Some(data) = data() else { return };
    let folder = tempfile::tempdir().unwrap();
    let models = data.join("course/unpaired/set-1/models");
    let driver =
        "eye 0 0 9\nlook 0 0 0\nup 0 1 0\nd 5\nbounds -1 -1 1 1\nres 8 8\nlight 1 2 3 0 1 1 1\nmodel 1 0 0 0 1 0 0 0 ";
    for (model, warning) in [("pug.obj", "W105"), ("torus.obj", "W104")] {
        std::fs::write(folder.path().join("d.txt"), format!("{driver}{model}")).unwrap();
        let output = run(folder.path(), &["render", "d.txt", "-o", "d.png", "--search", models.to_str().unwrap()]);
        assert!(stderr(&output).contains(warning), "{model}: {}", stderr(&output));
    }
}

#[test]
fn odd_drivers_of_other_students() {
    let folder = tempfile::tempdir().unwrap();
    let head = "eye 0 0 10\r\nlook 0 0 0\r\nup 0 1 0\r\nd 5\r\nbounds -2 -1 2 1\r\nres 16 8\r\nambient 1 1 1\r\n";
    let sphere = |radius: &str, ko: &str| {
        format!("sphere 0 0 0 {radius} .1 .2 .3 .1 .1 .1 .1 .1 .1 .5 .5 .5 {ko} {ko} {ko} 1.5\r\n")
    };
    for (text, code, expected) in [
        (head.to_owned() + &sphere("1", ".5"), 0, ""),
        (head.to_owned() + &sphere("0.0", ".5"), 0, "W001 invisible-sphere"),
        (head.to_owned() + &sphere("1", "1.5"), 0, "W003 opacity-above-one"),
        (head.replace("d 5", "d 10") + &sphere("1", ".5"), 0, "W009 before-image-plane"),
        (head.to_owned() + &sphere("1e10", "1"), 0, ""),
        (head.to_owned() + &sphere("-1", "1"), 3, "must not be negative, read -1"),
        (head.to_owned() + "sphere 0 0 0 1 .1 .2 .3 .1 .1 .1 .1 .1\r\n", 3, "13 or 16 values, read 12"),
        (head.to_owned() + "shininess 3\r\n", 0, "W101 unknown-keyword"),
        (head.replace("16 8", "0 8"), 3, "a picture of 0 x 8 pixels"),
        (head.replace("look 0 0 0", "look 0 0 10"), 3, "no direction to look in"),
        (head.replace("up 0 1 0", "up 0 0 2"), 3, "parallel to the view"),
        (head.replace("-2 -1 2 1", "1 1 1 1"), 3, "no area"),
        (head.to_owned() + "model 0 0 0 5 1 0 0 0 x.obj\r\n", 3, "is not there"),
    ] {
        std::fs::write(folder.path().join("d.txt"), &text).unwrap();
        let output = snell(folder.path(), &["render", "d.txt", "-o", "d.npy"]);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(code), "{text}\n{said}");
        assert!(said.contains(expected), "{text}\n{said}");
        assert!(expected.is_empty() || said.contains("d.txt:"), "no place: {said}");
    }
}
