//! `snell render`.

use crate::args::{ProgressKind, RenderArgs};
use crate::paths;
use crate::progress::{Phase, Reporter, short};
use crate::recipe::Recipe;
use crate::say::{self, FAILED, Failure, INTERRUPTED, OrFail, Outcome, SCENE, USAGE};
use serde_json::json;
use snell::film::transfer::Encoding;
use snell::film::{BYTES_PER_PIXEL, Crop};
use snell::render::{Options, RenderError, Rendered, render};
use snell::scene::WarningCode;
use snell::world::World;
use snell_formats::load::Loaded;
use snell_formats::picture::{self, Format};
use snell_formats::{Report, disk};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Set by ^C.
static CANCEL: AtomicBool = AtomicBool::new(false);
/// Is there a part of a picture to save? Before, ^C ends the program at once.
static RENDERING: AtomicBool = AtomicBool::new(false);

/// The first ^C stops the render and saves what is done; before a render, or the second time, it ends at once.
fn interrupt() {
    let something_to_save = RENDERING.load(Ordering::Relaxed);
    if !something_to_save || CANCEL.swap(true, Ordering::Relaxed) {
        disk::discard_pending();
        if !something_to_save {
            eprintln!("stopped before there was anything to save");
        }
        std::process::exit(INTERRUPTED.into());
    }
}

pub fn run(args: &RenderArgs) -> Outcome {
    let names: Vec<String> = match &args.from {
        Some(from) => vec![from.display().to_string()],
        None => args.scenes.clone(),
    };
    let outputs = outputs(args, &names)?;
    if ctrlc::set_handler(interrupt).is_err() {
        eprintln!("note: ^C cannot be caught here; it would lose the picture");
    }
    let mut failures = Vec::new();
    for (name, output) in names.iter().zip(&outputs) {
        let result = match &args.from {
            Some(from) => again(from, args, output),
            None => anew(name, args, output),
        };
        match result {
            Ok(()) => {}
            // One bad scene of many does not keep the others from being drawn.
            Err(failure) if names.len() > 1 && failure.code != INTERRUPTED => {
                say::reports(&failure.reports);
                failures.push(failure.code);
            }
            Err(failure) => return Err(failure),
        }
    }
    match failures.first() {
        None => Ok(()),
        Some(&code) => {
            let message = format!("{} of {} scenes were not drawn", failures.len(), names.len());
            Err(Failure::new(code, Report::error(message)))
        }
    }
}

/// Where each picture goes. What is sure to fail later fails here, before any work is done.
fn outputs(args: &RenderArgs, names: &[String]) -> Result<Vec<PathBuf>, Failure> {
    let ends_with_slash = |p: &Path| p.as_os_str().to_string_lossy().ends_with(['/', '\\']);
    let outputs = match &args.output {
        Some(path) if !path.is_dir() && !ends_with_slash(path) && (names.len() == 1 || Format::of(path).is_ok()) => {
            Format::of(path).or_fail(USAGE)?;
            if names.len() > 1 {
                let message = format!("{} scenes cannot be one picture `{}`", names.len(), path.display());
                return Err(Failure::new(USAGE, Report::error(message).help("name a folder, like -o out/")));
            }
            vec![path.clone()]
        }
        folder => in_folder(folder.as_deref().unwrap_or(Path::new(".")), args, names)?,
    };
    for output in &outputs {
        if names.iter().any(|name| same_file(Path::new(name), output)) {
            let message = format!("`{}` is what is read", output.display());
            return Err(Failure::new(USAGE, Report::error(message).help("give the new picture another name")));
        }
        disk::check_writable(output).or_fail(FAILED)?;
    }
    Ok(outputs)
}

/// A picture for each scene in a folder, which is made if need be.
fn in_folder(folder: &Path, args: &RenderArgs, names: &[String]) -> Result<Vec<PathBuf>, Failure> {
    if let Err(e) = std::fs::create_dir_all(folder) {
        let report = Report::error(format!("cannot make the folder `{}`: {e}", folder.display()));
        return Err(Failure::new(if folder.exists() { USAGE } else { FAILED }, report));
    }
    let mut taken: HashMap<PathBuf, &String> = HashMap::new();
    let mut outputs = Vec::new();
    for name in names {
        // Only an ending that scene files have is cut off: `eta-1.05` is a whole name.
        let path = Path::new(name);
        let known = path.extension().is_some_and(|e| ["txt", "toml", "json", "png", "exr"].iter().any(|k| e == *k));
        let stem = if known { path.file_stem() } else { path.file_name() };
        let stem = stem.map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
        let again = if args.from.is_some() { "-again" } else { "" };
        let output = folder.join(format!("{stem}{again}.{}", args.format));
        if let Some(other) = taken.insert(output.clone(), name) {
            let message = format!("`{other}` and `{name}` would both be written to `{}`", output.display());
            return Err(Failure::new(USAGE, Report::error(message).help("render them with two commands")));
        }
        outputs.push(output);
    }
    Ok(outputs)
}

/// Are these two names of one file?
pub fn same_file(a: &Path, b: &Path) -> bool {
    matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
}

