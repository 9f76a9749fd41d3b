//! Pictures in parts: joined, killed and resumed, they are the picture, to the byte of its file.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod common;

use common::{command, run, snell, stderr, stdout};
use std::fs;
use std::path::Path;
use std::process::Stdio;
use std::time::{Duration, Instant};

/// What is rendered in these tests, and its picture, whole.png.
const RENDER: &[&str] = &["render", "-q", "scene.toml", "--size", "120x90", "--spp", "24"];

fn workplace() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    run(folder.path(), &["scenes", "--save", "gallery/bubbles", "-o", "scene.toml"]);
    run(folder.path(), &[RENDER, &["-o", "whole.png"]].concat());
    folder
}

fn bytes(at: &Path, name: &str) -> Vec<u8> {
    fs::read(at.join(name)).unwrap()
}

fn refused(at: &Path, arguments: &[&str], code: i32, why: &str) {
    let output = snell(at, arguments);
    let said = stderr(&output);
    let words: Vec<&str> = said.split_whitespace().filter(|word| *word != "│").collect();
    assert!(output.status.code() == Some(code) && words.join(" ").contains(why), "{arguments:?}: {said}");
}

#[test]
fn parts_of_any_lanes_and_threads_join_to_the_very_file() {
    let folder = workplace();
    let at = folder.path();
    let part = |more: &[&str]| run(at, &[RENDER, more].concat());
    part(&["--rows", "0:31", "--part", "a.npz", "--lanes", "1", "--threads", "1"]);
    part(&["--rows", "31:90", "--samples", "0:7", "--part", "b.npz", "--tile", "13", "--lanes", "2"]);
    part(&["--rows", "31:90", "--samples", "7:24", "--part", "c.npz", "--lanes", "4", "--threads", "3"]);
    run(at, &["merge", "-q", "c.npz", "a.npz", "b.npz", "-o", "merged.png"]);
    assert!(bytes(at, "merged.png") == bytes(at, "whole.png"));
    run(at, &["merge", "-q", "c.npz", "a.npz", "-o", "ac.npz"]);
    run(at, &["merge", "-q", "ac.npz", "b.npz", "-o", "tree.png"]);
    assert!(bytes(at, "tree.png") == bytes(at, "whole.png"));
    // A part goes on like a checkpoint: what the others have is rendered again.
    run(at, &["render", "-q", "--resume", "ac.npz", "-o", "resumed.png"]);
    assert!(bytes(at, "resumed.png") == bytes(at, "whole.png"));

    refused(
        at,
        &["merge", "a.npz", "b.npz", "-o", "x.png"],
        1,
        "missing: rows 31 to 89, columns 0 to 119, samples 7 to 23",
    );
    refused(at, &["merge", "a.npz", "a.npz", "-o", "x.png"], 1, "are there twice");
    refused(at, &["merge", "a.npz", "b.npz", "-o", "a.npz"], 2, "was read for this");
    refused(at, &["merge", "a.npz", "scene.toml", "-o", "x.png"], 1, "no whole ZIP archive");
    refused(at, &["merge", "a.npz", "-o", "x.jpg"], 2, "not named like a picture");
    refused(at, &[RENDER, &["--rows", "80:91", "--part", "x.npz"]].concat(), 2, "no rows 80 to 90");
    refused(at, &[RENDER, &["--samples", "20:25", "--part", "x.npz"]].concat(), 2, "no samples 20 to 24");
    refused(at, &[RENDER, &["--part", "scene.toml"]].concat(), 2, "was read for this");
    refused(at, &[RENDER, &["--rows", "5:5", "--part", "x.npz"]].concat(), 2, "like 0:512");
    run(at, &[RENDER, &["--set", "material.water.eta=1.5", "--part", "other.npz"]].concat());
    refused(
        at,
        &["merge", "a.npz", "other.npz", "-o", "x.png"],
        1,
        "are parts of different pictures: `set` is nothing in one",
    );
    assert!(!at.join("x.png").exists() && !at.join("x.npz").exists());
}

/// clap overlooks what an option needs where that conflicts with another that is there, like `-o`.
#[test]
fn an_option_that_would_do_nothing_is_refused() {
    let folder = workplace();
    let at = folder.path();
    for (option, value, needed) in [
        ("--rows", "0:10", "--rows needs --part"),
        ("--samples", "0:4", "--samples needs --part"),
        ("--frames", "1:4", "--frames needs --keys"),
    ] {
        refused(at, &[RENDER, &[option, value, "-o", "x.png", "--checkpoint", "x.npz"]].concat(), 2, needed);
        let said = snell(at, &[RENDER, &[option, value, "-o", "x.png"]].concat());
        assert_eq!(said.status.code(), Some(2), "{}", stderr(&said));
    }
    assert!(!at.join("x.png").exists());
}

