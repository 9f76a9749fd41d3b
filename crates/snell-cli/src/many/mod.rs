//! `--sweep` and `--keys`: many pictures of one scene, by as many machines as run the same command on one folder.
//!
//! ```text
//!  Sweep ── of each picture: changes, a name
//!    │
//!    ▼          is it there?             may I?         is it there now?
//!  picture ──▶ there::look ── no ──▶ Claims::take ──▶ there::look ── no ──▶ ready::prepare, trace, save
//!                 │ yes                  │ no              │ yes
//!                 ▼                      ▼                 ▼
//!              skipped          later again, at the end   skipped
//! ```

mod tally;
mod there;

use crate::args::{ProgressKind, RenderArgs};
use crate::claim::{Claims, Taken};
use crate::input;
use crate::output::{is_standard, refuse_inputs};
use crate::progress::Reporter;
use crate::ready::{self, Ready};
use crate::recipe::{of_scene, of_text};
use crate::render::{self, CANCEL, RENDERING, quiet, stem};
use crate::say::{self, FAILED, Failure, INTERRUPTED, OrFail, Outcome, SCENE, USAGE, tell};
use serde_json::json;
use snell::geometry::bvh::Quality;
use snell::render::Progress;
use snell::world::CompiledScene;
use snell_formats::files::{Disk, Files, MAX_SCENE_BYTES};
use snell_formats::load::{Cache, Loaded};
use snell_formats::recipe::{Changes, Recipe};
use snell_formats::sweep::Sweep;
use snell_formats::text::decode;
use snell_formats::{Report, disk};
use std::collections::HashSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::time::{Duration, Instant};
use tally::{State, Tally};
use there::{There, look};

/// Are many pictures asked for?
pub fn is_asked(args: &RenderArgs) -> bool {
    !args.sweep.is_empty() || args.keys.is_some()
}

pub fn run(args: &RenderArgs) -> Outcome {
    let mut many = Many::new(args)?;
    // From here on ^C ends with a summary.
    RENDERING.store(true, Ordering::Relaxed);
    let ended = many.keep_all_inputs().and_then(|()| many.draw_all());
    many.reporter.finish();
    many.tally.summary(args);
    ended.and_then(|()| many.tally.outcome())
}

/// The pictures of one command.
struct Many<'a> {
    args: &'a RenderArgs,
    sweep: Sweep,
    outputs: Vec<PathBuf>,
    /// The scene without the changes of any picture.
    base: Loaded,
    cache: Arc<Cache>,
    /// All files that were read.
    inputs: HashSet<PathBuf>,
    claims: Claims,
    /// What was drawn last; the next one may share its tree.
    before: Option<CompiledScene>,
    tally: Tally,
    reporter: Reporter,
    /// Warnings that were shown: most pictures have the same.
    warned: HashSet<String>,
}

/// What came of a picture now.
enum Turn {
    Drawn,
    There,
    Elsewhere { host: String, is_alive: bool },
}

/// What goes wrong with one picture, or with all that would follow.
enum Trouble {
    One(Failure),
    All(Failure),
}

impl From<Failure> for Trouble {
    fn from(failure: Failure) -> Self {
        Self::One(failure)
    }
}

impl<'a> Many<'a> {
    /// Reads everything, and finds what is sure to fail before anything is drawn.
    fn new(args: &'a RenderArgs) -> Result<Self, Failure> {
        let [scene] = args.scenes.as_slice() else {
            let report = Report::error(format!("--sweep and --keys are of one scene, not of {}", args.scenes.len()));
            return Err(Failure::new(USAGE, report.help("render the scenes with several commands")));
        };
        let keys = args.keys.as_deref().map(read_keys).transpose()?;
        let sweep = Sweep::new(&args.sweep, keys.as_ref(), args.frames).or_fail(USAGE)?;
        let outputs = sweep.names(&pattern(args, &sweep, scene)?).or_fail(USAGE)?;
        let (_, base) = of_scene(scene, &args.reading, &Changes::from(args))?;
        sweep.check(&base.scene).or_fail(USAGE)?;
        let inputs =
            base.files().chain(args.keys.as_deref()).chain(input::standard(scene)).map(Path::to_owned).collect();
        let mut many = Self {
            args,
            tally: Tally::new(outputs.len()),
            reporter: Reporter::new(args.progress, args.quiet, &base.source.name),
            sweep,
            outputs,
            base,
            cache: Arc::default(),
            inputs,
            claims: Claims::new(),
            before: None,
            warned: HashSet::new(),
        };
        // What cannot be read now cannot be read a thousand times.
        many.read(0)?;
        many.refuse_inputs()?;
        many.make_folders()?;
        Ok(many)
    }

