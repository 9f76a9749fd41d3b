use super::*;
use proptest::prelude::*;

const VIEW: &str = "v\nfrom 0 0 5\nat 0 0 0\nup 0 1 0\nangle 90\nhither 0.5\nresolution 40 30\n";

fn read(text: &str) -> Nff {
    parse(&Source::new("s.nff", format!("{VIEW}{text}"))).unwrap()
}

#[test]
fn every_entity_finds_its_place() {
    let nff = read(
        "b .1 .2 .3 # sky\nl 1 2 3\nl 4 5 6 .5 .6 .7\nf 1 .5 .25 .5 .4 30 .75 1.5\ns 1 2 3 4\np 3\n0 0 0\n1 0 0\n0 1 0\n\
         f 1 1 1 1 0 100000 0 0\npp 4 0 0 0 0 0 1 1 0 0 0 0 1 1 1 0 0 0 1 0 1 0 0 0 1\nf 1 .5 .25 .5 .4 30 .75 1.5\nc 0 0 0 1\n0 0 1 0\n",
    );
    let scene = &nff.scene;
    assert_eq!(scene.render.size, [40, 30]);
    assert_eq!((scene.camera.eye, scene.camera.near), ([0.0, 0.0, 5.0], Some(-0.5)));
    // tan 45° is 1 but for a rounding.
    assert!(scene.camera.bounds.iter().flatten().all(|b| (b.abs() - 0.5).abs() < 1e-15));
    assert_eq!(scene.lights[0].color, Rgb::gray(1.0 / 2f64.sqrt()));
    assert_eq!(scene.lights[1].color, Rgb::new(0.5, 0.6, 0.7));
    assert_eq!(scene.materials.len(), 2, "equal fills are one material");
    let glass = &scene.materials["fill_1"];
    assert_eq!((glass.kd, glass.ks, glass.kr), (Rgb::new(0.5, 0.25, 0.125), Rgb::gray(0.4), Rgb::gray(0.4)));
    assert_eq!((glass.ko, glass.spow, glass.eta), (Rgb::gray(0.25), 30.0, 1.5));
    assert_eq!(scene.materials["fill_2"].eta, 1.0);
    assert_eq!((scene.spheres[0].center, scene.spheres[0].radius), ([1.0, 2.0, 3.0], 4.0));
    let faces: Vec<usize> = scene.meshes.iter().map(|m| m.faces.len()).collect();
    assert_eq!(faces, [1, 2, 64]);
    assert_eq!((scene.meshes[0].smooth_angle, scene.meshes[1].smooth_angle), (0.0, 60.0));
    assert_eq!(scene.meshes[2].vertices.len(), 65, "the tip is one vertex");
    let said: Vec<usize> = nff.warnings.iter().map(|w| w.place.clone().unwrap().1.start).collect();
    assert_eq!(nff.warnings.len(), 2, "normals, cone: {said:?}");
    assert_eq!(scene.background, Rgb::new(0.1, 0.2, 0.3));
    let place = nff.places.find(&[Step::from("sphere"), Step::from(0), Step::from("radius")]).unwrap();
    assert_eq!(
        &format!("{VIEW}b .1 .2 .3 # sky\nl 1 2 3\nl 4 5 6 .5 .6 .7\nf 1 .5 .25 .5 .4 30 .75 1.5\n").len(),
        &place.start
    );
    assert!(snell::world::World::new(scene).is_ok());
}

#[test]
fn errors_name_the_place() {
    for (text, line, message) in [
        ("s 0 0 0 1\n", 8, "before the first fill"),
        ("f 1 1 1 1 0 3 0 1\ns 0 0 x 1\n", 9, "read `x`"),
        ("f 1 1 1 1 0 3 0 1\np 2\n", 9, "3 corners, read 2"),
        ("f 1 1 1 1 0 3 0 1\np 4\n0 0 0\n", 11, "ends too early"),
        ("f 1 1 1 1 0 3 0 1\np 1e18\n0 0 0\n", 11, "ends too early"),
        ("f 1 1 1 1 0 3 0 1\nc 0 0 0 1 0 0 0 2\n", 9, "no axis"),
        ("q 1 2\n", 8, "read `q`"),
    ] {
        let report = parse(&Source::new("s.nff", format!("{VIEW}{text}"))).unwrap_err();
        let (source, range) = report.place.clone().unwrap();
        assert!(report.message.contains(message), "{report}");
        assert_eq!(source.line_column(range.start).0, line, "{report}");
    }
    for (from, to, message) in [
        ("angle 90", "angle 180", "between 0 and 180"),
        ("resolution 40 30", "resolution 40 0", "in pixels"),
        ("hither", "hitter", "read `hitter`"),
        ("at 0 0 0", "from 0 0 0", "once"),
        (VIEW, "l 0 0 0\n", "no view"),
    ] {
        let report = parse(&Source::new("s.nff", VIEW.replacen(from, to, 1))).unwrap_err();
        assert!(report.message.contains(message), "{report}");
    }
}

proptest! {
    #[test]
    fn no_text_breaks_the_reader(words in prop::collection::vec(
        prop::sample::select(vec!["v", "b", "l", "f", "s", "p", "pp", "c", "1", "2", "-1", "0", "4", "1e308", "\n", "#", "é"]),
        0..120,
    )) {
        let fill = "f 1 1 1 1 0 3 0 1\n";
        if let Ok(nff) = parse(&Source::new("s.nff", format!("{VIEW}{fill}{}", words.join(" ")))) {
            let _ = snell::world::World::new(&nff.scene);
        }
    }
}
