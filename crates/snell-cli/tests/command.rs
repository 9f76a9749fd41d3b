//! What the command promises: exit codes, messages, files, and that nothing is lost.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod common;

use common::{command, run, snell, stderr, stdout};
use serde_json::json;
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::{Duration, Instant};

const TINY: &[&str] = &["--size", "24x24"];

fn render(folder: &Path, arguments: &[&str]) {
    run(folder, &[&["render", "-q"], arguments].concat());
}

/// The film of a scene, by the library.
fn film_of(scene: &snell::scene::Scene) -> snell::film::Film {
    let world = snell::world::World::new(scene).unwrap();
    let settings = snell::render::Settings::from(scene);
    snell::render::render(&world, &settings, &snell::render::Options::default()).unwrap().film
}

#[test]
fn built_in_scenes_render_from_anywhere_and_can_be_saved() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let list = stdout(&run(at, &["scenes"]));
    let names: Vec<&str> =
        list.lines().filter_map(|l| l.split_whitespace().next()).filter(|n| n.contains('/')).collect();
    assert_eq!(names.len(), 25, "15 of the lecture, 1 to study, 9 of the gallery: {list}");
    render(at, &[&names, TINY, &["-o", "out/"]].concat());
    assert_eq!(fs::read_dir(at.join("out")).unwrap().count(), names.len());

    run(at, &["scenes", "--save", "lecture/default", "-o", "mine.toml"]);
    render(at, &[&["mine.toml", "-o", "mine.npy"], TINY].concat());
    render(at, &[&["lecture/default", "-o", "built-in.npy"], TINY].concat());
    run(at, &["diff", "mine.npy", "built-in.npy"]);
    let again = snell(at, &["scenes", "--save", "lecture/default", "-o", "mine.toml"]);
    assert!(again.status.code() == Some(1) && stderr(&again).contains("exists"));
}

#[test]
fn scenes_say_what_to_look_at() {
    let folder = tempfile::tempdir().unwrap();
    for line in stdout(&run(folder.path(), &["scenes"])).lines().take(16) {
        let name = line.split_whitespace().next().unwrap();
        let text = stdout(&run(folder.path(), &["info", name, "--scene"]));
        assert!(text.starts_with("# ") && text.contains("# Look"), "{name} starts with no comment");
    }
}

#[test]
fn every_format_is_written_and_compared() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    for file in ["a.png", "a.ppm", "a.exr", "a.npy"] {
        render(at, &[&["lecture/default", "-o", file], TINY].concat());
    }
    render(at, &[&["lecture/default", "-o", "b.png", "--bits", "16"], TINY].concat());
    run(at, &["diff", "a.png", "a.ppm"]);
    // 16 bit keeps what 8 bit rounds: at most half a step and a little.
    assert_eq!(snell(at, &["diff", "a.png", "b.png"]).status.code(), Some(1));
    run(at, &["diff", "a.png", "b.png", "--tolerance", "0.51"]);
    // f32 rounds a number near 1 by at most 6e-8.
    run(at, &["diff", "a.exr", "a.npy", "--tolerance", "1e-7"]);
}

#[test]
fn diff_says_how_much_and_where() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("a.ppm"), "P3 2 1 255 0 0 0 10 20 30\n").unwrap();
    fs::write(at.join("b.ppm"), "P3\n2 1\n255\n0 0 0 10 24 30\n").unwrap();
    fs::write(at.join("c.ppm"), "P3 1 1 255 0 0 0\n").unwrap();
    let output = snell(at, &["diff", "a.ppm", "b.ppm", "-o", "d.png"]);
    assert_eq!(output.status.code(), Some(1));
    assert_eq!(stdout(&output), "max 4 of 255 at pixel 1,0, mean 0.666667 of 255, 1 of 2 pixels differ\n");
    assert!(at.join("d.png").exists());
    assert_eq!(snell(at, &["diff", "a.ppm", "b.ppm", "--tolerance", "4"]).status.code(), Some(0));
    let sizes = snell(at, &["diff", "a.ppm", "c.ppm"]);
    assert!(sizes.status.code() == Some(1) && stderr(&sizes).contains("sizes differ"));
    assert_eq!(snell(at, &["diff", "a.ppm", "no.ppm"]).status.code(), Some(1));
}

#[test]
fn settings_reach_the_picture() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let picture = |name: &str, arguments: &[&str]| {
        render(at, &[arguments, TINY, &["-o", name]].concat());
    };
    for (built_in, changed) in [
        ("lecture/diamond", &["lecture/default", "--set", "material.glass.eta=2.42"][..]),
        ("lecture/no-shadows", &["lecture/default", "--shadows", "off"]),
        ("lecture/diamond-depth-2", &["lecture/diamond", "--depth", "2"]),
        ("lecture/wide", &["lecture/diamond", "--set", "camera.near=-4"]),
        ("lecture/quarter", &["lecture/diamond", "--set", "camera.bounds=[-2, 0, -2, 0]"]),
        ("study/quarter-view", &["lecture/default", "--set", "camera.bounds=[-2, 0, -2, 0]"]),
    ] {
        picture("a.npy", &[built_in]);
        picture("b.npy", changed);
        run(at, &["diff", "a.npy", "b.npy"]);
        picture("c.npy", &["lecture/default"]);
        assert_eq!(snell(at, &["diff", "a.npy", "c.npy"]).status.code(), Some(1), "{built_in} is the default scene");
    }
    picture("a.npy", &["lecture/default", "--integrator", "course2018"]);
    assert_eq!(snell(at, &["diff", "a.npy", "c.npy"]).status.code(), Some(1));
    picture("srgb.png", &["lecture/default", "--transfer", "srgb"]);
    picture("linear.png", &["lecture/default"]);
    assert_eq!(snell(at, &["diff", "srgb.png", "linear.png"]).status.code(), Some(1));
}

#[test]
fn another_shape_widens_and_says_so() {
    let folder = tempfile::tempdir().unwrap();
    let wide = run(folder.path(), &["render", "lecture/default", "--size", "40x20", "-o", "a.npy"]);
    assert!(stderr(&wide).contains("W201 widened-bounds"), "{}", stderr(&wide));
    let stretched = run(folder.path(), &["render", "lecture/default", "--size", "40x20", "--stretch", "-o", "b.npy"]);
    assert!(!stderr(&stretched).contains("W201"));
    let same = run(folder.path(), &["render", "lecture/default", "--size", "20x20", "-o", "c.npy"]);
    assert!(!stderr(&same).contains("W201"));
}

