//! Many pictures of one scene: the bits of single ones, drawn once, by however many processes, whatever happens to them.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod common;

use common::{command, run, snell, stderr};
use std::collections::BTreeMap;
use std::fs;
use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Output, Stdio};
use std::time::{Duration, Instant, SystemTime};

/// Two keys, and four pictures: `a_1.3_4.png` …
const SWEEP: &[&str] = &[
    "render",
    "scene.toml",
    "--size",
    "24x16",
    "--sweep",
    "material.glass.eta=1.3:1.5:2",
    "--sweep",
    "render.spp=[1, 4]",
    "-o",
    "a_{eta}_{spp}.png",
];

const KEYS: &str = "interpolation = 'smooth'\n[[frame]]\nat = 1\nambient = 0.25\n[[frame]]\nat = 5\nambient = 0.5\n\
                    material.glass.eta = 1.5\n[[frame]]\nat = 9\nambient = 0.25\nmaterial.glass.eta = 1.7\n";

fn workplace() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), &["scenes", "--save", "lecture/default", "-o", "scene.toml"]);
    fs::write(folder.path().join("keys.toml"), KEYS).unwrap();
    folder
}

fn files(at: &Path) -> BTreeMap<PathBuf, (Vec<u8>, SystemTime)> {
    let entries = fs::read_dir(at).unwrap().flatten().filter(|e| e.path().is_file());
    entries.map(|e| (e.path(), (fs::read(e.path()).unwrap(), e.metadata().unwrap().modified().unwrap()))).collect()
}

fn said(output: &Output) -> String {
    let said = stderr(output);
    let words: Vec<&str> = said.split_whitespace().filter(|word| *word != "│").collect();
    words.join(" ")
}

fn ends(at: &Path, arguments: &[&str], code: i32, why: &str) -> String {
    let output = snell(at, arguments);
    let said = said(&output);
    assert!(output.status.code() == Some(code) && said.contains(why), "{arguments:?}: {:?}\n{said}", output.status);
    assert!(!said.contains("panicked"), "{said}");
    said
}

/// Nothing but pictures is left.
fn no_litter(at: &Path) {
    let odd = fs::read_dir(at).unwrap().flatten().map(|e| e.file_name().into_string().unwrap());
    let odd: Vec<String> = odd.filter(|name| name.contains("claim") || name.starts_with('.')).collect();
    assert!(odd.is_empty(), "{odd:?}");
}

#[test]
fn the_bytes_of_single_pictures_and_those_that_are_there_stay() {
    let folder = workplace();
    let at = folder.path();
    ends(at, SWEEP, 0, "4 pictures: 4 drawn");
    for (eta, spp) in [("1.3", "1"), ("1.3", "4"), ("1.5", "1"), ("1.5", "4")] {
        let sets = [format!("material.glass.eta={eta}"), format!("render.spp={spp}")];
        run(
            at,
            &["render", "-q", "scene.toml", "--size", "24x16", "--set", &sets[0], "--set", &sets[1], "-o", "one.png"],
        );
        let many = fs::read(at.join(format!("a_{eta}_{spp}.png"))).unwrap();
        assert!(many == fs::read(at.join("one.png")).unwrap(), "{eta} {spp}");
    }
    let before = files(at);
    ends(at, SWEEP, 0, "4 pictures: 0 drawn, 4 were there");
    assert!(files(at) == before, "nothing is written, nothing is left");

    // Only what is not what it should be is drawn: of another recipe, cut off, empty, gone.
    let whole = fs::read(at.join("a_1.3_1.png")).unwrap();
    for (name, bytes) in [("a_1.3_1.png", &whole[..whole.len() - 20]), ("a_1.3_4.png", b""), ("a_1.5_1.png", &whole)] {
        fs::write(at.join(name), bytes).unwrap();
        ends(at, SWEEP, 0, "1 drawn, 3 were there");
    }
    fs::remove_file(at.join("a_1.5_4.png")).unwrap();
    ends(at, SWEEP, 0, "1 drawn, 3 were there");
    for (path, (bytes, _)) in before {
        assert!(fs::read(&path).unwrap() == bytes, "{}", path.display());
    }
    ends(at, &[SWEEP, &["--transfer", "srgb"]].concat(), 0, "4 drawn");
    ends(at, &[SWEEP, &["--transfer", "srgb", "--bits", "16"]].concat(), 0, "4 drawn");
    let scene = fs::read_to_string(at.join("scene.toml")).unwrap();
    fs::write(at.join("scene.toml"), scene.replace("eta = ", "kd = 0.125\neta = ")).unwrap();
    ends(at, SWEEP, 3, "kd");
    fs::write(at.join("scene.toml"), scene + "\n# changed\n").unwrap();
    ends(at, SWEEP, 0, "4 drawn");
    no_litter(at);
}

