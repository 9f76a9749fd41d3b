use super::*;
use crate::report::Source;
use snell::film::Rgb;
use snell::scene::{Integrator, Rounding, Transform};

const EARLY: &str = "eye 0 0 10\nlook 0 0 0\nup 0 1 0\nd 5\nbounds -2 -1 2 1\nres 8 4\n";
const LATE: &str = "eye 0 0 10\nlook 0 0 0\nup 0 1 0\nd -5\nbounds -2 2 -1 1\nres 8 4\n";
const Y2020: &str = "camera 0 0 10 0 0 0 0 1 0 -5\nbounds -2 2 -1 1\nres 8 4\n";

fn read(text: &str) -> Driver {
    parse(&Source::new("driver.txt", text), None).unwrap()
}

fn refused(text: &str) -> (usize, usize, String) {
    let report = parse(&Source::new("driver.txt", text), None).unwrap_err().pop().unwrap();
    let (source, range) = report.place.clone().expect("a place");
    let (line, column) = source.line_column(range.start);
    (line, column, format!("{} / {}", report.message, report.help.unwrap_or_default()))
}

#[test]
fn the_trap_of_the_bounds() {
    for (text, dialect) in [(EARLY, Dialect::Course2018), (LATE, Dialect::Course2019), (Y2020, Dialect::Course2020)] {
        let driver = read(text);
        assert_eq!(driver.dialect, dialect);
        assert_eq!(driver.scene.camera.bounds, Some([-2.0, 2.0, -1.0, 1.0]), "{dialect:?}");
        assert_eq!(driver.scene.camera.near, Some(-5.0));
        assert_eq!(driver.scene.camera.eye, [0.0, 0.0, 10.0]);
        assert_eq!(driver.scene.render.size, [8, 4]);
        assert!(driver.warnings.is_empty(), "{:?}", driver.warnings);
    }
}

#[test]
fn every_form_of_a_sphere() {
    let base = "sphere 1 2 3 4 .1 .1 .1 .2 .2 .2 .3 .3 .3";
    let kr = format!("{base} .4 .4 .4");
    for (head, line, dialect, material) in [
        (EARLY, base.to_owned(), Dialect::Course2018, (0.0, 1.0, 19.0, 1.0)),
        (EARLY, kr.clone(), Dialect::Course2018, (0.4, 1.0, 19.0, 1.0)),
        (EARLY, format!("{kr} .5 .5 .5 1.5"), Dialect::Lecture, (0.4, 0.5, 16.0, 1.5)),
        (EARLY, format!("{kr} .5 .5 .5 64 1.5"), Dialect::Lecture, (0.4, 0.5, 64.0, 1.5)),
        (LATE, kr.clone(), Dialect::Course2019, (0.4, 1.0, 16.0, 1.0)),
        (LATE, format!("{kr} 2"), Dialect::Course2019, (0.4, 0.0, 16.0, 2.0)),
        (Y2020, format!("{kr} 0"), Dialect::Course2020, (0.4, 1.0, 16.0, 1.0)),
    ] {
        let driver = read(&format!("{head}{line}"));
        assert_eq!(driver.dialect, dialect, "{line}");
        let sphere = &driver.scene.spheres[0];
        assert_eq!((sphere.center, sphere.radius), ([1.0, 2.0, 3.0], 4.0));
        let m = &driver.scene.materials[&sphere.material];
        assert_eq!((m.ka, m.kd, m.ks), (Rgb::gray(0.1), Rgb::gray(0.2), Rgb::gray(0.3)));
        assert_eq!((m.kr.r, m.ko.r, m.spow, m.eta), material, "{line}");
    }
    assert_eq!(read(EARLY).scene.render.rounding, Rounding::Truncate);
    assert_eq!(read(LATE).scene.render.integrator, Integrator::Course2020);
}

#[test]
fn a_short_sphere_line_is_refused_with_its_place() {
    let line = "  sphere 0 0 0 1 .1 .1 .1 .2 .2 .2 .3 .3 .3 .4 .4 # one missing\n";
    let (at, column, message) = refused(&format!("{EARLY}{line}"));
    assert_eq!((at, column), (7, 3));
    assert!(message.contains("13 or 16 values, read 15") && message.contains("sphere x y z r"), "{message}");
}

#[test]
fn models_of_three_years() {
    let turn = Transform::Rotate { axis: [1.0, 0.0, 0.0], degrees: 90.0 };
    let model = "model 1 0 0 90 2 3 4 5";
    for (head, line, angle) in [
        (EARLY, format!("{model} my model.obj"), 0.0),
        (EARLY, format!("{model} sharp my model.obj"), 0.0),
        (EARLY, format!("{model} smooth my model.obj"), 22.5),
        (LATE, format!("{model} 60 my model.obj"), 60.0),
    ] {
        let driver = read(&format!("{head}{line}"));
        let m = &driver.models[0];
        assert_eq!((m.file.as_str(), m.smooth_angle), ("my model.obj", angle), "{line}");
        assert_eq!(m.transform, [turn.clone(), Transform::Scale([2.0; 3]), Transform::Move([3.0, 4.0, 5.0])]);
    }
    let steps =
        "trans rota 1 0 0 90\nload a.obj\ntrans move 1 2 3\ncutoffAngle 30\nload b.obj\ntrans clear\nload c.obj\n";
    let models = read(&format!("{Y2020}{steps}")).models;
    assert_eq!(models.iter().map(|m| m.transform.len()).collect::<Vec<_>>(), [1, 2, 0]);
    assert_eq!(models.iter().map(|m| m.smooth_angle).collect::<Vec<_>>(), [0.0, 30.0, 30.0]);
}