#[test]
fn a_picture_can_be_rendered_again_from_itself() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let changed = ["lecture/default", "--set", "material.glass.eta=1.7", "--depth", "3", "--crop", "4,6,12,9"];
    for name in ["a.png", "a.exr"] {
        render(at, &[&changed, TINY, &["-o", name]].concat());
        render(at, &["--from", name, "-o", &format!("again-{name}")]);
        run(at, &["diff", name, &format!("again-{name}")]);
        let info = stdout(&run(at, &["info", name]));
        assert!(info.contains("material.glass.eta=1.7") && info.contains("4,6,12,9"), "{info}");
    }
    render(at, &[&["lecture/default", "-o", "a.ppm"], TINY].concat());
    let none = snell(at, &["render", "--from", "a.ppm", "-o", "x.png"]);
    assert!(none.status.code() == Some(1) && stderr(&none).contains("does not say how it was made"));
}

/// A ball of glass over a floor, in the model whose default shadows have changed; and what else a scene may leave out.
const GLASS: &str = "snell = 1\nambient = 0.1\n[render]\nintegrator = 'whitted'\nsize = [24, 24]\n[camera]\n\
                     eye = [0, 4, 9]\nlook_at = [0, 0, 0]\nup = [0, 1, 0]\nbounds = [-2, 2, -2, 2]\nnear = -5\n\
                     [material.glass]\nko = 0\neta = 1.5\n[material.floor]\nkd = 1\n\
                     [[sphere]]\ncenter = [0, 1, 0]\nradius = 1\nmaterial = 'glass'\n\
                     [[plane]]\ncenter = [0, -1, 0]\nnormal = [0, 1, 0]\nsize = [9, 9]\nmaterial = 'floor'\n\
                     [[light]]\nposition = [0, 9, 0]\ncolor = 1\n";

/// A recipe that names no shadows is from when they were opaque; it gives the same bits as then, and the new default is told.
#[test]
fn a_picture_made_by_an_older_default_is_made_again_by_it() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("glass.toml"), GLASS).unwrap();
    render(at, &["glass.toml", "-o", "tinted.npy"]);
    render(at, &["glass.toml", "--shadows", "opaque", "-o", "opaque.png"]);
    let recipe = |file: &str| -> serde_json::Value {
        let remembered = snell_formats::picture::read(&at.join(file)).unwrap().recipe.unwrap();
        serde_json::from_str(&remembered).unwrap()
    };
    // As it was written then: what was asked for, and nothing else.
    let old = |keep: &[&str], name: &str| {
        let source = snell_formats::Source::new("glass.toml", GLASS);
        let scene = snell_formats::scene_file::parse(&source, snell_formats::scene_file::Syntax::Toml).unwrap();
        let film = film_of(&scene);
        let mut text = recipe("opaque.png");
        let always = ["snell", "name", "kind", "text", "folder", "film_sha256"];
        text.as_object_mut().unwrap().retain(|key, _| always.contains(&key.as_str()) || keep.contains(&key.as_str()));
        let png = snell_formats::picture::Format::Png { sixteen_bit: false };
        let encoding =
            snell::film::transfer::Encoding { transfer: scene.render.transfer, rounding: scene.render.rounding };
        let writing = snell_formats::picture::Writing { format: png, encoding, threads: 1 };
        writing.write(&at.join(name), &film, Some(&text.to_string())).unwrap();
    };
    old(&[], "old.png");
    // That the film is the same is looked at by its hash, which the picture remembers.
    let again = run(at, &["render", "--from", "old.png", "-o", "again.png"]);
    let told = stderr(&again);
    assert!(told.contains("`tinted`") && told.contains("--shadows tinted"), "{told}");
    run(at, &["diff", "again.png", "opaque.png"]);
    let json = run(at, &["render", "--from", "old.png", "-o", "again.png", "--progress", "json"]);
    assert!(stderr(&json).lines().any(|line| line.contains(r#""event":"note""#)), "{}", stderr(&json));
    assert!(!stderr(&run(at, &["render", "--from", "old.png", "-o", "again.png", "-q"])).contains("tinted"));
    // Nothing has changed for who said it, or for another model of light, or for pictures of today.
    old(&["shadows"], "said.png");
    run(at, &["render", "glass.toml", "--integrator", "lecture", "-o", "lecture.png"]);
    render(at, &["glass.toml", "-o", "new.png"]);
    for file in ["said.png", "lecture.png", "new.png", "again.png"] {
        let told = stderr(&run(at, &["render", "--from", file, "-o", "last.png"]));
        assert!(!told.contains("note"), "{file}: {told}");
    }
    // And so that it stays so, all that a scene may leave out is written out.
    let settings =
        ["spp", "seed", "depth", "min_throughput", "bands", "integrator", "shadows", "near", "transfer", "rounding"];
    for file in ["new.png", "again.png"] {
        assert!(settings.iter().all(|&key| !recipe(file)[key].is_null()), "{}", recipe(file));
    }
    assert_eq!((&recipe("new.png")["shadows"], &recipe("again.png")["shadows"]), (&json!("tinted"), &json!("opaque")));
}

/// The same of where the image plane stands, which an angle of view left to a default of one unit.
#[test]
fn an_older_image_plane_stays_where_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let text = GLASS.replace("'whitted'", "'lecture'").replace("bounds = [-2, 2, -2, 2]\nnear = -5", "fov = 40");
    fs::write(at.join("fov.toml"), text).unwrap();
    render(at, &["fov.toml", "--set", "camera.near=-1", "-o", "then.png"]);
    let picture = snell_formats::picture::read(&at.join("then.png")).unwrap();
    let mut recipe: serde_json::Value = serde_json::from_str(&picture.recipe.unwrap()).unwrap();
    recipe.as_object_mut().unwrap().retain(|key, _| key != "set" && key != "near");
    let scene = |text: &str| {
        let source = snell_formats::Source::new("fov.toml", text);
        snell_formats::scene_file::parse(&source, snell_formats::scene_file::Syntax::Toml).unwrap()
    };
    let then = scene(&fs::read_to_string(at.join("fov.toml")).unwrap().replace("fov = 40", "fov = 40\nnear = -1"));
    let film = film_of(&then);
    let encoding = snell::film::transfer::Encoding { transfer: then.render.transfer, rounding: then.render.rounding };
    let png = snell_formats::picture::Format::Png { sixteen_bit: false };
    let writing = snell_formats::picture::Writing { format: png, encoding, threads: 1 };
    writing.write(&at.join("old.png"), &film, Some(&recipe.to_string())).unwrap();
    let told = stderr(&run(at, &["render", "--from", "old.png", "-o", "again.png"]));
    assert!(told.contains("`near` = -1") && !told.contains("differ"), "{told}");
    run(at, &["diff", "again.png", "then.png"]);
    // And what is made today says where the plane stands, which is elsewhere.
    render(at, &["fov.toml", "-o", "new.png"]);
    let told = stderr(&run(at, &["render", "--from", "new.png", "-o", "again.png"]));
    assert!(!told.contains("near"), "{told}");
    run(at, &["diff", "again.png", "new.png"]);
}

const TRIANGLE: &str = "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nusemtl m\nf 1 2 3\n";
const DRIVER: &str = "eye 0 0 9\nlook 0 0 0\nup 0 1 0\nd 5\nbounds -1 -1 1 1\nres 8 8\nambient 1 1 1\n\
                      model 0 0 1 90 1 0 0 0 t.obj\n";

fn triangle_scene(at: &Path) {
    fs::create_dir_all(at.join("models")).unwrap();
    fs::write(at.join("d.txt"), DRIVER).unwrap();
    fs::write(at.join("models/t.obj"), format!("mtllib t.mtl\n{TRIANGLE}")).unwrap();
    fs::write(at.join("models/t.mtl"), "newmtl m\nKa .5 .6 .7\n").unwrap();
}

/// Some hundred triangles of all sizes.
fn bumps(at: &Path) {
    let mut model = String::new();
    for i in 0..300u32 {
        let [x, y, z] = [13, 29, 7].map(|step| f64::from(i * step % 101) / 50.0 - 1.0);
        let size = f64::from(i % 10 + 1) / 20.0;
        writeln!(model, "v {x} {y} {z}\nv {} {y} {z}\nv {x} {} {z}\nf -3 -2 -1", x + size, y + size).unwrap();
    }
    fs::write(at.join("t.obj"), model).unwrap();
    let scene = "snell = 1\nambient = 1\n[render]\nintegrator = 'lecture'\nsize = [40, 40]\nmax_depth = 1\n[camera]\n\
                 eye = [0, 0, 9]\nlook_at = [0, 0, 0]\nup = [0, 1, 0]\nbounds = [-1, 1, -1, 1]\nnear = -5\n\
                 [material.m]\nka = 0.2\nkd = 0.5\nkr = 0.5\n[[mesh]]\nfile = 't.obj'\nmaterial = 'm'\n\
                 [[light]]\nposition = [3, 4, 9]\ncolor = 1\n";
    fs::write(at.join("s.toml"), scene).unwrap();
}

#[test]
fn a_changed_model_is_not_rendered_again_silently() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    triangle_scene(at);
    render(at, &["d.txt", "-o", "a.png"]);
    render(at, &["--from", "a.png", "-o", "b.png"]);
    run(at, &["diff", "a.png", "b.png"]);
    // Also from another folder: the picture remembers where its models are.
    fs::create_dir(at.join("elsewhere")).unwrap();
    render(&at.join("elsewhere"), &["--from", "../a.png", "-o", "b.png"]);
    fs::write(at.join("models/t.mtl"), "newmtl m\nKa .5 .6 .8\n").unwrap();
    let changed = snell(at, &["render", "--from", "a.png", "-o", "b.png"]);
    assert_eq!(changed.status.code(), Some(3));
    assert!(stderr(&changed).contains("t.mtl` has changed"), "{}", stderr(&changed));
}

