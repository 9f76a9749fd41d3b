//! Every verb against what goes wrong around it: files of the wrong kind, outputs that are inputs, disks that are full, streams
//! that are closed, names that do not exist, signals. Each ends with an exit code and words that can be read, and every file is
//! what it was, byte for byte.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod common;

use common::{command, run, snell, stderr, stdout};
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output, Stdio};

const SCENE: &str = "snell = 1\nambient = 1\n[render]\nintegrator = 'whitted'\nsize = [8, 8]\n[camera]\neye = [0, 0, 5]\n\
                     look_at = [0, 0, 0]\nup = [0, 1, 0]\nfov = 40\n[material.m]\nka = 1\ntexture = 't'\n[material.n]\nka = 1\n\
                     [texture.t]\nimage = 'scene.png'\n[[sphere]]\nname = 'ball'\ncenter = [0, 0, 0]\nradius = 1\nmaterial = 'm'\n\
                     [[mesh]]\nfile = 'model.obj'\n[sky]\nimage = 'sky.exr'\n[[light]]\nname = 'lamp'\nposition = [0, 9, 0]\ncolor = 1\n";
const MODEL: &str = "mtllib library.mtl\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nusemtl m\nf 1 2 3\n";
const DRIVER: &str = "eye 0 0 5\nlook 0 0 0\nup 0 1 0\nd 1\nbounds -1 -1 1 1\nres 8 8\nambient 1 1 1\n";

/// A folder with a scene and all that it reads, and a picture of it. The default name of the picture is that of its texture.
fn workplace() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("scene.toml"), SCENE).unwrap();
    fs::write(at.join("model.obj"), MODEL).unwrap();
    fs::write(at.join("library.mtl"), "newmtl m\nKa 1 0 0\nKd 1 0 0\n").unwrap();
    run(at, &["render", "-q", "lecture/default", "--size", "8x8", "-o", "scene.png"]);
    run(at, &["render", "-q", "lecture/default", "--size", "8x8", "-o", "sky.exr"]);
    run(at, &["render", "-q", "scene.toml", "-o", "older.png"]);
    folder
}

/// The bytes of all files of a folder, by their names.
fn files(at: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let entries = fs::read_dir(at).unwrap().flatten();
    entries.filter(|e| e.path().is_file()).map(|e| (e.path(), fs::read(e.path()).unwrap())).collect()
}

fn lines(count: usize, of: impl Fn(usize) -> String) -> String {
    (0..count).map(of).collect::<Vec<_>>().join("\n") + "\n"
}

/// Refused: an exit code, a line that begins with `error`, nothing that steers a terminal, and no file touched.
fn refused(at: &Path, arguments: &[&str], before: &BTreeMap<PathBuf, Vec<u8>>) -> Output {
    let output = snell(at, arguments);
    judge(at, &arguments.join(" "), &output, before);
    output
}

fn judge(at: &Path, what: &str, output: &Output, before: &BTreeMap<PathBuf, Vec<u8>>) {
    let said = stderr(output);
    assert!(matches!(output.status.code(), Some(1..=3)), "snell {what}: {:?}\n{said}", output.status);
    assert!(said.lines().any(|line| line.starts_with("error")), "snell {what}: no error is said\n{said}");
    for text in [&said, &stdout(output)] {
        let odd = text.chars().find(|c| (c.is_control() && *c != '\n' && *c != '\t') || *c == '\u{202e}');
        assert!(odd.is_none(), "snell {what}: {odd:?} in\n{text}");
    }
    assert!(!said.contains("panicked"), "snell {what}\n{said}");
    let after = files(at);
    assert!(&after == before, "snell {what}: files are {:?}\n{said}", after.keys());
}

