//! From a name to a scene with its models: the one way in for scene files, drivers and built-in scenes.

mod models;
mod pictures;

use crate::driver::{self, Dialect, Driver};
use crate::nff::{self, Nff};
use crate::report::{Report, Source};
use crate::scene_file::{self, Syntax};
use crate::{builtin, disk};
use models::ModelReader;
use serde::{Deserialize, Serialize};
use snell::geometry::bvh::Quality;
use snell::scene::{Problem, Scene, Step, Warning};
use snell::world::World;
use std::ops::Range;
use std::path::{Path, PathBuf};

/// A scene with more problems than this has them counted, not listed.
pub const MOST_PROBLEMS: usize = 15;

/// How to read a scene.
#[derive(Clone, Debug, Default)]
pub struct LoadOptions {
    /// Folders in which models are looked for first.
    pub search: Vec<PathBuf>,
    /// The year of a driver; `None` recognises it.
    pub dialect: Option<Dialect>,
    /// Changes, `key=value`, in order.
    pub set: Vec<String>,
}

/// What a text is.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Kind {
    /// A scene file.
    Toml,
    /// A scene file.
    Json,
    /// A driver file.
    Driver,
    /// Haines' Neutral File Format.
    Nff,
}

/// A file that a scene depends on besides its own text.
#[derive(Clone, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub struct ModelFile {
    /// Where it was found.
    pub path: PathBuf,
    /// SHA-256 of its bytes, in hexadecimal.
    pub sha256: String,
}

/// A scene with its models.
#[derive(Clone, Debug)]
pub struct Loaded {
    /// The scene, every mesh with its triangles.
    pub scene: Scene,
    /// Its text, before any change.
    pub source: Source,
    /// What the text is.
    pub kind: Kind,
    /// The year, if it is a driver.
    pub dialect: Option<Dialect>,
    /// Folder that file names are relative to.
    pub folder: PathBuf,
    /// All files with models, materials and pictures that were read.
    pub models: Vec<ModelFile>,
    /// For each mesh the file it comes from.
    pub mesh_paths: Vec<Option<PathBuf>>,
    /// What is odd.
    pub warnings: Vec<Report>,
    places: Places,
}

/// Where the values of the scene stand in a text.
#[derive(Clone, Debug)]
enum Places {
    Text(Source, Syntax),
    Driver(Source, Box<Driver>),
    Nff(Source, Box<Nff>),
}

impl Places {
    fn find(&self, steps: &[Step]) -> Option<(&Source, Range<usize>)> {
        match self {
            Self::Text(source, syntax) => scene_file::place(steps, source, *syntax).map(|range| (source, range)),
            Self::Driver(source, driver) => driver.place(steps).map(|range| (source, range)),
            Self::Nff(source, nff) => nff.place(steps).map(|range| (source, range)),
        }
    }

    fn put(&self, report: Report, steps: &[Step]) -> Report {
        match self.find(steps) {
            Some((source, range)) => report.at(source, range),
            None => report,
        }
    }
}

/// A name with one of these is meant as a file.
const ENDINGS: &[&str] = &["txt", "toml", "json", "nff"];

/// Reads a scene file, a driver, an NFF file, or a built-in scene.
///
/// # Errors
/// Everything that keeps the file from being read.
pub fn load(name: &str, options: &LoadOptions) -> Result<Loaded, Vec<Report>> {
    let path = Path::new(name);
    if path.is_dir() {
        return Err(vec![Report::error(format!("`{name}` is a folder")).help("name the scene file in it")]);
    }
    if !path.exists() {
        return match builtin::find(name) {
            Ok(source) => load_text(source, Kind::Toml, Path::new("."), options),
            Err(_) if path.extension().is_some_and(|e| ENDINGS.iter().any(|&ending| e == ending)) => {
                Err(vec![Report::error(format!("there is no file `{name}`"))])
            }
            Err(report) => Err(vec![report]),
        };
    }
    let source = disk::read_text(path, disk::MAX_SCENE_BYTES)?;
    let kind = kind_of(path, &source.text);
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    load_text(source, kind, folder, options)
}

/// What a text is: by its ending, or by how it starts.
fn kind_of(path: &Path, text: &str) -> Kind {
    match path.extension().and_then(|e| e.to_str()) {
        Some("toml") => Kind::Toml,
        Some("json") => Kind::Json,
        Some("txt") => Kind::Driver,
        Some("nff") => Kind::Nff,
        _ => {
            let first = text.lines().map(str::trim).find(|l| !l.is_empty() && !l.starts_with('#')).unwrap_or("");
            match first {
                _ if first.starts_with('{') => Kind::Json,
                _ if first.starts_with('[') || first.contains('=') => Kind::Toml,
                _ => Kind::Driver,
            }
        }
    }
}

