//! From a name to a scene with its models: the one way in for scene files, drivers and built-in scenes.

use crate::driver::{self, Dialect, Driver};
use crate::model::{Mirror, MtlMaterial, MtlRule, ObjModel, find, parse_mtl, parse_obj};
use crate::report::{Report, Source};
use crate::scene_file::{self, Syntax};
use crate::{builtin, disk};
use serde::{Deserialize, Serialize};
use snell::geometry::TriangleMesh;
use snell::scene::{Material, Problem, Scene, Step, Warning, WarningCode};
use snell::world::World;
use std::collections::HashMap;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::sync::Arc;

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
    /// All model and material files that were read.
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
}

impl Places {
    fn find(&self, steps: &[Step]) -> Option<(&Source, Range<usize>)> {
        match self {
            Self::Text(source, syntax) => scene_file::place(steps, source, *syntax).map(|range| (source, range)),
            Self::Driver(source, driver) => driver.place(steps).map(|range| (source, range)),
        }
    }

    fn put(&self, report: Report, steps: &[Step]) -> Report {
        match self.find(steps) {
            Some((source, range)) => report.at(source, range),
            None => report,
        }
    }
}

/// Reads a scene file, a driver, or a built-in scene.
///
/// # Errors
/// Everything that keeps the file from being read.
pub fn load(name: &str, options: &LoadOptions) -> Result<Loaded, Vec<Report>> {
    let path = Path::new(name);
    if path.is_dir() {
        return Err(vec![Report::error(format!("`{name}` is a folder")).help("name the scene file in it")]);
    }
    if !path.exists() {
        // A name with an ending is meant as a file.
        return match builtin::find(name) {
            Ok(source) => load_text(source, Kind::Toml, Path::new("."), options),
            Err(_) if path.extension().is_some_and(|e| e == "txt" || e == "toml" || e == "json") => {
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
    let mut warnings = Vec::new();
    let mut dialect = None;
    let (scene, places) = match kind {
        Kind::Driver => {
            let mut driver = driver::parse(&source, options.dialect)?;
            dialect = Some(driver.dialect);
            warnings.append(&mut driver.warnings);
            let scene = driver.scene_with_models();
            if options.set.is_empty() {
                (scene, Places::Driver(source.clone(), Box::new(driver)))
            } else {
                let text = scene_file::to_text(&scene, Syntax::Toml)?;
                changed(Source::new(format!("{} as a scene", source.name), text), Syntax::Toml, &options.set)?
            }
        }
        Kind::Toml => changed(source.clone(), Syntax::Toml, &options.set)?,
        Kind::Json => changed(source.clone(), Syntax::Json, &options.set)?,
    };
    let mut reader = ModelReader {
        folder,
        search: &options.search,
        rule: rule(dialect),
        objs: HashMap::new(),
        mtls: HashMap::new(),
        files: Vec::new(),
        warnings,
    };
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
    Ok(loaded)
}

fn changed(source: Source, syntax: Syntax, set: &[String]) -> Result<(Scene, Places), Report> {
    let (mut source, mut syntax) = (source, syntax);
    for change in set {
        source = scene_file::set(&source, syntax, change)?;
        syntax = Syntax::Toml;
    }
    Ok((scene_file::parse(&source, syntax)?, Places::Text(source, syntax)))
}

/// How the year of a driver reads the materials of polygons; scene files take what the file says.
fn rule(dialect: Option<Dialect>) -> MtlRule {
    let mirror = match dialect {
        Some(Dialect::Course2018) => Mirror::One,
        Some(Dialect::Lecture) => Mirror::KrOrOne,
        Some(Dialect::Course2019 | Dialect::Course2020) => Mirror::KsIfIllum3,
        None => Mirror::KrOrKsIfIllum3,
    };
    MtlRule { mirror, default_exponent: dialect.map_or(16.0, Dialect::default_exponent) }
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

    /// Compiles the scene.
    ///
    /// # Errors
    /// Everything that is wrong with it, each at its place.
    pub fn world(&self) -> Result<World, Vec<Report>> {
        World::new(&self.scene).map_err(|problems| problems.iter().map(|p| self.report(p)).collect())
    }
}

/// Reads models and their materials, each file once.
struct ModelReader<'a> {
    folder: &'a Path,
    search: &'a [PathBuf],
    rule: MtlRule,
    objs: HashMap<PathBuf, (Arc<TriangleMesh>, Vec<String>)>,
    mtls: HashMap<PathBuf, Vec<MtlMaterial>>,
    files: Vec<ModelFile>,
    warnings: Vec<Report>,
}

impl ModelReader<'_> {
    /// Gives a mesh its triangles and materials; returns where it was found.
    fn read_mesh(&mut self, loaded: &mut Loaded, index: usize) -> Result<Option<PathBuf>, Report> {
        let Some(file) = loaded.scene.meshes[index].file.clone() else { return Ok(None) };
        let place = [Step::from("mesh"), Step::from(index), Step::from("file")];
        let found = find(&file, self.folder, self.search).map_err(|r| loaded.places.put(r, &place))?;
        self.warnings.extend(found.warning.map(|w| loaded.places.put(w, &place)));
        let path = found.path;
        if !self.objs.contains_key(&path) {
            let is_obj = path.extension().is_some_and(|e| e.eq_ignore_ascii_case("obj"));
            if !is_obj {
                let report = Report::error(format!("`{file}` is not an OBJ model: models are read from .obj files"));
                return Err(loaded.places.put(report, &place));
            }
            let ObjModel { mesh, libraries, warnings } = parse_obj(&self.read_text(&path)?)?;
            self.warnings.extend(warnings);
            self.objs.insert(path.clone(), (Arc::new(mesh), libraries));
        }
        let (mesh, libraries) = self.objs[&path].clone();
        if loaded.scene.meshes[index].material.is_none() {
            for slot in &mesh.slots {
                if !loaded.scene.meshes[index].materials.contains_key(slot) {
                    let material = self.material(slot, &path, &libraries, &loaded.places, &place)?;
                    let name = add_material(&mut loaded.scene, &path, &material.0, material.1);
                    loaded.scene.meshes[index].materials.insert(slot.clone(), name);
                }
            }
        }
        loaded.scene.meshes[index].geometry = Some(mesh);
        Ok(Some(path))
    }

    fn read_text(&mut self, path: &Path) -> Result<Source, Report> {
        let source = disk::read_text(path, disk::MAX_MODEL_BYTES)?;
        let bytes = disk::read(path, disk::MAX_MODEL_BYTES)?;
        self.files.push(ModelFile { path: path.to_owned(), sha256: disk::sha256([bytes]) });
        Ok(source)
    }

    /// The material that a model calls `slot`: from its libraries, else the only one of an `.mtl` of the same name, else
    /// gray.
    fn material(
        &mut self,
        slot: &str,
        model: &Path,
        libraries: &[String],
        places: &Places,
        place: &[Step],
    ) -> Result<(String, Material), Report> {
        let mut missing = Vec::new();
        for library in libraries {
            match self.library(library, model)? {
                Some(materials) => {
                    if let Some(m) = materials.iter().find(|m| m.name == slot) {
                        return Ok((m.name.clone(), m.material(self.rule)));
                    }
                }
                None => missing.push(format!("`{library}`")),
            }
        }
        let same_name = model.with_extension("mtl").file_name().map(|n| n.to_string_lossy().into_owned());
        if let Some(materials) = self.library(&same_name.unwrap_or_default(), model)?
            && let [only] = materials.as_slice()
        {
            return Ok((only.name.clone(), only.material(self.rule)));
        }
        let why = match (slot, missing.is_empty()) {
            (_, false) => format!("its material library {} is not there", missing.join(", ")),
            ("", true) => "it names no material".to_owned(),
            (slot, true) => format!("no library has its material `{slot}`"),
        };
        let shown = model.display();
        let report = Report::warning(WarningCode::NoMaterial, format!("`{shown}` is drawn gray: {why}"));
        self.warnings.push(places.put(report, place));
        let gray = MtlMaterial::gray();
        Ok((gray.name.clone(), gray.material(self.rule)))
    }

    /// The materials of a library that a model names; `None` if it is nowhere.
    fn library(&mut self, name: &str, model: &Path) -> Result<Option<Vec<MtlMaterial>>, Report> {
        let beside = model.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let search = |name: &str| {
            find(name, beside, self.search).or_else(|_| find(name, self.folder, &[])).ok().map(|found| found.path)
        };
        // One name with spaces, or several names.
        let whole = search(name);
        let paths = match whole {
            Some(path) => vec![path],
            None => name.split_whitespace().filter_map(search).collect(),
        };
        let mut materials = Vec::new();
        for path in &paths {
            if !self.mtls.contains_key(path) {
                let (read, warnings) = parse_mtl(&self.read_text(path)?)?;
                self.warnings.extend(warnings);
                self.mtls.insert(path.clone(), read);
            }
            materials.extend(self.mtls[path].iter().cloned());
        }
        Ok((!paths.is_empty()).then_some(materials))
    }
}

/// Adds a material under a name that tells where it is from, or finds the same one again.
fn add_material(scene: &mut Scene, model: &Path, name: &str, material: Material) -> String {
    let stem = model.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
    // A name that needs no quotes in a scene file and no care in `--set`.
    let plain: String =
        format!("{stem}_{name}").chars().map(|c| if c.is_ascii_alphanumeric() || c == '-' { c } else { '_' }).collect();
    for number in 1.. {
        let candidate = if number == 1 { plain.clone() } else { format!("{plain}_{number}") };
        match scene.materials.get(&candidate) {
            Some(known) if *known == material => return candidate,
            Some(_) => {}
            None => {
                scene.materials.insert(candidate.clone(), material);
                return candidate;
            }
        }
    }
    plain
}