#[test]
fn files_of_the_wrong_kind() {
    let folder = workplace();
    let at = folder.path();
    let mut stl = vec![b' '; 80];
    stl.extend(1u32.to_le_bytes());
    stl.extend([0; 50]);
    for (name, bytes) in [
        ("a.glb", &b"glTF\x02\0\0\0\x1b[31m"[..]),
        ("a.gltf", b"{ \"asset\": {} }"),
        ("a.jpg", b"\xff\xd8\xff\xe0\0\x10JFIF\x1b[2J"),
        ("a.fbx", b"Kaydara FBX Binary  \0"),
        ("a.zip", b"PK\x03\x04\0"),
        ("a.pdf", b"%PDF-1.7\n"),
        ("a.ipynb", b"{ \"cells\": [] }"),
        ("noise", &[0, 1, 2, 0x1b, 0x9b, 200, 255]),
        ("noise.toml", &[0x1b, b'[', b'3', b'1', b'm', 0]),
        ("noise.txt", b"\x1b[31m \xe2\x80\xae 1 2\n"),
        ("empty", b""),
        ("empty.toml", b""),
        ("empty.obj", b""),
        ("solid.stl", &stl),
        ("\u{1b}[31mred.toml", b"snell = 1"),
    ] {
        fs::write(at.join(name), bytes).unwrap();
    }
    fs::create_dir(at.join("sub")).unwrap();
    let before = files(at);
    let inputs = [
        "a.glb",
        "a.gltf",
        "a.jpg",
        "a.fbx",
        "a.zip",
        "a.pdf",
        "a.ipynb",
        "noise",
        "noise.toml",
        "noise.txt",
        "empty",
        "empty.toml",
        "empty.obj",
        "\u{1b}[31mred.toml",
        "none.toml",
        "none",
        "sub",
        "model.obj",
        "solid.stl",
        "library.mtl",
        "scene.png",
        "sky.exr",
    ];
    for input in inputs {
        let is_model = ["model.obj", "solid.stl"].contains(&input);
        let is_picture = ["scene.png", "sky.exr"].contains(&input);
        refused(at, &["render", input, "-o", "new.png"], &before);
        refused(at, &["render", input, "-q"], &before);
        refused(at, &["convert", input], &before);
        refused(at, &["convert", input, "-o", "new.toml"], &before);
        if !is_picture {
            refused(at, &["explain", input, "1,1"], &before);
            refused(at, &["explain", input, "--find", "ball"], &before);
            refused(at, &["info", input], &before);
            refused(at, &["render", "--from", input, "-o", "new.png"], &before);
            refused(at, &["diff", input, "scene.png"], &before);
            refused(at, &["diff", "scene.png", input], &before);
        }
        if !is_model {
            refused(at, &["check", input], &before);
            refused(at, &["check", input, "--repair", "-o", "new.obj"], &before);
        }
        refused(at, &["scenes", "--save", input], &before);
        // Named by a scene.
        for (from, to) in [("scene.png", input), ("model.obj", input), ("sky.exr", input)] {
            if (is_picture && from != "model.obj") || (is_model && from == "model.obj") || input.starts_with('\u{1b}') {
                continue;
            }
            fs::write(at.join("other.toml"), SCENE.replace(from, to)).unwrap();
            refused(at, &["render", "other.toml", "-o", "new.png"], &files(at));
            fs::remove_file(at.join("other.toml")).unwrap();
        }
    }
    for (input, words) in [
        ("model.obj", "OBJ model"),
        ("solid.stl", "STL model"),
        ("a.glb", "glTF"),
        ("scene.png", "snell render --from"),
        ("a.jpg", "JPEG"),
        ("library.mtl", "materials"),
        ("none.toml", "no file `none.toml`"),
    ] {
        let said = stderr(&snell(at, &["render", input, "-o", "new.png"]));
        assert!(said.contains(words), "{input}: {said}");
    }
}

#[test]
fn twenty_warnings_and_then_the_error() {
    let folder = workplace();
    let at = folder.path();
    let odd = lines(40, |i| format!("odd{i} x"));
    fs::write(at.join("d.txt"), format!("{odd}{DRIVER}sphere 0 0 0 oops\n")).unwrap();
    fs::write(at.join("m.obj"), format!("{odd}{MODEL}f 1 2 oops\n")).unwrap();
    fs::write(at.join("m.toml"), SCENE.replace("model.obj", "m.obj")).unwrap();
    let negative = lines(40, |i| format!("[material.m{i}]\nkd = -1"));
    fs::write(at.join("w.toml"), format!("{negative}{SCENE}").replace("radius = 1", "radius = oops")).unwrap();
    let before = files(at);
    for input in ["d.txt", "m.toml", "w.toml"] {
        for arguments in [
            &["render", input, "-o", "new.png"][..],
            &["render", "-q", input, "-o", "new.png"],
            &["render", input, "-o", "new.png", "--progress", "json"],
            &["explain", input, "1,1"],
            &["info", input],
            &["convert", input],
            &["check", input],
        ] {
            let said = stderr(&refused(at, arguments, &before));
            assert!(said.contains("oops"), "{said}");
            let warnings = said.lines().filter(|line| line.starts_with("warning")).count();
            assert!(warnings <= 6, "{warnings} warnings\n{said}");
        }
    }
    assert!(stderr(&refused(at, &["check", "m.obj"], &before)).contains("oops"));
}

