//! Explanations: what they say adds up, to the bit, and what they leave open is bounded.

#![allow(clippy::unwrap_used, reason = "a test that cannot go on fails")]

mod common;

use common::leaves;
use snell::explain::{Ending, Explanation, Path, channels, explain, find, hits, layers};
use snell::film::{Crop, Rgb};
use snell::render::{Options, Settings, render, trace_pixel};
use snell::scene::{Integrator, Scene, Shadows};
use snell::world::{CompiledScene, World};
use snell_formats::builtin::SCENES;
use snell_formats::{LoadOptions, load};
use snell_test_scenes::glass;
use std::collections::BTreeMap;

/// All built-in scenes of a group at this size, in both models of light.
fn scenes(group: &str, size: u32) -> Vec<(String, Scene)> {
    let mut all = Vec::new();
    for (name, _) in SCENES.iter().filter(|(name, _)| name.starts_with(group)) {
        for integrator in [Integrator::Lecture, Integrator::Whitted] {
            let mut scene = load(name, &LoadOptions::default()).unwrap().into_scene();
            scene.render.size = [size, size];
            scene.render.integrator = integrator;
            // Some rays carry less in one model than in the other; what matters here is that all kinds are there.
            (scene.render.spp, scene.render.bands) = (scene.render.spp.min(2), scene.render.bands.min(4));
            if integrator == Integrator::Lecture && scene.render.shadows == Some(Shadows::Tinted) {
                scene.render.shadows = Some(Shadows::Opaque);
            }
            all.push((format!("{name}, {integrator:?}"), scene));
        }
    }
    all
}

fn pairs(samples: &[[f64; 3]], add: &impl Fn([f64; 3], [f64; 3]) -> [f64; 3]) -> [f64; 3] {
    if let [only] = samples {
        return *only;
    }
    let (left, right) = samples.split_at(samples.len() / 2);
    add(pairs(left, add), pairs(right, add))
}

/// The contributions of an explanation, folded as is written: within a sample one by one; the samples pairwise over aligned ranges
/// of powers of two, and the largest such ranges one by one; then the mean.
fn folded(explanation: &Explanation) -> [f64; 3] {
    let add = |a: [f64; 3], b: [f64; 3]| [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
    let sample =
        |nodes: &[snell::explain::ExplainedNode]| nodes.iter().fold([0.0; 3], |sum, n| add(sum, n.contribution));
    let samples: Vec<[f64; 3]> = explanation.samples.iter().map(|s| sample(&s.nodes)).collect();
    let (mut blocks, mut rest) = (Vec::new(), samples.as_slice());
    while !rest.is_empty() {
        let (block, after) = rest.split_at(1 << rest.len().ilog2());
        blocks.push(pairs(block, &add));
        rest = after;
    }
    blocks.into_iter().reduce(add).unwrap().map(|c| c / f64::from(explanation.spp))
}

fn adds_up(name: &str, scene: &Scene) {
    let compiled = CompiledScene::new(name, scene.clone()).unwrap();
    let film = render(compiled.world(), &compiled.settings(), &Options::default()).unwrap().film;
    let width = film.full_size[0];
    for (number, pixel) in (0u32..).zip(&film.pixels) {
        let (explanation, _) = explain(&compiled, number % width, number / width).unwrap();
        let bits = |c: [f64; 3]| c.map(f64::to_bits);
        assert_eq!(bits(folded(&explanation)), bits(pixel.to_array()), "{name}, pixel {number}");
        assert_eq!(bits(explanation.color), bits(pixel.to_array()));
    }
}

#[test]
fn every_pixel_of_the_lecture_adds_up() {
    for (name, scene) in scenes("lecture", 64) {
        adds_up(&name, &scene);
    }
}

#[test]
fn every_pixel_of_the_gallery_adds_up() {
    for (name, scene) in scenes("gallery", 48) {
        adds_up(&name, &scene);
    }
}

/// Thin panes, interfaces, patterns, spot lights, three samples; instances; glasses through each other; leaves with holes; the
/// course's models.
#[test]
fn every_pixel_of_hard_scenes_adds_up() {
    let course = |integrator| {
        let mut scene = load("lecture/default", &LoadOptions::default()).unwrap().into_scene();
        (scene.render.size, scene.render.integrator) = ([48, 48], integrator);
        scene
    };
    let mut all = vec![
        ("windows".to_owned(), glass::windows()),
        ("blocks".to_owned(), glass::blocks()),
        ("bubbles".to_owned(), glass::bubbles()),
        ("leaves".to_owned(), leaves()),
        ("course2018".to_owned(), course(Integrator::Course2018)),
        ("course2020".to_owned(), course(Integrator::Course2020)),
    ];
    for entry in std::fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/../../scenes/models")).unwrap() {
        let path = entry.unwrap().path();
        let mut scene = load(path.to_str().unwrap(), &LoadOptions::default()).unwrap().into_scene();
        (scene.render.size, scene.render.spp) = ([48, 48], 2);
        all.push((path.display().to_string(), scene));
    }
    assert!(all.len() == 11);
    for (name, scene) in all {
        adds_up(&name, &scene);
    }
}

