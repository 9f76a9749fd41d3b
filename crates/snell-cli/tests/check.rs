//! `snell check`, and the formats that it reads: PLY, STL, NFF.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod common;

use common::{run, snell, stderr, stdout};
use serde_json::Value;
use snell_test_scenes::real_files::data;
use std::fs;
use std::path::Path;

const TETRA: &str = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 1 4 3\n";

/// The report as JSON, and the exit code.
fn json(folder: &Path, arguments: &[&str]) -> (Value, i32) {
    let output = snell(folder, &[&["check", "--json"], arguments].concat());
    assert!(!output.stdout.is_empty(), "{}", stderr(&output));
    (serde_json::from_str(&stdout(&output)).unwrap(), output.status.code().unwrap())
}

#[test]
fn a_solid_ends_with_0_and_says_what_it_is() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("t.obj"), TETRA).unwrap();
    let said = stdout(&run(at, &["check", "t.obj"]));
    assert!(said.starts_with("t.obj: a solid\n"), "{said}");
    assert!(said.contains("Euler number 2") && said.contains("0.166667"), "{said}");
    let (report, code) = json(at, &["t.obj"]);
    assert_eq!((&report["verdict"], code), (&Value::from("solid"), 0));
    assert_eq!((&report["euler"], &report["components"][0]["orientation"]), (&2.into(), &"outward".into()));
}

#[test]
fn what_is_no_solid_ends_with_1_and_can_be_mended() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    // A box of eight-digit coordinates, without a triangle, with one turned and a copy; in a file with materials.
    let cube = "mtllib m.mtl\nv 0.12345678901 0 0\nv 1 0 0\nv 0.12345678901 1 0\nv 1 1 0\nv 0.12345678901 0 1\nv 1 0 1\nv \
                0.12345678901 1 1\nv 1 1 1\nusemtl glass\nf 1 3 4 2\nf 5 6 8 7\nf 1 2 6 5\nf 3 7 8 4\nf 1 5 7 3\nf 2 4 8\nf 1 4 3\n";
    fs::write(at.join("b.obj"), cube).unwrap();
    let output = snell(at, &["check", "b.obj"]);
    let said = stdout(&output);
    assert_eq!(output.status.code(), Some(1), "{said}");
    assert!(said.starts_with("b.obj: no solid: open along"), "{said}");
    assert!(said.contains("snell check b.obj --repair"), "{said}");
    let (report, code) = json(at, &["b.obj", "--repair", "-o", "m.obj"]);
    assert_eq!((code, &report["before"]["verdict"], &report["after"]["verdict"]), (0, &"open".into(), &"solid".into()));
    assert_eq!((&report["done"]["filled_holes"], &report["done"]["duplicate_faces"]), (&1.into(), &1.into()));
    let mended = fs::read_to_string(at.join("m.obj")).unwrap();
    assert!(mended.contains("v 0.12345678901 0 0\n") && mended.starts_with("mtllib m.mtl\n"), "{mended}");
    assert!(mended.contains("usemtl glass\n"), "{mended}");
    run(at, &["check", "m.obj"]);
    // What is there is not written over, the model itself above all.
    for output in ["b.obj", "m.obj"] {
        assert_eq!(snell(at, &["check", "b.obj", "--repair", "-o", output]).status.code(), Some(2));
    }
    assert_eq!(fs::read_to_string(at.join("b.obj")).unwrap(), cube);
    let again = stdout(&run(at, &["check", "m.obj", "--repair", "-o", "m.obj", "--force"]));
    assert!(again.contains("nothing to do"), "{again}");
    assert_eq!(fs::read_to_string(at.join("m.obj")).unwrap(), mended);
}