/// Each output of each verb against each file that was read, by its own name and by links of both kinds.
#[cfg(unix)]
#[test]
fn outputs_that_are_inputs() {
    let folder = workplace();
    let at = folder.path();
    for input in ["scene.toml", "model.obj", "library.mtl", "scene.png", "sky.exr", "older.png"] {
        for ending in ["png", "exr", "toml", "obj", "html"] {
            std::os::unix::fs::symlink(input, at.join(format!("soft-{input}.{ending}"))).unwrap();
            fs::hard_link(at.join(input), at.join(format!("hard-{input}.{ending}"))).unwrap();
        }
    }
    run(at, &["scenes", "--save", "lecture/default", "-o", "plain.toml"]);
    run(at, &["render", "-q", "plain.toml", "--size", "8x8", "-o", "plain.exr"]);
    std::os::unix::fs::symlink("plain.toml", at.join("plain.toml.png")).unwrap();
    let before = files(at);
    let of_scene = ["scene.toml", "model.obj", "library.mtl", "scene.png", "sky.exr"];
    // Its default name is that of its texture.
    refused(at, &["render", "scene.toml"], &before);
    refused(at, &["render", "scene.toml", "-o", "."], &before);
    refused(at, &["render", "lecture/default", "scene.toml", "-o", "."], &before);
    refused(at, &["explain", "scene.toml", "3,3", "--mask", "new.png"], &before);
    for input in of_scene {
        let names = |ending: &str| {
            let own = input.ends_with(ending).then(|| input.to_owned());
            [format!("soft-{input}.{ending}"), format!("hard-{input}.{ending}")].into_iter().chain(own)
        };
        for name in names("png").chain(names("exr")) {
            refused(at, &["render", "scene.toml", "-o", &name], &before);
            refused(at, &["render", "scene.toml", "-o", &name, "--only", "ball"], &before);
            refused(at, &["explain", "scene.toml", "--find", "ball", "--mask", &name], &before);
            refused(at, &["render", "--from", "older.png", "-o", &name], &before);
        }
        for name in names("exr") {
            refused(at, &["render", "scene.toml", "-o", &name, "--paths", "2"], &before);
        }
        for name in names("html").chain([input.to_owned()]) {
            refused(at, &["explain", "scene.toml", "3,3", "--html", &name], &before);
            refused(at, &["explain", "scene.toml", "3,3", "--svg", &name], &before);
        }
        for name in names("toml").filter(|name| name != "scene.toml") {
            refused(at, &["convert", "scene.toml", "-o", &name], &before);
            let links_to_itself = input == "scene.toml";
            if !links_to_itself {
                refused(at, &["convert", "scene.toml", "-o", &name, "--force"], &before);
            }
        }
        for name in names("obj").filter(|name| name.contains("model.obj")) {
            refused(at, &["check", "model.obj", "--repair", "-o", &name], &before);
        }
    }
    // Standard input is a file, too, and a scene that a picture remembers is somebody's work.
    for arguments in
        [&["explain", "-", "3,3", "--svg", "plain.toml"][..], &["explain", "-", "3,3", "--html", "plain.toml"]]
    {
        let input = fs::File::open(at.join("plain.toml")).unwrap();
        let output = command(at, arguments).stdin(input).output().unwrap();
        judge(at, &arguments.join(" "), &output, &before);
    }
    refused(at, &["explain", "plain.exr", "3,3", "--svg", "plain.toml"], &before);
    refused(at, &["render", "--from", "plain.exr", "-o", "plain.toml.png"], &before);
    refused(at, &["convert", "scene.toml", "-o", "scene.toml"], &before);
    refused(at, &["scenes", "--save", "lecture/default", "-o", "scene.toml"], &before);
    for name in ["older.png", "soft-older.png.png", "hard-older.png.exr"] {
        refused(at, &["render", "--from", "older.png", "-o", name], &before);
        refused(at, &["explain", "older.png", "3,3", "--html", name], &before);
        refused(at, &["explain", "older.png", "--find", "ball", "--mask", name], &before);
        refused(at, &["diff", "older.png", "scene.png", "-o", name], &before);
        refused(at, &["diff", "scene.png", "older.png", "-o", name], &before);
    }
}