#[test]
fn a_render_goes_on_as_it_was_begun() {
    let folder = workplace();
    let at = folder.path();
    let stopped = snell(at, &[RENDER, &["--checkpoint", "k.npz", "--until", "0.1s", "-o", "p.png"]].concat());
    assert!(stopped.status.code() == Some(130) && !at.join("p.png").exists(), "{}", stderr(&stopped));
    let half = bytes(at, "k.npz");
    let said =
        snell(at, &["render", "scene.toml", "--spp", "999", "--checkpoint", "l.npz", "--until", "0.1s", "-o", "x.exr"]);
    assert!(stderr(&said).contains("go on with: snell render --resume l.npz -o x.exr"), "{}", stderr(&said));
    refused(
        at,
        &[RENDER, &["--checkpoint", "k.npz", "-o", "p.png"]].concat(),
        2,
        "the checkpoint `k.npz` is there already",
    );
    refused(
        at,
        &[RENDER, &["--checkpoint", "p.png", "-o", "p.png"]].concat(),
        2,
        "both the checkpoint and the picture",
    );
    refused(at, &["render", "--resume", "k.npz", "--depth", "3", "-o", "p.png"], 2, "goes on as it was begun");
    refused(at, &[RENDER, &["--until", "1h", "-o", "p.png"]].concat(), 2, "need a file that keeps what is done");
    refused(at, &["render", "--resume", "nowhere.npz", "-o", "p.png"], 1, "there is no file `nowhere.npz`");
    let scene = fs::read_to_string(at.join("scene.toml")).unwrap();
    fs::write(at.join("scene.toml"), scene.replace("eta = ", "eta = 1")).unwrap();
    refused(
        at,
        &["render", "--resume", "k.npz", "-o", "p.png"],
        3,
        "`scene.toml` has changed since `k.npz` was begun: line",
    );
    fs::write(at.join("scene.toml"), &scene).unwrap();
    assert!(bytes(at, "k.npz") == half, "refusals change nothing");

    run(at, &["render", "-q", "--resume", "k.npz", "-o", "p.png"]);
    assert!(bytes(at, "p.png") == bytes(at, "whole.png"));
    // Good, but more.
    run(at, &["render", "-q", "--resume", "k.npz", "--spp", "40", "-o", "more.png"]);
    run(at, &["render", "-q", "scene.toml", "--size", "120x90", "--spp", "40", "-o", "at-once.png"]);
    assert!(bytes(at, "more.png") == bytes(at, "at-once.png"));
    refused(at, &["render", "--resume", "k.npz", "--spp", "24", "-o", "p.png"], 2, "has 40 samples of a pixel");
    run(
        at,
        &["render", "-q", "scene.toml", "--size", "20x20", "--spp", "1", "--checkpoint", "one.npz", "-o", "one.png"],
    );
    refused(at, &["render", "--resume", "one.npz", "--spp", "2", "-o", "one.png"], 2, "the point of the grid");
}

/// Samples were added later, on machines that began with that and on others that did not.
#[test]
fn parts_of_fewer_and_of_more_samples_join() {
    let folder = workplace();
    let at = folder.path();
    let part = |spp: &str, more: &[&str]| {
        run(at, &[&["render", "-q", "scene.toml", "--size", "60x45", "--spp", spp][..], more].concat());
    };
    part("64", &["--part", "first.npz"]);
    part("128", &["--samples", "64:128", "--part", "more.npz"]);
    part("128", &["-o", "at-once.png"]);
    part("128", &["--part", "at-once.npz"]);
    for order in [["first.npz", "more.npz"], ["more.npz", "first.npz"]] {
        run(at, &[&["merge", "-q"][..], &order, &["-o", "merged.png"]].concat());
        assert!(bytes(at, "merged.png") == bytes(at, "at-once.png"), "{order:?}");
        // What the samples took is in it, too.
        run(at, &[&["merge", "-q"][..], &order, &["-o", "merged.npz"]].concat());
        run(at, &["merge", "-q", "at-once.npz", "-o", "tree.npz"]);
        assert!(bytes(at, "merged.npz") == bytes(at, "tree.npz"), "{order:?}");
    }
    // Alone it is whole; with more it is not.
    run(at, &["merge", "-q", "first.npz", "-o", "x.png"]);
    part("128", &["--samples", "65:128", "--part", "gap.npz"]);
    refused(at, &["merge", "first.npz", "gap.npz", "-o", "x.png"], 1, "samples 64");
    // The point of the grid is no sample of many.
    part("1", &["--rows", "0:20", "--part", "one.npz"]);
    part("2", &["--rows", "20:45", "--part", "two.npz"]);
    refused(at, &["merge", "one.npz", "two.npz", "-o", "x.png"], 1, "`spp` is 1 in one and 2 in the other");
    refused(at, &["merge", "more.npz", "one.npz", "-o", "x.png"], 1, "`spp` is 128 in one and 1 in the other");
}