#[test]
fn models_of_one_name_in_two_folders_are_told_apart() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let scene = "snell = 1\nambient = 1\n[render]\nintegrator = 'lecture'\nsize = [8, 8]\nmax_depth = 1\n[camera]\n\
                 eye = [0, 0, 9]\nlook_at = [0, 0, 0]\nup = [0, 1, 0]\nbounds = [-1, 1, -1, 1]\nnear = -5\n\
                 [[mesh]]\nfile = 'p/t.obj'\n[[mesh]]\nfile = 'q/t.obj'\ntransform = [{ move = [0, 0, -3] }]\n";
    fs::write(at.join("s.toml"), scene).unwrap();
    for (name, ka) in [("p", ".9"), ("q", ".2")] {
        fs::create_dir(at.join(name)).unwrap();
        fs::write(at.join(name).join("t.obj"), format!("mtllib m.mtl\n{TRIANGLE}")).unwrap();
        fs::write(at.join(name).join("m.mtl"), format!("newmtl m\nKa {ka} 0 0\n")).unwrap();
    }
    render(at, &["s.toml", "-o", "a.png"]);
    render(at, &["--from", "a.png", "-o", "b.png"]);
    run(at, &["diff", "a.png", "b.png"]);
    // A model that is not read any more is a change too.
    let colors = "newmtl m\nKa 1 0 0\n";
    fs::write(at.join("p/m.mtl"), colors).unwrap();
    assert_eq!(snell(at, &["render", "--from", "a.png", "-o", "c.png"]).status.code(), Some(3));
    assert!(!at.join("c.png").exists());
}

#[test]
fn a_picture_remembers_its_bits() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    render(at, &[&["lecture/default", "--bits", "16", "-o", "a.png"], TINY].concat());
    render(at, &["--from", "a.png", "-o", "b.png"]);
    run(at, &["diff", "a.png", "b.png"]);
    assert!(stdout(&run(at, &["info", "b.png"])).contains("0 to 65535"));
}

#[test]
fn the_picture_in_the_readme_is_what_snell_renders() {
    let folder = tempfile::tempdir().unwrap();
    let picture = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/pictures/default.png");
    render(folder.path(), &["--from", picture.to_str().unwrap(), "-o", "again.png"]);
    run(folder.path(), &["diff", "again.png", picture.to_str().unwrap()]);
}