/// Every verb that writes a file, with the file behind its option.
const WRITERS: &[(&[&str], &str)] = &[
    (&["render", "scene.toml", "-o"], "png"),
    (&["render", "scene.toml", "-o"], "ppm"),
    (&["render", "scene.toml", "-o"], "exr"),
    (&["render", "scene.toml", "-o"], "npy"),
    (&["render", "scene.toml", "--only", "ball", "-o"], "png"),
    (&["render", "scene.toml", "--paths", "2", "-o"], "exr"),
    (&["render", "--from", "older.png", "-o"], "png"),
    (&["explain", "scene.toml", "3,3", "--html"], "html"),
    (&["explain", "scene.toml", "3,3", "--svg"], "svg"),
    (&["explain", "scene.toml", "--find", "ball", "--mask"], "png"),
    (&["convert", "scene.toml", "--force", "-o"], "toml"),
    (&["convert", "scene.toml", "--force", "-o"], "json"),
    (&["check", "model.obj", "--repair", "--force", "-o"], "obj"),
    (&["diff", "older.png", "scene.png", "-o"], "png"),
    (&["scenes", "--save", "lecture/default", "--force", "-o"], "toml"),
];

#[cfg(unix)]
#[test]
fn outputs_that_cannot_be_written() {
    let folder = workplace();
    let at = folder.path();
    fs::create_dir(at.join("folder.png")).unwrap();
    for (_, ending) in WRITERS {
        let path = at.join(format!("kept.{ending}"));
        fs::write(&path, "worked on for hours").unwrap();
        let mut permissions = path.metadata().unwrap().permissions();
        permissions.set_readonly(true);
        fs::set_permissions(&path, permissions).unwrap();
        let _ = std::os::unix::fs::symlink("/dev/full", at.join(format!("full.{ending}")));
        let _ = fs::create_dir(at.join(format!("folder.{ending}")));
    }
    let before = files(at);
    for (arguments, ending) in WRITERS {
        for name in ["kept", "full", "no/such", "folder"] {
            // A folder is a place for pictures.
            if name == "folder" && arguments[0] == "render" {
                continue;
            }
            let file = format!("{name}.{ending}");
            refused(at, &[arguments, &[&*file][..]].concat(), &before);
        }
    }
    // Where a picture could not be written it is kept elsewhere, and said where.
    let said = stderr(&refused(at, &["render", "scene.toml", "-o", "full.png"], &before));
    let kept = said.split("kept as ").nth(1).and_then(|rest| rest.split_whitespace().next()).unwrap();
    let told = stdout(&run(at, &["info", kept]));
    assert!(told.contains("film") && !told.contains("not finished"), "{told}");
    fs::remove_file(kept).unwrap();
}

