//! `snell render`.

use crate::args::{ProgressKind, RenderArgs};
use crate::claim;
use crate::input::{self, what_is};
use crate::kept;
use crate::machine;
use crate::many;
use crate::output::{self, beside, is_standard, refuse_inputs};
use crate::paths;
use crate::progress::{Reporter, short};
use crate::ready::{Ready, format, options, phase, prepare};
use crate::recipe::{of_picture, of_scene, same_film, short_hash};
use crate::say::{self, FAILED, Failure, INTERRUPTED, OrFail, Outcome, SCENE, USAGE, tell};
use crate::signals;
use serde_json::json;
use snell::render::{Options, Rendered};
use snell::scene::WarningCode;
use snell::threads::{self, ByDefault};
use snell_formats::given::Given;
use snell_formats::load::Loaded;
use snell_formats::picture::Format;
use snell_formats::recipe::{Changes, Recipe};
use snell_formats::{Report, disk};
use std::collections::HashMap;
use std::io::IsTerminal;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicBool, Ordering};
use std::time::Instant;

/// Set by ^C.
pub static CANCEL: AtomicBool = AtomicBool::new(false);
/// Is there a part of a picture to save? Before, ^C ends the program at once.
pub static RENDERING: AtomicBool = AtomicBool::new(false);

/// The first ^C stops the render and saves what is done; before a render, the second time, or while a pipe has no reader, it ends
/// at once.
fn interrupt() {
    let something_to_save = RENDERING.load(Ordering::Relaxed) && !disk::is_waiting();
    if !something_to_save || CANCEL.swap(true, Ordering::Relaxed) {
        disk::discard_pending();
        claim::discard_held();
        if !something_to_save {
            tell("stopped before there was anything to save");
        }
        std::process::exit(INTERRUPTED.into());
    }
}