    /// Refuses pictures that are files which were read. Only what is there can be one.
    fn refuse_inputs(&self) -> Outcome {
        let there: Vec<&PathBuf> = self.outputs.iter().filter(|output| output.exists()).collect();
        there.iter().try_for_each(|output| refuse_inputs(output, self.inputs.iter().map(PathBuf::as_path)))
    }

    fn make_folders(&self) -> Outcome {
        let folders: HashSet<&Path> = self.outputs.iter().filter_map(|output| output.parent()).collect();
        let make = |folder: &Path| {
            let made = if folder.as_os_str().is_empty() { Ok(()) } else { std::fs::create_dir_all(folder) };
            made.map_err(|e| {
                let report = Report::error(format!("cannot make the folder `{}`: {e}", folder.display()));
                Failure::new(if folder.exists() { USAGE } else { FAILED }, report)
            })
        };
        folders.into_iter().try_for_each(make)
    }

    /// Refuses to write over what a later picture reads, which only a text can name: all are read before one is drawn.
    fn keep_all_inputs(&mut self) -> Outcome {
        if !self.sweep.has_texts() || !self.outputs.iter().any(|output| output.exists()) {
            return Ok(());
        }
        for number in 0..self.outputs.len() {
            stop_if_cancelled()?;
            // What cannot be read is told when it is its turn.
            let _ = self.read(number);
        }
        self.refuse_inputs()
    }

    /// The scene of a picture, and how it is made.
    fn read(&mut self, number: usize) -> Result<(Recipe, Loaded), Failure> {
        let mut changes = Changes::from(self.args);
        changes.set.extend(self.sweep.changes(number));
        let (recipe, loaded) = of_text(&self.base, &self.args.reading, &self.cache, &changes)?;
        self.cache.keep_only(&loaded.models);
        self.inputs.extend(loaded.files().map(Path::to_owned));
        Ok((recipe, loaded))
    }

    fn draw_all(&mut self) -> Outcome {
        let mut others = Vec::new();
        for number in 0..self.outputs.len() {
            if self.turn(number)? {
                others.push(number);
            }
        }
        let mut said = false;
        while !others.is_empty() {
            let mut waiting = Vec::new();
            for number in others {
                if self.turn(number)? {
                    waiting.push(number);
                }
            }
            others = waiting;
            if let (Some(first), false) = (others.first(), std::mem::replace(&mut said, true)) {
                self.say_waiting(others.len(), *first);
            }
            let until = Instant::now() + (self.claims.stale() / 10).min(Duration::from_millis(500));
            while !others.is_empty() && Instant::now() < until {
                stop_if_cancelled()?;
                std::thread::sleep(Duration::from_millis(50));
            }
        }
        Ok(())
    }

    fn say_waiting(&self, count: usize, first: usize) {
        let seconds = self.claims.stale().as_secs_f64();
        let hosts = self.tally.hosts();
        let name = self.outputs[first].display();
        let message = format!(
            "waiting for what other processes have claimed ({hosts}): {count} in all, `{name}` first; until they are done, or their \
             claims have not been renewed for {seconds:.0} s"
        );
        match self.args.progress {
            _ if self.args.quiet => {}
            ProgressKind::Json => tell(&json!({ "event": "note", "message": message }).to_string()),
            ProgressKind::Auto => self.reporter.aside(|| tell(&message)),
        }
    }