/// A disk that is full in the middle of a file: the limit of a process on the size of its files says the same.
#[cfg(unix)]
#[test]
fn a_disk_that_becomes_full() {
    let folder = workplace();
    let at = folder.path();
    fs::write(at.join("big.toml"), SCENE.replace("size = [8, 8]", "size = [64, 64]")).unwrap();
    let mut model = MODEL.repeat(200);
    model.push_str("f 1 2 3\n");
    fs::write(at.join("model.obj"), model).unwrap();
    for (_, ending) in WRITERS {
        fs::write(at.join(format!("older.{ending}")), "older").unwrap();
    }
    fs::remove_file(at.join("older.png")).unwrap();
    run(at, &["render", "-q", "big.toml", "-o", "again.png"]);
    fs::write(at.join("older.png"), "older").unwrap();
    let before = files(at);
    let mut full = 0;
    for (arguments, ending) in WRITERS {
        let arguments: Vec<&str> = arguments
            .iter()
            .map(|&word| match word {
                "scene.toml" => "big.toml",
                "older.png" => "again.png",
                word => word,
            })
            .collect();
        // 512 bytes; the signal that would end the program is ignored.
        let limit = format!("trap '' XFSZ; ulimit -f 1; exec \"$0\" {} older.{ending}", arguments.join(" "));
        let limit = if arguments.contains(&"big.toml")
            || arguments.contains(&"model.obj")
            || arguments.contains(&"again.png")
        {
            limit
        } else {
            continue;
        };
        let output =
            Command::new("sh").args(["-c", &limit, env!("CARGO_BIN_EXE_snell")]).current_dir(at).output().unwrap();
        // Short files fit: a drawing, a scene, a small picture.
        if fs::read(at.join(format!("older.{ending}"))).unwrap() == b"older" {
            judge(at, &limit, &output, &before);
            full += 1;
        }
        fs::write(at.join(format!("older.{ending}")), "older").unwrap();
    }
    assert!(full > 8, "only {full} files were too large");
}

/// Every verb that prints.
const PRINTERS: &[&[&str]] = &[
    &["--help"],
    &["render", "--help"],
    &["--version"],
    &["render", "scene.toml", "-o", "-"],
    &["render", "scene.toml", "-o", "-", "--format", "exr"],
    &["render", "scene.toml", "--only", "ball", "-o", "-"],
    &["explain", "scene.toml", "3,3"],
    &["explain", "scene.toml", "3,3", "--json"],
    &["explain", "scene.toml", "3,3", "--html", "-"],
    &["explain", "scene.toml", "3,3", "--svg", "-"],
    &["explain", "scene.toml", "3,3", "--light", "lamp"],
    &["explain", "scene.toml", "3,3", "--set", "ambient=0.5"],
    &["explain", "scene.toml", "3,3", "--without", "ball"],
    &["explain", "scene.toml", "--find", "ball"],
    &["info", "scene.toml"],
    &["info", "scene.toml", "--scene"],
    &["info", "older.png"],
    &["scenes"],
    &["scenes", "--save", "lecture/default", "-o", "-"],
    &["convert", "scene.toml"],
    &["convert", "scene.toml", "-o", "-"],
    &["schema"],
    &["completions", "bash"],
    &["check", "model.obj"],
    &["check", "model.obj", "--json"],
    &["diff", "older.png", "older.png"],
];

#[cfg(unix)]
#[test]
fn standard_output_that_is_full_or_closed() {
    let folder = workplace();
    let at = folder.path();
    let before = files(at);
    for arguments in PRINTERS {
        let full = fs::File::options().write(true).open("/dev/full").unwrap();
        let output = command(at, arguments).stdout(full).stderr(Stdio::piped()).output().unwrap();
        judge(at, &arguments.join(" "), &output, &before);
        assert_eq!(output.status.code(), Some(1), "snell {}", arguments.join(" "));
        if arguments[0] == "render" {
            let said = stderr(&output);
            if let Some(kept) = said.split("kept as ").nth(1).and_then(|rest| rest.split_whitespace().next()) {
                fs::remove_file(kept).unwrap();
            }
        }
        // A reader that goes away, like `head`, is no error; the check of a model that is no solid still ends with 1.
        let (reader, writer) = std::io::pipe().unwrap();
        drop(reader);
        let output = command(at, arguments).stdout(writer).stderr(Stdio::piped()).output().unwrap();
        let expected = i32::from(arguments[0] == "check");
        let said = stderr(&output);
        assert_eq!(output.status.code(), Some(expected), "snell {}: {said}", arguments.join(" "));
        assert!(!said.contains("error"), "snell {}: {said}", arguments.join(" "));
        assert!(files(at) == before);
    }
}