pub fn run(args: &RenderArgs) -> Outcome {
    let again = args.from.as_ref().or(args.resume.as_ref());
    let names: Vec<String> = match again {
        Some(again) => vec![again.display().to_string()],
        None => args.scenes.clone(),
    };
    behave(args);
    if !kept::is_asked(args) && (args.until.is_some() || args.every.is_some()) {
        let report = Report::error("--until and --every need a file that keeps what is done");
        return Err(Failure::new(USAGE, report.help("name one, like --checkpoint work.npz")));
    }
    // clap's `requires` does not see what it needs where that conflicts with something else that is there.
    for (given, name, needed) in [
        (args.rows.is_some() && args.part.is_none(), "--rows", "--part FILE.npz"),
        (args.samples.is_some() && args.part.is_none(), "--samples", "--part FILE.npz"),
        (args.frames.is_some() && args.keys.is_none(), "--frames", "--keys FILE.toml"),
    ] {
        if given {
            return Err(Failure::new(USAGE, Report::error(format!("{name} needs {needed}"))));
        }
    }
    if kept::is_asked(args) && names.len() > 1 {
        let report = Report::error("--part and --checkpoint are of one picture");
        return Err(Failure::new(USAGE, report.help("render the scenes with several commands")));
    }
    if again.is_none() {
        names.iter().try_for_each(|name| refuse_picture(name))?;
    }
    let outputs = if many::is_asked(args) { Vec::new() } else { outputs(args, &names)? };
    if !signals::on_interrupt(interrupt) {
        tell("note: ^C cannot be caught here; it would lose the picture");
    }
    if many::is_asked(args) {
        return many::run(args).map_err(|failure| Failure { reports: quiet(failure.reports, args), ..failure });
    }
    if names.len() > 1 {
        keep_all_inputs(args, &names, &outputs)?;
    }
    let mut failures = Vec::new();
    let mut inputs: Vec<PathBuf> = Vec::new();
    for (name, output) in names.iter().zip(&outputs) {
        match one(name, args, output, &mut inputs) {
            Ok(()) => {}
            // One bad scene of many does not keep the others from being drawn.
            Err(failure) if names.len() > 1 && failure.code != INTERRUPTED => {
                say::reports(&quiet(failure.reports, args));
                failures.push(failure.code);
            }
            Err(Failure { code, reports }) => return Err(Failure { code, reports: quiet(reports, args) }),
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

/// Gives way to others, before there are any threads, and says what is odd about how many there will be.
fn behave(args: &RenderArgs) {
    if let Some(niceness) = args.nice
        && let Err(why) = machine::be_nice(niceness)
    {
        note(args, &format!("--nice {niceness} cannot be done: {why}; the render goes on as it is"));
    }
    if args.threads != 0 {
        return;
    }
    let ByDefault { count, variable, ignored } = ByDefault::here();
    let why = variable.map_or("one for each core that may be used".to_owned(), |name| format!("as {name} says"));
    for (name, read) in ignored {
        let expected = format!("a number of threads from 1 to {} was expected", threads::MOST);
        note(args, &format!("{name} is `{read}`, and {expected}; there are {count} instead, {why}"));
    }
}

/// Says something that is neither an error nor odd about the scene.
fn note(args: &RenderArgs, message: &str) {
    match args.progress {
        ProgressKind::Json => tell(&json!({ "event": "note", "message": message }).to_string()),
        ProgressKind::Auto if args.quiet => {}
        ProgressKind::Auto => tell(&format!("note: {message}")),
    }
}

/// With `--quiet` only the errors.
pub fn quiet(mut reports: Vec<Report>, args: &RenderArgs) -> Vec<Report> {
    reports.retain(|report| report.warning.is_none() || !args.quiet);
    reports
}

/// Where each picture goes. What is sure to fail later fails here, before any work is done.
fn outputs(args: &RenderArgs, names: &[String]) -> Result<Vec<PathBuf>, Failure> {
    let ends_with_slash = |p: &Path| p.as_os_str().to_string_lossy().ends_with(['/', '\\']);
    let is_picture = |p: &Path| is_standard(p) || Format::of(p).is_ok();
    if let Some(kept) = kept::file(args).filter(|kept| args.resume.as_deref() != Some(*kept)) {
        refuse_inputs(kept, names.iter().map(Path::new))?;
        disk::check_writable(kept).or_fail(FAILED)?;
    }
    if let Some(checkpoint) = &args.checkpoint {
        refuse_work(checkpoint, args)?;
    }
    let outputs = match &args.output {
        _ if args.part.is_some() => return Ok(args.part.iter().cloned().collect()),
        Some(path) if !path.is_dir() && !ends_with_slash(path) && (names.len() == 1 || is_picture(path)) => {
            let format = format(path, args)?;
            if names.len() > 1 {
                let message = format!("{} scenes cannot be one picture `{}`", names.len(), output::shown(path));
                return Err(Failure::new(USAGE, Report::error(message).help("name a folder, like -o out/")));
            }
            if is_standard(path) && format != (Format::Ppm { binary: false }) && std::io::stdout().is_terminal() {
                let report = Report::error("a picture would fill the terminal with unreadable bytes");
                return Err(Failure::new(USAGE, report.help("send it on: snell render … -o - > picture.png")));
            }
            vec![path.clone()]
        }
        folder => in_folder(folder.as_deref().unwrap_or(Path::new(".")), args, names)?,
    };
    for output in outputs.iter().filter(|output| !is_standard(output)) {
        refuse_inputs(output, names.iter().map(Path::new))?;
        disk::check_writable(output).or_fail(FAILED)?;
    }
    Ok(outputs)
}

/// Refuses to begin anew over a checkpoint, which may be the work of hours.
fn refuse_work(checkpoint: &Path, args: &RenderArgs) -> Outcome {
    let shown = checkpoint.display();
    if args.output.as_deref() == Some(checkpoint) {
        let report = Report::error(format!("`{shown}` cannot be both the checkpoint and the picture"));
        return Err(Failure::new(USAGE, report.help("name two files")));
    }
    if checkpoint.is_file() && args.resume.as_deref() != Some(checkpoint) {
        let report = Report::error(format!("the checkpoint `{shown}` is there already"));
        let output = kept::output_argument(args);
        let help = format!("go on with it: snell render --resume {shown}{output}; or remove it, or name another file");
        return Err(Failure::new(USAGE, report.help(help)));
    }
    Ok(())
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
        let again = if args.from.is_some() { "-again" } else { "" };
        // A part of the light is no picture of the scene, and layers are EXR.
        let (part, ending) = match (&args.only, args.paths) {
            (Some(_), _) => ("-only", &*args.format),
            (None, Some(_)) => ("-paths", "exr"),
            (None, None) => ("", &*args.format),
        };
        let output = folder.join(format!("{}{part}{again}.{ending}", stem(name)));
        if let Some(other) = taken.insert(output.clone(), name) {
            let message = format!("`{other}` and `{name}` would both be written to `{}`", output.display());
            return Err(Failure::new(USAGE, Report::error(message).help("render them with two commands")));
        }
        outputs.push(output);
    }
    Ok(outputs)
}

/// Endings of what is rendered.
const ENDINGS: &[&str] = &["txt", "toml", "json", "nff", "png", "exr", "npz"];

/// The name of a scene without its folder and its ending. Only an ending that scene files have is cut off: `eta-1.05` is a whole
/// name.
pub fn stem(name: &str) -> String {
    if name == output::STANDARD {
        return "picture".to_owned();
    }
    let path = Path::new(name);
    let known = path.extension().is_some_and(|e| ENDINGS.iter().any(|ending| e.eq_ignore_ascii_case(ending)));
    let stem = if known { path.file_stem() } else { path.file_name() };
    stem.unwrap_or_default().to_string_lossy().into_owned()
}

/// Refuses outputs that another scene of many would read only after they were written. Only a file that is there can be one.
fn keep_all_inputs(args: &RenderArgs, names: &[String], outputs: &[PathBuf]) -> Outcome {
    let there: Vec<&PathBuf> = outputs.iter().filter(|output| output.exists()).collect();
    if there.is_empty() {
        return Ok(());
    }
    // A pipe can be read once, and what cannot be read is told when it is its turn.
    for name in names.iter().filter(|name| !Path::new(name).exists() || Path::new(name).is_file()) {
        let Ok((_, loaded)) = of_scene(name, &args.reading, &Changes::from(args)) else { continue };
        there.iter().try_for_each(|output| refuse_inputs(output, loaded.files()))?;
    }
    Ok(())
}

/// Reads what is to be rendered, and how.
fn read(name: &str, args: &RenderArgs) -> Result<(Recipe, Loaded), Failure> {
    let changes = Changes::from(args);
    if let Some(path) = &args.resume {
        return kept::resumed(path, &args.reading.search, &changes);
    }
    if let Some(from) = &args.from {
        let (recipe, loaded, notes) = of_picture(from, &args.reading.search, &changes)?;
        for message in notes {
            note(args, message);
        }
        return Ok((recipe, loaded));
    }
    of_scene(name, &args.reading, &changes)
}

/// A picture knows its scene, but whoever gives one instead of a scene may not mean that.
fn refuse_picture(name: &str) -> Outcome {
    let Given::Picture(format) = what_is(name) else { return Ok(()) };
    let report = Report::error(format!("`{name}` is {}, not a scene", format.words()));
    let help = format!("if Snell made it, this makes it again, with changes or without: snell render --from {name}");
    Err(Failure::new(SCENE, report.help(help)))
}

/// Renders one picture. `inputs` are all files that were read for this and the ones before.
fn one(name: &str, args: &RenderArgs, output: &Path, inputs: &mut Vec<PathBuf>) -> Outcome {
    let reading = phase(args, "reading", name);
    let read = read(name, args);
    drop(reading);
    let (recipe, loaded) = read?;
    // A scene that a picture remembers is not read again, but is somebody's work all the same.
    let read = loaded.files().chain([Path::new(&recipe.name)]).chain(input::standard(name));
    inputs.extend(read.map(Path::to_owned));
    refuse_inputs(output, inputs.iter().map(PathBuf::as_path))?;
    if let Some(kept) = kept::file(args) {
        refuse_inputs(kept, inputs.iter().map(PathBuf::as_path))?;
    }
    let mut ready = prepare(recipe, loaded, None, args, output)?;
    warn(&ready.warnings, args);
    if ready.recipe.paths.is_some() || ready.recipe.only.is_some() {
        return paths::run(&ready.compiled, ready.recipe, args, output, ready.format);
    }
    let reporter = Reporter::new(args.progress, args.quiet, &ready.recipe.name);
    let started = Instant::now();
    let progress = |p| {
        RENDERING.store(true, Ordering::Relaxed);
        reporter.update(p);
    };
    let options = options(args, &ready.recipe, &progress);
    let rendered = if kept::is_asked(args) {
        let rendered = kept::render(&ready.compiled, &ready.compiled.settings(), &ready.recipe, args, &options);
        RENDERING.store(false, Ordering::Relaxed);
        reporter.finish();
        match rendered? {
            Some(rendered) => rendered,
            None => return Ok(()),
        }
    } else {
        ready.trace(&options)?
    };
    let seconds = started.elapsed().as_secs_f64();
    reporter.finish();
    if !rendered.film.finished.contains(&true) {
        // An empty picture would only take the place of what is there.
        return Err(Failure { code: INTERRUPTED, reports: Vec::new() });
    }

    let finished = rendered.film.is_finished();
    let unfinished;
    let mut output = output;
    if !finished && !is_standard(output) && output.is_file() {
        // What is there may have taken hours.
        unfinished = beside(output);
        output = &unfinished;
    }
    let before = ready.recipe.film_sha256.take();
    let written = ready.save_anywhere(&rendered, args, output);
    RENDERING.store(false, Ordering::Relaxed);
    written?;
    summary(&ready, &rendered, args, &options, output, seconds);
    if !finished {
        return Err(Failure { code: INTERRUPTED, reports: Vec::new() });
    }
    same_film(&ready.recipe, before.as_deref())
}

/// Says what is odd about a scene.
pub fn warn(reports: &[Report], args: &RenderArgs) {
    match args.progress {
        _ if args.quiet => {}
        ProgressKind::Json => {
            let (warnings, more, _) = say::shown(reports);
            for line in more {
                tell(&json!({ "event": "note", "message": line }).to_string());
            }
            for report in warnings {
                let place = report.place.as_ref().map(|(source, range)| {
                    let (line, column) = source.line_column(range.start);
                    json!({ "file": &*source.name, "line": line, "column": column })
                });
                let (code, message) = (report.warning.map(WarningCode::code), &report.message);
                tell(&json!({ "event": "warning", "code": code, "message": message, "place": place }).to_string());
            }
        }
        ProgressKind::Auto => say::reports(reports),
    }
}

/// Says what was done.
fn summary(ready: &Ready, rendered: &Rendered, args: &RenderArgs, options: &Options<'_>, output: &Path, seconds: f64) {
    let (recipe, world, settings) = (&ready.recipe, ready.compiled.world(), ready.compiled.settings());
    let odd = ready.odd(rendered);
    let film = &rendered.film;
    let statistics = &rendered.statistics;
    let (rays, lost) = (statistics.rays, statistics.lost);
    let (worst_x, worst_y) = lost.worst_pixel(world.camera.size[0]);
    let hash = recipe.film_sha256.as_deref();
    if args.progress == ProgressKind::Json {
        for warning in &odd {
            let (code, message) = (warning.code.code(), &warning.message);
            tell(&json!({ "event": "warning", "code": code, "message": message, "place": null }).to_string());
        }
        let tree = world.tree();
        tell(
            &json!({
                "event": if hash.is_some() { "done" } else { "interrupted" },
                "file": output, "width": film.crop.width, "height": film.crop.height, "seconds": seconds,
                "rays": { "camera": rays.camera, "mirror": rays.mirror, "refracted": rays.refracted, "shadow": rays.shadow },
                "depth": statistics.depth,
                "threads": threads::count(options.threads), "lanes": options.lanes.numbers(),
                "tree": { "nodes": tree.nodes, "leaves": tree.leaves, "depth": tree.depth },
                "lost": {
                    "rays": lost.rays, "share": lost.share(rays.camera), "worst": lost.worst(settings.spp), "worst_pixel": [worst_x, worst_y],
                },
                "film_sha256": hash,
            })
            .to_string(),
        );
        return;
    }
    if args.quiet {
        return;
    }
    let total = rays.total() as f64;
    let state = hash.map_or("stopped before it was finished".to_owned(), |h| format!("film {}", short_hash(h)));
    tell(&format!(
        "{}: {} x {}, {} rays in {seconds:.2} s ({} rays/s), {state}",
        output::shown(output),
        film.crop.width,
        film.crop.height,
        short(total),
        short(total / seconds.max(1e-9)),
    ));
    if lost.rays > 0 && settings.max_depth == 0 {
        tell("  depth 0: mirrors and glass send no rays on");
    }
    for warning in &odd {
        tell(&format!("  {warning}{}", say::advice(warning.code)));
    }
}
