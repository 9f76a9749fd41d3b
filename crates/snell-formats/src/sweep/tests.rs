//! Values, key frames and names, and everything that is none.

use super::*;
use crate::builtin;
use crate::scene_file::Syntax;
use std::collections::BTreeSet;

fn sweep(axes: &[&str], keys: Option<&str>, frames: Option<[u32; 2]>) -> Result<Sweep, Report> {
    let axes: Vec<String> = axes.iter().map(ToString::to_string).collect();
    Sweep::new(&axes, keys.map(|text| Source::new("keys.toml", text)).as_ref(), frames)
}

fn values(axis: &str) -> Vec<String> {
    let sweep = sweep(&[axis], None, None).unwrap();
    (0..sweep.count()).map(|n| sweep.changes(n).remove(0).rsplit_once('=').unwrap().1.to_owned()).collect()
}

/// A track of one number, at all frames.
fn track(keys: &str) -> Vec<f64> {
    let sweep = sweep(&[], Some(keys), None).unwrap();
    (0..sweep.count()).map(|n| sweep.changes(n)[0].rsplit('=').next().unwrap().parse().unwrap()).collect()
}

fn key_frames(interpolation: &str, keys: &[(u32, f64)]) -> String {
    let frame = |(at, value): &(u32, f64)| format!("[[frame]]\nat = {at}\nambient = {value:?}\n");
    format!("interpolation = '{interpolation}'\n") + &keys.iter().map(frame).collect::<String>()
}

fn refused(result: Result<impl std::fmt::Debug, Report>, why: &str) -> Report {
    let report = result.unwrap_err();
    let said = format!("{} / {}", report.message, report.help.as_deref().unwrap_or_default());
    assert!(said.contains(why), "{said}");
    report
}

#[test]
fn values_are_even_and_their_ends_exact() {
    let eta = ["1.3", "1.35", "1.4", "1.45", "1.5", "1.55", "1.6", "1.65", "1.7"];
    assert_eq!(values("m.eta=1.3:1.7:9"), eta);
    let mut back = eta;
    back.reverse();
    assert_eq!(values(" m.eta = 1.7 : 1.3 : 9 "), back);
    assert_eq!(values("a=-0.3:0.7:11")[3], "0");
    assert_eq!(values("a=1:3:3"), ["1", "2", "3"]);
    assert_eq!(values("a=2:2:1"), ["2"]);
    assert_eq!(values("a=0:1:2"), ["0", "1"]);
    assert_eq!(values("a=-1e308:1e308:3"), ["-1e308", "0", "1e308"], "nothing overflows");
    assert_eq!(values("a=5e-324:1e-323:2"), ["5e-324", "1e-323"]);
    // Ends keep their bits, and steps that are hardly there stay apart.
    let near = values("a=1:1.0000000000000009:5");
    assert_eq!(near.iter().collect::<BTreeSet<_>>().len(), 5, "{near:?}");
    assert_eq!(near[4].parse::<f64>().unwrap().to_bits(), 1.000_000_000_000_000_9_f64.to_bits());
    assert_eq!(values("a=0:1e6:1000000").len(), MOST_PICTURES);
    assert_eq!(values("m.eta=['BK7', \"SF10\"]"), ["'BK7'", "\"SF10\""]);
    assert_eq!(values("camera.eye=[[0,0,5], # left\n [1, 0, 5]]"), ["[0,0,5]", "[1, 0, 5]"]);
    assert_eq!(values("material.\"x=y\".kd=[0.5]"), ["0.5"]);
}

#[test]
fn values_that_are_none() {
    let of = |axis: &str| sweep(&[axis], None, None);
    refused(of("eta"), "has no `=`");
    refused(of("=1:2:3"), "no key");
    refused(of("a..b=1:2:3"), "no key");
    refused(of("\"a=1:2:3"), "has no `=`");
    for axis in ["a=1.5", "a=", "a=1:2", "a=1:2:3:4", "a=BK7"] {
        refused(of(axis), "write A:B:N");
    }
    for axis in ["a=nan:2:3", "a=1:inf:3", "a=x:2:3", "a=1e999:2:3", "a=[nan]", "a=[[1, inf]]", "a=[{ b = -inf }]"] {
        refused(of(axis), "finite number");
    }
    for axis in ["a=1:2:0", "a=1:2:-1", "a=1:2:2.5", "a=1:2:1000001", "a=1:2:99999999999999999999"] {
        refused(of(axis), "from 1 to 1000000");
    }
    refused(of("a=1:2:1"), "cannot go from 1 to 2");
    refused(of("a=2:2:3"), "cannot go from 2 to 2");
    refused(of("a=[]"), "without values");
    refused(of("a=[1, 2"), "expected a list");
    refused(of("a=[1] [2]"), "expected a list");
    refused(sweep(&["a=1:2:1000", "b=1:2:1000", "c=1:2:2"], None, None), "1000 x 1000 x 2 pictures");
    refused(sweep(&["a.b=1:2:2", "a.'b'=1:2:2"], None, None), "change the same value");
    refused(sweep(&["a.b=1:2:2", "a=[{ b = 1 }]"], None, None), "`a` and `a.b` change the same value");
    refused(sweep(&["ambient=1:2:2"], Some(&key_frames("linear", &[(1, 0.0)])), None), "`ambient` is changed twice");
    assert!(sweep(&["a=1:2:2", "ab=1:2:2"], None, None).is_ok());
}

