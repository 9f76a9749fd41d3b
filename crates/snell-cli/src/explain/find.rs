//! `--find`: in which pixels an object is seen, and along which path.

use super::{Asked, known_object};
use crate::args::{ExplainArgs, ProgressKind};
use crate::excerpt::plain;
use crate::progress::Reporter;
use crate::say::{self, FAILED, Failure, OrFail, Outcome, USAGE, tell};
use snell::explain::find;
use snell::film::transfer::{Encoding, Rounding, Transfer};
use snell::film::{Crop, Film, Rgb};
use snell::render::Options;
use snell_formats::Report;
use snell_formats::picture::{Format, Writing};
use std::fmt::Write;

/// Paths that are listed.
const LISTED: usize = 20;

pub fn run(asked: &Asked, object: &str, args: &ExplainArgs) -> Outcome {
    let world = asked.compiled.world();
    known_object(world, object)?;
    let mask =
        args.mask.as_deref().map(|file| Format::of(file).map(|format| (file, format))).transpose().or_fail(USAGE)?;
    if let Some((file, _)) = mask {
        asked.refuse(file, args)?;
    }
    let reporter = Reporter::new(ProgressKind::Auto, false, "looking");
    let update = |progress| reporter.update(progress);
    let options = Options { progress: Some(&update), crop: asked.recipe.crop, ..Options::default() };
    let found = find(&asked.compiled, object, &options).unwrap_or_default();
    reporter.finish();
    let mut text = String::new();
    if found.paths.is_empty() {
        let _ = writeln!(text, "{object} is nowhere to be seen");
    }
    for (path, pixels) in found.paths.iter().take(LISTED) {
        let _ = writeln!(text, "{pixels:9} px  {path}");
    }
    if found.paths.len() > LISTED {
        let _ = writeln!(text, "          … and {} more paths", found.paths.len() - LISTED);
    }
    let pixels = found.mask.iter().filter(|share| **share > 0.0).count();
    let _ = writeln!(text, "{pixels:9} px  together; above, a pixel counts once for each of its paths");
    if let Some((file, format)) = mask {
        let [width, height] = world.camera.size;
        let crop = asked.recipe.crop.unwrap_or(Crop { x: 0, y: 0, width, height });
        let mut film =
            Film::new([width, height], crop).map_err(|e| Failure::new(FAILED, Report::error(e.to_string())))?;
        for (pixel, &share) in film.pixels.iter_mut().zip(&found.mask) {
            *pixel = Rgb::gray(share);
        }
        film.finished.fill(true);
        let encoding = Encoding { transfer: Transfer::Linear, rounding: Rounding::Round };
        Writing { format, encoding, threads: 0 }.write(file, &film, None).or_fail(FAILED)?;
        tell(&file.display().to_string());
    }
    say::print(&plain(&text))
}
