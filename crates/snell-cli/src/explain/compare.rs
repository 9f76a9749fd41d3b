//! `--set` and `--without`: the same pixel, before and after, branch by branch.

use super::{colored, known_object, pixel, settings};
use crate::args::ExplainArgs;
use crate::say::{self, OrFail, Outcome, SCENE};
use snell::explain::text::{head, mean, numbers, swatch};
use snell::explain::{Explanation, Names, Path, by_path};
use snell::film::Rgb;
use snell::render::trace_pixel;
use snell::scene::Scene;
use snell::world::World;
use snell_formats::load::Loaded;
use snell_formats::{LoadOptions, load};
use std::fmt::Write;

/// Compares a pixel of a scene, as explained, with that of the scene that `args` ask for.
pub fn run(before: &Explanation, world: &World, original: &Loaded, args: &ExplainArgs) -> Outcome {
    let [x, y] = before.pixel;
    let mut loaded = load(&args.scene, &LoadOptions::from(&args.reading)).or_fail(SCENE)?;
    settings(&mut loaded, args);
    if let Some(object) = &args.without {
        known_object(world, object)?;
        remove(&mut loaded.scene, object);
    }
    let changed = loaded.world().or_fail(SCENE)?;
    let after = pixel(&changed, &loaded, args, x, y)?;
    let mut text = head(before, colored());
    let without = args.without.as_ref().map(|object| format!("without {object}"));
    let changes: Vec<String> = args.reading.set.iter().map(|change| format!("with {change}")).chain(without).collect();
    let _ = writeln!(
        text,
        "\n{}:\n{}{}\n{}\n",
        changes.join(", "),
        swatch(after.color, after.transfer, colored()),
        numbers(after.color),
        after.sentence
    );
    text += &table(&paths(world, original, x, y), &paths(&changed, &loaded, x, y));
    say::print(&text)
}

/// Takes an object out of a scene.
fn remove(scene: &mut Scene, object: &str) {
    // What has no name keeps the one that its place in the list gives it.
    let name = |name: &mut Option<String>, kind: &str, i: usize| {
        name.get_or_insert_with(|| format!("{kind} {}", i + 1));
    };
    for (i, mesh) in scene.meshes.iter_mut().enumerate() {
        mesh.name = mesh.name.take().or_else(|| mesh.file.clone());
        name(&mut mesh.name, "mesh", i);
    }
    scene.spheres.iter_mut().enumerate().for_each(|(i, sphere)| name(&mut sphere.name, "sphere", i));
    scene.planes.iter_mut().enumerate().for_each(|(i, plane)| name(&mut plane.name, "plane", i));
    scene.boxes.iter_mut().enumerate().for_each(|(i, cuboid)| name(&mut cuboid.name, "box", i));
    scene.lathes.iter_mut().enumerate().for_each(|(i, lathe)| name(&mut lathe.name, "lathe", i));
    scene.spheres.retain(|sphere| sphere.name.as_deref() != Some(object));
    scene.meshes.retain(|mesh| mesh.name.as_deref() != Some(object));
    scene.planes.retain(|plane| plane.name.as_deref() != Some(object));
    scene.boxes.retain(|cuboid| cuboid.name.as_deref() != Some(object));
    scene.lathes.retain(|lathe| lathe.name.as_deref() != Some(object));
}

fn paths(world: &World, loaded: &Loaded, x: u32, y: u32) -> Vec<(Path, Rgb)> {
    let names = Names { world, scene: &loaded.scene };
    trace_pixel(world, x, y).map_or(Vec::new(), |trace| by_path(&names, &trace))
}

/// All paths of both, those that changed most first.
fn table(before: &[(Path, Rgb)], after: &[(Path, Rgb)]) -> String {
    let of = |paths: &[(Path, Rgb)], path: &Path| paths.iter().find(|(p, _)| p == path).map_or(0.0, |(_, c)| c.mean());
    let mut rows: Vec<(&Path, f64, f64)> =
        before.iter().map(|(path, color)| (path, color.mean(), of(after, path))).collect();
    let new = after.iter().filter(|(path, _)| !before.iter().any(|(p, _)| p == path));
    rows.extend(new.map(|(path, color)| (path, 0.0, color.mean())));
    rows.sort_by(|a, b| (b.1 - b.2).abs().total_cmp(&(a.1 - a.2).abs()));
    let mut text = format!("{:>9} {:>9}  path\n", "before", "after");
    for (path, before, after) in rows {
        let _ = writeln!(text, "{before:9.5} {after:9.5}  {path}");
    }
    let _ = writeln!(text, "{:9.5} {:9.5}  together", total(before), total(after));
    text
}

fn total(paths: &[(Path, Rgb)]) -> f64 {
    mean(paths.iter().fold(Rgb::gray(0.0), |sum, (_, color)| sum + *color).to_array())
}