#[test]
fn all_combinations_the_last_one_fastest_each_a_movie() {
    let keys = key_frames("linear", &[(1, 0.0), (3, 1.0)]);
    let sweep = sweep(&["a=[1, 2]", "b=['x', 'y']"], Some(&keys), None).unwrap();
    let all: Vec<String> = (0..sweep.count()).map(|number| sweep.changes(number).join(" ")).collect();
    assert_eq!(all.len(), 12);
    assert_eq!(
        all[..4],
        ["a=1 b='x' ambient=0", "a=1 b='x' ambient=0.5", "a=1 b='x' ambient=1", "a=1 b='y' ambient=0"]
    );
    assert_eq!(all[11], "a=2 b='y' ambient=1");
}

#[test]
fn key_frames_are_exact_and_what_lies_between_is_what_it_should_be() {
    let line = [(10, -3.0), (11, -2.0), (20, 7.0), (50, 37.0)];
    for kind in ["linear", "smooth"] {
        for (frame, value) in track(&key_frames(kind, &line)).into_iter().enumerate() {
            assert!((value - (frame as f64 - 3.0)).abs() < 1e-13, "{kind}: {value} at {}", frame + 10);
        }
    }
    let parabola = |t: f64| 0.25 * t * t - 3.0 * t + 7.0;
    let keys: Vec<(u32, f64)> = [0, 3, 4, 9, 30].map(|at| (at, parabola(at.into()))).to_vec();
    for (frame, value) in track(&key_frames("smooth", &keys)).into_iter().enumerate() {
        assert!((value - parabola(frame as f64)).abs() < 1e-11, "{value} at {frame}");
    }
    // Bits at keys, whatever they are; what does not change stays; before and behind it is constant.
    let odd = [(2, 0.1), (5, -1e-310), (7, 1e300), (8, -1e300), (11, 0.1), (12, 0.1), (13, 0.1), (17, 0.1)];
    for kind in ["linear", "smooth", "step"] {
        let text = key_frames(kind, &odd);
        let sweep = sweep(&[], Some(&text), Some([0, 20])).unwrap();
        let at = |frame: usize| sweep.changes(frame)[0].rsplit('=').next().unwrap().parse::<f64>().unwrap();
        for (frame, value) in odd {
            assert_eq!(at(frame as usize).to_bits(), value.to_bits(), "{kind} at {frame}");
        }
        for frame in [0, 1, 12, 17, 18, 20] {
            assert_eq!(at(frame), 0.1, "{kind} at {frame}");
        }
        assert!((0..=20).all(|frame| at(frame).is_finite()));
    }
    assert_eq!(track(&key_frames("step", &[(0, 1.0), (3, 2.0)])), [1.0, 1.0, 1.0, 2.0]);
}

#[test]
fn each_key_is_a_track_of_its_own() {
    let keys = "frame = [\n{ at = 9, camera = { eye = [0, 0, 4] }, render.spp = 9 },\n\
                { at = 1, camera.eye = [0, 8, 0], sky.name = 'a', material.\"x.y\".kd = 1 },\n\
                { at = 5, sky.name = 'b', render.spp = 1, light.2.color = [[1, 2], [3, 4]] }]";
    let sweep = sweep(&[], Some(keys), None).unwrap();
    let frame = |at: usize| sweep.changes(at - 1).join(" ");
    let rest = "light.2.color=[[1, 2], [3, 4]] material.\"x.y\".kd=1 ";
    assert_eq!(frame(1), format!("camera.eye=[0, 8, 0] {rest}render.spp=1 sky.name=\"a\""));
    assert_eq!(frame(3), format!("camera.eye=[0, 6, 1] {rest}render.spp=1 sky.name=\"a\""));
    assert_eq!(frame(6), format!("camera.eye=[0, 3, 2.5] {rest}render.spp=3 sky.name=\"b\""));
    assert_eq!(frame(9), format!("camera.eye=[0, 0, 4] {rest}render.spp=9 sky.name=\"b\""));
    // Whole numbers that `f64` does not have are kept.
    let seeds = "[[frame]]\nat = 0\nrender.seed = 9007199254740993\n[[frame]]\nat = 9\nrender.seed = 1";
    assert_eq!(self::sweep(&[], Some(seeds), None).unwrap().changes(4), ["render.seed=9007199254740993"]);
}

