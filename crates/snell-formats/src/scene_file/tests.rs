use super::*;
use crate::builtin;

fn source(text: &str) -> Source {
    Source::new("scene.toml", text)
}

const SMALL: &str = r#"snell = 1
[render]
integrator = "lecture"
size = [4, 4]
max_depth = 2
[camera]
eye = [0, 0, 10]
look_at = [0, 0, 0]
up = [0, 1, 0]
bounds = [-2, 2, -2, 2]
near = -5
[[light]]
name = "lamp"
position = [0, 9, 0]
color = 0.5
[material.glass]
kd = [0.1, 0.2, 0.3]
[[sphere]]
name = "ball"
center = [0, 0, 0]
radius = 1
material = "glass"
"#;

#[test]
fn every_builtin_scene_survives_both_syntaxes_to_the_bit() {
    for (name, text) in builtin::SCENES {
        let scene = parse(&Source::new(*name, *text), Syntax::Toml).unwrap();
        for syntax in [Syntax::Toml, Syntax::Json] {
            let again = parse(&source(&to_text(&scene, syntax).unwrap()), syntax).unwrap();
            assert_eq!(again, scene, "{name} as {syntax:?}");
        }
    }
}

/// The text that a report points at.
fn pointed(report: &Report) -> &str {
    let (source, range) = report.place.as_ref().unwrap();
    &source.text[range.clone()]
}

#[test]
fn errors_point_at_what_was_read_and_say_what_to_do() {
    for (from, to, at, message, help) in [
        ("radius = 1", "radus = 1", "radus", "unknown key `radus`", "did you mean `radius`?"),
        ("\"lecture\"", "\"lektüre\"", "\"lektüre\"", "unknown value `lektüre`", "lecture, course2018, course2020"),
        ("integrator = \"lecture\"\n", "", "[render]", "`integrator` is missing", "which model of light"),
        ("color = 0.5", "color = [1, 2]", "[1, 2]", "a colour", ""),
        ("radius = 1", "radius = \"big\"", "\"big\"", "invalid type", ""),
        ("near = -5", "near = ", "", "", ""),
    ] {
        let report = parse(&source(&SMALL.replace(from, to)), Syntax::Toml).unwrap_err();
        assert!(report.message.contains(message), "{report}");
        assert!(pointed(&report).starts_with(at), "`{}` should be `{at}`", pointed(&report));
        assert!(report.help.clone().unwrap_or_default().contains(help), "{report:?}");
    }
}

#[test]
fn tables_are_read_by_name_only_and_names_are_given_once() {
    for (from, to) in [
        ("[material.glass]\nkd = [0.1, 0.2, 0.3]", "[material]\nglass = [0.9]"),
        ("[[sphere]]\nname = \"ball\"\ncenter = [0, 0, 0]\nradius = 1\nmaterial = \"glass\"", ""),
    ] {
        let text = SMALL.replace(from, to);
        let text = if to.is_empty() { format!("sphere = [['ball', [0, 0, 0], 1, 'glass']]\n{text}") } else { text };
        let report = parse(&source(&text), Syntax::Toml).unwrap_err();
        assert!(report.message.contains("a table, with names") && pointed(&report).starts_with('['), "{report:?}");
    }
    let json = to_text(&parse(&source(SMALL), Syntax::Toml).unwrap(), Syntax::Json).unwrap();
    let twice = json.replace("\"glass\": {", "\"glass\": {}, \"glass\": {");
    assert!(parse(&source(&twice), Syntax::Json).unwrap_err().message.contains("given twice"));
    assert!(parse(&source(" []"), Syntax::Json).unwrap_err().message.contains("object"));
}

#[test]
fn json_errors_point_too() {
    let json = to_text(&parse(&source(SMALL), Syntax::Toml).unwrap(), Syntax::Json).unwrap();
    let report = parse(&source(&json.replace("\"radius\"", "\"radus\"")), Syntax::Json).unwrap_err();
    assert!(report.message.contains("radus") && pointed(&report).contains("radus"), "{report:?}");
    let report = parse(&source(&json[..json.len() / 2]), Syntax::Json).unwrap_err();
    assert!(report.message.contains("EOF"), "{report}");
}