/// Reads a scene from its text. File names are relative to `folder`.
///
/// # Errors
/// As [`load`].
pub fn load_text(source: Source, kind: Kind, folder: &Path, options: &LoadOptions) -> Result<Loaded, Vec<Report>> {
    load_with(source, kind, folder, options, |_| {})
}

/// The same for a scene of which something large is already in memory: `fill` puts it in before models are read.
///
/// # Errors
/// As [`load`].
pub fn load_with(
    source: Source,
    kind: Kind,
    folder: &Path,
    options: &LoadOptions,
    fill: impl FnOnce(&mut Scene),
) -> Result<Loaded, Vec<Report>> {
    let mut warnings = Vec::new();
    let mut dialect = None;
    let (mut scene, places) = match kind {
        Kind::Driver => {
            let mut driver = driver::parse(&source, options.dialect)?;
            dialect = Some(driver.dialect);
            warnings.append(&mut driver.warnings);
            let scene = driver.scene_with_models();
            let places = Places::Driver(source.clone(), Box::new(driver));
            rewritten(scene, places, &source, &options.set)?
        }
        Kind::Nff => {
            let mut nff = nff::parse(&source)?;
            warnings.append(&mut nff.warnings);
            rewritten(nff.scene.clone(), Places::Nff(source.clone(), Box::new(nff)), &source, &options.set)?
        }
        Kind::Toml => changed(source.clone(), Syntax::Toml, &options.set)?,
        Kind::Json => changed(source.clone(), Syntax::Json, &options.set)?,
    };
    fill(&mut scene);
    let mut reader = ModelReader::new(folder, &options.search, dialect, warnings);
    let mut loaded = Loaded {
        scene,
        source,
        kind,
        dialect,
        folder: folder.to_owned(),
        models: Vec::new(),
        mesh_paths: Vec::new(),
        warnings: Vec::new(),
        places,
    };
    for index in 0..loaded.scene.meshes.len() {
        let path = reader.read_mesh(&mut loaded, index)?;
        loaded.mesh_paths.push(path);
    }
    loaded.models = reader.files;
    loaded.warnings = reader.warnings;
    pictures::read(&mut loaded, &options.search)?;
    Ok(loaded)
}

/// What is no scene file is changed as the scene file that it could be.
fn rewritten(scene: Scene, places: Places, source: &Source, set: &[String]) -> Result<(Scene, Places), Report> {
    if set.is_empty() {
        return Ok((scene, places));
    }
    let text = scene_file::to_text(&scene, Syntax::Toml)?;
    changed(Source::new(format!("{} as a scene", source.name), text), Syntax::Toml, set)
}

fn changed(source: Source, syntax: Syntax, set: &[String]) -> Result<(Scene, Places), Report> {
    let (mut source, mut syntax) = (source, syntax);
    for change in set {
        source = scene_file::set(&source, syntax, change)?;
        syntax = Syntax::Toml;
    }
    Ok((scene_file::parse(&source, syntax)?, Places::Text(source, syntax)))
}

impl Loaded {
    /// A problem of the scene, at its place in the text.
    pub fn report(&self, problem: &Problem) -> Report {
        let mut report = Report::error(problem.message.clone());
        report.help.clone_from(&problem.help);
        self.places.put(report, &problem.place)
    }

    /// A warning of the scene, at its place in the text.
    pub fn warning(&self, warning: &Warning) -> Report {
        self.places.put(Report::warning(warning.code, warning.message.clone()), &warning.place)
    }

    /// All warnings, of the files and of the compiled scene, each at its place.
    pub fn warnings_with(&self, world: &World) -> Vec<Report> {
        let located = world.warnings.iter().take(MOST_PROBLEMS).map(|w| self.warning(w));
        let unlocated = world.warnings.iter().skip(MOST_PROBLEMS);
        let unlocated = unlocated.map(|w| Report::warning(w.code, w.message.clone()));
        self.warnings.iter().cloned().chain(located).chain(unlocated).collect()
    }

    /// Compiles the scene.
    ///
    /// # Errors
    /// What is wrong with it, each at its place; from [`MOST_PROBLEMS`] on only their number.
    pub fn world(&self) -> Result<World, Vec<Report>> {
        self.build(Quality::default(), 0)
    }

    /// Compiles the scene with a tree of this quality, on so many threads; see [`World::build`].
    ///
    /// # Errors
    /// As [`world`](Self::world).
    pub fn build(&self, quality: Quality, threads: usize) -> Result<World, Vec<Report>> {
        World::build(&self.scene, quality, threads).map_err(|problems| {
            let mut reports: Vec<Report> = problems.iter().take(MOST_PROBLEMS).map(|p| self.report(p)).collect();
            if problems.len() > MOST_PROBLEMS {
                let more = problems.len() - MOST_PROBLEMS;
                reports.push(Report::error(format!("{more} more problems like these")));
            }
            reports
        })
    }
}