/// What was not followed adds at most its bound: the same picture, ten levels deeper.
#[test]
fn the_bounds_hold_ten_levels_deeper() {
    let mut holes = leaves();
    holes.render.size = [16, 16];
    let shallow = scenes("lecture/default", 24).into_iter().chain(scenes("gallery", 16));
    let shallow = shallow.chain([("leaves".to_owned(), holes)]);
    for (name, mut scene) in shallow {
        (scene.render.max_depth, scene.render.min_throughput, scene.render.bands) = (2, 0.0, 3);
        let compiled = CompiledScene::new(name.as_str(), scene.clone()).unwrap();
        let mut deep = scene.clone();
        deep.render.max_depth = 12;
        let deeper = render(&World::new(&deep).unwrap(), &Settings::from(&deep), &Options::default()).unwrap().film;
        let width = compiled.world().camera.size[0];
        let mut used = 0.0f64;
        for (number, pixel) in (0u32..).zip(&deeper.pixels) {
            let (explanation, trace) = explain(&compiled, number % width, number / width).unwrap();
            let bounds = explanation.samples.iter().flat_map(|s| &s.nodes).filter_map(|n| n.bound);
            let open = bounds.fold([0.0; 3], |sum, b| [sum[0] + b[0], sum[1] + b[1], sum[2] + b[2]]);
            let missing = (*pixel - trace.radiance).to_array();
            for (missing, open) in missing.into_iter().zip(open) {
                let open = open / f64::from(scene.render.spp);
                // A few hundred additions of numbers up to 10.
                assert!(missing.abs() <= open + 1e-12, "{name}, pixel {number}: {missing} of {open}");
                used = used.max(if open > 0.0 { missing / open } else { 0.0 });
            }
        }
        // A bound that is a thousand times too large says nothing.
        assert!(used == 0.0 || used > 1e-3, "{name}: {used}");
    }
}

/// The strongest paths and the rest make the picture.
#[test]
fn layers_add_up_to_the_picture() {
    for (name, scene) in scenes("gallery/bubbles", 24).into_iter().chain(scenes("lecture/default", 32)) {
        let compiled = CompiledScene::new(name.as_str(), scene).unwrap();
        let settings = compiled.settings();
        let film = render(compiled.world(), &settings, &Options::default()).unwrap().film;
        let split = layers(&compiled, 5, &Options::default()).unwrap();
        assert_eq!(split.picture, film.pixels, "{name}");
        let left = split.rest.iter().any(|c| *c != Rgb::gray(0.0));
        // Bubbles have few paths in the lecture's model, which refracts only in spheres; the others have more than five.
        let few = name == "gallery/bubbles, Lecture";
        assert_eq!((split.layers.len() == 5, left), (!few, !few), "{name}");
        for (i, pixel) in film.pixels.iter().enumerate() {
            let all = split.layers.iter().map(|(_, pixels)| pixels[i]).chain([split.rest[i]]);
            let (sum, count) = all.fold((Rgb::gray(0.0), 0.0), |(sum, count), c| (sum + c, count + 1.0));
            let (width, i) = (film.width() as u32, i as u32);
            let trace = trace_pixel(compiled.world(), &settings, i % width, i / width).unwrap();
            let additions = count + trace.samples.iter().map(|s| s.nodes.len()).sum::<usize>() as f64;
            for (sum, pixel) in sum.to_array().into_iter().zip(pixel.to_array()) {
                // One ulp for each addition.
                assert!(
                    (sum - pixel).abs() <= additions * f64::EPSILON * pixel.abs().max(1.0),
                    "{name}: {sum} {pixel}"
                );
            }
        }
    }
}