#[test]
fn problems_are_found_in_both_texts() {
    let bad = SMALL.replace("radius = 1", "radius = -1.5").replace("bounds = [-2, 2, -2, 2]", "bounds = [2, 2, 0, 1]");
    let scene = parse(&source(&bad), Syntax::Toml).unwrap();
    let problems = snell::scene::validate(&scene).unwrap_err();
    assert_eq!(problems.len(), 2, "{problems:?}");
    let json = to_text(&scene, Syntax::Json).unwrap();
    for (text, syntax) in [(bad.as_str(), Syntax::Toml), (json.as_str(), Syntax::Json)] {
        let texts: Vec<_> = problems
            .iter()
            .map(|p| pointed(&report(p, &source(text), syntax)).replace(char::is_whitespace, ""))
            .collect();
        assert!(texts[0].starts_with("[2") && texts[1] == "-1.5", "{texts:?}");
    }
}

#[test]
fn set_changes_one_value_and_nothing_else() {
    let before = parse(&source(SMALL), Syntax::Toml).unwrap();
    let change = |change: &str| {
        let mut scene = before.clone();
        let place = set(&mut scene, change).unwrap();
        (scene, place)
    };
    let mut expected = before.clone();
    expected.materials["glass"].eta = 2.42;
    assert_eq!(change("material.glass.eta=2.42"), (expected, ["material", "glass", "eta"].map(Step::from).to_vec()));
    let mut expected = before.clone();
    expected.spheres[0].radius = 3.0;
    let place = vec![Step::from("sphere"), Step::from(0), Step::from("radius")];
    assert_eq!(change("sphere.ball.radius = 3"), (expected.clone(), place.clone()));
    assert_eq!(change("sphere.1.radius=3.0"), (expected, place));
    let mut expected = before.clone();
    expected.camera.eye = [1.0, 2.0, 3.0];
    assert_eq!(change("camera.eye=[1, 2, 3]").0, expected);
    expected.camera.eye = [0.0, 0.0, 7.0];
    assert_eq!(change("camera.eye.3=7"), (expected, vec![Step::from("camera"), Step::from("eye"), Step::from(2)]));
    let mut expected = before.clone();
    expected.render.shadows = Some(snell::scene::Shadows::Off);
    assert_eq!(change("render.shadows=off").0, expected);
    let mut expected = before.clone();
    expected.ambient = snell::film::Rgb::gray(0.5);
    assert_eq!(change("ambient=0.5").0, expected);
    // Whole tables, new ones, and lists.
    let mut expected = before.clone();
    expected.materials.insert("new".to_owned(), snell::scene::Material { eta: 1.5, ..Default::default() });
    assert_eq!(change("material.new={ eta = 1.5 }").0, expected);
    let mut expected = before.clone();
    expected.lights[0] = snell::scene::Light::at([1.0, 2.0, 3.0], snell::film::Rgb::gray(1.0));
    assert_eq!(change("light.lamp={ position = [1, 2, 3], color = 1 }").0, expected);
    let mut expected = before.clone();
    expected.spheres.clear();
    assert_eq!(change("sphere=[]").0, expected);
}

#[test]
fn set_reaches_quoted_names() {
    let mut scene = parse(&source(&SMALL.replace("[material.glass]", "[material.\"a.b=c\"]")), Syntax::Toml).unwrap();
    set(&mut scene, "material.\"a.b=c\".kd=0.5").unwrap();
    assert_eq!(scene.materials["a.b=c"].kd.r, 0.5);
}