#[test]
fn what_is_read_is_not_written_over() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    render(at, &[&["lecture/default", "-o", "a.png"], TINY].concat());
    render(at, &[&["lecture/wide", "-o", "b.png"], TINY].concat());
    let before = fs::read(at.join("a.png")).unwrap();
    for arguments in [
        &["diff", "a.png", "b.png", "-o", "a.png"][..],
        &["render", "--from", "a.png", "-o", "a.png"],
        &["render", "lecture/default", "lecture/wide", "-o", "a.png"],
        &["render", "lecture/default", "lecture/wide", "-o", "c.png"],
    ] {
        assert_eq!(snell(at, arguments).status.code(), Some(2), "{}", arguments.join(" "));
    }
    assert_eq!(fs::read(at.join("a.png")).unwrap(), before);
    // A scene with the ending of a picture would be its own picture's name.
    triangle_scene(at);
    fs::copy(at.join("d.txt"), at.join("scene.png")).unwrap();
    assert_eq!(snell(at, &["render", "scene.png"]).status.code(), Some(2));
    // What cannot be written is said before the work is done.
    let started = snell(at, &["render", "lecture/default", "--size", "8000x8000", "-o", "no/such/a.png"]);
    assert!(started.status.code() == Some(1) && stderr(&started).contains("mkdir -p no/such"));
}

#[test]
fn models_are_found_missed_and_refused_with_their_place() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    triangle_scene(at);
    let scene = "snell = 1\n[render]\nintegrator = 'lecture'\nsize = [8, 8]\nmax_depth = 1\n[camera]\neye = [0, 0, 9]\n\
                 look_at = [0, 0, 0]\nup = [0, 1, 0]\nbounds = [-1, 1, -1, 1]\nnear = -5\n[[mesh]]\nfile = 't.obj'\n";
    fs::write(at.join("s.toml"), scene).unwrap();
    render(at, &["s.toml", "-o", "s.png"]);
    for (model, place, message) in [
        ("v 0 0 0\nf 1 2 3\n", "t.obj:2:5", "no vertex 2: the file has 1"),
        ("v 0 0 zero\n", "t.obj:1:7", "expected a number, read `zero`"),
        ("hello\n", "t.obj:1:1", "has no faces"),
        ("", "t.obj:1:1", "has no faces"),
    ] {
        fs::write(at.join("models/t.obj"), model).unwrap();
        for scene in ["s.toml", "d.txt"] {
            let output = snell(at, &["render", scene, "-o", "x.png"]);
            let said = stderr(&output);
            assert_eq!(output.status.code(), Some(3), "{said}");
            assert!(said.contains(place) && said.contains(message), "{said}");
        }
    }
    fs::remove_file(at.join("models/t.obj")).unwrap();
    for (scene, place) in [("s.toml", "s.toml:13:8"), ("d.txt", "d.txt:8:1")] {
        let output = snell(at, &["render", scene, "-o", "x.png"]);
        assert!(stderr(&output).contains("is not there") && stderr(&output).contains(place), "{}", stderr(&output));
        assert!(stderr(&output).contains("--search"));
    }
    assert!(!at.join("x.png").exists());
}

#[test]
fn what_is_wrong_with_a_scene_is_shown_in_the_scene() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    run(at, &["scenes", "--save", "lecture/default"]);
    let text = fs::read_to_string(at.join("default.toml")).unwrap();
    for (from, to, line, message) in [
        ("radius = 9", "radius = -9", "radius = -9", "must not be negative, read -9"),
        ("radius = 9", "radius = nan", "radius = nan", "expected a number"),
        ("radius = 9", "radios = 9", "radios = 9", "did you mean `radius`?"),
        ("material = \"red\"", "material = \"rot\"", "material = \"rot\"", "glass`, `red`, `green`, `blue"),
        ("look_at = [50, 50, 10]", "look_at = [50, 50, 100]", "look_at =", "no direction to look in"),
        ("up = [0, 1, 0]", "up = [0, 0, 3]", "up =", "parallel to the view"),
        ("bounds = [-2, 2, -2, 2]", "bounds = [-2, -2, 2, 2]", "bounds =", "left, right, bottom, top"),
        ("size = [512, 512]", "size = [512, 0]", "size =", "512 x 0 pixels"),
        ("size = [512, 512]", "size = [4000000000, 4000000000]", "", "GiB"),
        ("near = -5", "near = 5", "near = 5", "must be negative"),
        ("near = -5", "", "[camera]", "nothing says where that is"),
        ("position = [20, 100, 100]", "", "[[light]]", "needs a position or a direction"),
        ("integrator = \"lecture\"", "", "[render]", "which model of light"),
        ("snell = 1", "snell = 2", "snell = 2", "this program reads version 1"),
        ("eta = 2.0", "eta = 0", "eta = 0", "must be above 0"),
        ("[camera]", "[camera", "[camera", ""),
    ] {
        assert!(text.contains(from), "{from}");
        fs::write(at.join("bad.toml"), text.replacen(from, to, 1)).unwrap();
        let output = snell(at, &["render", "bad.toml", "-o", "x.png"]);
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(3), "{to}: {said}");
        assert!(said.contains(line) && said.contains(message), "{to}: {said}");
        assert!(line.is_empty() || said.contains("bad.toml:"), "no place: {said}");
    }
    fs::write(at.join("cut.toml"), &text[..text.len() / 3]).unwrap();
    assert_eq!(snell(at, &["render", "cut.toml"]).status.code(), Some(3));
}