/// Messages that nobody can read cost no picture.
#[cfg(unix)]
#[test]
fn standard_error_that_is_full_or_closed() {
    let folder = workplace();
    let at = folder.path();
    let arguments = ["render", "scene.toml", "-o", "new.png"];
    run(at, &arguments);
    let expected = fs::read(at.join("new.png")).unwrap();
    for more in [&[][..], &["--progress", "json"]] {
        for kind in ["full", "closed pipe", "closed"] {
            fs::remove_file(at.join("new.png")).unwrap();
            let mut render = command(at, &[&arguments[..], more].concat());
            match kind {
                "full" => {
                    render.stderr(fs::File::options().write(true).open("/dev/full").unwrap());
                }
                "closed pipe" => {
                    let (reader, writer) = std::io::pipe().unwrap();
                    drop(reader);
                    render.stderr(writer);
                }
                _ => {
                    render = Command::new("sh");
                    let line = format!("exec \"$0\" {} {} 2>&-", arguments.join(" "), more.join(" "));
                    render.args(["-c", &line, env!("CARGO_BIN_EXE_snell")]).current_dir(at);
                }
            }
            assert_eq!(render.status().unwrap().code(), Some(0), "{kind}");
            assert!(fs::read(at.join("new.png")).unwrap() == expected, "{kind}");
        }
    }
    // An error that cannot be said is still an exit code.
    let full = fs::File::options().write(true).open("/dev/full").unwrap();
    assert_eq!(command(at, &["render", "none.toml"]).stderr(full).status().unwrap().code(), Some(3));
}

#[test]
fn names_that_do_not_exist() {
    let folder = workplace();
    let at = folder.path();
    fs::write(at.join("new.png"), "older").unwrap();
    fs::write(at.join("new.exr"), "older").unwrap();
    let before = files(at);
    for (arguments, near) in [
        (&["render", "scene.toml", "-o", "new.png", "--only", "bal"][..], "`ball`"),
        (&["render", "scene.toml", "-o", "new.png", "--only", "bal(mirror) ball"], "`ball`"),
        (&["render", "scene.toml", "-o", "new.png", "--only", "ball(bounce) ball"], "name(mirror)"),
        (&["render", "scene.toml", "-o", "new.png", "--set", "sphere.bal.radius=2"], "`ball`"),
        (&["render", "scene.toml", "-o", "new.png", "--set", "sphere.ball.radios=2"], "`radius`"),
        (&["render", "scene.toml", "-o", "new.png", "--set", "materiel.m.ka=2"], "`material`"),
        (&["render", "scene.toml", "-o", "new.png", "--set", "mesh.2.smooth_angle=2"], "Known here: 1"),
        (&["render", "scene.toml", "-o", "new.png", "--set", "render.integrator=whited"], "`whitted`"),
        (&["render", "scene.toml", "-o", "new.png", "--integrator", "whited"], "whitted"),
        (&["render", "--from", "older.png", "-o", "new.png", "--set", "light.lampe.color=2"], "`lamp`"),
        (&["render", "--from", "older.png", "-o", "new.png", "--only", "bal"], "`ball`"),
        (&["render", "--from", "alder.png", "-o", "new.png"], "no file"),
        (&["render", "scene.tom", "-o", "new.png"], "scene"),
        (&["render", "scena.toml", "-o", "new.png"], "`scene.toml`"),
        (&["render", "lecture/defalt", "-o", "new.png"], "`lecture/default`"),
        (&["explain", "scene.toml", "3,3", "--without", "bal"], "`ball`"),
        (&["explain", "scene.toml", "3,3", "--light", "lam"], "`lamp`"),
        (&["explain", "scene.toml", "--find", "bal"], "`ball`"),
        (&["explain", "scene.toml", "--find", "bal", "--mask", "new.png"], "`ball`"),
        (&["explain", "scene.toml", "3,3", "--set", "sphere.bal.radius=2"], "`ball`"),
        (&["explain", "older.png", "3,3", "--set", "sphere.bal.radius=2"], "`ball`"),
        (&["explain", "scene.toml", "8,3"], "0 to 7"),
        (&["convert", "scene.toml", "--set", "sphere.bal.radius=2"], "`ball`"),
        (&["info", "scene.toml", "--set", "sphere.bal.radius=2"], "`ball`"),
        (&["scenes", "--save", "lecture/defalt"], "`lecture/default`"),
        (&["completions", "bosh"], "bash"),
    ] {
        let said = stderr(&refused(at, arguments, &before));
        assert!(said.contains(near), "snell {}: {near} in\n{said}", arguments.join(" "));
    }
    // The nearest file.
    fs::write(at.join("other.toml"), SCENE.replace("model.obj", "modell.obj")).unwrap();
    let said = stderr(&snell(at, &["render", "other.toml", "-o", "new.png"]));
    assert!(said.contains("did you mean `model.obj`"), "{said}");
}