/// Renders a picture of a scene.
fn anew(name: &str, args: &RenderArgs, output: &Path) -> Outcome {
    let reading = Phase::start(args.progress, args.quiet, "reading", name);
    let read = Recipe::of(name, args);
    drop(reading);
    let (recipe, loaded) = read?;
    one(recipe, loaded, args, output)
}

/// Renders a picture from what another one remembers.
fn again(from: &Path, args: &RenderArgs, output: &Path) -> Outcome {
    let remembered = picture::read(from).or_fail(FAILED)?.recipe.ok_or_else(|| {
        let report = Report::error(format!("`{}` does not say how it was made", from.display()));
        Failure::new(FAILED, report.help("only PNG and EXR pictures made by Snell do"))
    })?;
    let mut recipe: Recipe = serde_json::from_str(&remembered).map_err(|e| {
        Failure::new(FAILED, Report::error(format!("the recipe in `{}` cannot be read: {e}", from.display())))
    })?;
    let loaded = recipe.load(&args.reading.search)?;
    for note in recipe.keep_old_defaults(&loaded.scene) {
        match args.progress {
            ProgressKind::Json => eprintln!("{}", json!({ "event": "note", "message": note })),
            ProgressKind::Auto if args.quiet => {}
            ProgressKind::Auto => eprintln!("note: {note}"),
        }
    }
    one(recipe, loaded, args, output)
}

/// Renders one picture.
fn one(mut recipe: Recipe, mut loaded: Loaded, args: &RenderArgs, output: &Path) -> Outcome {
    let widened = recipe.apply(&mut loaded.scene);
    recipe.resolve(&loaded.scene);
    let preparing = Phase::start(args.progress, args.quiet, "preparing", &recipe.name);
    let world = loaded.build(args.bvh, args.threads.into()).or_fail(SCENE)?;
    drop(preparing);
    let widened = widened.map(|note| Report::warning(WarningCode::WidenedBounds, note));
    let warnings: Vec<Report> = widened.into_iter().chain(loaded.warnings_with(&world)).collect();
    for warning in warnings.iter().take(say::SHOWN) {
        warn(warning, args);
    }
    if !args.quiet && args.progress == ProgressKind::Auto {
        say::more(warnings.len());
    }
    enough_memory(&world, recipe.crop)?;
    if Format::of(output).or_fail(USAGE)? == Format::Exr && world.camera.size.iter().any(|&n| n > i32::MAX as u32) {
        let report = Report::error("an EXR picture has at most 2147483647 pixels in a row or column");
        return Err(Failure::new(USAGE, report));
    }

    if args.paths.is_some() || args.only.is_some() {
        return paths::run(&world, &loaded, args, output);
    }
    let reporter = Reporter::new(args.progress, args.quiet, &recipe.name);
    let started = Instant::now();
    let progress = |p| {
        RENDERING.store(true, Ordering::Relaxed);
        reporter.update(p);
    };
    let options = Options {
        threads: args.threads.into(),
        tile_size: args.tile,
        lanes: args.lanes.unwrap_or_default(),
        crop: recipe.crop,
        progress: Some(&progress),
        cancel: Some(&CANCEL),
    };
    let rendered = render(&world, &options).map_err(|e| {
        let code = if matches!(e, RenderError::CropOutside { .. }) { USAGE } else { SCENE };
        Failure::new(code, Report::error(e.to_string()))
    })?;
    let seconds = started.elapsed().as_secs_f64();
    reporter.finish();
    if !rendered.film.finished.contains(&true) {
        // An empty picture would only take the place of what is there.
        return Err(Failure { code: INTERRUPTED, reports: Vec::new() });
    }

    let writing = Phase::start(args.progress, args.quiet, "writing", &output.display().to_string());
    let finished = rendered.film.is_finished();
    let before = recipe.film_sha256.take();
    if finished {
        recipe.film_sha256 = Some(disk::sha256(rendered.film.bytes()));
    }
    let format = match Format::of(output).or_fail(USAGE)? {
        Format::Png { .. } => Format::Png { sixteen_bit: recipe.bits == Some(16) },
        Format::Ppm { .. } => Format::Ppm { binary: args.binary },
        other => other,
    };
    let encoding = Encoding { transfer: world.render.transfer, rounding: world.render.rounding };
    let text = serde_json::to_string(&recipe).unwrap_or_default();
    let written = picture::write(output, format, &rendered.film, encoding, Some(&text));
    RENDERING.store(false, Ordering::Relaxed);
    drop(writing);
    if let Err(report) = written {
        return Err(Failure::new(FAILED, rescue(report, output, format, &rendered, encoding, &text)));
    }
    summary(&recipe, &world, &rendered, args, &options, output, seconds);
    if !finished {
        return Err(Failure { code: INTERRUPTED, reports: Vec::new() });
    }
    if let (Some(before), Some(now)) = (&before, &recipe.film_sha256)
        && before != now
    {
        let message =
            format!("the picture is not the same: film {} before, {} now", short_hash(before), short_hash(now));
        let help = format!("it was made by Snell {}", recipe.snell);
        return Err(Failure::new(FAILED, Report::error(message).help(help)));
    }
    Ok(())
}

