//! `snell render --paths` and `--only`: a picture by the ways of its light.

use crate::args::{ProgressKind, RenderArgs};
use crate::progress::Reporter;
use crate::say::{FAILED, Failure, OrFail, Outcome, USAGE};
use snell::explain::{Path as Way, layers, only};
use snell::film::transfer::Encoding;
use snell::film::{Crop, Film, Rgb};
use snell::render::Options;
use snell::world::World;
use snell_formats::Report;
use snell_formats::load::Loaded;
use snell_formats::picture::{self, Format, write_layers};
use std::path::Path;

/// Renders one layer for each of the strongest ways, or one way only.
pub fn run(world: &World, loaded: &Loaded, args: &RenderArgs, output: &Path) -> Outcome {
    if args.crop.is_some() {
        let report = Report::error("--paths and --only look at whole pictures");
        return Err(Failure::new(USAGE, report.help("leave out --crop, or choose a smaller --size")));
    }
    let [width, height] = world.camera.size;
    let reporter = Reporter::new(args.progress, args.quiet, "ways of light");
    let update = |progress| reporter.update(progress);
    let options = Options { threads: args.threads.into(), progress: Some(&update), ..Options::default() };
    if let Some(text) = &args.only {
        let way = Way::parse(text).map_err(|e| {
            let help = "like --only \"glass(refract) green\"; snell render --paths 20 lists the ways of a picture";
            Failure::new(USAGE, Report::error(e.to_string()).help(help))
        })?;
        let pixels = only(world, &loaded.scene, &way, &options).unwrap_or_default();
        reporter.finish();
        let seen = pixels.iter().filter(|pixel| **pixel != Rgb::gray(0.0)).count();
        say(args, &format!("{}: {way}, in {seen} of {} pixels", output.display(), pixels.len()));
        let film = film([width, height], pixels)?;
        let encoding = Encoding { transfer: world.render.transfer, rounding: world.render.rounding };
        return picture::write(output, Format::of(output).or_fail(USAGE)?, &film, encoding, None).or_fail(FAILED);
    }
    let most = args.paths.unwrap_or_default() as usize;
    if Format::of(output).or_fail(USAGE)? != Format::Exr {
        let report = Report::error("only EXR pictures have layers").help("name one, like -o paths.exr");
        return Err(Failure::new(USAGE, report));
    }
    let split = layers(world, &loaded.scene, most, &options).unwrap_or_default();
    reporter.finish();
    let total: f64 = split.picture.iter().map(|c| c.mean()).sum();
    // A black picture has no shares.
    let total = if total == 0.0 { 1.0 } else { total };
    let mut named: Vec<(String, Vec<Rgb>)> =
        split.layers.into_iter().map(|(way, pixels)| (way.to_string(), pixels)).collect();
    named.push(("rest".to_owned(), split.rest));
    for (name, pixels) in &named {
        let share: f64 = pixels.iter().map(|c| c.mean()).sum();
        say(args, &format!("{:5.1} %  {name}", 100.0 * share / total));
    }
    write_layers(output, [width, height], &split.picture, &named).or_fail(FAILED)?;
    say(args, &format!("{}: {} layers that add up to the picture", output.display(), named.len()));
    Ok(())
}

fn say(args: &RenderArgs, text: &str) {
    if !args.quiet && args.progress == ProgressKind::Auto {
        eprintln!("{text}");
    }
}

fn film([width, height]: [u32; 2], pixels: Vec<Rgb>) -> Result<Film, Failure> {
    let whole = Crop { x: 0, y: 0, width, height };
    let mut film = Film::new([width, height], whole).map_err(|e| Failure::new(FAILED, Report::error(e.to_string())))?;
    film.pixels = pixels;
    film.finished.fill(true);
    Ok(film)
}
