//! `snell explain`: why a pixel has the colour it has.

mod compare;
mod find;
mod light;

use crate::args::ExplainArgs;
use crate::say::{self, FAILED, Failure, OrFail, Outcome, SCENE, USAGE};
use snell::explain::text::{self, Style};
use snell::explain::{Explanation, Names, explain};
use snell::world::World;
use snell_formats::figure::figure;
use snell_formats::load::Loaded;
use snell_formats::page::page;
use snell_formats::{LoadOptions, Report, disk, load};
use std::path::Path;

/// The viewer, built from `viewer/` by `npm run bundle`.
const VIEWER: &str = include_str!("../../assets/snell-viewer.js");

pub fn run(args: &ExplainArgs) -> Outcome {
    let mut options = LoadOptions::from(&args.reading);
    if args.find.is_none() {
        // Of a pixel, `--set` and `--without` ask what would be if.
        options.set.clear();
    }
    let mut loaded = load(&args.scene, &options).or_fail(SCENE)?;
    settings(&mut loaded, args);
    let world = loaded.world().or_fail(SCENE)?;
    if let Some(object) = &args.find {
        return find::run(&world, &loaded, object, args);
    }
    let Some([x, y]) = args.pixel else {
        let report =
            Report::error("which pixel?").help("like `snell explain lecture/default 256,256`, or --find OBJECT");
        return Err(Failure::new(USAGE, report));
    };
    let explanation = pixel(&world, &loaded, args, x, y)?;
    if !args.reading.set.is_empty() || args.without.is_some() {
        return compare::run(&explanation, &world, &loaded, args);
    }
    if let Some(light) = &args.light {
        return say::print(&light::text(&explanation, light)?);
    }
    if let Some(file) = &args.html {
        return write(file, &page(&explanation, &Names { world: &world, scene: &loaded.scene }, VIEWER));
    }
    if let Some(file) = &args.svg {
        return write(file, &figure(&explanation));
    }
    if args.json {
        return say::print(&format!("{}\n", json(&explanation)));
    }
    let plain = Style::default();
    let style =
        Style { top: args.top.unwrap_or(plain.top), depth: args.depth.unwrap_or(plain.depth), colored: colored() };
    say::print(&text::text(&explanation, style))
}

/// May stdout be coloured?
fn colored() -> bool {
    say::colored(&std::io::stdout())
}

/// The settings of the command line.
fn settings(loaded: &mut Loaded, args: &ExplainArgs) {
    let render = &mut loaded.scene.render;
    render.integrator = args.integrator.unwrap_or(render.integrator);
    render.shadows = args.shadows.or(render.shadows);
    render.spp = args.spp.unwrap_or(render.spp);
    if let Some(size) = args.size {
        loaded.scene.resize(size);
    }
}

/// Fails with the names that there are, if a scene has no such object.
fn known_object(world: &World, object: &str) -> Outcome {
    let known = world.object_names();
    if known.contains(&object) {
        return Ok(());
    }
    let help = format!("objects: {}", known.into_iter().take(30).collect::<Vec<_>>().join(", "));
    Err(Failure::new(USAGE, Report::error(format!("no object is called `{object}`")).help(help)))
}

fn pixel(world: &World, loaded: &Loaded, args: &ExplainArgs, x: u32, y: u32) -> Result<Explanation, Failure> {
    let found = explain(world, &loaded.scene, &args.scene, x, y);
    found.map(|(explanation, _)| explanation).ok_or_else(|| {
        let [width, height] = world.camera.size;
        let message = format!("there is no pixel {x},{y} in a picture of {width} x {height}");
        let help = format!("columns are 0 to {}, rows 0 to {}, from the top left", width - 1, height - 1);
        Failure::new(USAGE, Report::error(message).help(help))
    })
}

/// The JSON form.
fn json(explanation: &Explanation) -> String {
    // Every number in it is finite: worlds hold no others, and what is infinite is left out.
    serde_json::to_string(explanation).unwrap_or_default()
}

fn write(file: &Path, text: &str) -> Outcome {
    disk::write(file, |out| out.write_all(text.as_bytes())).or_fail(FAILED)?;
    eprintln!("{}", file.display());
    Ok(())
}
