//! From a scene that was read to the file of its picture, for one picture and for many.

use crate::args::RenderArgs;
use crate::many;
use crate::output::{self, is_standard};
use crate::progress::Phase;
use crate::recipe::widened;
use crate::render::CANCEL;
use crate::say::{Failure, OrFail, Outcome, SCENE, USAGE};
use snell::explain::black_picture;
use snell::film::transfer::Encoding;
use snell::film::{BYTES_PER_PIXEL, Crop};
use snell::render::{Options, Progress, RenderError, Rendered, render};
use snell::scene::{Warning, WarningCode};
use snell::world::{CompiledScene, World};
use snell_formats::load::Loaded;
use snell_formats::picture::{Format, Writing};
use snell_formats::recipe::Recipe;
use snell_formats::{Report, memory};
use std::path::{Path, PathBuf};

/// A picture that only has to be traced.
pub struct Ready {
    pub recipe: Recipe,
    pub compiled: CompiledScene,
    /// What is odd about the scene.
    pub warnings: Vec<Report>,
    pub format: Format,
}

/// Compiles a scene, and refuses what is sure to fail later. `before` is nearly the same scene, which may share its tree.
pub fn prepare(
    mut recipe: Recipe,
    mut loaded: Loaded,
    before: Option<&CompiledScene>,
    args: &RenderArgs,
    output: &Path,
) -> Result<Ready, Failure> {
    let bounds = recipe.apply(loaded.scene_mut());
    recipe.resolve(&loaded.scene);
    let preparing = phase(args, "preparing", &recipe.name);
    let compiled = match before {
        Some(before) => loaded.compile_after(before),
        None => loaded.compile(&recipe.name, args.bvh, args.threads.into()),
    };
    let compiled = compiled.or_fail(SCENE)?;
    drop(preparing);
    let world = compiled.world();
    let note = bounds.map(|bounds| widened(loaded.scene.render.size, bounds));
    let widened = note.map(|note| Report::warning(WarningCode::WidenedBounds, note));
    let warnings: Vec<Report> = widened.into_iter().chain(loaded.warnings_with(world)).collect();
    let format = if args.part.is_some() { Format::Npy } else { format(output, args)? };
    let format = if format == (Format::Png { sixteen_bit: false }) {
        Format::Png { sixteen_bit: recipe.bits == Some(16) }
    } else {
        format
    };
    enough_memory(world, recipe.crop)?;
    if format == Format::Exr && world.camera.size.iter().any(|&n| n > i32::MAX as u32) {
        let report = Report::error("an EXR picture has at most 2147483647 pixels in a row or column");
        return Err(Failure::new(USAGE, report));
    }
    Ok(Ready { recipe, compiled, warnings, format })
}

/// How it is rendered, which does not change a bit of it.
pub fn options<'a>(args: &RenderArgs, recipe: &Recipe, progress: &'a (dyn Fn(Progress) + Sync)) -> Options<'a> {
    Options {
        threads: args.threads.into(),
        tile_size: args.tile,
        lanes: args.lanes.unwrap_or_default(),
        crop: recipe.crop,
        progress: Some(progress),
        cancel: Some(&CANCEL),
        ..Options::default()
    }
}

impl Ready {
    pub fn trace(&self, options: &Options<'_>) -> Result<Rendered, Failure> {
        render(self.compiled.world(), &self.compiled.settings(), options).map_err(|e| {
            let code = if matches!(e, RenderError::CropOutside { .. }) { USAGE } else { SCENE };
            Failure::new(code, Report::error(e.to_string()))
        })
    }

    /// Writes the picture with its recipe.
    pub fn save(&mut self, rendered: &Rendered, args: &RenderArgs, output: &Path) -> Outcome {
        let _writing = phase(args, "writing", &output::shown(output));
        let writing = Writing { format: self.format, encoding: self.encoding(), threads: args.threads.into() };
        let recipe = &mut self.recipe;
        output::write(output, |out| {
            writing.write_to(out, &rendered.film, || {
                recipe.remember(&rendered.film);
                Some(recipe.to_json())
            })
        })
    }

    /// The same, or keeps it elsewhere.
    pub fn save_anywhere(&mut self, rendered: &Rendered, args: &RenderArgs, output: &Path) -> Outcome {
        self.save(rendered, args, output).map_err(|Failure { code, mut reports }| {
            if let Some(report) = reports.pop() {
                // It may have failed before the film was looked at.
                self.recipe.remember(&rendered.film);
                let text = self.recipe.to_json();
                let writing = Writing { format: self.format, encoding: self.encoding(), threads: args.threads.into() };
                reports.push(rescue(report, output, writing, rendered, &text));
            }
            Failure { code, reports }
        })
    }

    fn encoding(&self) -> Encoding {
        self.compiled.scene().render.encoding()
    }

    /// What is odd about the picture.
    pub fn odd(&self, rendered: &Rendered) -> Vec<Warning> {
        let world = self.compiled.world();
        let mut odd = snell::render::warnings(&rendered.statistics, world, &self.compiled.settings());
        odd.extend(black_picture(&self.compiled, &rendered.film));
        odd
    }
}

/// The picture could not be written where it should go: it is kept elsewhere if possible, so that no work is lost.
fn rescue(report: Report, output: &Path, writing: Writing, rendered: &Rendered, recipe: &str) -> Report {
    let ending = match writing.format {
        Format::Png { .. } => "png",
        Format::Ppm { .. } => "ppm",
        Format::Exr => "exr",
        Format::Npy => "npy",
    };
    let stem = output.file_stem().unwrap_or_default().to_string_lossy();
    let name = format!("{}.{ending}", if is_standard(output) { "picture" } else { &stem });
    let elsewhere = std::env::temp_dir().join(format!("snell-{}-{name}", std::process::id()));
    match writing.write(&elsewhere, &rendered.film, Some(recipe)) {
        Ok(()) => report.help(format!("the picture is kept as {}", elsewhere.display())),
        Err(_) => report,
    }
}

/// Which format a picture gets.
pub fn format(output: &Path, args: &RenderArgs) -> Result<Format, Failure> {
    let name = PathBuf::from(format!("picture.{}", args.format));
    Ok(match Format::of(if is_standard(output) { &name } else { output }).or_fail(USAGE)? {
        Format::Png { .. } => Format::Png { sixteen_bit: args.bits == Some(16) },
        Format::Ppm { .. } => Format::Ppm { binary: args.binary },
        other => other,
    })
}

/// What goes on besides tracing; of many pictures the bar over all says enough.
pub fn phase(args: &RenderArgs, what: &'static str, name: &str) -> Phase {
    Phase::start(args.progress, args.quiet || many::is_asked(args), what, name)
}

/// Refuses a film that would not fit into the memory that is free, where the system says how much that is.
fn enough_memory(world: &World, crop: Option<Crop>) -> Outcome {
    let [width, height] = crop.map_or(world.camera.size, |c| [c.width, c.height]);
    if width > world.camera.size[0] || height > world.camera.size[1] {
        // Such a crop does not fit, which is said later.
        return Ok(());
    }
    let needed = u64::from(width).saturating_mul(u64::from(height)).saturating_mul(BYTES_PER_PIXEL);
    memory::check(&format!("a picture of {width} x {height} pixels"), needed)
        .map_err(|report| report.help("choose a smaller --size, or render parts with --crop"))
        .or_fail(SCENE)
}
