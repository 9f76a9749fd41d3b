//! Recipes, as a command line asks for them and speaks of them.

use crate::args::{ExplainArgs, ReadingArgs, RenderArgs};
use crate::input;
use crate::say::{FAILED, Failure, OrFail, Outcome, SCENE};
use snell::explain::text::six_digits;
use snell_formats::load::{Cache, Loaded, load_text};
use snell_formats::recipe::{Changes, OldDefault, Recipe};
use snell_formats::{LoadOptions, Report};
use std::path::{Path, PathBuf};
use std::sync::Arc;

impl From<&RenderArgs> for Changes {
    fn from(args: &RenderArgs) -> Self {
        Self {
            set: args.reading.set.clone(),
            size: args.size,
            stretch: args.stretch,
            crop: args.crop,
            spp: args.spp,
            depth: args.depth,
            integrator: args.integrator,
            shadows: args.shadows,
            transfer: args.transfer,
            rounding: args.rounding,
            bits: args.bits,
            paths: args.paths,
            only: args.only.clone(),
        }
    }
}

impl From<&ExplainArgs> for Changes {
    fn from(args: &ExplainArgs) -> Self {
        Self {
            set: args.reading.set.clone(),
            size: args.size,
            spp: args.spp,
            integrator: args.integrator,
            shadows: args.shadows,
            ..Self::default()
        }
    }
}

/// Reads a scene, and notes how it was read.
pub fn of_scene(name: &str, reading: &ReadingArgs, changes: &Changes) -> Result<(Recipe, Loaded), Failure> {
    let options =
        LoadOptions { set: changes.set.clone(), integrator: changes.integrator, ..LoadOptions::from(reading) };
    let loaded = input::scene(name, &options)?;
    Ok((Recipe::of(&loaded, &options, changes), loaded))
}

/// Makes another scene of a text that was read before.
pub fn of_text(
    base: &Loaded,
    reading: &ReadingArgs,
    cache: &Arc<Cache>,
    changes: &Changes,
) -> Result<(Recipe, Loaded), Failure> {
    let options = LoadOptions {
        set: changes.set.clone(),
        integrator: changes.integrator,
        cache: Some(Arc::clone(cache)),
        ..LoadOptions::from(reading)
    };
    let loaded = load_text(base.source.clone(), base.kind, &base.folder, &options).or_fail(SCENE)?;
    Ok((Recipe::of(&loaded, &options, changes), loaded))
}

/// Reads the scene of a picture again, with changes. The third are notes on defaults that have changed since.
pub fn of_picture(
    path: &Path,
    search: &[PathBuf],
    changes: &Changes,
) -> Result<(Recipe, Loaded, Vec<&'static str>), Failure> {
    let mut recipe = Recipe::in_picture(path).or_fail(FAILED)?;
    recipe.change(changes);
    let loaded = recipe.load(search).or_fail(SCENE)?;
    let notes = recipe.keep_old_defaults(&loaded.scene).into_iter().map(note).collect();
    Ok((recipe, loaded, notes))
}

fn note(kept: OldDefault) -> &'static str {
    match kept {
        OldDefault::OpaqueShadows => {
            "the picture was made when `whitted` had opaque shadows by default, and gets them again; the default is `tinted` \
             now: to have that, render its scene (`snell info --scene` prints it) with --shadows tinted"
        }
        OldDefault::ImagePlane => {
            "the picture was made when the image plane stood at `near` = -1 by default, and stands there again; the default is \
             a tenth of the way to `look_at` now: to have that, render its scene (`snell info --scene` prints it)"
        }
    }
}

/// What is said of bounds that were widened.
pub fn widened([width, height]: [u32; 2], bounds: [f64; 4]) -> String {
    format!(
        "{width} x {height} has another shape than the scene: to keep pixels square the bounds are widened to [{}] \
         (--stretch leaves them)",
        bounds.map(six_digits).join(", ")
    )
}

/// Fails if a picture that was made again is another one.
pub fn same_film(recipe: &Recipe, before: Option<&str>) -> Outcome {
    if let (Some(before), Some(now)) = (before, &recipe.film_sha256)
        && before != now
    {
        let message =
            format!("the picture is not the same: film {} before, {} now", short_hash(before), short_hash(now));
        let help = format!("it was made by Snell {}", recipe.snell);
        return Err(Failure::new(FAILED, Report::error(message).help(help)));
    }
    Ok(())
}

/// The first digits of a hash, for people.
pub fn short_hash(hash: &str) -> &str {
    hash.get(..12).unwrap_or(hash)
}