#[test]
fn wrong_usage_ends_with_2() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("s.txt"), DRIVER).unwrap();
    for arguments in [
        &["render"][..],
        &["render", "lecture/default", "-o", "picture.jpg"],
        &["render", "lecture/default", "--size", "0x5"],
        &["render", "lecture/default", "--size", "5"],
        &["render", "lecture/default", "--crop", "1,2,3"],
        &["render", "lecture/default", "--crop", "500,0,20,20"],
        &["render", "lecture/default", "--shadows", "soft"],
        &["render", "lecture/default", "--stretch"],
        &["render", "lecture/default", "--depth", "1001"],
        &["render", "lecture/default", "--threads", "5000"],
        &["render", "lecture/default", "--bits", "12"],
        &["render", "lecture/default", "--bvh", "better"],
        &["render", "lecture/default", "--lanes", "3"],
        &["render", "lecture/default", "--set", "material.glass.eta"],
        &["render", "lecture/default", "--search", "no-such-folder"],
        &["render", "lecture/default", "--size", "9x9", "--crop", "0,0,4000000000,4000000000"],
        &["render", "a/driver.txt", "b/driver.txt", "-o", "out/"],
        &["convert", "s.txt", "-o", "s.yaml"],
        &["diff", "a.png", "b.png", "--tolerance", "nan"],
        &["scenes", "--save", "lecture/defualt"],
        &["paint"],
    ] {
        let output = snell(at, arguments);
        assert_eq!(output.status.code(), Some(2), "snell {}\n{}", arguments.join(" "), stderr(&output));
    }
    let near = snell(at, &["scenes", "--save", "lecture/defualt"]);
    assert!(stderr(&near).contains("did you mean `lecture/default`?"));
    let long = snell(at, &["render", &"x".repeat(20_000)]);
    assert!(long.status.code() == Some(3) && stderr(&long).len() < 1000, "{} bytes", stderr(&long).len());
    assert_eq!(snell(at, &["render", "lecture/defualt"]).status.code(), Some(3));
    assert_eq!(snell(at, &["render", "no.toml"]).status.code(), Some(3));
}

#[test]
fn a_scene_is_not_overwritten_by_its_picture() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    triangle_scene(at);
    fs::copy(at.join("d.txt"), at.join("d.png")).unwrap();
    let before = fs::read(at.join("d.png")).unwrap();
    assert_eq!(snell(at, &["render", "d.png", "-o", "d.png"]).status.code(), Some(2));
    assert_eq!(fs::read(at.join("d.png")).unwrap(), before);
}

#[test]
fn one_bad_scene_of_many_does_not_stop_the_others() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("bad.toml"), "snell = 1").unwrap();
    let output = snell(at, &[&["render", "bad.toml", "lecture/default", "-o", "out"], TINY].concat());
    assert_eq!(output.status.code(), Some(3));
    assert!(at.join("out/default.png").exists());
}

#[test]
fn progress_as_json_is_json() {
    let folder = tempfile::tempdir().unwrap();
    let arguments = [&["render", "lecture/default", "-o", "a.png", "--progress", "json"], TINY].concat();
    let said = stderr(&run(folder.path(), &arguments));
    let events: Vec<serde_json::Value> = said.lines().map(|l| serde_json::from_str(l).unwrap()).collect();
    let names: Vec<_> = events.iter().map(|e| e["event"].as_str().unwrap()).collect();
    assert_eq!(names[..3], ["reading", "preparing", "progress"]);
    let done = events.last().unwrap();
    assert_eq!(done["event"], "done");
    assert_eq!(done["rays"]["camera"], 24 * 24);
    assert_eq!(done["film_sha256"].as_str().unwrap().len(), 64);
}

/// What `render --progress json` says at the end.
fn done(mut render: Command) -> serde_json::Value {
    let output = render.args(["-o", "a.png", "--progress", "json"]).output().unwrap();
    assert!(output.status.success(), "{}", stderr(&output));
    serde_json::from_str(stderr(&output).lines().last().unwrap()).unwrap()
}

/// The tree over a picture of many triangles is another one for each quality, so that it is seen whether one arrives.
#[test]
fn neither_lanes_nor_the_tree_change_the_picture() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    bumps(at);
    let render = |arguments: &[&str]| done(command(at, &[&["render", "s.toml"], arguments].concat()));
    let default = render(&[]);
    assert!(default["rays"]["mirror"].as_u64().unwrap() > 300, "hardly anything is hit: {default}");
    for (lanes, number) in [("1", 1), ("2", 2), ("4", 4), ("8", 8)] {
        let made = render(&["--lanes", lanes]);
        assert_eq!((&made["lanes"], &made["film_sha256"]), (&json!(number), &default["film_sha256"]));
    }
    let made = ["fast", "good", "best"].map(|quality| render(&["--bvh", quality]));
    for one in &made {
        assert_eq!(one["film_sha256"], default["film_sha256"]);
    }
    assert_eq!(made[1]["tree"], default["tree"]);
    assert!(made[0]["tree"] != made[1]["tree"] && made[1]["tree"] != made[2]["tree"], "{made:?}");
    // Nor are they part of what a picture remembers: a picture made in any other way is the same file.
    render(&["--lanes", "1", "--bvh", "fast"]);
    let picture = fs::read(at.join("a.png")).unwrap();
    render(&["--lanes", "8", "--bvh", "best"]);
    assert!(fs::read(at.join("a.png")).unwrap() == picture, "the files differ");
}

#[test]
fn lanes_can_come_from_the_environment() {
    let folder = tempfile::tempdir().unwrap();
    let with = |variable: &str, arguments: &[&str]| {
        let mut render = command(folder.path(), &[&["render", "lecture/default"], TINY, arguments].concat());
        render.env("SNELL_LANES", variable);
        render
    };
    assert_eq!(done(with("1", &[]))["lanes"], 1);
    assert_eq!(done(with("4", &[]))["lanes"], 4);
    assert_eq!(done(with("4", &["--lanes", "2"]))["lanes"], 2, "what is typed wins");
    assert_eq!(done(with("3", &["--lanes", "2"]))["lanes"], 2, "what is not used may be wrong");
    for wrong in ["3", "0", "16", "-1", "two", " 2", "18446744073709551617"] {
        let output = with(wrong, &[]).output().unwrap();
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(2), "{wrong}: {said}");
        assert!(said.contains(&format!("'{wrong}'")) && said.contains("expected 1, 2, 4 or 8"), "{said}");
        assert!(said.contains("--lanes") && said.contains("SNELL_LANES"), "{said}");
    }
    // It is the business of `render` alone.
    assert!(command(folder.path(), &["scenes"]).env("SNELL_LANES", "3").status().unwrap().success());
}

#[test]
fn stderr_into_a_file_has_no_bar_and_no_colour() {
    let folder = tempfile::tempdir().unwrap();
    let output = run(folder.path(), &[&["render", "lecture/default", "-o", "a.png"], TINY].concat());
    let said = stderr(&output);
    assert!(!said.contains('\u{1b}') && !said.contains('━'), "{said}");
    assert!(said.contains("24 x 24") && said.contains("rays/s"), "{said}");
    let quiet = run(folder.path(), &[&["render", "lecture/default", "-o", "a.png", "-q"], TINY].concat());
    assert_eq!(stderr(&quiet), "");
}