#[test]
fn an_object_is_found_in_all_pixels_that_show_it() {
    let mut scene = load("lecture/default", &LoadOptions::default()).unwrap().into_scene();
    scene.render.size = [96, 96];
    let compiled = CompiledScene::new("lecture/default", scene).unwrap();
    let settings = compiled.settings();
    let found = find(&compiled, "green", &Options { threads: 2, ..Options::default() }).unwrap();
    let mut counts: BTreeMap<Path, u64> = BTreeMap::new();
    for number in 0..96 * 96 {
        let trace = trace_pixel(compiled.world(), &settings, number % 96, number / 96).unwrap();
        let tree = &trace.samples[0];
        let seen = (0..tree.nodes.len()).filter(|&n| tree.nodes[n].contribution != Rgb::gray(0.0));
        let mut paths: Vec<Path> =
            seen.map(|n| Path::of(&compiled, tree, n)).filter(|path| path.end == "green").collect();
        paths.sort();
        paths.dedup();
        let shown = found.mask[number as usize] > 0.0;
        assert_eq!(shown, !paths.is_empty(), "pixel {number}");
        for path in paths {
            *counts.entry(path).or_insert(0) += 1;
        }
    }
    assert_eq!(found.paths.iter().cloned().collect::<BTreeMap<_, _>>(), counts);
    let named = |text: &str| found.paths.iter().find(|(path, _)| path.to_string() == text).map(|(_, count)| *count);
    // Green is large, and small and upside down in the glass.
    let (direct, through) = (named("camera → green").unwrap(), named("camera → glass(refract) → green").unwrap());
    assert!(direct > 3 * through && through > 30, "{direct} directly, {through} through the glass");
}

/// What the channels say of a pixel is what its explanation says, also of a part of the picture; and ^C ends them.
#[test]
fn channels_agree_with_explanations() {
    for (name, scene) in scenes("lecture/default", 40).into_iter().chain(scenes("gallery/ice", 24)) {
        let compiled = CompiledScene::new(name.as_str(), scene).unwrap();
        let world = compiled.world();
        let part = Crop { x: 3, y: 5, width: 20, height: 17 };
        let (settings, options) = (compiled.settings(), Options { crop: Some(part), ..Options::default() });
        let (found, met) = (channels(world, &settings, &options).unwrap(), hits(world, &settings, &options).unwrap());
        let mut missed = 0;
        for i in 0..(20 * 17) as usize {
            let (x, y) = (3 + i as u32 % 20, 5 + i as u32 / 20);
            let (explanation, _) = explain(&compiled, x, y).unwrap();
            let nodes = explanation.samples.iter().flat_map(|s| &s.nodes);
            assert_eq!(met[i] as usize, nodes.filter(|n| n.hit.is_some()).count(), "{name}, pixel {x},{y}");
            let object = usize::try_from(found.object[i]).ok().map(|object| world.objects[object].name.as_str());
            let first = explanation.samples[0].nodes[0].hit.as_ref();
            assert_eq!(object, first.map(|hit| hit.object.as_str()), "{name}, pixel {x},{y}");
            assert_eq!(found.depth[i], first.map_or(f64::INFINITY, |hit| hit.t));
            assert_eq!(found.normal[i], first.map_or([0.0; 3], |hit| hit.normal));
            missed += u32::from(first.is_none());
        }
        assert!(missed < 20 * 17, "{name}: nothing is seen");
        let stop = std::sync::atomic::AtomicBool::new(true);
        assert_eq!(channels(world, &settings, &Options { cancel: Some(&stop), ..Options::default() }), None);
    }
}

/// In the middle of the lecture's picture: the sentence names what is there, and the light that is not.
#[test]
fn the_lectures_question_is_answered() {
    let scene = load("lecture/default", &LoadOptions::default()).unwrap().into_scene();
    let compiled = CompiledScene::new("lecture/default", scene).unwrap();
    let (found, _) = explain(&compiled, 190, 300).unwrap();
    let first = found.samples[0].nodes[0].hit.as_ref().unwrap();
    assert_eq!((first.object.as_str(), first.eta_before, first.eta_behind), ("glass", 1.0, 2.0));
    assert_eq!(
        found.sentence,
        "Green because 53 % of this pixel is the sphere `green`, seen through `glass` (in at 43.1° → 20.0°); 47 % is the \
         sphere `glass` itself."
    );
    // Snell's law at every surface, by the angles that are said.
    for hit in found.samples[0].nodes.iter().filter_map(|n| n.hit.as_ref()) {
        if let Some(out) = hit.angle_out {
            let sin = |degrees: f64| libm::sin(degrees.to_radians());
            // Angles from acos and asin lose half of their digits near 0 and 90 degrees.
            assert!((hit.eta_before * sin(hit.angle_in) - hit.eta_behind * sin(out)).abs() < 1e-7);
        }
    }
}