#[test]
fn hostile_key_frames() {
    let place = |keys: &str, why: &str| {
        let (source, range) = refused(sweep(&[], Some(keys), None), why).place.unwrap();
        assert_eq!(&*source.name, "keys.toml");
        source.line_column(range.start)
    };
    assert_eq!(place("interpolation = 'smoth'\n[[frame]]\nat = 1\na = 1", "did you mean `smooth`?"), (1, 17));
    assert_eq!(place("interpolation = 3", "read `3`"), (1, 17));
    assert_eq!(place("[[frame]]\nat = 1\na = 1\n[[frames]]", "did you mean `frame`?").0, 4);
    assert_eq!(place("[[frame]]\nat = 1\na = 1\n[frame.b]\nc = nan", "finite"), (5, 5));
    for (at, why) in [
        ("", "`at` is missing"),
        ("at = 1.5", "`1.5`"),
        ("at = -1", "`-1`"),
        ("at = 'x'", "`\"x\"`"),
        ("at = 4294967296", "`4294967296`"),
    ] {
        assert_eq!(
            place(&format!("[[frame]]\nat = 7\na = 1\n[[frame]]\n{at}\na = 2"), why).0,
            if at.is_empty() { 4 } else { 5 }
        );
    }
    assert_eq!(place("[[frame]]\nat = 1\na = 1\n[[frame]]\nat = 1\na = 2", "two key frames are at 1"), (5, 6));
    assert_eq!(
        place("[[frame]]\nat = 1\na = [1, 2]\n[[frame]]\nat = 2\na = [1, 2, 3]", "a list of 2 at frame 1"),
        (6, 5)
    );
    assert_eq!(
        place("[[frame]]\nat = 1\na = 1\n[[frame]]\nat = 2\na = [1]", "a number at frame 1 and a list of 1"),
        (6, 5)
    );
    assert_eq!(place("[[frame]]\nat = 1\na = 1e301", "at most 1e300"), (3, 5));
    assert_eq!(place("[[frame]]\nat = 1\n[[frame.sphere]]\nradius = 1", "sphere.1.KEY").0, 3);
    assert_eq!(place("[frame]\nat = 1", "two brackets").0, 1);
    assert_eq!(place("frame = [1]", "two brackets").0, 1);
    assert_eq!(place("", "no key frame"), (1, 1));
    assert_eq!(place("frame = []", "no key frame"), (1, 1));
    assert_eq!(place("[[frame]]\nat = 1\ncamera = {}", "changes anything"), (1, 1));
    place("[[frame]\nat = 1", "");
    place("[[frame]]\nat = 1\na.b = 1\na = 2", "");
    let deep = format!("[[frame]]\nat = 1\na = {}1{}", "[".repeat(10_000), "]".repeat(10_000));
    place(&deep, "");
    refused(sweep(&[], Some("[[frame]]\nat = 1\na = 1"), Some([240, 1])), "240 is behind 1");
    refused(
        sweep(&[], Some("[[frame]]\nat = 4294967295\na = 1\n[[frame]]\nat = 0\na = 1"), None),
        "4294967296 pictures",
    );
}

#[test]
fn keys_are_tried_on_the_scene() {
    let source = builtin::find("lecture/default").unwrap();
    let scene = scene_file::parse(&source, Syntax::Toml).unwrap();
    let check = |axes: &[&str], keys: Option<&str>| sweep(axes, keys, None).unwrap().check(&scene);
    check(&["material.glass.eta=1:2:3"], Some(&key_frames("smooth", &[(0, 0.0), (9, 1.0)]))).unwrap();
    refused(check(&["material.glas.eta=1:2:3"], None), "did you mean `glass`?");
    let report = refused(check(&["material.glass.eta=[1, 'BK8']"], None), "BK8");
    assert_eq!(&*report.place.unwrap().0.text, "material.glass.eta='BK8'");
    let keys = "[[frame]]\nat = 1\ncamera.fov = 1\n[[frame]]\nat = 2\ncamera.eyes = [1, 2, 3]";
    let (source, range) = refused(check(&[], Some(keys)), "eyes").place.unwrap();
    assert_eq!((&*source.name, source.line_column(range.start)), ("keys.toml", (6, 15)));
}

