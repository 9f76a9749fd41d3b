//! Models and their materials.

use super::cache::{Cache, Parsed};
use super::pictures::PictureReader;
use super::{Loaded, ModelFile};
use crate::driver::Dialect;
use crate::files::{MAX_MODEL_BYTES, sha256};
use crate::model::{Finder, Found, Mirror, Model, MtlMaterial, MtlRule, parse_model, parse_mtl};
use crate::report::{Report, list};
use crate::text::decode;
use snell::geometry::TriangleMesh;
use snell::geometry::solid::structure;
use snell::scene::{Integrator, Material, Mesh, Scene, Step, Texture, WarningCode};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Reads models and their materials, each file once.
pub(super) struct ModelReader<'a> {
    folder: &'a Path,
    finder: Finder<'a>,
    rule: MtlRule,
    /// Drivers make the course's pictures.
    is_course: bool,
    models: HashMap<PathBuf, Arc<Read>>,
    mtls: HashMap<PathBuf, Vec<MtlMaterial>>,
    /// Where files are looked for that one in a folder names.
    places: HashMap<PathBuf, Vec<PathBuf>>,
    /// Scene materials by model and slot, and the number that the next one of a name gets.
    named: HashMap<(PathBuf, String), String>,
    numbers: HashMap<String, usize>,
    cache: Option<&'a Cache>,
    pub files: Vec<ModelFile>,
    pub pictures: PictureReader<'a>,
    pub warnings: Vec<Report>,
}

/// A model that was read, with its libraries.
struct Read {
    model: Arc<Parsed>,
    libraries: Libraries,
}

impl<'a> ModelReader<'a> {
    pub fn new(
        folder: &'a Path,
        finder: Finder<'a>,
        dialect: Option<Dialect>,
        integrator: Integrator,
        warnings: Vec<Report>,
        cache: Option<&'a Cache>,
    ) -> Self {
        Self {
            folder,
            finder,
            rule: rule(dialect, integrator),
            is_course: dialect.is_some(),
            models: HashMap::new(),
            mtls: HashMap::new(),
            places: HashMap::new(),
            named: HashMap::new(),
            numbers: HashMap::new(),
            cache,
            files: Vec::new(),
            pictures: PictureReader::new(cache),
            warnings,
        }
    }

    /// Gives a mesh its triangles and materials; returns where it was found.
    pub fn read_mesh(&mut self, loaded: &mut Loaded, index: usize) -> Result<Option<PathBuf>, Report> {
        let Some(file) = loaded.scene.meshes[index].file.clone() else { return Ok(None) };
        let place = [Step::from("mesh"), Step::from(index), Step::from("file")];
        let found = self.find_model(&file).map_err(|r| loaded.places.put(r, &place))?;
        self.warnings.extend(found.warning.map(|w| loaded.places.put(w, &place)));
        let path = found.path;
        if !self.models.contains_key(&path) {
            let located = |r: Report| if r.place.is_some() { r } else { loaded.places.put(r, &place) };
            let model = self.parsed(&path, located)?;
            self.warnings.extend(model.warnings.iter().cloned());
            let libraries = self.libraries(&model.libraries, &path)?;
            self.models.insert(path.clone(), Arc::new(Read { model, libraries }));
        }
        let read = Arc::clone(&self.models[&path]);
        if loaded.scene.meshes[index].material.is_none() {
            self.give_materials(loaded, index, &path, &read, &place)?;
        }
        if let Some(report) = &read.model.lost_uv {
            // Without a texture nobody looks at them.
            if is_textured(&loaded.scene, &loaded.scene.meshes[index]) {
                return Err(report.clone());
            }
            let message = format!("{}; its face has no texture coordinates", report.message);
            let warning = Report { warning: Some(WarningCode::NotDrawn), message, ..report.clone() };
            self.warnings.push(warning);
        }
        if read.model.has_normals && !self.is_course && loaded.scene.meshes[index].smooth_angle == 0.0 {
            let message = format!("the normals of `{}` are not drawn: its faces are flat", path.display());
            let help = "`smooth_angle = 60` in its [[mesh]] smooths all edges of less than 60 degrees";
            self.warnings.push(loaded.places.put(Report::warning(WarningCode::NotDrawn, message).help(help), &place));
        }
        loaded.scene_mut().meshes[index].geometry = Some(Arc::clone(&read.model.mesh));
        Ok(Some(path))
    }