#[test]
fn what_cannot_be_mended_is_not_written() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("sheet.obj"), "v 0 0 0\nv 1 0 0\nv 0 0.01 0\nf 1 2 3\n").unwrap();
    for (options, why) in [(&[][..], "without guessing"), (&["--weld", "0.1"], "smaller --weld")] {
        let output = snell(at, &[&["check", "sheet.obj", "--repair", "-o", "m.obj"], options].concat());
        assert!(output.status.code() == Some(1) && !at.join("m.obj").exists());
        let said = stderr(&output);
        assert!(
            said.starts_with("error: nothing was mended, and `m.obj` was not written") && said.contains(why),
            "{said}"
        );
    }
}

#[test]
fn wrong_usage_and_what_cannot_be_read() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    fs::write(at.join("t.obj"), TETRA).unwrap();
    fs::write(at.join("bad.ply"), "ply\nformat ascii 1.0\nelement vertex x\nend_header\n").unwrap();
    fs::write(at.join("bad.stl"), "solid\nvertex 1 2 three\n").unwrap();
    for (code, arguments) in [
        (2, &["check"][..]),
        (2, &["check", "t.obj", "--repair"]),
        (2, &["check", "t.obj", "-o", "m.obj"]),
        (2, &["check", "t.obj", "--repair", "-o", "m.stl"]),
        (2, &["check", "t.obj", "--repair", "-o", "m.obj", "--weld", "2"]),
        (2, &["check", "t.obj", "--repair", "-o", "m.obj", "--weld", "nan"]),
        (2, &["check", "lecture/default", "--repair", "-o", "m.obj"]),
        (1, &["check", "t.obj", "--repair", "-o", "no/such/m.obj"]),
        (3, &["check", "no.obj"]),
        (3, &["check", "bad.ply"]),
        (3, &["check", "bad.stl"]),
        (3, &["check", "no-such-scene"]),
    ] {
        let output = snell(at, arguments);
        assert_eq!(output.status.code(), Some(code), "snell {}\n{}", arguments.join(" "), stderr(&output));
        assert!(!stderr(&output).is_empty());
    }
    assert!(stderr(&snell(at, &["check", "bad.ply"])).contains("bad.ply:3:1"));
    assert!(stderr(&snell(at, &["check", "bad.stl"])).contains("bad.stl:2:12"));
}

#[test]
fn scenes_take_ply_and_stl_models() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let head = "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n\
                property list uchar int vertex_index\nend_header\n";
    fs::write(at.join("t.ply"), format!("{head}-9 -9 0\n9 -9 0\n0 9 0\n3 0 1 2\n")).unwrap();
    let stl = "solid t\nfacet normal 0 0 1\nouter loop\nvertex -9 -9 0\nvertex 9 -9 0\nvertex 0 9 0\nendloop\nendfacet\nendsolid\n";
    fs::write(at.join("t.STL"), stl).unwrap();
    fs::write(at.join("t.obj"), "v -9 -9 0\nv 9 -9 0\nv 0 9 0\nf 1 2 3\n").unwrap();
    for model in ["t.ply", "t.STL", "t.obj", "t.xyz"] {
        let scene = format!(
            "snell = 1\nambient = 1\n[render]\nintegrator = 'lecture'\nsize = [8, 8]\nmax_depth = 1\n[camera]\neye = [0, 0, 9]\n\
             look_at = [0, 0, 0]\nup = [0, 1, 0]\nbounds = [-1, 1, -1, 1]\nnear = -5\n[[mesh]]\nfile = '{model}'\n"
        );
        fs::write(at.join(format!("{model}.toml")), scene).unwrap();
    }
    for model in ["t.ply", "t.STL", "t.obj"] {
        run(at, &["render", &format!("{model}.toml"), "-o", &format!("{model}.npy")]);
    }
    run(at, &["diff", "t.ply.npy", "t.obj.npy"]);
    run(at, &["diff", "t.STL.npy", "t.obj.npy"]);
    fs::write(at.join("t.xyz"), "").unwrap();
    let other = snell(at, &["render", "t.xyz.toml", "-o", "x.npy"]);
    assert!(
        other.status.code() == Some(3) && stderr(&other).contains("models are OBJ, PLY or STL"),
        "{}",
        stderr(&other)
    );
    assert!(stderr(&other).contains("t.xyz.toml:14:8"), "{}", stderr(&other));
}

