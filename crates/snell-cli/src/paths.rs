//! `snell render --paths` and `--only`: a picture by its light paths.

use crate::args::{ProgressKind, RenderArgs};
use crate::output;
use crate::progress::Reporter;
use crate::recipe::same_film;
use crate::say::{FAILED, Failure, Outcome, USAGE, tell};
use snell::explain::{Path as LightPath, layers, only};
use snell::film::{Crop, Film, Rgb};
use snell::render::Options;
use snell::world::{CompiledScene, World};
use snell_formats::Report;
use snell_formats::picture::{self, Format, Writing};
use snell_formats::recipe::Recipe;
use snell_formats::report::known_names;
use std::path::Path;

/// Renders one layer for each of the strongest paths, or one only.
pub fn run(compiled: &CompiledScene, mut recipe: Recipe, args: &RenderArgs, output: &Path, format: Format) -> Outcome {
    if recipe.crop.is_some() {
        let report = Report::error("--paths and --only look at whole pictures");
        return Err(Failure::new(USAGE, report.help("leave out --crop, or choose a smaller --size")));
    }
    let world = compiled.world();
    let path = recipe.only.as_ref().map(|text| light_path(text, world)).transpose()?;
    if path.is_none() && format != Format::Exr {
        let report = Report::error("only EXR pictures have layers").help("name one, like -o paths.exr");
        return Err(Failure::new(USAGE, report));
    }
    let [width, height] = world.camera.size;
    let reporter = Reporter::new(args.progress, args.quiet, "light paths");
    let update = |progress| reporter.update(progress);
    let options = Options { threads: args.threads.into(), progress: Some(&update), ..Options::default() };
    let before = recipe.film_sha256.take();
    if let Some(path) = path {
        let pixels = only(compiled, &path, &options).unwrap_or_default();
        reporter.finish();
        let seen = pixels.iter().filter(|pixel| **pixel != Rgb::gray(0.0)).count();
        say(args, &format!("{}: {path}, in {seen} of {} pixels", output::shown(output), pixels.len()));
        let film = film([width, height], pixels)?;
        let encoding = compiled.scene().render.encoding();
        recipe.remember(&film);
        let text = recipe.to_json();
        let writing = Writing { format, encoding, threads: args.threads.into() };
        output::write(output, |out| writing.write_to(out, &film, || Some(text)))?;
        return same_film(&recipe, before.as_deref());
    }
    let most = recipe.paths.unwrap_or_default() as usize;
    let split = layers(compiled, most, &options).unwrap_or_default();
    reporter.finish();
    let total: f64 = split.picture.iter().map(|c| c.mean()).sum();
    // A black picture has no shares.
    let total = if total == 0.0 { 1.0 } else { total };
    let mut named: Vec<(String, Vec<Rgb>)> =
        split.layers.into_iter().map(|(path, pixels)| (path.to_string(), pixels)).collect();
    named.push(("rest".to_owned(), split.rest));
    for (name, pixels) in &named {
        let share: f64 = pixels.iter().map(|c| c.mean()).sum();
        say(args, &format!("{:5.1} %  {name}", 100.0 * share / total));
    }
    let whole = film([width, height], split.picture)?;
    recipe.remember(&whole);
    let text = recipe.to_json();
    let threads = args.threads.into();
    let size = [width, height];
    output::write(output, |out| picture::write_layers_to(out, size, &whole.pixels, &named, threads, Some(&text)))?;
    say(args, &format!("{}: {} layers that add up to the picture", output::shown(output), named.len()));
    same_film(&recipe, before.as_deref())
}

/// The path that a text names, if all of its objects are there.
fn light_path(text: &str, world: &World) -> Result<LightPath, Failure> {
    let path = LightPath::parse(text).map_err(|e| {
        let help =
            "like --only \"glass(refract) green\"; snell render --paths 20 -o paths.exr lists the paths of a picture";
        Failure::new(USAGE, Report::error(e.to_string()).help(help))
    })?;
    let known = world.object_names();
    let steps = path.legs.iter().map(|leg| leg.object.as_str());
    let ends = std::iter::once(path.end.as_str()).filter(|end| *end != snell::explain::SKY);
    match steps.chain(ends).find(|name| !known.contains(name)) {
        None => Ok(path),
        Some(name) => {
            let report = Report::error(format!("no object is called `{name}`"));
            Err(Failure::new(USAGE, report.help(known_names(name, known))))
        }
    }
}

fn say(args: &RenderArgs, text: &str) {
    if !args.quiet && args.progress == ProgressKind::Auto {
        tell(text);
    }
}

fn film([width, height]: [u32; 2], pixels: Vec<Rgb>) -> Result<Film, Failure> {
    let whole = Crop { x: 0, y: 0, width, height };
    let mut film = Film::new([width, height], whole).map_err(|e| Failure::new(FAILED, Report::error(e.to_string())))?;
    film.pixels = pixels;
    film.finished.fill(true);
    Ok(film)
}