#[test]
fn the_way_people_type() {
    // CRLF, tabs, comments after values, .2 and -0, no final newline, lines in any order.
    let text = "# a driver\r\nres 8 4\t\r\n\r\nlight 1 2 3 0 .2 -0 1e0 # sun\r\nlight 1 2 3 1 1 1 1\r\n".to_owned()
        + "eye 0 0 10\r\nlook 0 0 0\r\nup 0 1 0\r\nbounds -2 -1 2 1\r\nrecursionLevel 3\r\nd\t5";
    let scene = read(&text).scene;
    assert_eq!(scene.lights[0].direction, Some([1.0, 2.0, 3.0]));
    assert_eq!(scene.lights[0].color, Rgb::new(0.2, -0.0, 1.0));
    assert_eq!(scene.lights[1].position, Some([1.0, 2.0, 3.0]));
    assert_eq!(scene.render.max_depth, 3);
}

#[test]
fn unknown_repeated_and_contradicting_lines_are_warnings() {
    let codes = |text: &str| -> Vec<_> { read(text).warnings.iter().map(|w| w.warning.unwrap().code()).collect() };
    assert_eq!(codes(&format!("{EARLY}ambeint 1 1 1\n")), ["W101 unknown-keyword"]);
    assert_eq!(codes(&format!("{EARLY}eye 1 1 1\n")), ["W102 repeated-line"]);
    assert_eq!(codes(&format!("{EARLY}cutoffAngle 3\n")), ["W106 unclear-dialect"]);
    let forced = parse(
        &Source::new("x", "eye 0 0 9\nlook 0 0 0\nup 0 1 0\nd 5\nbounds -1 -1 1 1\nres 2 2"),
        Some(Dialect::Lecture),
    );
    assert_eq!(forced.unwrap().scene.render.integrator, Integrator::Lecture);
}

#[test]
fn a_misspelt_keyword_explains_what_is_missing() {
    let reports = parse(&Source::new("x", EARLY.replace("look", "lok")), None).unwrap_err();
    assert!(reports[0].help.as_deref() == Some("did you mean `look`?") && reports[1].message.contains("no `look`"));
}

#[test]
fn errors_name_line_and_column() {
    for (text, at, message) in [
        (format!("{EARLY}light 0 0 0 1 1 1\n"), (7, 1), "7 values, read 6"),
        (format!("{EARLY}light 0 0 0 2 1 1 1\n"), (7, 13), "w must be 0 or 1"),
        (format!("{EARLY}ambient 1 two 3\n"), (7, 11), "read `two`"),
        (format!("{EARLY}ambient 1 nan 3\n"), (7, 11), "read `nan`"),
        (format!("{EARLY}recursionLevel 1.5\n"), (7, 16), "whole number"),
        (format!("{EARLY}recursionLevel -1\n"), (7, 16), "whole number"),
        (EARLY.replace("res 8 4\n", ""), (5, 17), "no `res` line"),
        (EARLY.replace("res 8 4", "res 8 4000000000"), (6, 7), "whole number"),
        (format!("{EARLY}model 1 0 0 90 1 0 0 0\n"), (7, 1), "at least 9 values"),
        (format!("{Y2020}trans spin 3\n"), (4, 1), "`trans spin` with 1 values"),
        (String::new(), (1, 1), "no `res` line"),
    ] {
        let (line, column, found) = refused(&text);
        assert!(found.contains(message), "{found}");
        assert_eq!((line, column), at, "{found}");
    }
}

mod properties {
    use super::*;
    use proptest::prelude::*;

    const WORDS: &[&str] = &[
        "eye",
        "look",
        "up",
        "d",
        "camera",
        "bounds",
        "res",
        "recursionLevel",
        "light",
        "sphere",
        "model",
        "trans",
        "rota",
        "clear",
        "load",
        "cutoffAngle",
        "smooth",
        "x.obj",
        "1",
        "-2",
        ".5",
        "1e10",
        "1e999",
        "nan",
        "#",
        "\n",
        "\r\n",
        "\t",
        "é",
    ];

    proptest! {
        #[test]
        fn no_text_breaks_the_reader(words in prop::collection::vec(prop::sample::select(WORDS), 0..80)) {
            let source = Source::new("driver.txt", words.join(" "));
            for dialect in [None].into_iter().chain(Dialect::ALL.map(Some)) {
                let reports = parse(&source, dialect).map_or_else(|reports| reports, |driver| driver.warnings);
                for report in reports {
                    let (source, range) = report.place.unwrap();
                    prop_assert!(source.text.get(range).is_some());
                }
            }
        }

        #[test]
        fn nor_do_random_characters(text in "\\PC{0,200}") {
            let _ = parse(&Source::new("driver.txt", text), None);
        }
    }
}