    /// Finds a model that the scene names.
    fn find_model(&mut self, file: &str) -> Result<Found, Report> {
        let (folder, finder) = (self.folder, self.finder);
        finder.find_in(file, self.places_of(folder))
    }

    fn places_of(&mut self, folder: &Path) -> &[PathBuf] {
        self.places.entry(folder.to_owned()).or_insert_with(|| self.finder.places(folder))
    }

    /// A model, of which `located` says where it is named if it is none.
    fn parsed(&mut self, path: &Path, located: impl FnOnce(Report) -> Report) -> Result<Arc<Parsed>, Report> {
        if let Some(known) = self.cache.and_then(|cache| cache.model(path)) {
            self.files.push(ModelFile { path: path.to_owned(), sha256: known.sha256.clone() });
            return Ok(known);
        }
        let bytes = self.read(path)?;
        let Model { mesh, libraries, has_normals, lost_uv, warnings } = parse_model(path, &bytes).map_err(located)?;
        let sha256 = self.files.last().map(|file| file.sha256.clone()).unwrap_or_default();
        let parsed = Arc::new(Parsed { mesh: Arc::new(mesh), libraries, has_normals, lost_uv, warnings, sha256 });
        if let Some(cache) = self.cache {
            cache.keep_model(path, &parsed);
        }
        Ok(parsed)
    }

    fn read(&mut self, path: &Path) -> Result<Vec<u8>, Report> {
        let bytes = self.finder.files.read(path, MAX_MODEL_BYTES)?;
        self.files.push(ModelFile { path: path.to_owned(), sha256: sha256([&bytes]) });
        Ok(bytes)
    }

    /// Gives a mesh a material for each name that its model uses: from its libraries, else the only one of an `.mtl` of the same
    /// name, else gray.
    fn give_materials(
        &mut self,
        loaded: &mut Loaded,
        index: usize,
        path: &Path,
        read: &Read,
        place: &[Step],
    ) -> Result<(), Report> {
        let own = &loaded.scene.meshes[index].materials;
        let slots: Vec<String> =
            read.model.mesh.slots.iter().filter(|slot| !own.contains_key(*slot)).cloned().collect();
        let unnamed = |slot: &&String| !self.named.contains_key(&(path.to_owned(), (*slot).clone()));
        let new: Vec<String> = slots.iter().filter(unnamed).cloned().collect();
        let (known, unknown): (Vec<&String>, Vec<&String>) =
            new.iter().partition(|slot| read.libraries.materials.contains_key(*slot));
        let mut added = Vec::new();
        for slot in known {
            let found = read.libraries.materials[slot].clone();
            added.push(self.add(loaded, path, read, &found, place));
            self.named.insert((path.to_owned(), slot.clone()), added[added.len() - 1].clone());
        }
        if !unknown.is_empty() {
            let only = self.only_material(path)?;
            if only.is_none() {
                let report =
                    Report::warning(WarningCode::NoMaterial, why_gray(path, &unknown, &read.libraries.missing));
                self.warnings.push(loaded.places.put(report, place));
            }
            let name = self.add(loaded, path, read, &only.unwrap_or_else(MtlMaterial::gray), place);
            for slot in unknown {
                self.named.insert((path.to_owned(), slot.clone()), name.clone());
            }
            added.push(name);
        }
        make_solid(loaded.scene_mut(), &added, &read.model.mesh);
        for slot in slots {
            let name = self.named[&(path.to_owned(), slot.clone())].clone();
            loaded.scene_mut().meshes[index].materials.insert(slot, name);
        }
        Ok(())
    }

