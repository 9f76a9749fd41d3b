//! `--set` and `--without`: the same pixel, before and after, branch by branch.

use super::{Asked, ask, known_object, print, shown};
use crate::args::ExplainArgs;
use crate::excerpt::plain;
use crate::say::{OrFail, Outcome, SCENE, tell};
use snell::explain::text::{Text, head, mean, numbers};
use snell::explain::{Path, by_path};
use snell::film::Rgb;
use snell::geometry::bvh::Quality;
use snell::render::trace_pixel;
use snell::scene::Scene;
use snell_formats::recipe::Changes;
use std::fmt::Write;

/// Compares a pixel of the scene with that of the scene that `args` ask for.
pub fn run(args: &ExplainArgs, changes: &Changes, pixel: [u32; 2]) -> Outcome {
    let mut asked = ask(args, changes)?;
    asked.warn();
    if let Some(object) = &args.without {
        known_object(asked.compiled.world(), object)?;
        remove(asked.loaded.scene_mut(), object);
        asked.compiled = asked.loaded.compile(&asked.recipe.name, Quality::default(), 0).or_fail(SCENE)?;
    }
    let after = asked.pixel(pixel)?;
    let [x, y] = after.pixel;
    let without = args.without.as_ref().map(|object| format!("without {object}"));
    let made: Vec<String> = changes.set.iter().map(|change| format!("with {change}")).chain(without).collect();
    let made = plain(&made.join(", "));
    let mut changed = Text::default();
    changed.patch(after.color, after.transfer);
    let changed = format!("{}{}\n{}\n", shown(&changed), numbers(after.color), after.sentence);
    // The change may be what makes a scene of it.
    let unchanged = Changes { set: Vec::new(), ..changes.clone() };
    let original = match ask(args, &unchanged).and_then(|original| Ok((original.pixel(pixel)?, original))) {
        Ok(original) => original,
        Err(failure) => {
            let why = failure.reports.iter().find(|report| report.warning.is_none());
            let why = why.map_or(String::new(), |report| format!(": {report}"));
            tell(&format!("note: only the pixel after the change is shown; without the change there is none{why}"));
            return print(
                &asked,
                &format!("{}\n{made}:\n{changed}\n{}", shown(&head(&after)), table(&[], &paths(&asked, x, y))),
            );
        }
    };
    let (before, original) = original;
    let text = format!("{}\n{made}:\n{changed}\n", shown(&head(&before)));
    let [u, v] = before.pixel;
    print(&asked, &(text + &table(&paths(&original, u, v), &paths(&asked, x, y))))
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
    scene.discs.iter_mut().enumerate().for_each(|(i, disc)| name(&mut disc.name, "disc", i));
    scene.lathes.iter_mut().enumerate().for_each(|(i, lathe)| name(&mut lathe.name, "lathe", i));
    scene.spheres.retain(|sphere| sphere.name.as_deref() != Some(object));
    scene.meshes.retain(|mesh| mesh.name.as_deref() != Some(object));
    scene.planes.retain(|plane| plane.name.as_deref() != Some(object));
    scene.boxes.retain(|cuboid| cuboid.name.as_deref() != Some(object));
    scene.discs.retain(|disc| disc.name.as_deref() != Some(object));
    scene.lathes.retain(|lathe| lathe.name.as_deref() != Some(object));
}

fn paths(asked: &Asked, x: u32, y: u32) -> Vec<(Path, Rgb)> {
    let compiled = &asked.compiled;
    trace_pixel(compiled.world(), &compiled.settings(), x, y).map_or(Vec::new(), |trace| by_path(compiled, &trace))
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