/// The picture could not be written where it should go: it is kept elsewhere if possible, so that no work is lost.
fn rescue(
    report: Report,
    output: &Path,
    format: Format,
    rendered: &Rendered,
    encoding: Encoding,
    recipe: &str,
) -> Report {
    let name = output.file_name().map(|n| n.to_string_lossy().into_owned()).unwrap_or_default();
    let elsewhere = std::env::temp_dir().join(format!("snell-{}-{name}", std::process::id()));
    match picture::write(&elsewhere, format, &rendered.film, encoding, Some(recipe)) {
        Ok(()) => report.help(format!("the picture is kept as {}", elsewhere.display())),
        Err(_) => report,
    }
}

/// The first digits of a hash, for people.
fn short_hash(hash: &str) -> &str {
    hash.get(..12).unwrap_or(hash)
}

fn warn(report: &Report, args: &RenderArgs) {
    match args.progress {
        ProgressKind::Json => {
            let place = report.place.as_ref().map(|(source, range)| {
                let (line, column) = source.line_column(range.start);
                json!({ "file": &*source.name, "line": line, "column": column })
            });
            eprintln!(
                "{}",
                json!({ "event": "warning", "code": report.warning, "message": report.message, "place": place })
            );
        }
        ProgressKind::Auto if args.quiet => {}
        ProgressKind::Auto => say::report(report),
    }
}

/// Says what was done.
fn summary(
    recipe: &Recipe,
    world: &World,
    rendered: &Rendered,
    args: &RenderArgs,
    options: &Options<'_>,
    output: &Path,
    seconds: f64,
) {
    let film = &rendered.film;
    let statistics = &rendered.statistics;
    let (rays, lost) = (statistics.rays, statistics.lost);
    let pixels = film.pixels.len() as u64;
    let (worst_x, worst_y) = lost.worst_pixel(world.camera.size[0]);
    let hash = recipe.film_sha256.as_deref();
    if args.progress == ProgressKind::Json {
        for warning in statistics.warnings(world, pixels) {
            let (code, message) = (warning.code.code(), &warning.message);
            eprintln!("{}", json!({ "event": "warning", "code": code, "message": message, "place": null }));
        }
        let tree = world.tree();
        eprintln!(
            "{}",
            json!({
                "event": if hash.is_some() { "done" } else { "interrupted" },
                "file": output, "width": film.crop.width, "height": film.crop.height, "seconds": seconds,
                "rays": { "camera": rays.camera, "mirror": rays.mirror, "refracted": rays.refracted, "shadow": rays.shadow },
                "depth": statistics.depth,
                "lanes": options.lanes.numbers(),
                "tree": { "nodes": tree.nodes, "leaves": tree.leaves, "depth": tree.depth },
                "lost": {
                    "rays": lost.rays, "share": lost.share(pixels), "worst": lost.worst(), "worst_pixel": [worst_x, worst_y],
                },
                "film_sha256": hash,
            })
        );
        return;
    }
    if args.quiet {
        return;
    }
    let total = rays.total() as f64;
    let state = hash.map_or("stopped before it was finished".to_owned(), |h| format!("film {}", short_hash(h)));
    eprintln!(
        "{}: {} x {}, {} rays in {seconds:.2} s ({} rays/s), {state}",
        output.display(),
        film.crop.width,
        film.crop.height,
        short(total),
        short(total / seconds.max(1e-9)),
    );
    if lost.rays > 0 && world.render.max_depth == 0 {
        eprintln!("  depth 0: mirrors and glass send no rays on");
    }
    for warning in statistics.warnings(world, pixels) {
        eprintln!("  {warning}");
    }
}

/// Refuses a film that would not fit into the memory that is free, where the system says how much that is.
fn enough_memory(world: &World, crop: Option<Crop>) -> Outcome {
    let [width, height] = crop.map_or(world.camera.size, |c| [c.width, c.height]);
    if width > world.camera.size[0] || height > world.camera.size[1] {
        // Such a crop does not fit, which is said later.
        return Ok(());
    }
    let needed = u64::from(width).saturating_mul(u64::from(height)).saturating_mul(BYTES_PER_PIXEL);
    match free_memory() {
        Some(free) if needed > free => {
            let gib = |bytes: u64| bytes as f64 / f64::from(1 << 30);
            let message = format!(
                "a picture of {width} x {height} pixels needs {:.1} GiB of memory, and {:.1} GiB are free",
                gib(needed),
                gib(free)
            );
            Err(Failure::new(
                SCENE,
                Report::error(message).help("choose a smaller --size, or render parts with --crop"),
            ))
        }
        _ => Ok(()),
    }
}

/// Linux: what the kernel says can be had without swapping.
fn free_memory() -> Option<u64> {
    let text = std::fs::read_to_string("/proc/meminfo").ok()?;
    let line = text.lines().find_map(|l| l.strip_prefix("MemAvailable:"))?;
    line.trim().strip_suffix("kB")?.trim().parse::<u64>().ok().map(|kib| kib * 1024)
}
