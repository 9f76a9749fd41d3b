//! No default depends on the unit of length: what was small, large or around the eye is drawn right, and a scene is the same
//! picture in metres, millimetres and light years.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod common;

use common::{close, picture, traced};
use snell::film::Rgb;
use snell::geometry::Vec3;
use snell::optics::absorption::transmittance;
use snell::scene::{Integrator, Scene, WarningCode};
use snell::world::World;
use snell_formats::Source;
use snell_formats::load::{Kind, LoadOptions, load_text};
use snell_test_scenes::real_files::cases;
use std::path::Path;

fn read(text: &str) -> Scene {
    load_text(Source::new("scene.toml", text), Kind::Toml, Path::new("."), &LoadOptions::default())
        .unwrap()
        .into_scene()
}

/// A scene of `cases/scale`, which came back empty or wrong once; `None` where these files are not.
fn case(name: &str) -> Option<Scene> {
    let path = cases()?.join("scale").join(name);
    Some(read(&std::fs::read_to_string(path).unwrap()))
}

/// Unpolarised reflectance from the angles on both sides (Fresnel); 1 where no angle behind exists.
fn reflectance(theta_i: f64, eta: f64) -> f64 {
    let sin_t = libm::sin(theta_i) / eta;
    if sin_t > 1.0 {
        return 1.0;
    }
    let (i, t) = (libm::cos(theta_i), (1.0 - sin_t * sin_t).sqrt());
    let (s, p) = ((i - eta * t) / (i + eta * t), (t - eta * i) / (t + eta * i));
    f64::midpoint(s * s, p * p)
}

/// A ball of 8 cm, half a metre away: which rays meet it is known, and by which angle it bends them.
#[test]
fn a_ball_of_8_cm_is_seen_whole_and_bends_light() {
    let Some(scene) = case("ball-of-8-cm.toml") else { return };
    let (eye, center, radius) = (Vec3::from(scene.camera.eye), Vec3::new(0.0, 0.05, 0.0), 0.04);
    let light = scene.background;
    let world = World::new(&scene).unwrap();
    let mut met = 0;
    for (x, y) in (0..64 * 64).map(|i| (i % 64, i / 64)) {
        let (radiance, tree) = traced(&scene, &world, x, y);
        let first = &tree.nodes[0];
        assert_eq!(first.origin, eye);
        let impact = (center - eye).cross(first.dir).length() / radius;
        // No ray passes within some roundings of the rim.
        assert!((impact - 1.0).abs() > 1e-12);
        assert_eq!(first.hit.is_some(), impact < 1.0, "{x},{y}");
        // Glass that takes nothing away, in an even light, is invisible but for what was not followed.
        assert!(close(radiance + tree.lost * light, light, 1e-12), "{x},{y}: {radiance:?}");
        let Some(hit) = &first.hit else { continue };
        met += 1;
        // v − √(r² − b²) from the eye on, each to a few roundings of 0.5 in a root of at least 1e-3.
        let v = (center - eye).dot(first.dir);
        let t = v - radius * (1.0 - impact * impact).sqrt();
        assert!((hit.t - t).abs() < 1e-12, "{x},{y}: {} {t}", hit.t);
        // Snell's law at the entry and, under the same angle, at the exit: it turns by 2(θ − θ_t).
        let (_, out, count) = common::straight_through(&tree);
        let turn = 2.0 * (libm::asin(impact) - libm::asin(impact / 1.5));
        let found = libm::atan2(first.dir.cross(out).length(), first.dir.dot(out));
        // An arc sine near 1 keeps half of the digits.
        assert!(count == 2 && (found - turn).abs() < 1e-7, "{x},{y}: {found} {turn}");
    }
    // The disc under sin ψ = r/D on a plane whose 63 steps span 2·tan 15°: its area in pixels, and at most its circle off.
    let sin = radius / (center - eye).length();
    let across = sin / (1.0 - sin * sin).sqrt() / libm::tan(15f64.to_radians()) * 31.5;
    let (area, circle) = (std::f64::consts::PI * across * across, 2.0 * std::f64::consts::PI * across);
    assert!((f64::from(met) - area).abs() < circle, "{met} {area}");
}