    /// The only material of an `.mtl` that is named like the model.
    fn only_material(&mut self, model: &Path) -> Result<Option<MtlMaterial>, Report> {
        let same_name = model.with_extension("mtl").file_name().map(|n| n.to_string_lossy().into_owned());
        let Some(path) = self.find_library(&same_name.unwrap_or_default(), model) else { return Ok(None) };
        Ok(match self.read_library(&path)? {
            [only] => Some(only.clone()),
            _ => None,
        })
    }

    /// Adds a material of a model to the scene, with its texture; returns its name there.
    fn add(&mut self, loaded: &mut Loaded, path: &Path, read: &Read, found: &MtlMaterial, place: &[Step]) -> String {
        let name = self.add_material(loaded.scene_mut(), path, &found.name, found.material(self.rule));
        if let Some(file) = &found.map_kd
            && let Err(why) = self.add_texture(loaded.scene_mut(), path, &name, file, &read.model.mesh)
        {
            let message = format!("the texture `{file}` is not drawn: {why}");
            self.warnings.push(loaded.places.put(Report::warning(WarningCode::TextureIgnored, message), place));
        }
        name
    }

    /// Gives a material of a model its texture. Fails with why not.
    fn add_texture(
        &mut self,
        scene: &mut Scene,
        model: &Path,
        material: &str,
        file: &str,
        mesh: &TriangleMesh,
    ) -> Result<(), String> {
        if self.is_course {
            return Err("the course's programs drew only the colours of its material".to_owned());
        }
        if mesh.face_uvs.is_empty() {
            return Err("the model has no texture coordinates".to_owned());
        }
        let beside = model.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let anywhere = Finder { search: &[], ..self.finder };
        let found = self.finder.find(file, beside).or_else(|_| anywhere.find(file, self.folder));
        let path = found.map_err(|report| report.message)?.path;
        let name = path.display().to_string();
        let pixels = Some(self.pictures.read(self.finder.files, &name, &path, true).map_err(|report| report.message)?);
        let texture = Texture { checker: None, image: Some(name), repeat: [1.0, 1.0], linear: false, pixels };
        scene.textures.insert(material.to_owned(), texture);
        scene.materials[material].texture = Some(material.to_owned());
        Ok(())
    }

    /// The materials of the libraries that a model names.
    fn libraries(&mut self, names: &[String], model: &Path) -> Result<Libraries, Report> {
        let mut libraries = Libraries::default();
        for name in names {
            // One name with spaces, or several names.
            let paths: Vec<PathBuf> = match self.find_library(name, model) {
                Some(path) => vec![path],
                None => name.split_whitespace().filter_map(|word| self.find_library(word, model)).collect(),
            };
            if paths.is_empty() {
                libraries.missing.push(format!("`{name}`"));
            }
            for path in &paths {
                for material in self.read_library(path)? {
                    // Of two materials of one name the first counts.
                    libraries.materials.entry(material.name.clone()).or_insert_with(|| material.clone());
                }
            }
        }
        Ok(libraries)
    }