#[test]
fn an_nff_file_is_drawn_changed_and_converted() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let text = "b 0 0 1\nv\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 45\nhither 1\nresolution 16 16\nl 0 9 9\n\
                f 1 0.5 0.5 0.8 0 10 0 0\ns 0 0 0 1\np 3\n-2 -2 -1\n2 -2 -1\n0 2 -1\n";
    fs::write(at.join("s.nff"), text).unwrap();
    let output = run(at, &["render", "s.nff", "-o", "a.npy"]);
    assert!(!stderr(&output).contains("W107 approximated"), "{}", stderr(&output));
    fs::write(at.join("hollow.nff"), text.replace("s 0 0 0 1", "s 0 0 0 -1")).unwrap();
    let hollow = run(at, &["render", "hollow.nff", "-o", "h.npy"]);
    assert!(stderr(&hollow).contains("W107 approximated"), "{}", stderr(&hollow));
    run(at, &["convert", "s.nff", "-o", "s.toml"]);
    run(at, &["render", "s.toml", "-o", "b.npy"]);
    run(at, &["diff", "a.npy", "b.npy"]);
    run(at, &["render", "s.nff", "--set", "sphere.1.radius=2", "-o", "c.npy"]);
    assert_eq!(snell(at, &["diff", "a.npy", "c.npy"]).status.code(), Some(1));
    run(at, &["render", "s.nff", "-o", "p.png"]);
    run(at, &["render", "--from", "p.png", "-o", "q.png"]);
    run(at, &["diff", "p.png", "q.png"]);
    fs::write(at.join("bad.nff"), text.replace("s 0 0 0 1", "s 0 0 0 x")).unwrap();
    let bad = snell(at, &["render", "bad.nff"]);
    assert!(bad.status.code() == Some(3) && stderr(&bad).contains("bad.nff:11:9"), "{}", stderr(&bad));
    fs::write(at.join("far.nff"), text.replace("from 0 0 5", "from 0 0 1e99")).unwrap();
    let far = snell(at, &["render", "far.nff"]);
    assert!(far.status.code() == Some(3) && stderr(&far).contains("far.nff:2:1"), "{}", stderr(&far));
}

#[test]
fn real_models_are_what_is_known_of_them() {
    let Some(data) = data() else { return };
    let check = |name: &str| json(&data, &[name]);
    for (name, euler) in
        [("spot.obj", 2), ("armadillo.obj", 2), ("torusknot.obj", 0), ("rocker-arm.obj", 0), ("dragon.ply", -4)]
    {
        let (report, code) = check(&format!("meshes/{name}"));
        assert_eq!((code, &report["solid"]), (0, &true.into()), "{name}: {report}");
        assert_eq!(report["euler"], euler, "{name}");
    }
    for (name, boundary, crowded) in [("stanford-bunny.obj", 223, 0), ("teapot.obj", 160, 0), ("suzanne.obj", 42, 1)] {
        let (report, code) = check(&format!("meshes/{name}"));
        assert_eq!((code, &report["boundary_edges"]["count"]), (1, &boundary.into()), "{name}");
        assert_eq!(report["non_manifold_edges"]["count"], crowded, "{name}");
    }
    let (armadillo, _) = check("meshes/armadillo.obj");
    assert_eq!(armadillo["verdict"], "inside-out");
    let (igea, code) = check("meshes/igea.ply");
    assert_eq!((&igea["vertices"], &igea["euler"], code), (&134_345.into(), &2.into(), 0));
    let (gears, _) = check("nff/gears-2.nff");
    // Two layers of four, each gear with 144 corners above and below.
    let solids = gears.as_array().unwrap();
    // The floor comes first.
    assert_eq!(solids[0]["verdict"], "open");
    assert!(solids.len() == 9 && solids[1..].iter().all(|m| m["verdict"] == "solid"), "{gears}");
}