#[test]
fn exr_pictures_and_those_of_a_scene_on_standard_input() {
    let folder = workplace();
    let at = folder.path();
    let text = fs::read(at.join("scene.toml")).unwrap();
    let mut outputs = Vec::new();
    for _ in 0..2 {
        let arguments = ["render", "-", "--size", "8x8", "--sweep", "ambient=0:1:3", "--format", "exr", "-o", "new/"];
        let mut child = command(at, &arguments).stdin(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        child.stdin.take().unwrap().write_all(&text).unwrap();
        outputs.push(said(&child.wait_with_output().unwrap()));
    }
    assert!(outputs[0].contains("3 drawn") && outputs[1].contains("3 were there"), "{outputs:?}");
    assert_eq!(files(&at.join("new")).len(), 3);
    let cut = at.join("new/picture_0.5.exr");
    let whole = fs::read(&cut).unwrap();
    fs::write(&cut, &whole[..whole.len() - 1]).unwrap();
    let from_file =
        ["render", "scene.toml", "--size", "8x8", "--sweep", "ambient=0:1:3", "-o", "new/picture_{ambient}.exr"];
    ends(at, &from_file, 0, "1 drawn, 2 were there");
}

#[test]
fn key_frames_make_movies() {
    let folder = workplace();
    let at = folder.path();
    let movie = ["render", "scene.toml", "--size", "12x8", "--keys", "keys.toml", "-o", "m/{frame}.png"];
    ends(at, &movie, 0, "9 pictures: 9 drawn");
    let is = |frame: &str, ambient: &str, eta: &str| {
        let sets = [format!("ambient={ambient}"), format!("material.glass.eta={eta}")];
        run(
            at,
            &["render", "-q", "scene.toml", "--size", "12x8", "--set", &sets[0], "--set", &sets[1], "-o", "one.png"],
        );
        assert!(fs::read(at.join("m").join(frame)).unwrap() == fs::read(at.join("one.png")).unwrap(), "{frame}");
    };
    is("1.png", "0.25", "1.5");
    is("5.png", "0.5", "1.5");
    // The parabola through the three keys.
    is("3.png", "0.4375", "1.5");
    is("9.png", "0.25", "1.7");
    let more =
        ["render", "scene.toml", "--size", "12x8", "--keys", "keys.toml", "--frames", "8:12", "-o", "m/{frame}.png"];
    ends(at, &more, 0, "5 pictures: 5 drawn");
    assert!(at.join("m/08.png").exists() && at.join("m/12.png").exists());
    let usual = [
        "render",
        "scene.toml",
        "--size",
        "8x8",
        "--keys",
        "keys.toml",
        "--sweep",
        "render.seed=[3]",
        "--frames",
        "2:2",
    ];
    run(at, &usual);
    assert!(at.join("scene_2_3.png").exists());
}

#[test]
fn processes_at_once_draw_each_picture_once() {
    let folder = workplace();
    let at = folder.path();
    let arguments = |output| {
        [
            "render",
            "scene.toml",
            "--size",
            "96x64",
            "--spp",
            "4",
            "--threads",
            "1",
            "--sweep",
            "render.seed=0:39:40",
            "-o",
            output,
        ]
    };
    let start = |_: u32| command(at, &arguments("p/{seed}.png")).stderr(Stdio::piped()).spawn().unwrap();
    let running: Vec<_> = (0..3).map(start).collect();
    let outputs: Vec<Output> = running.into_iter().map(|child| child.wait_with_output().unwrap()).collect();
    let drawn = |output: &Output| -> u32 {
        let said = said(output);
        assert!(output.status.success() && said.contains("40 pictures: "), "{said}");
        said.split("40 pictures: ").nth(1).unwrap().split(' ').next().unwrap().parse().unwrap()
    };
    let counts: Vec<u32> = outputs.iter().map(drawn).collect();
    assert_eq!(counts.iter().sum::<u32>(), 40, "{counts:?}");
    no_litter(&at.join("p"));
    run(at, &arguments("q/{seed}.png"));
    let bytes = |name: &str| files(&at.join(name)).into_values().map(|(bytes, _)| bytes).collect::<Vec<_>>();
    assert!(bytes("p") == bytes("q"));
}

/// Starts pictures of some seconds each, and returns when the first claim is there.
#[cfg(unix)]
fn begun(at: &Path, more: &[&str]) -> std::process::Child {
    let slow = [
        "render",
        "scene.toml",
        "--size",
        "512x512",
        "--spp",
        "256",
        "--sweep",
        "render.seed=[1, 2]",
        "-o",
        "s{seed}.png",
    ];
    let child = command(at, &[&slow, more].concat()).stderr(Stdio::piped()).spawn().unwrap();
    let last = Instant::now() + Duration::from_secs(30);
    while !at.join("s1.png.claim-1").exists() {
        assert!(Instant::now() < last, "nothing is claimed");
        std::thread::sleep(Duration::from_millis(10));
    }
    std::thread::sleep(Duration::from_millis(200));
    child
}

/// The same pictures of one sample, which are there at once.
#[cfg(unix)]
const FAST: &[&str] =
    &["render", "scene.toml", "--size", "16x16", "--sweep", "render.seed=[1, 2]", "-o", "s{seed}.png"];

#[cfg(unix)]
#[test]
fn who_is_killed_is_replaced_at_once() {
    let folder = workplace();
    let at = folder.path();
    let mut child = begun(at, &[]);
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(at.join("s1.png.claim-1").exists());
    let started = Instant::now();
    ends(at, FAST, 0, "2 pictures: 2 drawn");
    assert!(started.elapsed() < Duration::from_secs(20), "its process is dead, which needs no waiting");
    no_litter(at);
    // One that died after its picture was there.
    let dead = "{\"host\": \"elsewhere\", \"boot\": \"b\", \"pid\": 1, \"token\": \"t\"}";
    fs::write(at.join("s2.png.claim-1"), dead).unwrap();
    let old = SystemTime::now() - Duration::from_secs(1000);
    fs::File::options().write(true).open(at.join("s2.png.claim-1")).unwrap().set_modified(old).unwrap();
    ends(at, FAST, 0, "2 were there");
    no_litter(at);
}

#[cfg(unix)]
#[test]
fn who_is_stopped_leaves_pictures_that_are_whole_and_no_claims() {
    for (signal, code) in [(libc::SIGINT, 130), (libc::SIGTERM, 130)] {
        let folder = workplace();
        let at = folder.path();
        run(at, FAST);
        let before = files(at);
        let child = begun(at, &[]);
        // SAFETY: a signal to a process that this test has started and not yet waited for.
        #[allow(unsafe_code, reason = "the standard library sends no signals but SIGKILL")]
        unsafe {
            libc::kill(child.id() as i32, signal);
        }
        let output = child.wait_with_output().unwrap();
        assert_eq!(output.status.code(), Some(code), "{}", said(&output));
        assert!(said(&output).contains("2 pictures: 0 drawn, 2 missing"), "{}", said(&output));
        assert!(files(at) == before, "what was there stays as it was");
    }
}

#[test]
fn claims_of_others_are_left_while_they_are_renewed_and_taken_when_not() {
    let folder = workplace();
    let at = folder.path();
    let arguments = ["render", "scene.toml", "--size", "8x8", "--sweep", "ambient=0:1:3", "-o", "{ambient}.png"];
    let owner = "{\"host\": \"far-away\", \"boot\": \"b\", \"pid\": 1, \"token\": \"t\"}\n";
    let claim = at.join("0.5.png.claim-1");
    let start = || {
        fs::write(&claim, owner).unwrap();
        command(at, &arguments).env("SNELL_CLAIM_SECONDS", "2").stderr(Stdio::piped()).spawn().unwrap()
    };
    let mut child = start();
    while child.try_wait().unwrap().is_none() {
        std::thread::sleep(Duration::from_millis(200));
        fs::write(&claim, owner).unwrap();
    }
    let output = child.wait_with_output().unwrap();
    assert!(
        output.status.success() && said(&output).contains("3 pictures: 2 drawn, 1 is being drawn elsewhere (far-away)"),
        "{}",
        said(&output)
    );
    assert!(!at.join("0.5.png").exists() && claim.exists());
    let output = start().wait_with_output().unwrap();
    assert!(
        said(&output).contains("waiting for what other processes have claimed (far-away): 1 in all"),
        "{}",
        said(&output)
    );
    assert!(
        output.status.success() && said(&output).contains("3 pictures: 1 drawn, 2 were there"),
        "{}",
        said(&output)
    );
    no_litter(at);
}

#[test]
fn failures_of_some_keep_no_others_and_their_code_says_whether_to_try_again() {
    let folder = workplace();
    let at = folder.path();
    let arguments =
        ["render", "scene.toml", "--size", "8x8", "--sweep", "sphere.1.radius=[-1, 2, -3]", "-o", "{index}.png"];
    let said = ends(at, &arguments, 3, "3 pictures: 1 drawn, 2 failed");
    assert!(said.contains("0.png is not drawn:") && said.contains("2 of 3 pictures failed: 0.png, 2.png"), "{said}");
    assert!(at.join("1.png").exists() && !at.join("0.png").exists());
    // Files that Snell did not make.
    let mine = at.join("0.png");
    for bytes in [&b"a poem"[..], b"\x89PNG\r\n\x1a\n and more"] {
        fs::write(&mine, bytes).unwrap();
        ends(
            at,
            &["render", "scene.toml", "--size", "8x8", "--sweep", "ambient=[1, 2]", "-o", "{index}.png"],
            3,
            "`0.png` is not written over",
        );
        assert_eq!(fs::read(&mine).unwrap(), bytes);
    }
    fs::remove_file(&mine).unwrap();
    fs::create_dir(&mine).unwrap();
    ends(
        at,
        &["render", "scene.toml", "--size", "8x8", "--sweep", "ambient=[1, 3]", "-o", "{index}.png"],
        3,
        "it is no file",
    );
    fs::remove_dir(&mine).unwrap();
    // What another try may mend.
    #[cfg(unix)]
    {
        std::os::unix::fs::symlink("nowhere/x.png", &mine).unwrap();
        let said = ends(
            at,
            &["render", "scene.toml", "--size", "8x8", "--sweep", "ambient=[1, 4]", "-o", "{index}.png"],
            1,
            "2 pictures: 1 drawn, 1 failed",
        );
        assert!(said.contains("no folder `nowhere`"), "{said}");
    }
    no_litter(at);
}

#[test]
fn what_is_wrong_is_said_before_anything_is_drawn() {
    let folder = workplace();
    let at = folder.path();
    fs::write(at.join("wrong.toml"), "[[frame]]\nat = 1\ncamera.eyes = [1, 2, 3]\n").unwrap();
    fs::write(at.join("broken.toml"), "[[frame]\n").unwrap();
    let before = files(at);
    let long = format!("{}_{{ambient}}.png", "x".repeat(1000));
    let ambient = ["render", "scene.toml", "--sweep", "ambient=0:1:3"];
    for (more, why) in [
        (&["--sweep", "material.glas.eta=1:2:3"][..], "did you mean `glass`?"),
        (&["--sweep", "ambient=1:2:3"], "changed twice"),
        (&["--keys", "keys.toml"], "changed twice"),
        (&["--keys", "wrong.toml"], "eyes"),
        (&["--keys", "broken.toml"], "broken.toml"),
        (&["--keys", "none.toml"], "no file `none.toml`"),
        (&["--keys", "."], "cannot read"),
        (&["--frames", "1:5"], "--keys"),
        (&["--keys", "keys.toml", "--frames", "240:1"], "both included"),
        (&["--part", "x.npz"], "cannot be used with"),
        (&["--checkpoint", "x.npz"], "cannot be used with"),
        (&["--paths", "3"], "cannot be used with"),
        (&["--only", "glass"], "cannot be used with"),
        (&["--until", "3s"], "cannot be used with"),
        (&["scene.toml"], "one scene, not of 2"),
        (&["-o", "-"], "standard output"),
        (&["-o", "{ambien}.png"], "did you mean `ambient`?"),
        (&["-o", "a.png"], "would both be `a.png`"),
        (&["-o", "{ambient}.ppm"], "only these remember"),
        (&["-o", "new", "--format", "npy"], "only these remember"),
        (&["-o", "new/", "--format", "npy"], "only these remember"),
        (&["-o", &long], "too long"),
        (&["-o", "keys.toml/{ambient}.png"], "cannot make the folder"),
    ] {
        ends(at, &[&ambient, more].concat(), 2, why);
    }
    ends(at, &["render", "none.toml", "--sweep", "ambient=0:1:3"], 3, "none.toml");
    ends(at, &["render", "--sweep", "ambient=0:1:3"], 2, "SCENE");
    assert!(files(at) == before && !at.join("new").exists());
}

#[test]
fn what_is_read_is_not_written_over() {
    let folder = workplace();
    let at = folder.path();
    for name in ["a.png", "b.png"] {
        run(at, &["render", "-q", "lecture/default", "--size", "8x8", "-o", name]);
    }
    let scene = fs::read_to_string(at.join("scene.toml")).unwrap();
    fs::write(
        at.join("scene.toml"),
        scene.replace("'lecture'", "'whitted'").replace("\"lecture\"", "\"whitted\"") + "\n[sky]\nimage = 'a.png'\n",
    )
    .unwrap();
    let before = files(at);
    // The second picture would be drawn over what the first reads, the first over what the second reads.
    for pattern in ["{image}", "./{image}"] {
        for images in ["['a.png', 'b.png']", "['b.png', 'a.png']"] {
            let sweep = format!("sky.image={images}");
            ends(
                at,
                &["render", "scene.toml", "--size", "8x8", "--sweep", &sweep, "-o", pattern],
                2,
                "was read for this",
            );
        }
    }
    ends(
        at,
        &[
            "render",
            "scene.toml",
            "--size",
            "8x8",
            "--sweep",
            "sky.image=['a.png', 'b.png']",
            "--set",
            "ambient=1",
            "-o",
            "x_{image}",
        ],
        0,
        "2 drawn",
    );
    assert!(before.iter().all(|(path, (bytes, _))| &fs::read(path).unwrap() == bytes));
}
