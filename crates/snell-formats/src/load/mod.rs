//! From a name to a scene with its models: the one way in for scene files, drivers and built-in scenes.

mod cache;
mod models;
#[cfg(feature = "disk")]
mod named;
mod pictures;

pub use cache::Cache;
#[cfg(feature = "disk")]
pub use named::load;

use crate::driver::{self, Dialect, Driver};
use crate::files::{self, Files};
use crate::given::given;
use crate::model::Finder;
use crate::nff::{self, Nff};
use crate::report::{Report, Source};
use crate::scene_file::{self, Syntax};
use crate::text::decode;
use models::ModelReader;
use serde::{Deserialize, Serialize};
use snell::geometry::bvh::Quality;
use snell::scene::{Integrator, Problem, Problems, Scene, Step, Warning};
use snell::world::{CompiledScene, World};
use std::collections::HashMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A scene with more problems than this has them counted, not listed.
pub const MOST_PROBLEMS: usize = 15;

/// How to read a scene.
#[derive(Clone, Debug)]
pub struct LoadOptions {
    /// Where models and pictures lie: by default on the disk, or nowhere without the feature `disk`.
    pub files: Arc<dyn Files>,
    /// Folders in which models are looked for first.
    pub search: Vec<PathBuf>,
    /// The year of a driver; `None` recognises it.
    pub dialect: Option<Dialect>,
    /// Changes, `key=value`, in order.
    pub set: Vec<String>,
    /// The model of light, if it is to be another than the scene's; some read more of the materials of models than others.
    pub integrator: Option<Integrator>,
    /// Models and pictures that were read before, and stay what they were then.
    pub cache: Option<Arc<Cache>>,
}

impl Default for LoadOptions {
    fn default() -> Self {
        #[cfg(feature = "disk")]
        let files = files::Disk;
        #[cfg(not(feature = "disk"))]
        let files = files::InMemory::default();
        Self {
            files: Arc::new(files),
            search: Vec::new(),
            dialect: None,
            set: Vec::new(),
            integrator: None,
            cache: None,
        }
    }
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
    pub scene: Arc<Scene>,
    /// The file that it was read from; `None` for a text that was in memory.
    pub path: Option<PathBuf>,
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
    /// For each picture, by the name that the scene has for it, where it was found.
    pub picture_paths: HashMap<String, PathBuf>,
    /// What is odd.
    pub warnings: Vec<Report>,
    places: Places,
}

/// Where the values of the scene stand in its text, or in the changes of that.
#[derive(Clone, Debug)]
struct Places {
    text: Text,
    /// Steps to what was changed, and the text of the change.
    changes: Vec<(Vec<Step>, Source)>,
}

#[derive(Clone, Debug)]
enum Text {
    File(Source, Syntax),
    Driver(Source, Box<Driver>),
    Nff(Source, nff::Places),
}

impl Places {
    fn find(&self, places: &[&[Step]]) -> Vec<Option<(&Source, Range<usize>)>> {
        let changed = |steps: &[Step]| {
            let of = |place: &[Step]| {
                steps.starts_with(place)
                    || place.split_last().is_some_and(|(last, list)| matches!(last, Step::Index(_)) && list == steps)
            };
            let change = self.changes.iter().rev().find(|(place, _)| of(place));
            change.map(|(_, source)| (source, 0..source.text.len()))
        };
        let in_text: Vec<Option<(&Source, Range<usize>)>> = match &self.text {
            Text::File(source, syntax) => {
                let found = scene_file::places(places, source, *syntax);
                found.into_iter().map(|range| Some((source, range?))).collect()
            }
            Text::Driver(source, driver) => places.iter().map(|steps| Some((source, driver.place(steps)?))).collect(),
            Text::Nff(source, nff) => places.iter().map(|steps| Some((source, nff.find(steps)?))).collect(),
        };
        places.iter().zip(in_text).map(|(steps, found)| changed(steps).or(found)).collect()
    }

    fn put(&self, report: Report, steps: &[Step]) -> Report {
        self.put_all(vec![(report, steps)]).remove(0)
    }