/// An eye in the middle of a ball of water in white light: it absorbs from the eye on. Each ray goes along a diameter; of what
/// arrives at the wall `1 − R` is white from outside, `R` comes from the other side of the ball:
/// `τ(1 − R)(1 + Rτ² + …) = τ(1 − R)/(1 − Rτ²)`, with `τ` over the radius.
#[test]
fn an_eye_in_a_bowl_sees_through_the_water_around_it() {
    let Some(scene) = case("eye-in-a-bowl.toml") else { return };
    let tau = |sigma_a: f64| transmittance(sigma_a, 0.9);
    let r = (0.333f64 / 2.333) * (0.333 / 2.333);
    let seen = |tau: f64| tau * (1.0 - r) / (1.0 - r * tau * tau);
    let expected = Rgb::new(seen(tau(0.5)), seen(tau(0.2)), seen(tau(0.05)));
    // Some sixty terms, each of a few roundings, in a sum below 1.
    assert!(picture(&scene).pixels.iter().all(|&pixel| close(pixel, expected, 1e-13)));
}

/// Half a unit under water: Snell's window. Within 48.6° of the zenith the white sky, less what Fresnel sends back to the black
/// floor; beyond, only that floor.
#[test]
fn a_diver_sees_snells_window() {
    let Some(scene) = case("diver.toml") else { return };
    let film = picture(&scene);
    let (critical, step) = (libm::asin(1.0 / 1.333), libm::tan(60f64.to_radians()) / 60.0);
    let mut within = 0;
    for (i, pixel) in film.pixels.iter().enumerate() {
        let (x, y) = ((i % 121) as f64 - 60.0, (i / 121) as f64 - 60.0);
        let theta = libm::atan(libm::hypot(x, y) * step);
        // One over the root of the distance to the critical angle is how fast the reflectance changes there.
        assert!((theta - critical).abs() > 1e-7);
        within += usize::from(theta < critical);
        let expected = 1.0 - reflectance(theta, 1.0 / 1.333);
        assert!(close(*pixel, Rgb::gray(expected), 1e-11), "{x},{y}: {pixel:?} {expected}");
    }
    assert!(within > 0 && within < film.pixels.len() && film.pixels[60 * 121 + 60].r > 0.97);
}

/// What every scene below has; `~` stands before a length, `/` before what is per length.
const ROOM: &str = r#"
eye = [~0.31, ~1.27, ~6.13]
look_at = [~0.07, ~0.42, ~0.03]
up = [0, 1, 0]
[[light]]
position = [~3, ~5.2, ~4.1]
color = 0.8
[material.glass]
ko = 0
eta = 1.5
[material.water]
ko = 0
eta = 1.333
[material.red]
ka = [0.8, 0.1, 0.1]
kd = [0.8, 0.2, 0.1]
ks = 0.3
[material.mirror]
kr = 0.9
ks = 0.4
[[plane]]
name = "floor"
center = [0, ~-0.93, 0]
size = [~9, ~9]
material = "board"
[material.board]
ka = 0.8
kd = 0.7
texture = "board"
[texture.board]
checker = [[0.9, 0.8, 0.7], [0.2, 0.3, 0.5]]
repeat = [8, 8]
"#;

const WHITTED: &str = "integrator = 'whitted'";
const FOV: &str = "fov = 40";