    /// Draws a picture, or finds why not. Returns whether somebody else has it, of whom it is not known that he is alive.
    fn turn(&mut self, number: usize) -> Result<bool, Failure> {
        stop_if_cancelled()?;
        let (state, again) = match self.draw(number) {
            Ok(Turn::Drawn) => (State::Drawn, false),
            Ok(Turn::There) => (State::There, false),
            Ok(Turn::Elsewhere { host, is_alive }) => (State::Elsewhere(host), !is_alive),
            Err(Trouble::One(failure)) if failure.code != INTERRUPTED => {
                (State::Failed(self.say_failure(number, failure)), false)
            }
            Err(Trouble::One(failure) | Trouble::All(failure)) => return Err(failure),
        };
        self.event(number, state.word());
        self.tally.note(number, &self.outputs[number], state);
        Ok(again)
    }

    /// The first few failures are told in full. Returns the exit code.
    fn say_failure(&self, number: usize, failure: Failure) -> u8 {
        let reports = quiet(failure.reports, self.args);
        match self.args.progress {
            ProgressKind::Json => {
                let messages: Vec<String> = reports.iter().map(ToString::to_string).collect();
                let (file, code) = (&self.outputs[number], failure.code);
                tell(&json!({ "event": "failure", "file": file, "code": code, "messages": messages }).to_string());
            }
            ProgressKind::Auto if self.tally.failures() < SHOWN_FAILURES => self.reporter.aside(|| {
                tell(&format!("{} is not drawn:", self.outputs[number].display()));
                say::reports(&reports);
            }),
            ProgressKind::Auto => {}
        }
        failure.code
    }

    fn event(&self, number: usize, state: &str) {
        if self.args.progress == ProgressKind::Json {
            let (file, of) = (&self.outputs[number], self.outputs.len());
            tell(&json!({ "event": "picture", "file": file, "number": number, "of": of, "state": state }).to_string());
        }
    }

    fn draw(&mut self, number: usize) -> Result<Turn, Trouble> {
        let output = self.outputs[number].clone();
        if self.is_there(number, &output)? {
            self.claims.clear(&output);
            return Ok(Turn::There);
        }
        let taken = self.claims.take(&output).or_fail(FAILED).map_err(Trouble::All)?;
        let claim = match taken {
            Taken::Mine(claim) => claim,
            Taken::Other { host, is_alive } => return Ok(Turn::Elsewhere { host, is_alive }),
        };
        // Somebody may have drawn it before it was claimed here.
        if self.is_there(number, &output)? {
            return Ok(Turn::There);
        }
        let (recipe, loaded) = self.read(number)?;
        refuse_inputs(&output, self.inputs.iter().map(PathBuf::as_path))?;
        disk::check_writable(&output).or_fail(FAILED)?;
        self.event(number, "drawing");
        let before = self.before.take();
        let mut ready = ready::prepare(recipe, loaded, before.as_ref(), self.args, &output)?;
        drop(before);
        self.warn(&ready.warnings);
        let rendered = self.trace(&ready)?;
        if !rendered.film.is_finished() {
            return Err(Failure { code: INTERRUPTED, reports: Vec::new() }.into());
        }
        // A machine whose locks are not seen here may take a file that is being written for abandoned: once more.
        let written = ready.save(&rendered, self.args, &output);
        let written = written.or_else(|_| ready.save_anywhere(&rendered, self.args, &output));
        // Where one cannot be written, the next one would be drawn for nothing too.
        written.map_err(Trouble::All)?;
        drop(claim);
        self.warn_of_picture(&output, &ready.odd(&rendered));
        self.tally.rays += rendered.statistics.rays.total();
        // What is shared has a tree of the usual quality.
        let is_shared = self.sweep.keeps_shapes() && self.args.bvh == Quality::default();
        self.before = is_shared.then_some(ready.compiled);
        Ok(Turn::Drawn)
    }