#[test]
fn what_pictures_share_is_known_by_their_keys() {
    let of = |axes: &[&str], keys: Option<&str>| {
        let sweep = sweep(axes, keys, None).unwrap();
        (sweep.keeps_shapes(), sweep.has_texts())
    };
    assert_eq!(of(&["camera.eye=[[0, 0, 1]]"], Some(KEYS_WITH_TEXT)), (true, true));
    assert_eq!(of(&["material.m.eta=1:2:3"], Some(&key_frames("linear", &[(1, 0.0)]))), (true, false));
    assert_eq!(of(&["mesh.1.file=['a.obj']"], None), (false, true));
    assert_eq!(of(&[], Some("[[frame]]\nat = 1\nsphere.1.radius = 3")), (false, false));
}

const KEYS_WITH_TEXT: &str = "[[frame]]\nat = 1\nsky.image = 'a.png'";

#[test]
fn names() {
    let keys = key_frames("linear", &[(8, 0.0), (10, 1.0)]);
    let of = |axes: &[&str], keys: Option<&str>, pattern: &str| {
        let names = sweep(axes, keys, None).unwrap().names(pattern)?;
        Ok::<Vec<String>, Report>(names.iter().map(|name| name.to_str().unwrap().to_owned()).collect())
    };
    let two = ["material.glass.eta=1.3:1.7:2", "render.spp=[4, 16]"];
    assert_eq!(
        of(&two, None, "{eta}_{{{spp}}}.exr").unwrap(),
        ["1.3_{4}.exr", "1.3_{16}.exr", "1.7_{4}.exr", "1.7_{16}.exr"]
    );
    assert_eq!(of(&[], Some(&keys), "out/f_{frame}.PNG").unwrap(), ["out/f_08.PNG", "out/f_09.PNG", "out/f_10.PNG"]);
    let eleven = of(&["a=1:11:11"], None, "{index}.png").unwrap();
    assert_eq!([&*eleven[0], &*eleven[10]], ["00.png", "10.png"]);
    let lists = ["camera.eye=[[0, 0, 5], [1, 0, 5.50]]", "material.'x.y'.eta=['BK7', true]"];
    let listed = of(&lists, None, "../{camera.eye}/{material.\"x.y\".eta}.png").unwrap();
    assert_eq!([&*listed[0], &*listed[3]], ["../0,0,5/BK7.png", "../1,0,5.5/true.png"]);
    let usual = |axes: &[&str], keys| sweep(axes, keys, None).unwrap().usual_pattern("a{b", "exr");
    assert_eq!(usual(&two, Some(&keys)), "a{{b_{frame}_{material.glass.eta}_{render.spp}.exr");
    assert_eq!(usual(&["a=[1]"], None), "a{{b_{a}.exr");

    refused(of(&two, None, "{eta}_{sp}.png"), "did you mean `spp`?");
    refused(of(&two, None, "{frame}.png"), "frames come with --keys");
    refused(of(&two, None, "{}.png"), "Known here: eta, spp, index");
    for pattern in ["{eta.png", "eta}.png", "{{eta}.png", "{.png", "}"] {
        refused(of(&two, None, pattern), "has no other brace");
    }
    refused(of(&two, None, "{eta}.png"), "pictures 0 and 1 would both be `1.3.png`");
    refused(of(&["a=[1, 1.0]"], None, "{a}.png"), "would both be `1.png`");
    refused(of(&["a.eta=[1, 2]", "b.eta=[1, 2]"], None, "{eta}.png"), "may be {a.eta} or {b.eta}");
    refused(of(&["a.eta=[1, 2]", "b.eta=[1, 2]"], None, "{a.eta}.png"), "-o: {a.eta}, {b.eta}, {index}");
    for (value, why) in [
        ("'../x'", "holds '/'"),
        ("'a\\b'", "holds '\\\\'"),
        ("\"\\u0000\"", "holds"),
        ("''", "without letters"),
        ("{ b = 1 }", "is no part"),
        ("1979-05-27", "is no part"),
    ] {
        let axis = format!("a=[{value}]");
        refused(of(&[&axis], None, "{a}.png"), why);
        assert_eq!(of(&[&axis], None, "{index}.png").unwrap(), ["0.png"]);
    }
    for pattern in ["{a}/x.png", "y/{a}/x.png"] {
        refused(of(&["a=['..']"], None, pattern), "another folder");
    }
    for pattern in ["{a}.ppm", "{a}.npy", "{a}", "", "png", "{a}.png/", "x/"] {
        let names = of(&["a=[1]"], None, pattern);
        assert!(names.is_err() || pattern == "{a}.png/", "{pattern}");
    }
    let long = "x".repeat(1000);
    refused(of(&["a=[1]"], None, &format!("{long}.png")), "too long");
    refused(of(&["a=[1]"], None, &format!("{}{{a}}.png", "x/".repeat(4000))), "too long");
    refused(of(&[&format!("a=['{long}']")], None, "{a}.png"), "too long");
}