#[test]
fn set_refuses_what_would_be_ignored() {
    for (change, message, help) in [
        ("material.glas.eta=2", "no `material.glas`", "did you mean `glass`"),
        ("sphere.cube.radius=2", "no `sphere.cube`", "Known here: ball"),
        ("sphere.0.radius=2", "no `sphere.0`", "Known here: ball"),
        ("sphere.radius=2", "is a list", "sphere.1.radius"),
        ("plane.1.size=2", "no `plane.1`", "there are none"),
        ("camera.eye.x=2", "no `camera.eye.x`", "3 elements"),
        ("camera.eye.4=2", "no `camera.eye.4`", "3 elements"),
        ("camera.near.x=2", "no keys", ""),
        ("materiel.glass.eta=2", "no `materiel`", "did you mean `material`"),
        ("material.glass.etta=2", "unknown key `etta`", "did you mean `eta`"),
        ("material.glass.eta=big", "invalid type", ""),
        ("render.integrator=whited", "unknown value `whited`", "did you mean `whitted`"),
        ("material.glass=0.5", "is a table", "{ kd"),
        ("sphere=[1]", "list of tables", ""),
        ("material.glass.eta", "no `=`", ""),
        ("..=1", "no key", ""),
    ] {
        let mut scene = parse(&source(SMALL), Syntax::Toml).unwrap();
        let before = scene.clone();
        let report = set(&mut scene, change).unwrap_err();
        assert!(report.message.contains(message), "{change}: {report}");
        assert!(report.help.clone().unwrap_or_default().contains(help), "{change}: {report:?}");
        assert_eq!(pointed(&report), change);
        assert_eq!(scene, before, "{change}");
    }
}

#[test]
fn one_of_many_elements_is_changed() {
    let mut scene = parse(&source(SMALL), Syntax::Toml).unwrap();
    scene.spheres = vec![scene.spheres[0].clone(); 300_000];
    set(&mut scene, "sphere.299999.radius=2").unwrap();
    set(&mut scene, "camera.near=-4").unwrap();
    assert!((scene.spheres[299_998].radius, scene.spheres.len(), scene.camera.near) == (2.0, 300_000, Some(-4.0)));
}

#[test]
fn the_scene_in_the_documentation_is_one() {
    let page = include_str!("../../../../docs/scenes.md");
    let text = page.split("```toml").nth(1).and_then(|t| t.split("```").next()).unwrap();
    let scene = parse(&source(text), Syntax::Toml).unwrap();
    assert_eq!((scene.spheres.len(), scene.meshes.len(), scene.lights.len()), (1, 2, 3));
    assert_eq!(snell::scene::validate(&scene).unwrap(), []);
}

mod properties {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        /// Whatever a text says, reading it ends with a scene or a report whose place lies within the text.
        #[test]
        fn no_text_breaks_the_reader(at in 0..SMALL.len(), cut in 0usize..20, insert in "\\PC{0,8}") {
            let end = (at + cut).min(SMALL.len());
            let text = format!("{}{insert}{}", &SMALL[..at], &SMALL[end..]);
            for syntax in [Syntax::Toml, Syntax::Json] {
                match parse(&source(&text), syntax) {
                    Ok(scene) => {
                        if let Err(problems) = snell::scene::validate(&scene) {
                            for p in problems {
                                let _ = report(&p, &source(&text), syntax);
                            }
                        }
                    }
                    Err(report) => {
                        let (source, range) = report.place.clone().unwrap();
                        prop_assert!(source.text.get(range).is_some());
                    }
                }
            }
        }

        #[test]
        fn no_change_breaks_set(change in "[a-z0-9.=\\[\\] ]{0,24}") {
            let _ = set(&mut parse(&source(SMALL), Syntax::Toml).unwrap(), &change);
        }
    }
}

#[test]
fn a_scene_is_written_for_people() {
    let text = to_text(&parse(&source(SMALL), Syntax::Toml).unwrap(), Syntax::Toml).unwrap();
    for line in
        ["[camera]", "[[light]]", "[material.glass]", "[[sphere]]", "[render]", "eye = [0.0, 0.0, 10.0]", "color = 0.5"]
    {
        assert!(text.lines().any(|l| l == line), "`{line}` is missing in\n{text}");
    }
    let mesh = SMALL.to_owned()
        + "[[mesh]]\nfile = 'a.obj'\ntransform = [{ scale = [1, 2, 3] }, { rotate = { axis = [1, 0, 0], degrees = 9 } }]\n";
    let scene = parse(&source(&mesh), Syntax::Toml).unwrap();
    let text = to_text(&scene, Syntax::Toml).unwrap();
    assert!(text.lines().any(|l| l.starts_with("transform = [{ scale = [1.0, 2.0, 3.0] }, { rotate")), "{text}");
    assert_eq!(parse(&source(&text), Syntax::Toml).unwrap(), scene);
}