    fn find_library(&mut self, name: &str, model: &Path) -> Option<PathBuf> {
        let beside = model.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new(".")).to_owned();
        let (folder, finder) = (self.folder, self.finder);
        let anywhere = Finder { search: &[], ..finder };
        let found = finder.look_in(name, self.places_of(&beside));
        let found = found.or_else(|| anywhere.look_in(name, self.places_of(folder)))?;
        if !self.mtls.contains_key(&found.path) {
            self.warnings.extend(found.warning);
        }
        Some(found.path)
    }

    fn read_library(&mut self, path: &Path) -> Result<&[MtlMaterial], Report> {
        if !self.mtls.contains_key(path) {
            let (source, warning) = decode(&path.display().to_string(), &self.read(path)?);
            let (read, warnings) = parse_mtl(&source)?;
            self.warnings.extend(warning);
            self.warnings.extend(warnings);
            if !self.rule.real_optics {
                self.beyond_the_course(path, &read);
            }
            self.mtls.insert(path.to_owned(), read);
        }
        Ok(&self.mtls[path])
    }

    /// Warns of what the materials of a library have and this model of light does not draw.
    fn beyond_the_course(&mut self, path: &Path, materials: &[MtlMaterial]) {
        let mut what: Vec<&str> = materials.iter().flat_map(MtlMaterial::beyond_the_course).collect();
        what.sort_unstable();
        what.dedup();
        if !what.is_empty() {
            let message = format!("{} of `{}` are drawn by `whitted` only", list(what), path.display());
            self.warnings.push(Report::warning(WarningCode::NotInThisModel, message));
        }
    }

    /// Adds a material under a name that tells where it is from.
    fn add_material(&mut self, scene: &mut Scene, model: &Path, name: &str, material: Material) -> String {
        let stem = model.file_stem().map(|s| s.to_string_lossy().into_owned()).unwrap_or_default();
        // A name that needs no quotes in a scene file and no care in `--set`.
        let plain: String = format!("{stem}_{name}")
            .chars()
            .map(|c| if c.is_ascii_alphanumeric() || c == '-' { c } else { '_' })
            .collect();
        loop {
            let number = self.numbers.entry(plain.clone()).and_modify(|n| *n += 1).or_insert(1);
            let candidate = if *number == 1 { plain.clone() } else { format!("{plain}_{number}") };
            if !scene.materials.contains_key(&candidate) {
                scene.materials.insert(candidate.clone(), material);
                return candidate;
            }
        }
    }
}

/// The materials that a model can name, and the libraries that are nowhere.
#[derive(Debug, Default)]
struct Libraries {
    materials: HashMap<String, MtlMaterial>,
    missing: Vec<String>,
}

/// Why a model is drawn gray.
fn why_gray(model: &Path, slots: &[&String], missing: &[String]) -> String {
    let why = match (slots, missing.is_empty()) {
        (_, false) => format!("its material library {} is not there", list(missing.iter().map(String::as_str))),
        ([only], true) if only.is_empty() => "it names no material".to_owned(),
        ([only], true) => format!("no library has its material `{only}`"),
        (slots, true) => {
            let names: Vec<String> = slots.iter().map(|slot| format!("`{slot}`")).collect();
            format!("no library has its materials {}", list(names.iter().map(String::as_str)))
        }
    };
    format!("`{}` is drawn gray: {why}", model.display())
}

/// Does the mesh have a material with a texture?
fn is_textured(scene: &Scene, mesh: &Mesh) -> bool {
    let mut names = mesh.material.iter().chain(mesh.materials.values().filter(|_| mesh.material.is_none()));
    names.any(|name| scene.materials.get(name).is_some_and(|m| m.texture.is_some()))
}

/// What light goes through is a solid where the mesh is one and all of it has one index; else it stays panes.
fn make_solid(scene: &mut Scene, materials: &[String], mesh: &TriangleMesh) {
    let through: Vec<&String> = materials.iter().filter(|name| scene.materials[*name].is_transparent()).collect();
    let index = |name: &String| scene.materials[name].eta;
    let Some(first) = through.first() else { return };
    if through.iter().all(|name| index(name) == index(first)) && structure(mesh).is_solid() {
        for name in through {
            scene.materials[name].thickness = None;
        }
    }
}

/// How the year of a driver reads the materials of polygons; scene files take what the file says.
fn rule(dialect: Option<Dialect>, integrator: Integrator) -> MtlRule {
    let mirror = match dialect {
        Some(Dialect::Course2018) => Mirror::One,
        Some(Dialect::Lecture) => Mirror::KrOrOne,
        Some(Dialect::Course2019 | Dialect::Course2020) => Mirror::KsIfIllum3,
        None => Mirror::KrOrKsIfIllum3,
    };
    let real_optics = dialect.is_none() && integrator == Integrator::Whitted;
    MtlRule { mirror, default_exponent: dialect.map_or(16.0, Dialect::default_exponent), real_optics }
}