/// One scene for each shape and feature: its name, what is special of its settings and its camera, and its objects. Everything
/// that may be left out is.
const SCENES: &[(&str, &str, &str, &str)] = &[
    ("sphere", WHITTED, FOV, "[[sphere]]\nname = 'thing'\ncenter = [0, ~0.4, 0]\nradius = ~1.1\nmaterial = 'glass'"),
    ("mirror sphere", WHITTED, FOV, "[[sphere]]\nname = 'thing'\ncenter = [0, ~0.4, 0]\nradius = ~1.1\nmaterial = 'mirror'"),
    ("mesh", WHITTED, FOV, "[[mesh]]\nname = 'thing'\nmaterial = 'glass'
vertices = [[~-1, ~-0.5, ~1], [~1.2, ~-0.5, ~1], [~0.1, ~-0.5, ~-1.1], [~0.05, ~1.4, ~0.1]]
faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]"),
    ("smooth mesh", WHITTED, FOV, "[[mesh]]\nname = 'thing'\nmaterial = 'red'\nsmooth_angle = 120
vertices = [[~-1, ~-0.5, ~1], [~1.2, ~-0.5, ~1], [~0.1, ~-0.5, ~-1.1], [~0.05, ~1.4, ~0.1]]
faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]"),
    ("open mesh", WHITTED, FOV, "[[mesh]]\nname = 'thing'\nmaterial = 'glass'\nopen = 'fill'
vertices = [[~-1, ~-0.5, ~1], [~1.2, ~-0.5, ~1], [~0.1, ~-0.5, ~-1.1], [~0.05, ~1.4, ~0.1]]
faces = [[0, 1, 3], [1, 2, 3], [2, 0, 3]]"),
    ("plane", WHITTED, FOV, "[[plane]]\nname = 'thing'\nnormal = [0.1, 0.3, 1]\nsize = [~2, ~1.7]\nmaterial = 'red'"),
    ("box", WHITTED, FOV, "[[box]]\nname = 'thing'\nmin = [~-0.9, ~-0.6, ~-0.8]\nmax = [~0.8, ~1.1, ~0.7]\nmaterial = 'glass'"),
    ("lathe", WHITTED, FOV, "[[lathe]]\nname = 'thing'\nprofile = [[0, ~-0.5], [~0.9, ~-0.3], [~0.6, ~0.8], [0, ~1.1]]\nmaterial = 'glass'"),
    ("lathe, smooth", WHITTED, FOV, "[[lathe]]\nname = 'thing'\nsmooth_angle = 60
profile = [[0, ~-0.5], [~0.9, ~-0.3], [~0.6, ~0.8], [0, ~1.1]]\nmaterial = 'red'"),
    ("instances", WHITTED, FOV, "[[box]]\nname = 'thing'\nmin = [~-0.4, ~-0.4, ~-0.4]\nmax = [~0.4, ~0.5, ~0.3]\nmaterial = 'glass'
instances = [[{ move = [~-0.9, ~0.2, 0] }], [{ rotate = { axis = [0.2, 1, 0], degrees = 40 } }, { move = [~0.8, ~0.6, ~0.1] }]]"),
    ("transform", WHITTED, FOV, "[[lathe]]\nname = 'thing'\nprofile = [[0, ~-0.5], [~0.7, 0], [0, ~0.6]]\nmaterial = 'red'
transform = [{ scale = [1.5, 0.8, 1.2] }, { rotate = { axis = [1, 0.3, 0], degrees = 70 } }, { move = [~0.1, ~0.5, 0] }]
[[sphere]]\ncenter = [~0.2, 0, 0]\nradius = ~0.3\nmaterial = 'glass'
transform = [{ scale = [2, 2, 2] }, { move = [~-1, ~0.4, ~1] }]"),
    ("thin pane", WHITTED, FOV, "[material.pane]\nko = 0\neta = 1.5\nthickness = ~0.05\nsigma_a = [/0.9, /0.5, /0.1]
[[plane]]\nname = 'thing'\ncenter = [0, ~0.3, ~0.6]\nnormal = [0.4, 0.2, 1]\nsize = [~2, ~2.2]\nmaterial = 'pane'"),
    ("interfaces", WHITTED, FOV, "[[plane]]\nname = 'thing'\ncenter = [0, ~-0.4, 0]\nsize = [~9, ~9]\nmaterial = 'water'\ninside = 'water'
[[mesh]]\nmaterial = 'glass'\ninside = 'glass'\noutside = 'water'
vertices = [[~-2, ~-0.7, ~2], [~2, ~-0.7, ~2], [~2, ~-0.7, ~-2], [~-2, ~-0.7, ~-2]]\nfaces = [[0, 1, 2], [0, 2, 3]]"),
    ("textures", WHITTED, FOV, "[[sphere]]\nname = 'thing'\ncenter = [~-0.7, ~0.3, 0]\nradius = ~0.8\nmaterial = 'board'
[[box]]\nmin = [~0.3, ~-0.7, ~-0.3]\nmax = [~1.3, ~0.7, ~0.6]\nmaterial = 'board'
[[lathe]]\nprofile = [[0, ~0.8], [~0.3, ~0.9], [0, ~1.7]]\nmaterial = 'board'"),
    ("sky", WHITTED, FOV, "[sky]\nhorizon = [0.9, 0.8, 0.7]\nzenith = [0.2, 0.4, 0.9]
[[sphere]]\nname = 'thing'\ncenter = [0, ~0.4, 0]\nradius = ~1.1\nmaterial = 'glass'"),
    ("lights", WHITTED, FOV, "[[light]]\nposition = [~-2, ~4, ~3]\ntarget = [0, ~0.2, 0]\ncone = 14\nedge = 4\ncolor = [0.2, 0.9, 0.4]
[[light]]\ndirection = [-1, 2, 1]\ncolor = [0.3, 0.2, 0.6]
[[sphere]]\nname = 'thing'\ncenter = [~-0.2, ~0.1, 0]\nradius = ~0.9\nmaterial = 'red'"),
    ("emission", WHITTED, FOV, "[material.lamp]\nemission = [2, 1.5, 1]
[[sphere]]\nname = 'thing'\ncenter = [~-0.2, ~0.1, 0]\nradius = ~0.9\nmaterial = 'lamp'"),
    ("absorption", WHITTED, FOV, "[material.tea]\nko = 0\neta = 1.333\nsigma_a = [/0.1, /0.4, /0.9]
[material.bottle]\nko = 0\neta = 1.5\nattenuation_color = [0.5, 0.9, 0.6]\nattenuation_distance = ~0.8
[[sphere]]\nname = 'thing'\ncenter = [~-0.7, ~0.3, 0]\nradius = ~0.8\nmaterial = 'tea'
[[box]]\nmin = [~0.3, ~-0.7, ~-0.3]\nmax = [~1.3, ~0.7, ~0.6]\nmaterial = 'bottle'"),
    ("dispersion", WHITTED, FOV, "[material.flint]\nko = 0\nglass = 'SF10'
[[mesh]]\nname = 'thing'\nmaterial = 'flint'
vertices = [[~-1, ~-0.5, ~1], [~1.2, ~-0.5, ~1], [~0.1, ~-0.5, ~-1.1], [~0.05, ~1.4, ~0.1]]
faces = [[0, 2, 1], [0, 1, 3], [1, 2, 3], [2, 0, 3]]"),
    ("overlap and bubble", WHITTED, FOV, "[material.ice]\nko = 0\neta = 1.31\npriority = 1
[[sphere]]\nname = 'thing'\ncenter = [0, ~0.3, 0]\nradius = ~1.2\nmaterial = 'water'
[[box]]\nmin = [~-0.3, ~0.5, ~-0.4]\nmax = [~0.6, ~1.9, ~0.5]\nmaterial = 'ice'
[material.air]\nko = 0\npriority = 2
[[sphere]]\ncenter = [~0.1, ~-0.2, ~0.4]\nradius = ~0.3\nmaterial = 'air'"),
    ("touching", WHITTED, FOV, "[[box]]\nname = 'thing'\nmin = [~-1, ~-0.93, ~-0.6]\nmax = [0, ~0.7, ~0.6]\nmaterial = 'glass'
[[box]]\nmin = [0, ~-0.93, ~-0.6]\nmax = [~1, ~0.7, ~0.6]\nmaterial = 'water'"),
    ("eye in glass", WHITTED, FOV, "[[sphere]]\nname = 'thing'\ncenter = [~0.4, ~1.2, ~6]\nradius = ~1.3\nmaterial = 'water'
[[sphere]]\ncenter = [0, ~0.4, 0]\nradius = ~0.9\nmaterial = 'red'"),
    ("samples", "integrator = 'whitted'\nspp = 4", FOV, "[[sphere]]\nname = 'thing'\ncenter = [0, ~0.4, 0]\nradius = ~1.1\nmaterial = 'red'"),
    ("bounds", WHITTED, "bounds = [~-0.9, ~0.8, ~-0.7, ~0.9]\nnear = ~-2.2", "[[sphere]]\nname = 'thing'\ncenter = [0, ~0.4, 0]\nradius = ~1.1\nmaterial = 'glass'"),
    ("lecture", "integrator = 'lecture'", FOV, "[[sphere]]\nname = 'thing'\ncenter = [0, ~0.4, 0]\nradius = ~1.1\nmaterial = 'blend'
[material.blend]\nka = 0.3\nkr = 0.8\nko = 0.4\neta = 1.6
[[sphere]]\ncenter = [~0.9, ~0.2, ~-1.4]\nradius = ~0.8\nmaterial = 'red'"),
    ("course2018", "integrator = 'course2018'", FOV, "[[sphere]]\nname = 'thing'\ncenter = [0, ~0.4, 0]\nradius = ~1.1\nmaterial = 'mirror'
[[sphere]]\ncenter = [~0.9, ~0.2, ~1.4]\nradius = ~0.5\nmaterial = 'red'"),
    ("course2020", "integrator = 'course2020'", FOV, "[[sphere]]\nname = 'thing'\ncenter = [0, ~0.4, 0]\nradius = ~1.1\nmaterial = 'blend'
[material.blend]\nka = 0.3\nkr = 0.7\neta = 1.6
[[sphere]]\ncenter = [~0.9, ~0.2, ~-1.4]\nradius = ~0.8\nmaterial = 'red'"),
];

/// A scene with all its lengths times a factor.
fn at_scale((_, settings, view, objects): (&str, &str, &str, &str), factor: f64) -> Scene {
    let head = format!("snell = 1\nambient = 0.3\n[render]\n{settings}\nsize = [64, 64]\n[camera]\n{view}");
    let text = format!("{head}{ROOM}{objects}");
    let (mut scaled, mut rest) = (String::new(), text.as_str());
    while let Some(at) = rest.find(['~', '/']) {
        let (before, marked) = rest.split_at(at);
        let after = &marked[1..];
        let end = after.find(|c: char| !"0123456789.-".contains(c)).unwrap_or(after.len());
        let number: f64 = after[..end].parse().unwrap();
        let number = if marked.starts_with('~') { number * factor } else { number / factor };
        scaled = scaled + before + &format!("{number:?}");
        rest = &after[end..];
    }
    read(&(scaled + rest))
}

/// Is `thing` what at least a twentieth of the picture shows first, so that there is something to compare?
fn shows_the_thing(scene: &Scene) -> bool {
    let world = World::new(scene).unwrap();
    let shown = (0..64 * 64).filter(|i| {
        let pixel = snell::render::trace_pixel(&world, &snell::render::Settings::from(scene), i % 64, i / 64).unwrap();
        let hit = pixel.samples[0].nodes[0].hit.as_ref();
        hit.and_then(|hit| world.object_of(hit.primitive)).is_some_and(|object| object.name == "thing")
    });
    shown.count() >= 64 * 64 / 20
}

/// By what all lengths are multiplied. In the lecture's models no hit counts that is nearer than its own 1e-5, and a scene of some
/// units must not shrink to that.
fn factors(scene: &Scene) -> &'static [f64] {
    let all = &[1e-15, 1e-12, 1e-9, 1e-6, 1e-3, 1e3, 1e6, 1e9];
    if scene.render.integrator == Integrator::Whitted { all } else { &all[4..] }
}

#[test]
fn every_shape_and_feature_looks_the_same_at_any_scale() {
    let mut others = Vec::new();
    for &own in SCENES {
        let (name, scene) = (own.0, at_scale(own, 1.0));
        assert!(shows_the_thing(&scene), "{name}");
        let expected = picture(&scene);
        for factor in factors(&scene) {
            let found = picture(&at_scale(own, *factor));
            let pixels = (0..expected.pixels.len()).filter(|&i| !close(found.pixels[i], expected.pixels[i], 1e-9));
            others.extend(pixels.map(|i| format!("{name}, times {factor:e}: pixel {},{}", i % 64, i / 64)));
        }
    }
    // Roundings may put a ray on the other side of a silhouette or an edge. A handful of nearly a million pixels.
    assert!(others.len() <= 5, "{others:#?}");
}

#[test]
fn every_shape_and_feature_has_the_same_bits_at_any_power_of_two() {
    for &own in SCENES {
        let scene = at_scale(own, 1.0);
        if scene.render.integrator != Integrator::Whitted {
            continue;
        }
        let expected = picture(&scene);
        for exponent in [-40, -20, 20, 30] {
            let found = picture(&at_scale(own, libm::exp2(f64::from(exponent))));
            assert!(found.pixels == expected.pixels, "{}, times 2^{exponent}", own.0);
        }
    }
}

/// In the lecture's models rays start on the image plane, and what stands before it is said; in `whitted` nothing is lost.
#[test]
fn what_stands_before_the_image_plane_is_said() {
    let balls = "[[sphere]]\nname = 'far'\ncenter = [0, ~0.4, 0]\nradius = ~1\nmaterial = 'red'
[[sphere]]\nname = 'near'\ncenter = [~0.26, ~1.1, ~5]\nradius = ~0.4\nmaterial = 'red'
[[box]]\nname = 'beside'\nmin = [~3, ~1, ~5.6]\nmax = [~4, ~2, ~5.9]\nmaterial = 'red'";
    let warned = |integrator: &str, near: &str, objects: &str, factor: f64| {
        let settings = format!("integrator = '{integrator}'");
        let scene = at_scale(("", &settings, &format!("{FOV}\n{near}"), objects), factor);
        World::new(&scene).unwrap().warnings
    };
    for factor in [1e-9, 1.0, 1e9] {
        for integrator in ["lecture", "course2018", "course2020"] {
            // A tenth of the way is 0.62, and the near ball begins at 0.75.
            assert_eq!(warned(integrator, "", balls, factor), []);
            for near in ["near = ~-1", "near = ~-3", "near = ~-5.3"] {
                let found = warned(integrator, near, balls, factor);
                let names = if near.ends_with("5.3") { "of `far`, `near`, `floor`, which" } else { "of `near`, which" };
                assert!(found.len() == 1 && found[0].code == WarningCode::BeforeImagePlane, "{found:?}");
                assert!(found[0].message.contains(names), "{}", found[0].message);
            }
        }
        assert_eq!(warned("whitted", "near = ~-5.3", balls, factor), []);
    }
    let ball =
        |i| format!("[[sphere]]\nname = 'b{i}'\ncenter = [~0.26, ~1.1, ~5]\nradius = ~0.{i}\nmaterial = 'red'\n");
    let many = [1, 2, 3, 4, 5].map(ball).concat();
    let found = warned("lecture", "near = ~-2", &many, 1.0);
    assert!(found[0].message.contains("`b1`, `b2`, `b3` and 2 more"), "{}", found[0].message);
    // Meshes in several places are looked at where they stand.
    let placed = "[[box]]\nname = 'placed'\nmin = [~-0.2, ~-0.2, ~-0.2]\nmax = [~0.2, ~0.2, ~0.2]\nmaterial = 'red'
instances = [[{ move = [0, 0, 0] }], [{ move = [~0.26, ~1.1, ~5] }]]";
    assert_eq!(warned("lecture", "near = ~-2", placed, 1.0).len(), 1);
    assert_eq!(warned("lecture", "near = ~-0.5", placed, 1.0), []);
}

/// Bounds are measured on the image plane, so its place must be known; with an angle of view it need not be.
#[test]
fn bounds_need_an_image_plane() {
    for integrator in ["lecture", "whitted"] {
        let settings = format!("integrator = '{integrator}'");
        let scene = at_scale(("", &settings, "bounds = [-1, 1, -1, 1]", ""), 1.0);
        let problems = World::new(&scene).unwrap_err();
        assert_eq!(
            problems[0].to_string(),
            "camera.near: `bounds` are measured on the image plane, and nothing says where that is"
        );
        assert!(problems.len() == 1 && problems[0].help.as_ref().is_some_and(|help| help.contains("near = -")));
        World::new(&at_scale(("", &settings, FOV, ""), 1.0)).unwrap();
    }
}