/// A render that takes long enough to be interrupted.
#[cfg(unix)]
fn long_render(at: &Path, output: &str, before: &str) -> std::process::Child {
    let line =
        format!("{before} exec \"$0\" render gallery/ball --size 1200x1200 --spp 16 --progress json -o {output}");
    let mut render = Command::new("sh");
    render.args(["-c", &line, env!("CARGO_BIN_EXE_snell")]).current_dir(at).stderr(Stdio::piped());
    render.spawn().unwrap()
}

/// Waits until a render has finished some pixels; its further lines are read by nobody in particular.
#[cfg(unix)]
fn running(child: &mut std::process::Child) -> std::thread::JoinHandle<String> {
    let mut lines = std::io::BufRead::lines(std::io::BufReader::new(child.stderr.take().unwrap()));
    while !lines.next().unwrap().unwrap().contains("\"progress\"") {}
    std::thread::spawn(move || lines.map_while(Result::ok).collect::<Vec<_>>().join("\n"))
}

#[cfg(unix)]
fn signal(name: &str, child: &std::process::Child) {
    let kill = Command::new("kill").args([&format!("-{name}"), &child.id().to_string()]).status();
    assert!(kill.unwrap().success());
}

#[cfg(unix)]
#[test]
fn signals_leave_a_finished_picture_as_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("ball.png"), "a finished picture").unwrap();
    for (number, name) in ["INT", "TERM", "HUP"].into_iter().enumerate() {
        let mut child = long_render(at, "ball.png", "");
        let rest = running(&mut child);
        signal(name, &child);
        assert_eq!(child.wait().unwrap().code(), Some(130), "{name}");
        let said = rest.join().unwrap();
        assert_eq!(fs::read(at.join("ball.png")).unwrap(), b"a finished picture", "{name}");
        let beside =
            if number == 0 { "ball-unfinished.png".to_owned() } else { format!("ball-unfinished-{}.png", number + 1) };
        let bytes = fs::read(at.join(&beside)).unwrap();
        // Colour type 6 has transparency, for what is missing.
        assert!(bytes[25] == 6 && said.contains(&beside), "{name}: {said}");
    }
    // Where nothing was, the picture so far has its own name.
    let mut child = long_render(at, "new.png", "");
    let rest = running(&mut child);
    signal("INT", &child);
    assert_eq!(child.wait().unwrap().code(), Some(130));
    rest.join().unwrap();
    assert_eq!(fs::read(at.join("new.png")).unwrap()[25], 6);
    // `nohup` ignores that the terminal is closed, and so do we; other signals still work.
    let mut child = long_render(at, "hup.png", "trap '' HUP;");
    let rest = running(&mut child);
    signal("HUP", &child);
    std::thread::sleep(std::time::Duration::from_millis(300));
    assert!(child.try_wait().unwrap().is_none(), "it was stopped: {}", rest.join().unwrap());
    signal("TERM", &child);
    assert_eq!(child.wait().unwrap().code(), Some(130));
    rest.join().unwrap();
    let hidden =
        fs::read_dir(at).unwrap().flatten().filter(|e| e.file_name().to_string_lossy().starts_with('.')).count();
    assert_eq!(hidden, 0);
}