    /// Is the picture finished? Fails if something else is in its place.
    fn is_there(&mut self, number: usize, output: &Path) -> Result<bool, Failure> {
        if output.symlink_metadata().is_err() {
            return Ok(false);
        }
        let (mut recipe, mut loaded) = self.read(number)?;
        recipe.apply(loaded.scene_mut());
        recipe.resolve(&loaded.scene);
        match look(output, &recipe) {
            There::Finished => Ok(true),
            There::Nothing | There::Another => Ok(false),
            There::Foreign(why) => {
                let report = Report::error(format!("`{}` is not written over: {why}", output.display()));
                Err(Failure::new(SCENE, report.help("remove it, or choose other names with -o")))
            }
        }
    }

    fn trace(&self, ready: &Ready) -> Result<snell::render::Rendered, Failure> {
        let (done, total, rays) = (self.tally.drawn(), self.tally.to_draw(), self.tally.rays);
        let one =
            (self.args.progress == ProgressKind::Json).then(|| Reporter::new(self.args.progress, self.args.quiet, ""));
        self.reporter.now(format!("picture {} of {}", self.tally.settled() + 1, self.outputs.len()));
        let update = |progress: Progress| match &one {
            Some(one) => one.update(progress),
            None => self.reporter.update(Progress {
                pixels: done * progress.total_pixels + progress.pixels,
                total_pixels: total * progress.total_pixels,
                rays: rays + progress.rays,
            }),
        };
        ready.trace(&ready::options(self.args, &ready.recipe, &update))
    }

    /// Says what is odd about a scene, but nothing twice.
    fn warn(&mut self, warnings: &[Report]) {
        let new: Vec<Report> = warnings.iter().filter(|w| self.warned.insert(w.to_string())).cloned().collect();
        self.reporter.aside(|| render::warn(&new, self.args));
    }

    /// Says what is odd about a picture, each kind once.
    fn warn_of_picture(&mut self, output: &Path, odd: &[snell::scene::Warning]) {
        for warning in odd {
            let code = warning.code.code();
            if self.warned.insert(code.to_owned()) {
                let message = format!("{}: {}{}", output.display(), warning.message, say::advice(warning.code));
                let report = Report::warning(warning.code, message);
                self.reporter.aside(|| render::warn(&[report], self.args));
            }
        }
    }
}

/// More failures than this are counted.
const SHOWN_FAILURES: usize = 3;

fn stop_if_cancelled() -> Outcome {
    if CANCEL.load(Ordering::Relaxed) { Err(Failure { code: INTERRUPTED, reports: Vec::new() }) } else { Ok(()) }
}

fn read_keys(path: &Path) -> Result<snell_formats::Source, Failure> {
    let bytes = Disk.read(path, MAX_SCENE_BYTES).or_fail(USAGE)?;
    Ok(decode(&path.display().to_string(), &bytes).0)
}

/// How the pictures are called.
fn pattern(args: &RenderArgs, sweep: &Sweep, scene: &str) -> Result<String, Failure> {
    let usual = || sweep.usual_pattern(&stem(scene), &args.format);
    let Some(output) = &args.output else { return Ok(usual()) };
    if is_standard(output) {
        let report = Report::error("many pictures do not go to standard output");
        return Err(Failure::new(USAGE, report.help("name them with a pattern, like -o 'f_{index}.png'")));
    }
    let Some(text) = output.to_str() else {
        return Err(Failure::new(USAGE, Report::error(format!("`{}` is no UTF-8 text", output.display()))));
    };
    let folder = text.trim_end_matches(['/', std::path::MAIN_SEPARATOR]);
    Ok(if output.is_dir() {
        format!("{}/{}", snell_formats::sweep::escaped(folder), usual())
    } else if text.ends_with(['/', std::path::MAIN_SEPARATOR]) {
        format!("{folder}/{}", usual())
    } else {
        text.to_owned()
    })
}