    fn put_all(&self, reports: Vec<(Report, &[Step])>) -> Vec<Report> {
        let places: Vec<&[Step]> = reports.iter().map(|(_, steps)| *steps).collect();
        let found = self.find(&places).into_iter();
        let put = |(report, found): (Report, Option<(&Source, Range<usize>)>)| match found {
            Some((source, range)) => report.at(source, range),
            None => report,
        };
        reports.into_iter().map(|(report, _)| report).zip(found).map(put).collect()
    }
}

/// Reads a scene from bytes, of a kind that the ending of `path` tells, or how they start.
///
/// # Errors
/// Everything that keeps the scene from being read.
pub fn load_bytes(
    name: &str,
    path: &Path,
    bytes: &[u8],
    folder: &Path,
    options: &LoadOptions,
) -> Result<Loaded, Vec<Report>> {
    if let Some(report) = given(path, bytes).no_scene(name) {
        return Err(vec![report]);
    }
    let (source, warning) = decode(name, bytes);
    let kind = kind_of(path, &source.text);
    if kind == Kind::Driver && !driver::has_keywords(&source) {
        let help = "scenes are TOML or JSON, drivers of the course, or NFF; docs/scenes.md has an example of each";
        return Err(vec![Report::error(format!("`{name}` is no scene that Snell knows")).help(help)]);
    }
    let loaded = load_text(source, kind, folder, options);
    match (loaded, warning) {
        (Ok(mut loaded), warning) => {
            loaded.warnings.splice(0..0, warning);
            Ok(loaded)
        }
        (Err(reports), warning) => Err(warning.into_iter().chain(reports).collect()),
    }
}

/// What a text is: by the ending of its name, or by how it starts.
pub fn kind_of(path: &Path, text: &str) -> Kind {
    match path.extension().and_then(|e| e.to_str()).map(str::to_ascii_lowercase).as_deref() {
        Some("toml") => Kind::Toml,
        Some("json") => Kind::Json,
        Some("txt") => Kind::Driver,
        Some("nff") => Kind::Nff,
        _ => {
            let first = text.lines().map(str::trim).find(|l| !l.is_empty() && !l.starts_with('#')).unwrap_or("");
            match first {
                _ if first.starts_with('{') => Kind::Json,
                _ if is_nff(first) => Kind::Nff,
                _ if first.starts_with('[') || first.contains('=') => Kind::Toml,
                _ => Kind::Driver,
            }
        }
    }
}

/// Does a text start with an entity of NFF? Its names are one letter or two; of drivers only `d` is, the distance of the image.
fn is_nff(line: &str) -> bool {
    line.split_whitespace().next().is_some_and(|word| ["v", "b", "l", "f", "s", "p", "pp", "c"].contains(&word))
}

/// Reads a scene from its text. File names are relative to `folder`.
///
/// # Errors
/// Everything that keeps the scene from being read.
pub fn load_text(source: Source, kind: Kind, folder: &Path, options: &LoadOptions) -> Result<Loaded, Vec<Report>> {
    load_with(source, kind, folder, options, |_| {})
}