/// ^C within a second: what is done is written, unfinished pixels are transparent, and the exit code is 130.
#[cfg(unix)]
#[test]
fn interrupted_renders_keep_what_is_done() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    // Two thousand million samples: it is far from done when the signal comes, however busy or fast the machine is.
    let arguments = ["render", "lecture/default", "--size", "3000x3000", "--spp", "256", "--progress", "json", "-o"];
    for name in ["a.png", "a.npy"] {
        let mut child =
            command(at, &[&arguments[..], &[name]].concat()).stderr(std::process::Stdio::piped()).spawn().unwrap();
        // Once the first tiles are reported, it is running.
        let mut lines = std::io::BufRead::lines(std::io::BufReader::new(child.stderr.take().unwrap()));
        while !lines.next().unwrap().unwrap().contains("\"progress\"") {}
        let rest = std::thread::spawn(move || lines.map_while(Result::ok).collect::<Vec<_>>());
        let interrupted = Instant::now();
        let kill = Command::new("kill").args(["-INT", &child.id().to_string()]).status().unwrap();
        assert!(kill.success());
        assert_eq!(child.wait().unwrap().code(), Some(130));
        // Stopping takes milliseconds; writing nine million pixels takes the rest, on a machine that does other things too.
        assert!(interrupted.elapsed() < Duration::from_mins(1));
        assert!(rest.join().unwrap().last().unwrap().contains("\"interrupted\""));
        let bytes = fs::read(at.join(name)).unwrap();
        // Byte 25 of a PNG is its colour type: 6 has transparency. In an NPY what is missing is NaN.
        assert!(if name == "a.png" { bytes[25] == 6 } else { bytes.ends_with(&f64::NAN.to_le_bytes()) }, "{name}");
    }
    let litter =
        fs::read_dir(at).unwrap().flatten().filter(|e| e.file_name().to_string_lossy().contains(".tmp")).count();
    assert_eq!(litter, 0);
}

#[test]
fn info_schema_and_completions_answer() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    triangle_scene(at);
    let info = stdout(&run(at, &["info", "d.txt"]));
    for expected in ["dialect", "2018", "course2018, depth 0", "8 x 8", "1 triangles"] {
        assert!(info.contains(expected), "{expected} in\n{info}");
    }
    assert!(info.contains("  tree        1 nodes, 1 leaves, depth 1, "), "{info}");
    let schema: serde_json::Value = serde_json::from_str(&stdout(&run(at, &["schema"]))).unwrap();
    assert!(schema["properties"]["sphere"].is_object());
    for shell in ["bash", "zsh", "fish"] {
        assert!(stdout(&run(at, &["completions", shell])).contains("snell"));
    }
}

/// A picture knows its scene, and what it is asked to be otherwise.
#[test]
fn a_picture_can_be_made_again_with_changes() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let made = |arguments: &[&str]| render(at, &[arguments, &["-o", "b.npy"]].concat());
    let same = |arguments: &[&str]| {
        render(at, &[arguments, &["-o", "c.npy"]].concat());
        run(at, &["diff", "b.npy", "c.npy"]);
    };
    render(
        at,
        &[&["lecture/default", "--depth", "3", "--set", "material.glass.eta=1.7", "-o", "a.png"], TINY].concat(),
    );
    let first = [&["lecture/default", "--depth", "3", "--set", "material.glass.eta=1.7"], TINY].concat();
    made(&["--from", "a.png"]);
    same(&first);
    made(&["--from", "a.png", "--spp", "4", "--set", "material.glass.eta=1.2"]);
    same(&[&first[..], &["--spp", "4", "--set", "material.glass.eta=1.2"]].concat());
    // What is set in the scene wins over what the picture remembers of its settings.
    made(&["--from", "a.png", "--set", "render.max_depth=1"]);
    same(&[&["lecture/default", "--depth", "1", "--set", "material.glass.eta=1.7"], TINY].concat());
    made(&["--from", "a.png", "--size", "30x20"]);
    same(&["lecture/default", "--depth", "3", "--set", "material.glass.eta=1.7", "--size", "30x20"]);
    made(&["--from", "a.png", "--integrator", "whitted"]);
    same(&[&first[..], &["--integrator", "whitted"]].concat());
    made(&["--from", "a.png", "--crop", "3,4,5,6"]);
    same(&[&first[..], &["--crop", "3,4,5,6"]].concat());
    // Quoted keys are keys.
    made(&["--from", "a.png", "--set", "'render'.\"max_depth\"=1"]);
    same(&[&["lecture/default", "--depth", "1", "--set", "material.glass.eta=1.7"], TINY].concat());
    // What was asked for stays; what was a default is that of the other model of light.
    fs::write(at.join("glass.toml"), GLASS).unwrap();
    for (asked, expected) in [(&["--shadows", "off"][..], &["--shadows", "off"][..]), (&[], &[])] {
        render(at, &[&["glass.toml", "--integrator", "lecture", "-o", "g.png"], asked].concat());
        for other in
            [&["--integrator", "whitted"][..], &["--set", "render.integrator=whitted", "--integrator", "whitted"]]
        {
            made(&[&["--from", "g.png"], other].concat());
            same(&[&["glass.toml", "--integrator", "whitted"], expected].concat());
        }
    }
    fs::write(
        at.join("fov.toml"),
        GLASS.replace("'whitted'", "'lecture'").replace("bounds = [-2, 2, -2, 2]\nnear = -5", "fov = 40"),
    )
    .unwrap();
    render(at, &["fov.toml", "-o", "f.png"]);
    made(&["--from", "f.png", "--set", "camera.fov=30"]);
    same(&["fov.toml", "--set", "camera.fov=30"]);
    // A change may be that a model is not read any more.
    fs::write(at.join("t.obj"), TRIANGLE).unwrap();
    fs::write(at.join("mesh.toml"), format!("{GLASS}[[mesh]]\nfile = 't.obj'\nmaterial = 'floor'\n")).unwrap();
    render(at, &["mesh.toml", "-o", "m.png"]);
    made(&["--from", "m.png", "--set", "mesh=[]"]);
    same(&["mesh.toml", "--set", "mesh=[]"]);
    // And the change is remembered in turn.
    render(at, &["--from", "a.png", "--set", "ambient=0.7", "-o", "d.png"]);
    render(at, &["--from", "d.png", "-o", "e.png"]);
    run(at, &["diff", "d.png", "e.png"]);
    let info = stdout(&run(at, &["info", "e.png"]));
    assert!(info.contains("changed      material.glass.eta=1.7\nchanged      ambient=0.7"), "{info}");
    // Ways of light, too.
    for (arguments, name) in [(["--paths", "3"], "p.exr"), (["--only", "green"], "p.png")] {
        render(at, &[&["lecture/default"], TINY, &arguments, &["-o", name]].concat());
        render(at, &["--from", name, "-o", &format!("again-{name}")]);
        run(at, &["diff", name, &format!("again-{name}")]);
        assert!(fs::read(at.join(name)).unwrap() == fs::read(at.join(format!("again-{name}"))).unwrap(), "{name}");
    }
}