fn events(output: &std::process::Output, kind: &str) -> Vec<serde_json::Value> {
    let lines: Vec<serde_json::Value> =
        stderr(output).lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    lines.into_iter().filter(|event| event["event"] == kind).collect()
}

#[test]
fn a_farm_sees_which_samples_are_done() {
    let folder = workplace();
    let at = folder.path();
    let json = |more: &[&str]| snell(at, &[RENDER, &["--progress", "json"], more].concat());
    let rows_31_to_60 = ["--rows", "31:61", "--samples", "0:12", "--part", "a.npz"];
    let kept = events(&json(&rows_31_to_60), "kept").pop().unwrap();
    assert_eq!(kept["file"], "a.npz");
    // A third of the rows, half of the samples.
    assert!((kept["share"].as_f64().unwrap() - 1.0 / 6.0).abs() < 1e-12, "{kept}");
    let rect = serde_json::json!({ "x": 0, "y": 31, "width": 120, "height": 30 });
    assert_eq!(kept["pieces"], serde_json::json!([{ "rect": rect, "samples": [[0, 12]] }]));
    assert_eq!(kept["more_pieces"], 0);

    let output = json(&["--checkpoint", "k.npz", "--every", "0.02s", "--threads", "1", "-o", "p.png"]);
    let kept = events(&output, "kept");
    let shares: Vec<f64> = kept.iter().map(|event| event["share"].as_f64().unwrap()).collect();
    assert!(shares.len() > 1 && shares.is_sorted() && shares.last() == Some(&1.0), "{shares:?}");
    let times: Vec<u64> = kept.iter().map(|event| event["times"].as_u64().unwrap()).collect();
    assert!((1..).zip(&times).all(|(number, &times)| number == times), "{times:?}");

    // Tiles of one pixel, stopped in the middle, leave more pieces than anybody wants to read.
    let stop = ["--checkpoint", "tiny.npz", "--until", "0.05s", "--tile", "1", "--threads", "1", "-o", "q.png"];
    let output = json(&stop);
    assert_eq!(output.status.code(), Some(130));
    let [kept, interrupted] = ["kept", "interrupted"].map(|kind| events(&output, kind).pop().unwrap());
    let header = snell_formats::part::PartFile::open(&at.join("tiny.npz")).unwrap().header().clone();
    for event in [kept, interrupted] {
        assert_eq!(event["share"], header.share());
        let listed = event["pieces"].as_array().unwrap().len();
        assert_eq!(listed, header.pieces.len().min(100));
        assert_eq!(event["more_pieces"], header.pieces.len() - listed);
    }
}

#[test]
fn info_says_what_a_part_is_of() {
    let folder = workplace();
    let at = folder.path();
    let part = ["--crop", "10,20,60,40", "--rows", "20:30", "--samples", "6:18", "--set", "material.water.eta=1.4"];
    run(at, &[RENDER, &part, &["--part", "a.npz"]].concat());
    let said = stdout(&run(at, &["info", "a.npz"]));
    let snell = concat!("made by      Snell ", env!("CARGO_PKG_VERSION"));
    for line in [
        "a.npz: a part of a picture of 120 x 90 pixels, 24 samples each",
        snell,
        "scene        scene.toml (its text: --scene)",
        "changed      material.water.eta=1.4",
        "crop         10,20,60,40",
        "has          rows 20 to 29, columns 10 to 69, samples 6 to 17",
        "share        12.5 % of all samples of the crop",
        "go on        snell render --resume a.npz",
    ] {
        assert!(said.lines().any(|said| said == line), "{line}: {said}");
    }
    let rays = said.lines().find_map(|line| line.strip_prefix("rays         ")).unwrap().parse::<u64>().unwrap();
    assert!(rays >= 60 * 10 * 12, "{rays}");
    assert_eq!(stdout(&run(at, &["info", "a.npz", "--scene"])), fs::read_to_string(at.join("scene.toml")).unwrap());
    let whole = bytes(at, "a.npz");
    fs::write(at.join("a.npz"), &whole[..whole.len() - 100]).unwrap();
    refused(at, &["info", "a.npz"], 1, "the part `a.npz` cannot be read: it is no whole ZIP archive");
}