/// A pipe without a reader can be interrupted, the first time.
#[cfg(unix)]
#[test]
fn a_pipe_that_nobody_reads() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    assert!(Command::new("mkfifo").arg(at.join("pipe.png")).status().unwrap().success());
    let arguments = ["render", "lecture/default", "--size", "8x8", "-o", "pipe.png", "--progress", "json"];
    let mut child = command(at, &arguments).stderr(Stdio::piped()).spawn().unwrap();
    let mut lines = std::io::BufRead::lines(std::io::BufReader::new(child.stderr.take().unwrap()));
    while !lines.next().unwrap().unwrap().contains("\"writing\"") {}
    std::thread::sleep(std::time::Duration::from_millis(200));
    assert!(child.try_wait().unwrap().is_none(), "it waits for a reader");
    signal("INT", &child);
    assert_eq!(child.wait().unwrap().code(), Some(130));
    // With a reader it is a picture like any other.
    let reader = std::thread::spawn({
        let pipe = at.join("pipe.png");
        move || fs::read(pipe).unwrap()
    });
    run(at, &arguments);
    run(at, &["render", "-q", "lecture/default", "--size", "8x8", "-o", "file.png"]);
    assert!(reader.join().unwrap() == fs::read(at.join("file.png")).unwrap());
}

/// What `kill -9` leaves is gone after the next run, and never in the place of a picture.
#[cfg(unix)]
#[test]
fn a_killed_program_leaves_nothing_for_long() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    run(at, &["render", "-q", "lecture/default", "--size", "300x300", "-o", "a.npy"]);
    let whole = fs::read(at.join("a.npy")).unwrap();
    for delay in (0..40).map(|i| 2 * i) {
        let arguments = ["render", "-q", "lecture/default", "--size", "300x300", "-o", "a.npy"];
        let mut child = command(at, &arguments).spawn().unwrap();
        std::thread::sleep(std::time::Duration::from_millis(delay));
        let _ = child.kill();
        child.wait().unwrap();
        assert!(fs::read(at.join("a.npy")).unwrap() == whole, "after {delay} ms");
    }
    fs::write(at.join(".snell-writing-AbCd12AbCd120123.tmp"), "left by another one").unwrap();
    run(at, &["render", "-q", "lecture/default", "--size", "300x300", "-o", "a.npy"]);
    assert_eq!(fs::read_dir(at).unwrap().count(), 1);
}

/// A machine that allows no threads draws with the one that there is.
#[cfg(target_os = "linux")]
#[test]
fn no_threads_to_be_had() {
    let folder = workplace();
    let at = folder.path();
    // Root is not limited; a user that nobody else is has one process.
    let mut render = Command::new("setpriv");
    render.args(["--reuid=54321", "--clear-groups", "prlimit", "--nproc=1", env!("CARGO_BIN_EXE_snell")]);
    render.args(["render", "lecture/default", "--size", "24x24", "-o", "-", "--format", "npy"]).current_dir("/");
    let alone = render.output();
    let Some(alone) = alone.ok().filter(|output| !stderr(output).contains("setpriv")) else {
        use std::io::Write;
        std::io::stderr()
            .write_all(b"SKIPPED: only root can limit another user's threads, with setpriv and prlimit\n")
            .unwrap();
        return;
    };
    assert!(alone.status.success(), "{}", stderr(&alone));
    run(at, &["render", "-q", "lecture/default", "--size", "24x24", "-o", "many.npy"]);
    assert!(alone.stdout == fs::read(at.join("many.npy")).unwrap());
}

/// Too little memory is an error like others, and no abort (134).
#[cfg(target_os = "linux")]
#[test]
fn no_memory_to_be_had() {
    let folder = workplace();
    let at = folder.path();
    let many = lines(60_000, |i| format!("s {i} 0 0 1"));
    let head = "v\nfrom 0 0 9\nat 0 0 0\nup 0 1 0\nangle 40\nhither 1\nresolution 8 8\nf 1 1 1 1 0 0 0 0\n";
    fs::write(at.join("many.nff"), format!("{head}{many}")).unwrap();
    let before = files(at);
    for (limit, arguments) in [
        (30_000, "render many.nff -o new.png"),
        (30_000, "info many.nff"),
        (30_000, "convert many.nff -o new.toml"),
        (200_000, "render lecture/default --size 4000x4000 -o new.png"),
    ] {
        let line = format!("ulimit -v {limit}; exec \"$0\" {arguments}");
        let output =
            Command::new("sh").args(["-c", &line, env!("CARGO_BIN_EXE_snell")]).current_dir(at).output().unwrap();
        judge(at, &line, &output, &before);
    }
}