#[test]
fn a_picture_can_be_explained() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    render(at, &[&["lecture/default", "--set", "material.glass.eta=1.7", "-o", "a.png"], TINY].concat());
    let explain = |arguments: &[&str]| stdout(&run(at, &[&["explain"], arguments].concat()));
    let of_scene = [&["lecture/default", "12,11"], TINY].concat();
    let changed = explain(&[&of_scene[..], &["--set", "material.glass.eta=1.7"]].concat());
    let said = explain(&["a.png", "12,11"]);
    assert!(said.starts_with("a.png, lecture/default with material.glass.eta=1.7, pixel 12,11 of 24 x 24"), "{said}");
    // The numbers below "with material.glass.eta=1.7:" are those of the picture.
    assert!(changed.contains(said.lines().nth(1).unwrap()), "{changed}\n{said}");
    // A part of a picture: columns and rows are the part's.
    render(at, &[&["lecture/default", "--crop", "10,9,5,5", "-o", "part.exr"], TINY].concat());
    let json = explain(&["part.exr", "2,2", "--json"]).replace("part.exr, lecture", "lecture");
    assert_eq!(json, explain(&[&of_scene[..], &["--json"]].concat()));
    let outside = snell(at, &["explain", "part.exr", "5,2"]);
    assert!(
        outside.status.code() == Some(2) && stderr(&outside).contains("columns are 0 to 4"),
        "{}",
        stderr(&outside)
    );
    // A change may be what makes a scene of it.
    fs::write(at.join("t.obj"), TRIANGLE).unwrap();
    fs::write(
        at.join("open.toml"),
        GLASS.replace("[[sphere]]\ncenter = [0, 1, 0]\nradius = 1", "[[mesh]]\nfile = 't.obj'"),
    )
    .unwrap();
    assert_eq!(snell(at, &["explain", "open.toml", "12,12"]).status.code(), Some(3));
    let what_if = run(at, &["explain", "open.toml", "12,12", "--set", "mesh.1.open=opaque"]);
    assert!(stderr(&what_if).contains("not a solid") && stdout(&what_if).contains("with mesh.1.open=opaque"));
}

#[test]
fn standard_input_and_output() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let text = stdout(&run(at, &["scenes", "--save", "lecture/default", "-o", "-"]));
    let piped = |arguments: &[&str], input: &str| {
        let mut child = command(at, arguments)
            .stdin(std::process::Stdio::piped())
            .stdout(std::process::Stdio::piped())
            .stderr(std::process::Stdio::piped())
            .spawn()
            .unwrap();
        std::io::Write::write_all(&mut child.stdin.take().unwrap(), input.as_bytes()).unwrap();
        child.wait_with_output().unwrap()
    };
    for format in ["png", "ppm", "exr", "npy"] {
        let through = piped(&[&["render", "-", "-o", "-", "--format", format], TINY].concat(), &text);
        assert!(through.status.success(), "{}", stderr(&through));
        let name = format!("a.{format}");
        fs::write(at.join(&name), &through.stdout).unwrap();
        render(at, &[&["lecture/default", "-o", &format!("b.{format}")], TINY].concat());
        run(at, &["diff", &name, &format!("b.{format}")]);
    }
    // What it is, is told by how it starts: JSON, a driver, NFF.
    let json = stdout(&run(at, &["convert", "lecture/default", "-o", "s.json"]))
        + &fs::read_to_string(at.join("s.json")).unwrap();
    let nff = "v\nfrom 0 0 9\nat 0 0 0\nup 0 1 0\nangle 40\nhither 1\nresolution 8 8\nf 1 1 1 1 0 0 0 0\ns 0 0 0 1\n";
    triangle_scene(at);
    for (input, expected) in
        [(&*json, "lecture, depth 6"), (DRIVER, "course2018"), (nff, "whitted, depth 32"), (&text, "lecture, depth 6")]
    {
        let info = piped(&["info", "-"], input);
        assert!(stdout(&info).contains(expected), "{}{}", stdout(&info), stderr(&info));
    }
    let empty = piped(&["render", "-", "-o", "x.png"], "");
    assert!(empty.status.code() == Some(3) && stderr(&empty).starts_with("error"), "{}", stderr(&empty));
    // The name of the picture is made of what is known.
    fs::write(at.join("balls.nff"), nff).unwrap();
    render(at, &["balls.nff"]);
    assert!(at.join("balls.png").exists());
}

