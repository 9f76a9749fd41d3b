//! `snell explain`, and the light paths in `snell render`.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod common;

use common::{run, snell, stderr, stdout};
use serde_json::Value;
use std::fs;
use std::path::Path;

fn said(arguments: &[&str]) -> String {
    stdout(&run(Path::new("."), &[&["explain"], arguments].concat()))
}

/// What people see first: word by word.
#[test]
fn the_tree_in_the_terminal() {
    let expected = "\
lecture/default, pixel 190,300 of 512 x 512, lecture
(0.1121, 0.4890, 0.1121) #1d7d1d
Green because 53 % of this pixel is the sphere `green`, seen through `glass` (in at 43.1° → 20.0°); 47 % is the sphere `glass` itself.

 100 %  camera ray from the image plane → glass after 38.0123, at 43.1° → 20.0°
│       47 % its own colour: ambient, left, right
├─  53 %  refracted → green after 19.1487, at 7.5°
│ │       53 % its own colour: ambient, left, right
│ └─   0 %  mirrored → nothing
└─   0 %  mirrored → nothing
";
    assert_eq!(said(&["lecture/default", "190,300"]), expected);
}

#[test]
fn the_tree_as_json_adds_up() {
    let text = said(&["lecture/default", "190,300", "--json"]);
    let value: Value = serde_json::from_str(&text).unwrap();
    assert_eq!((&value["snell_ray_tree"], &value["pixel"]), (&1.into(), &serde_json::json!([190, 300])));
    let nodes = value["samples"][0]["nodes"].as_array().unwrap();
    let sum = nodes.iter().fold(0.0, |sum, node| sum + node["contribution"][1].as_f64().unwrap());
    assert_eq!(Some(sum), value["color"][1].as_f64(), "bit for bit, through the text too");
}

#[test]
fn questions_are_answered() {
    let light = said(&["lecture/default", "256,400", "--light", "left"]);
    assert!(light.contains("on blue at") && light.contains("blocked by glass at"), "{light}");
    let without = said(&["lecture/default", "327,163", "--without", "red"]);
    assert!(without.contains("camera → green(mirror) → red") && without.contains("Green because all"), "{without}");
    let same = said(&["gallery/window", "600,100", "--without", "red ball"]);
    assert!(same.contains("without red ball:"), "{same}");
    let less = said(&["lecture/default", "190,300", "--set", "material.glass.eta=1.0"]);
    assert!(less.contains("with material.glass.eta=1.0:") && less.contains("before"), "{less}");
    let found = said(&["lecture/default", "--find", "green", "--size", "64x64"]);
    assert!(found.contains(" px  camera → green\n") && found.contains("camera → glass(refract) → green"), "{found}");
    let set = ["lecture/default", "--find", "green", "--size", "64x64", "--set", "material.glass.eta=2.42"];
    assert_eq!(said(&set), said(&["lecture/diamond", "--find", "green", "--size", "64x64"]), "of the scene as set");
    assert_ne!(said(&set), found);
    let few = said(&["gallery/bubbles", "302,340", "--top", "3", "--depth", "2"]);
    assert!(few.contains("more rays; --top N and --depth N show more"), "{few}");
}

#[test]
fn pages_and_drawings_need_nothing_else() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    run(at, &["explain", "lecture/default", "190,300", "--html", "why.html"]);
    let page = fs::read_to_string(at.join("why.html")).unwrap();
    assert!(page.contains("SnellViewer.mount(") && page.contains("\"snell_view\":1"));
    let elsewhere = page.matches("src=\"http").count() + page.matches("href=\"http").count();
    assert_eq!(elsewhere, 0);
    run(at, &["explain", "gallery/pencil", "300,500", "--spp", "1", "--svg", "why.svg"]);
    let drawing = fs::read_to_string(at.join("why.svg")).unwrap();
    assert!(drawing.starts_with("<svg") && drawing.contains("critical 41.1°") && drawing.ends_with("</svg>\n"));
    // A name that would end the script that holds it.
    let scene = stdout(&run(at, &["scenes", "--save", "lecture/default", "-o", "s.toml"]));
    assert_eq!(scene, "s.toml\n");
    let text = fs::read_to_string(at.join("s.toml")).unwrap().replace("name = \"green\"", "name = \"</script><b>\"");
    fs::write(at.join("s.toml"), text).unwrap();
    run(at, &["explain", "s.toml", "190,300", "--html", "bad.html"]);
    let page = fs::read_to_string(at.join("bad.html")).unwrap();
    assert_eq!(page.matches("</script").count(), 2, "the viewer's and the data's own");
}

#[test]
fn pictures_come_apart_by_their_paths() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let output = run(at, &["render", "lecture/default", "--size", "48x48", "--paths", "4", "-o", "paths.exr"]);
    let list = stderr(&output);
    assert!(list.contains("camera → glass") && list.contains("rest") && list.contains("5 layers"), "{list}");
    let bytes = fs::read(at.join("paths.exr")).unwrap();
    let has = |text: &[u8]| bytes.windows(text.len()).any(|window| window == text);
    assert!(has(b"camera -> glass") && has(b"picture"));
    let only = ["render", "lecture/default", "--size", "48x48", "--only", "glass(refract) green", "-o", "only.png"];
    assert!(stderr(&run(at, &only)).contains("camera → glass(refract) → green, in "));
}

#[test]
fn mistakes_say_what_there_is() {
    for (arguments, expected) in [
        (&["explain", "lecture/default", "512,0"][..], "columns are 0 to 511"),
        (&["explain", "lecture/default", "5"], "expected column and row"),
        (&["explain", "lecture/default"], "X,Y"),
        (&["explain", "lecture/default", "5,5", "--without", "gren"], "did you mean `green`? Known here: glass"),
        (&["explain", "lecture/default", "190,300", "--light", "middle"], "Known here: left, right"),
        (&["explain", "lecture/default", "--find", "nobody"], "no object is called"),
        (&["render", "lecture/default", "--paths", "3", "-o", "x.png"], "only EXR pictures have layers"),
        (&["render", "lecture/default", "--only", "glass(bent) green", "-o", "x.png"], "is no step of a path"),
    ] {
        let output = snell(Path::new("."), arguments);
        assert_eq!(output.status.code(), Some(2), "{arguments:?}");
        assert!(stderr(&output).contains(expected), "{arguments:?}: {}", stderr(&output));
    }
}

/// What README and documentation show below a command is what it prints: each block is a part of it, line by line.
#[test]
fn commands_in_the_documentation_print_what_is_shown() {
    let mut count = 0;
    for page in [include_str!("../../../README.md"), include_str!("../../../docs/explain.md")] {
        for block in page.split("```text\n$ snell ").skip(1) {
            let block = block.split("```").next().unwrap();
            let (command, shown) = block.split_once('\n').unwrap();
            let printed = stdout(&run(Path::new("."), &command.split_whitespace().collect::<Vec<_>>()));
            let mut lines = printed.lines();
            for line in shown.lines() {
                assert!(lines.any(|printed| printed == line), "snell {command} does not print\n{line}\nbut\n{printed}");
            }
            count += 1;
        }
    }
    assert_eq!(count, 5);
}
