//! `--find`: in which pixels an object is seen, and by which way.

use super::known_object;
use crate::args::{ExplainArgs, ProgressKind};
use crate::progress::Reporter;
use crate::say::{self, FAILED, Failure, OrFail, Outcome, USAGE};
use snell::explain::find;
use snell::film::transfer::{Encoding, Rounding, Transfer};
use snell::film::{Crop, Film, Rgb};
use snell::render::Options;
use snell::world::World;
use snell_formats::Report;
use snell_formats::load::Loaded;
use snell_formats::picture::{self, Format};
use std::fmt::Write;

/// Paths that are listed.
const LISTED: usize = 20;

pub fn run(world: &World, loaded: &Loaded, object: &str, args: &ExplainArgs) -> Outcome {
    known_object(world, object)?;
    let reporter = Reporter::new(ProgressKind::Auto, false, "looking");
    let update = |progress| reporter.update(progress);
    let options = Options { progress: Some(&update), ..Options::default() };
    let found = find(world, &loaded.scene, object, &options).unwrap_or_default();
    reporter.finish();
    let mut text = String::new();
    if found.paths.is_empty() {
        let _ = writeln!(text, "{object} is nowhere to be seen");
    }
    for (path, pixels) in found.paths.iter().take(LISTED) {
        let _ = writeln!(text, "{pixels:9} px  {path}");
    }
    if found.paths.len() > LISTED {
        let _ = writeln!(text, "          … and {} more ways", found.paths.len() - LISTED);
    }
    let pixels = found.mask.iter().filter(|share| **share > 0.0).count();
    let _ = writeln!(text, "{pixels:9} px  together: a pixel counts once for each way that it has");
    if let Some(file) = &args.mask {
        let [width, height] = world.camera.size;
        let mut film = Film::new([width, height], Crop { x: 0, y: 0, width, height })
            .map_err(|e| Failure::new(FAILED, Report::error(e.to_string())))?;
        for (pixel, &share) in film.pixels.iter_mut().zip(&found.mask) {
            *pixel = Rgb::gray(share);
        }
        film.finished.fill(true);
        let encoding = Encoding { transfer: Transfer::Linear, rounding: Rounding::Round };
        picture::write(file, Format::of(file).or_fail(USAGE)?, &film, encoding, None).or_fail(FAILED)?;
        eprintln!("{}", file.display());
    }
    say::print(&text)
}