/// What is large goes beside a converted scene, to the bit; and what is beside it is found from another folder.
#[test]
fn a_converted_scene_is_the_same_scene_anywhere() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let mut nff =
        "b 0.2 0.3 0.4\nv\nfrom 0 0 9\nat 0 0 0\nup 0 1 0\nangle 40\nhither 1\nresolution 24 24\nl 3 4 9\n".to_owned();
    nff.push_str("f 0.9 0.1 0.3 1 0 0 0 0\n");
    for i in 0..1500u32 {
        let [x, y, z] = [13, 29, 7].map(|step| f64::from(i * step % 101) / 25.0 - 2.0 + f64::from(i) * 1e-9);
        writeln!(nff, "p 3\n{x} {y} {z}\n{} {y} {z}\n{x} {} {z}", x + 0.3, y + 0.2).unwrap();
    }
    fs::write(at.join("many.nff"), nff).unwrap();
    fs::create_dir(at.join("sub")).unwrap();
    render(at, &["many.nff", "-o", "a.npy"]);
    for output in ["sub/many.toml", "sub/many.json"] {
        let said = stderr(&run(at, &["convert", "many.nff", "-o", output, "--force"]));
        assert!(said.contains("many-mesh-") && fs::metadata(at.join(output)).unwrap().len() < 4000, "{said}");
        render(at, &[output, "-o", "b.npy"]);
        run(at, &["diff", "a.npy", "b.npy"]);
    }
    // The names are made of the content: another mesh takes nobody's place, and what has the name is not written over.
    let meshes = || {
        let names = fs::read_dir(at.join("sub")).unwrap().flatten().map(|e| e.file_name().into_string().unwrap());
        names.filter(|name| name.contains("-mesh-")).collect::<Vec<_>>()
    };
    let [mesh] = &meshes()[..] else { panic!("{:?}", meshes()) };
    let scale =
        fs::read_to_string(at.join("many.nff")).unwrap().replace("p 3\n", "p 3\n0 0 0\n").replacen("p 3", "p 4", 9999);
    fs::write(at.join("sub/other.nff"), scale).unwrap();
    run(at, &["convert", "sub/other.nff", "-o", "sub/many.toml", "--force"]);
    assert_eq!(meshes().len(), 2);
    render(at, &["sub/many.json", "-o", "b.npy"]);
    run(at, &["diff", "a.npy", "b.npy"]);
    fs::write(at.join("sub").join(mesh), "mine").unwrap();
    let refused = snell(at, &["convert", "many.nff", "-o", "sub/many.toml", "--force"]);
    assert!(
        refused.status.code() == Some(1) && fs::read(at.join("sub").join(mesh)).unwrap() == b"mine",
        "{}",
        stderr(&refused)
    );
    // Textures, of the scene and of its models, are found from the new place.
    render(at, &[&["lecture/default", "-o", "wall.png"], TINY].concat());
    fs::write(
        at.join("t.obj"),
        "mtllib t.mtl\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n",
    )
    .unwrap();
    fs::write(at.join("t.mtl"), "newmtl m\nKa 1 1 1\nmap_Kd wall.png\n").unwrap();
    let scene = GLASS.replace(
        "[material.floor]\nkd = 1",
        "[material.floor]\nka = 1\ntexture = 't'\n[texture.t]\nimage = 'wall.png'",
    );
    fs::write(at.join("s.toml"), format!("{scene}[sky]\nimage = 'wall.png'\n[[mesh]]\nfile = 't.obj'\n")).unwrap();
    render(at, &["s.toml", "-o", "a.npy"]);
    run(at, &["convert", "s.toml", "-o", "sub/s.toml"]);
    run(&at.join("sub"), &["render", "-q", "s.toml", "-o", "../b.npy"]);
    run(at, &["diff", "a.npy", "b.npy"]);
}

/// Glass of a model's own materials: a solid where the mesh is one, panes elsewhere; the map of a material without `Kd`.
#[test]
fn materials_of_models_are_drawn_or_named() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let tetra = "mtllib m.mtl\nusemtl m\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";
    let scene = "snell = 1\nambient = 1\nbackground = [0, 0, 1]\n[render]\nintegrator = 'whitted'\nsize = [9, 9]\n[camera]\n\
                 eye = [0.2, 0.2, 9]\nlook_at = [0.2, 0.2, 0]\nup = [0, 1, 0]\nfov = 4\n[[mesh]]\nfile = 't.obj'\n";
    fs::write(at.join("s.toml"), scene).unwrap();
    fs::write(at.join("m.mtl"), "newmtl m\nKa 1 0 0\nd 0.25\nNi 1.5\n").unwrap();
    let explained = |arguments: &[&str]| stdout(&run(at, &[&["explain", "s.toml", "4,4"], arguments].concat()));
    fs::write(at.join("t.obj"), tetra).unwrap();
    assert!(explained(&[]).contains("refracted"), "{}", explained(&[]));
    assert!(explained(&["--json"]).contains("\"eta_behind\":1.5"), "a solid of glass");
    fs::write(at.join("t.obj"), tetra.replace("f 1 4 3\n", "")).unwrap();
    assert!(
        explained(&["--json"]).contains("\"eta_behind\":1.0") || explained(&["--json"]).contains("\"eta_behind\":1,"),
        "{}",
        explained(&["--json"])
    );
    // What another model of light does not draw is said, and so is what none does.
    fs::write(at.join("m.mtl"), "newmtl m\nKa 1 0 0\nd 0.25\nTf 1 0 0\nPm 1\n").unwrap();
    let said = stderr(&run(at, &["render", "s.toml", "--integrator", "lecture", "-o", "x.png"]));
    assert!(said.contains("`d` or `Tr`") && said.contains("W006"), "{said}");
    assert!(said.contains("`Tf`, `Pm`") && said.contains("W109"), "{said}");
    // Many names that are nowhere are one warning.
    let many: Vec<String> = (0..20_000).map(|i| format!("usemtl n{i}\nf 1 2 3\n")).collect();
    fs::write(at.join("t.obj"), format!("{tetra}{}", many.concat())).unwrap();
    let said = stderr(&run(at, &["render", "s.toml", "--integrator", "lecture", "-o", "x.png"]));
    assert!(said.matches("W104").count() == 1 && said.contains("and 19980 more"), "{said}");
}

#[test]
fn info_and_completions_know_names() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let shapes = "[[sphere]]\ncenter = [2, 1, 0]\nradius = 1\nmaterial = 'glass'\n\
                  [[plane]]\ncenter = [0, -1, 0]\nsize = [2, 2]\nmaterial = 'floor'\n[[box]]\nname = 'crate'\nmin = [0, 0, 0]\n\
                  max = [1, 1, 1]\nmaterial = 'floor'\n";
    fs::write(at.join("s.toml"), format!("{GLASS}{shapes}")).unwrap();
    let info = stdout(&run(at, &["info", "s.toml"]));
    for expected in [
        "sphere 1: ",
        "sphere 2: ",
        "plane 2: ",
        "crate: from",
        "near -5",
        "bounds      (-4.5, -1, -4.5) to (4.5, 2, 4.5)",
        "light 1: ",
    ] {
        assert!(info.contains(expected), "{expected} in\n{info}");
    }
    for shell in ["bash", "zsh", "fish"] {
        let script = stdout(&run(at, &["completions", shell]));
        assert!(script.contains("gallery/brilliant"), "{shell}");
    }
    let help = stdout(&run(at, &["render", "--help"]));
    assert!(!help.contains("gallery/brilliant"), "{help}");
}