/// Killed at moments that have nothing to do with what it does: the file is always whole, and the picture the same in the end.
#[test]
#[cfg(unix)]
fn kill_dash_nine_loses_little() {
    let folder = workplace();
    let at = folder.path();
    let kills: u32 = std::env::var("SNELL_SOAK_KILLS").ok().and_then(|n| n.parse().ok()).unwrap_or(12);
    let (mut killed, mut resumed) = (0, 0);
    let begin = [RENDER, &["--checkpoint", "k.npz", "--every", "0.01s", "-o", "p.png"]].concat();
    let go_on = ["render", "-q", "--resume", "k.npz", "--every", "0.01s", "-o", "p.png"];
    let started = Instant::now();
    while killed < kills && started.elapsed() < Duration::from_secs(400) {
        // A begun file that was killed before the first checkpoint is begun again.
        let arguments = if at.join("k.npz").exists() { &go_on[..] } else { &begin[..] };
        let mut child = command(at, arguments).stderr(Stdio::null()).spawn().unwrap();
        // The golden ratio leaves no moment out.
        let moment = 0.2 * (f64::from(killed) * 0.618_033_988_749_895).fract();
        std::thread::sleep(Duration::from_secs_f64(moment));
        if child.try_wait().unwrap().is_none() {
            child.kill().unwrap();
            killed += 1;
        }
        child.wait().unwrap();
        if at.join("k.npz").exists() {
            snell_formats::part::PartFile::open(&at.join("k.npz")).unwrap();
        }
        if at.join("p.png").exists() {
            assert!(bytes(at, "p.png") == bytes(at, "whole.png"), "after {killed} kills");
            fs::remove_file(at.join("p.png")).unwrap();
            fs::remove_file(at.join("k.npz")).unwrap();
            resumed += 1;
        }
    }
    if at.join("k.npz").exists() {
        run(at, &go_on);
        assert!(bytes(at, "p.png") == bytes(at, "whole.png"));
        resumed += 1;
    }
    assert!(killed >= kills && resumed > 0, "{killed} kills, {resumed} pictures");
}

/// The old checkpoint survives a disk that is full, and the render says so and goes on.
#[test]
#[cfg(target_os = "linux")]
fn a_full_disk_costs_a_checkpoint_and_no_render() {
    let folder = workplace();
    let at = folder.path();
    // No file may grow beyond 16 blocks of 512 bytes: the first checkpoint does not fit, the picture is sent to a pipe.
    let line = "trap '' XFSZ; ulimit -f 16; exec \"$0\" render -q scene.toml --size 120x90 --spp 24 --checkpoint k.npz --every 0.05s \
                -o - --format png > /dev/null";
    let output = std::process::Command::new("sh")
        .args(["-c", line, env!("CARGO_BIN_EXE_snell")])
        .current_dir(at)
        .output()
        .unwrap();
    let said = stderr(&output);
    assert!(said.contains("cannot write `k.npz`"), "{said}");
    assert!(said.contains("the render goes on"), "{said}");
    assert!(output.status.success() && !at.join("k.npz").exists(), "the picture is worth more: {said}");
}

/// What `docs/scale.md` shows is run as it stands there: the first block for a shell, and the makefile.
#[test]
#[cfg(unix)]
fn recipes_of_the_documentation_make_the_picture() {
    let page = fs::read_to_string(concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/scale.md")).unwrap();
    let block = |kind: &str| {
        let (_, rest) = page.split_once(&format!("```{kind}\n")).unwrap();
        rest.split_once("```").unwrap().0
    };
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    run(at, &["scenes", "--save", "gallery/bubbles", "-o", "scene.toml"]);
    let small = run(at, &["convert", "scene.toml", "--set", "render.size=[60,45]"]);
    fs::write(at.join("scene.toml"), small.stdout).unwrap();
    run(at, &["render", "-q", "scene.toml", "--spp", "32", "-o", "whole.png"]);
    fs::write(at.join("makefile"), block("make")).unwrap();
    let bin = Path::new(env!("CARGO_BIN_EXE_snell")).parent().unwrap();
    let path = format!("{}:{}", bin.display(), std::env::var("PATH").unwrap());
    for line in [block("sh"), "rm part-*.npz picture.png; make -s -j2"] {
        let output =
            std::process::Command::new("sh").args(["-ec", line]).current_dir(at).env("PATH", &path).output().unwrap();
        assert!(output.status.success(), "{line}: {}", stderr(&output));
        assert!(bytes(at, "picture.png") == bytes(at, "whole.png"), "{line}");
    }
}
