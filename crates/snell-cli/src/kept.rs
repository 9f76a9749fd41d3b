//! `--part`, `--checkpoint`, `--resume`: what is kept of a picture that is not, or not yet, whole.

use crate::args::{ProgressKind, RenderArgs};
use crate::say::{FAILED, Failure, INTERRUPTED, OrFail, SCENE, USAGE, tell};
use serde_json::json;
use snell::film::Crop;
use snell::render::{Grid, Options, PartialFilm, RenderError, Rendered, Settings};
use snell::world::CompiledScene;
use snell_formats::files::{Disk, Files, MAX_SCENE_BYTES};
use snell_formats::load::Loaded;
use snell_formats::part::{self, Header, PartFile};
use snell_formats::recipe::{Changes, Recipe};
use snell_formats::text::decode;
use snell_formats::{Report, disk};
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};

/// Is anything to be kept but the picture?
pub fn is_asked(args: &RenderArgs) -> bool {
    args.part.is_some() || args.checkpoint.is_some() || args.resume.is_some()
}

/// How often it is kept, if nobody says.
const EVERY: Duration = Duration::from_secs(30);

/// The file that is kept, if there is one.
pub fn file(args: &RenderArgs) -> Option<&Path> {
    [&args.part, &args.checkpoint, &args.resume].into_iter().flatten().next().map(PathBuf::as_path)
}

/// The recipe of a part, with more samples if they are asked for, and its scene as it was.
pub fn resumed(path: &Path, search: &[PathBuf], changes: &Changes) -> Result<(Recipe, Loaded), Failure> {
    let header = PartFile::open(path).or_fail(FAILED)?.header().clone();
    let shown = path.display();
    let of_the_file = Changes { spp: None, transfer: None, rounding: None, bits: None, ..changes.clone() };
    if of_the_file != Changes::default() {
        let report = Report::error(format!("`{shown}` is a part of a picture, which goes on as it was begun"));
        return Err(Failure::new(USAGE, report.help("only --spp, and how the picture is written, can be another one")));
    }
    if let Some(spp) = changes.spp {
        let most = header.pieces.iter().flat_map(|piece| &piece.samples).map(|range| range[1]).max().unwrap_or(0);
        if spp < most {
            let report =
                Report::error(format!("`{shown}` has {most} samples of a pixel, more than the {spp} of --spp"));
            return Err(Failure::new(USAGE, report));
        }
        if header.spp == 1 && spp > 1 {
            let message = format!("`{shown}` has one sample per pixel, the point of the grid, which is none of many");
            return Err(Failure::new(USAGE, Report::error(message).help("render it anew with --spp")));
        }
    }
    let mut recipe = header.recipe;
    same_text(&recipe, path)?;
    recipe.change(changes);
    let loaded = recipe.load(search).or_fail(SCENE)?;
    Ok((recipe, loaded))
}

/// Fails if the file of the scene has been changed meanwhile; one that is gone is no change.
fn same_text(recipe: &Recipe, path: &Path) -> Result<(), Failure> {
    let scene = Path::new(&recipe.name);
    let Some(bytes) = scene.is_file().then(|| Disk.read(scene, MAX_SCENE_BYTES).ok()).flatten() else { return Ok(()) };
    let mut now = recipe.clone();
    decode(&recipe.name, &bytes).0.text.as_ref().clone_into(&mut now.text);
    match recipe.difference(&now) {
        None => Ok(()),
        Some(what) => {
            let message = format!("`{}` has changed since `{}` was begun: {what}", recipe.name, path.display());
            let help = "put the scene back as it was, or render it anew";
            Err(Failure::new(SCENE, Report::error(message).help(help)))
        }
    }
}

/// Renders what is missing, and keeps it in the file from time to time. Returns the picture, but for a part.
pub fn render(
    compiled: &CompiledScene,
    settings: &Settings,
    recipe: &Recipe,
    args: &RenderArgs,
    options: &Options<'_>,
) -> Result<Option<Rendered>, Failure> {
    let size = compiled.world().camera.size;
    let crop = options.crop_of(compiled.world()).map_err(of_render)?;
    let mut film = begun(size, crop, args)?;
    let [first, end] = args.samples.unwrap_or([0, settings.spp]);
    let (file, started) = (file(args), Instant::now());
    let last = args.until.map(|until| started + until);
    let (mut writing, mut written) = (Duration::ZERO, 0u32);
    loop {
        let next = Instant::now() + args.every.unwrap_or(EVERY);
        let until = if file.is_some() { Some(last.map_or(next, |last| last.min(next))) } else { last };
        film.render(compiled.world(), settings, first..end, options, until).map_err(of_render)?;
        let is_cancelled = options.cancel.is_some_and(|cancel| cancel.load(Ordering::Relaxed));
        let is_done = film.has(first..end);
        let is_late = last.is_some_and(|last| Instant::now() >= last);
        if let Some(file) = file {
            let at = Instant::now();
            let header = Header::new(recipe, size, film.pieces(), film.statistics());
            match keep(file, &header, &film) {
                Ok(()) => {
                    written += 1;
                    if args.progress == ProgressKind::Json {
                        let writing = (writing + at.elapsed()).as_secs_f64();
                        let mut event = of_kept("kept", file, &header);
                        event["times"] = written.into();
                        event["writing_seconds"] = writing.into();
                        event["seconds"] = started.elapsed().as_secs_f64().into();
                        tell(&event.to_string());
                    }
                }
                Err(report) if is_cancelled || is_late || is_done && args.part.is_some() => {
                    return Err(Failure::new(FAILED, rescue(report, file, &header, &film)));
                }
                Err(report) => not_kept(&report, args),
            }
            writing += at.elapsed();
        }
        if is_done {
            break;
        }
        if is_cancelled || is_late {
            if let Some(file) = file {
                stopped(file, &Header::new(recipe, size, film.pieces(), film.statistics()), args);
            }
            return Err(Failure { code: INTERRUPTED, reports: Vec::new() });
        }
    }
    if let Some(file) = &args.part {
        if !args.quiet && args.progress == ProgressKind::Auto {
            let (rays, seconds) = (film.statistics().rays.total(), started.elapsed().as_secs_f64());
            tell(&format!("{}: samples {first} to {}, {rays} rays in {seconds:.2} s", file.display(), end - 1));
        }
        return Ok(None);
    }
    let picture = film.film(settings.spp).map_err(|e| Failure::new(SCENE, Report::error(e.to_string())))?;
    Ok(Some(Rendered { film: picture, statistics: film.statistics() }))
}