/// Whatever keeps a light away is named: with and without each blocker the diffuse light agrees with what is said.
#[test]
fn lights_are_on_or_someone_blocks_them() {
    let mut holes = leaves();
    holes.render.size = [40, 40];
    let all = scenes("lecture/default", 40).into_iter().chain(scenes("gallery/window", 40));
    for (name, scene) in all.chain([("leaves".to_owned(), holes)]) {
        let compiled = CompiledScene::new(name.as_str(), scene).unwrap();
        let mut blocked = 0;
        for number in 0..1600 {
            let (found, _) = explain(&compiled, number % 40, number / 40).unwrap();
            for node in found.samples.iter().flat_map(|s| &s.nodes) {
                for light in node.local.iter().flat_map(|local| &local.lights) {
                    let dark = light.transmittance == [0.0; 3];
                    let shows = node.contribution != [0.0; 3];
                    let missing = light.facing && dark && light.blocked_by.is_none() && shows;
                    assert!(!missing, "{name}, pixel {number}: {} is dark for no reason", light.name);
                    assert!(dark || light.blocked_by.is_none());
                    blocked += u32::from(light.blocked_by.is_some());
                }
                assert!(node.hit.is_some() || node.ended.is_some());
                assert_eq!(
                    node.bound.is_some(),
                    matches!(node.ended, Some(Ending::Depth | Ending::Threshold | Ending::Rays))
                );
            }
        }
        assert!(blocked > 10, "{name}: {blocked}");
    }
}

/// The form that other programs read, version 1: these keys, and no others.
#[test]
fn the_json_form_has_these_keys() {
    let scene = load("gallery/prism", &LoadOptions::default()).unwrap().into_scene();
    let compiled = CompiledScene::new("gallery/prism", scene).unwrap();
    let (found, _) = explain(&compiled, 200, 240).unwrap();
    let value = serde_json::to_value(&found).unwrap();
    let keys = |value: &serde_json::Value| value.as_object().unwrap().keys().cloned().collect::<Vec<_>>().join(" ");
    assert_eq!(keys(&value), "color integrator pixel samples scene sentence size snell_ray_tree spp transfer");
    let node = &value["samples"][0]["nodes"][0];
    assert_eq!(
        keys(node),
        "band_nm bound contribution depth dir ended eta hit id kind local medium origin parent subtotal throughput"
    );
    assert_eq!(
        keys(&node["hit"]),
        "angle_in angle_out eta_before eta_behind material normal object point primitive t throughput total_reflection"
    );
}

/// What happens inside of an object belongs to its leg, also around another one in it.
#[test]
fn paths_know_what_is_in_what() {
    let text = r#"
snell = 1
background = 1
[render]
integrator = "whitted"
size = [3, 3]
[camera]
eye = [0.1, 0.2, 9]
look_at = [0, 0, 0]
up = [0, 1, 0]
bounds = [-0.1, 0.1, -0.1, 0.1]
near = -1
[material.glass]
ko = 0
eta = 1.5
[material.air]
ko = 0
eta = 1
priority = 1
[[sphere]]
name = "outer"
center = [0, 0, 0]
radius = 2
material = "glass"
[[sphere]]
name = "bubble (small)"
center = [0, 0, 0]
radius = 1
material = "air"
"#;
    let source = snell_formats::Source::new("s.toml", text);
    let options = LoadOptions::default();
    let kind = load::Kind::Toml;
    let scene = load::load_text(source, kind, std::path::Path::new("."), &options).unwrap().into_scene();
    let compiled = CompiledScene::new("inside", scene).unwrap();
    let trace = trace_pixel(compiled.world(), &compiled.settings(), 1, 1).unwrap();
    let tree = &trace.samples[0];
    let strongest =
        (0..tree.nodes.len()).max_by(|&a, &b| tree.nodes[a].contribution.g.total_cmp(&tree.nodes[b].contribution.g));
    let path = Path::of(&compiled, tree, strongest.unwrap());
    assert_eq!(path.to_string(), "camera → outer(refract) → bubble (small)(refract) → sky");
    assert_eq!(Path::parse(&path.to_string()).as_ref(), Ok(&path));
    let all: Vec<String> = (0..tree.nodes.len())
        .filter(|&n| tree.nodes[n].contribution.g > 0.0)
        .map(|n| Path::of(&compiled, tree, n).to_string())
        .collect();
    // Against the outer wall from inside, behind the bubble: within the outer leg.
    assert!(
        all.contains(
            &"camera → outer(refract, 1 inside) → bubble (small)(refract) → bubble (small)(refract) → sky".to_owned()
        ),
        "{all:#?}"
    );
}
