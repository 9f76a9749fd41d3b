//! Does one thing on one thread, for callgrind to count the instructions of; without arguments it prints what there is to
//! count, one command a line. `counts.py` runs it.
//!
//! | command | what is counted |
//! | --- | --- |
//! | `read SCENE` | from the text of a built-in scene to the scene |
//! | `build SCENE` | from a scene to its world, the tree above all |
//! | `render SCENE LANES` | from a world to a picture |

#![allow(clippy::print_stdout, reason = "its answers go there")]

use snell::geometry::bvh::Quality;
use snell::render::{LaneWidth, Options, Settings, render};
use snell::scene::{Integrator, Scene};
use snell::world::World;
use snell_bench::{knot, scenes};
use snell_formats::builtin;
use snell_formats::scene_file::{Syntax, parse};
use snell_test_scenes::{at_size, crowd, glass, instances, lecture};
use std::hint::black_box;
use std::sync::Arc;

const READ: [&str; 1] = ["gallery/ice"];
const BUILT: [&str; 2] = ["gallery/ice", "knot"];
/// Every model of light and kind of shape, and shadows of the opaque and of glass; the smaller, the heavier.
const RENDERED: [&str; 11] = [
    "lecture/default",
    "instances",
    "knot",
    "crowd",
    "flake",
    "gallery/ball",
    "gallery/bubbles",
    "gallery/prism",
    "gallery/ice",
    "blocks",
    "windows",
];
/// Valgrind knows no wider instructions.
const LANES: [usize; 3] = [1, 2, 4];

fn scene(name: &str) -> Result<Scene, String> {
    Ok(match name {
        "lecture/default" => lecture(name, 256),
        "instances" => at_size(instances(0.0, true), 64),
        // 20 000 triangles, part mirrors, `course2018`.
        "knot" => scenes::knot_on_ground(Arc::new(knot::knot(200, 50, 0.45)), 96),
        "crowd" => at_size(crowd(Integrator::Course2020), 64),
        // 820 mirrors and nothing transparent in `whitted`.
        "flake" => {
            let mut scene = scenes::find("flake:3", 64)?;
            scene.render.integrator = Integrator::Whitted;
            scene
        }
        "gallery/ball" => lecture(name, 64),
        "gallery/bubbles" => lecture(name, 32),
        // 32 wavelengths.
        "gallery/prism" => lecture(name, 24),
        // Four samples a pixel.
        "gallery/ice" => lecture(name, 16),
        "blocks" => at_size(glass::blocks(), 32),
        "windows" => at_size(glass::windows(), 32),
        _ => return Err(format!("no scene is called `{name}` here; without arguments, all are listed")),
    })
}

fn main() -> Result<(), String> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    match *arguments.iter().map(String::as_str).collect::<Vec<_>>() {
        [] => list(),
        ["read", name] => {
            let text = builtin::find(name).map_err(|report| format!("{report:?}"))?;
            count_instructions_of(&mut || {
                parse(&text, Syntax::Toml).map(|scene| drop(black_box(scene))).map_err(|report| format!("{report:?}"))
            })?;
        }
        ["build", name] => {
            let scene = scene(name)?;
            count_instructions_of(&mut || world(&scene).map(|world| drop(black_box(world))))?;
        }
        ["render", name, lanes] => {
            let scene = scene(name)?;
            let world = world(&scene)?;
            let lanes = lanes.parse().ok().and_then(LaneWidth::of).ok_or("lanes are 1, 2, 4 or 8")?;
            let (settings, options) = (Settings::from(&scene), Options { threads: 1, lanes, ..Options::default() });
            count_instructions_of(&mut || {
                render(&world, &settings, &options)
                    .map(|picture| drop(black_box(picture)))
                    .map_err(|error| error.to_string())
            })?;
        }
        _ => return Err("not understood; see the top of bench-counts.rs".to_owned()),
    }
    Ok(())
}

fn world(scene: &Scene) -> Result<World, String> {
    World::build(scene, Quality::Good, 1).map_err(|problems| format!("{problems:?}"))
}

/// Callgrind counts while this function runs: `counts.py` finds it by its name, which no other function may contain.
#[inline(never)]
fn count_instructions_of(work: &mut dyn FnMut() -> Result<(), String>) -> Result<(), String> {
    black_box(work())
}

/// Prints what there is to count, each a command.
fn list() {
    for name in READ {
        println!("read {name}");
    }
    for name in BUILT {
        println!("build {name}");
    }
    // Without its instructions a width is computed as plain arrays, which says nothing about it.
    let widths = LANES.iter().filter(|&&lanes| lanes <= LaneWidth::best().numbers());
    for (name, lanes) in RENDERED.iter().flat_map(|name| widths.clone().map(move |lanes| (name, lanes))) {
        println!("render {name} {lanes}");
    }
}