/// The same for a scene of which something large is already in memory: `fill` puts it in before models are read.
///
/// # Errors
/// Everything that keeps the scene from being read.
pub fn load_with(
    source: Source,
    kind: Kind,
    folder: &Path,
    options: &LoadOptions,
    fill: impl FnOnce(&mut Scene),
) -> Result<Loaded, Vec<Report>> {
    let mut warnings = Vec::new();
    let mut dialect = None;
    let (mut scene, text) = match kind {
        Kind::Driver => {
            let mut driver = driver::parse(&source, options.dialect)?;
            dialect = Some(driver.dialect);
            warnings.append(&mut driver.warnings);
            (driver.scene_with_models(), Text::Driver(source.clone(), Box::new(driver)))
        }
        Kind::Nff => {
            let Nff { scene, warnings: mut odd, places } = nff::parse(&source)?;
            warnings.append(&mut odd);
            (scene, Text::Nff(source.clone(), places))
        }
        Kind::Toml => (scene_file::parse(&source, Syntax::Toml)?, Text::File(source.clone(), Syntax::Toml)),
        Kind::Json => (scene_file::parse(&source, Syntax::Json)?, Text::File(source.clone(), Syntax::Json)),
    };
    let mut places = Places { text, changes: Vec::new() };
    for change in &options.set {
        let place = scene_file::set(&mut scene, change)?;
        places.changes.push((place, Source::new("the change", change.as_str())));
    }
    fill(&mut scene);
    scene.render.integrator = options.integrator.unwrap_or(scene.render.integrator);
    let finder = Finder { files: &*options.files, search: &options.search };
    let cache = options.cache.as_deref();
    let mut reader = ModelReader::new(folder, finder, dialect, scene.render.integrator, warnings, cache);
    let mut loaded = Loaded {
        scene: Arc::new(scene),
        path: None,
        source,
        kind,
        dialect,
        folder: folder.to_owned(),
        models: Vec::new(),
        mesh_paths: Vec::new(),
        picture_paths: HashMap::new(),
        warnings: Vec::new(),
        places,
    };
    for index in 0..loaded.scene.meshes.len() {
        let path = reader.read_mesh(&mut loaded, index)?;
        loaded.mesh_paths.push(path);
    }
    loaded.models = reader.files;
    let mut pictures = reader.pictures;
    loaded.warnings = reader.warnings;
    pictures::read(&mut loaded, finder, &mut pictures)?;
    loaded.models.extend(pictures.files);
    loaded.picture_paths = pictures.paths;
    Ok(loaded)
}

impl Loaded {
    /// All files that were read.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        self.path.iter().map(PathBuf::as_path).chain(self.models.iter().map(|file| file.path.as_path()))
    }

    /// The scene, to be changed before it is compiled.
    pub fn scene_mut(&mut self) -> &mut Scene {
        Arc::make_mut(&mut self.scene)
    }

    /// The scene alone.
    pub fn into_scene(self) -> Scene {
        Arc::unwrap_or_clone(self.scene)
    }

    /// Problems of the scene, each at its place in the text.
    pub fn reports(&self, problems: &[Problem]) -> Vec<Report> {
        self.places.put_all(problems.iter().map(|p| (Report::from(p), p.place.as_slice())).collect())
    }

    /// All warnings, of the files and of the compiled scene, each at its place.
    pub fn warnings_with(&self, world: &World) -> Vec<Report> {
        let report = |warning: &Warning| Report::warning(warning.code, warning.message.clone());
        let (located, others) = world.warnings.split_at(world.warnings.len().min(MOST_PROBLEMS));
        let located = self.places.put_all(located.iter().map(|w| (report(w), w.place.as_slice())).collect());
        self.warnings.iter().cloned().chain(located).chain(others.iter().map(report)).collect()
    }

    /// The scene with what it is compiled to, where `before` is that of nearly the same scene; see [`CompiledScene::edited`].
    ///
    /// # Errors
    /// As [`world`](Self::world).
    pub fn compile_after(&self, before: &CompiledScene) -> Result<CompiledScene, Vec<Report>> {
        before.edited(Arc::clone(&self.scene)).map_err(|problems| self.located(&problems))
    }

    /// What the scene is compiled to.
    ///
    /// # Errors
    /// What is wrong with it, each at its place; from [`MOST_PROBLEMS`] on only their number.
    pub fn world(&self) -> Result<World, Vec<Report>> {
        World::new(&self.scene).map_err(|problems| self.located(&problems))
    }

    /// The scene with what it is compiled to; see [`CompiledScene::build`].
    ///
    /// # Errors
    /// As [`world`](Self::world).
    pub fn compile(&self, name: &str, quality: Quality, threads: usize) -> Result<CompiledScene, Vec<Report>> {
        let compiled = CompiledScene::build(name, Arc::clone(&self.scene), quality, threads);
        compiled.map_err(|problems| self.located(&problems))
    }

    fn located(&self, problems: &Problems) -> Vec<Report> {
        let mut reports = self.reports(&problems[..problems.len().min(MOST_PROBLEMS)]);
        if problems.len() > MOST_PROBLEMS {
            let more = problems.len() - MOST_PROBLEMS;
            reports.push(Report::error(format!("{more} more problems like these")));
        }
        reports
    }
}