fn of_render(error: RenderError) -> Failure {
    let code = if matches!(error, RenderError::OtherModel { .. }) { SCENE } else { USAGE };
    Failure::new(code, Report::error(error.to_string()))
}

/// Nothing yet, or what has been kept.
fn begun(size: [u32; 2], mut crop: Crop, args: &RenderArgs) -> Result<PartialFilm, Failure> {
    if let Some([first, end]) = args.rows {
        if first < crop.y || end > crop.y + crop.height {
            let rows = format!("rows {} to {}", crop.y, crop.y + crop.height - 1);
            let report = Report::error(format!("no rows {first} to {}: the picture has {rows}", end - 1));
            return Err(Failure::new(USAGE, report));
        }
        crop = Crop { y: first, height: end - first, ..crop };
    }
    let Some(path) = &args.resume else { return Ok(PartialFilm::new(size, crop, Grid::new(crop, args.tile, []))) };
    let mut part = PartFile::open(path).or_fail(FAILED)?;
    if (part.header().size, part.header().crop) != (size, crop) {
        let message = format!("`{}` is not of the picture that its recipe makes", path.display());
        return Err(Failure::new(FAILED, Report::error(message).help("render it anew")));
    }
    let pieces = part.header().pieces.clone();
    let grid = Grid::new(crop, args.tile, pieces.iter().map(|piece| piece.rect));
    let mut film = PartialFilm::new(size, crop, grid);
    for (number, piece) in pieces.iter().enumerate() {
        let rows = piece.rect.y..piece.rect.y + piece.rect.height;
        let (sums, lost) = (part.sums(number, &rows).or_fail(FAILED)?, part.lost(number, &rows).or_fail(FAILED)?);
        let twice = |twice: snell::trace::Twice| Report::error(format!("`{}`: {twice}", path.display()));
        film.insert(piece, &sums, &lost).map_err(twice).or_fail(FAILED)?;
    }
    film.count(&part.header().statistics);
    Ok(film)
}

fn keep(file: &Path, header: &Header, film: &PartialFilm) -> Result<(), Report> {
    disk::write(file, |out| part::write(out, header, film))
}

/// So many pieces are listed in an event.
const LISTED: usize = 100;

/// What a file that is kept has, for a farm that shows it.
fn of_kept(event: &str, file: &Path, header: &Header) -> serde_json::Value {
    let pieces = &header.pieces[..header.pieces.len().min(LISTED)];
    let more = header.pieces.len() - pieces.len();
    json!({ "event": event, "file": file, "share": header.share(), "pieces": pieces, "more_pieces": more })
}

/// Says that the disk is full, or what else it is.
fn not_kept(report: &Report, args: &RenderArgs) {
    let message = format!("{report}; what was kept before stays, and the render goes on");
    tell(&match args.progress {
        ProgressKind::Json => json!({ "event": "note", "message": message }).to_string(),
        ProgressKind::Auto => format!("warning: {message}"),
    });
}

/// Keeps elsewhere what cannot be kept where it should be, if possible, so that no work is lost.
fn rescue(report: Report, file: &Path, header: &Header, film: &PartialFilm) -> Report {
    let name = file.file_stem().unwrap_or_default().to_string_lossy();
    let elsewhere = std::env::temp_dir().join(format!("snell-{}-{name}.npz", std::process::id()));
    match keep(&elsewhere, header, film) {
        Ok(()) => report.help(format!("what is done is kept as {}", elsewhere.display())),
        Err(_) => report,
    }
}

/// The option that names the picture, if there was one, to be given again.
pub fn output_argument(args: &RenderArgs) -> String {
    args.output.as_ref().map_or_else(String::new, |output| format!(" -o {}", output.display()))
}

/// Says how far it has come, and how it goes on.
fn stopped(file: &Path, header: &Header, args: &RenderArgs) {
    if args.progress == ProgressKind::Json {
        tell(&of_kept("interrupted", file, header).to_string());
    } else if !args.quiet {
        let (percent, shown, output) = (100.0 * header.share(), file.display(), output_argument(args));
        tell(&format!(
            "stopped: {percent:.1} % of the samples are kept in {shown}; go on with: snell render --resume {shown}{output}"
        ));
    }
}
