//! Models and their materials.

use super::{Loaded, ModelFile, Places};
use crate::disk;
use crate::driver::Dialect;
use crate::model::{Mirror, MtlMaterial, MtlRule, ObjModel, find, parse_model, parse_mtl};
use crate::report::Report;
use crate::texture::read_image;
use snell::geometry::TriangleMesh;
use snell::scene::{Material, Scene, Step, Texture, WarningCode};
use std::collections::HashMap;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Reads models and their materials, each file once.
pub(super) struct ModelReader<'a> {
    folder: &'a Path,
    search: &'a [PathBuf],
    rule: MtlRule,
    /// Drivers make the course's pictures.
    draws_no_textures: bool,
    objs: HashMap<PathBuf, (Arc<TriangleMesh>, Arc<Libraries>)>,
    mtls: HashMap<PathBuf, Vec<MtlMaterial>>,
    /// Scene materials by model and slot, and the number that the next one of a name gets.
    named: HashMap<(PathBuf, String), String>,
    numbers: HashMap<String, usize>,
    pub files: Vec<ModelFile>,
    pub warnings: Vec<Report>,
}

impl<'a> ModelReader<'a> {
    pub fn new(folder: &'a Path, search: &'a [PathBuf], dialect: Option<Dialect>, warnings: Vec<Report>) -> Self {
        Self {
            folder,
            search,
            rule: rule(dialect),
            draws_no_textures: dialect.is_some(),
            objs: HashMap::new(),
            mtls: HashMap::new(),
            named: HashMap::new(),
            numbers: HashMap::new(),
            files: Vec::new(),
            warnings,
        }
    }

    /// Gives a mesh its triangles and materials; returns where it was found.
    pub fn read_mesh(&mut self, loaded: &mut Loaded, index: usize) -> Result<Option<PathBuf>, Report> {
        let Some(file) = loaded.scene.meshes[index].file.clone() else { return Ok(None) };
        let place = [Step::from("mesh"), Step::from(index), Step::from("file")];
        let found = find(&file, self.folder, self.search).map_err(|r| loaded.places.put(r, &place))?;
        self.warnings.extend(found.warning.map(|w| loaded.places.put(w, &place)));
        let path = found.path;
        if !self.objs.contains_key(&path) {
            let located = |r: Report| if r.place.is_some() { r } else { loaded.places.put(r, &place) };
            let bytes = self.read(&path)?;
            let ObjModel { mesh, libraries, warnings } = parse_model(&path, &bytes).map_err(located)?;
            self.warnings.extend(warnings);
            let libraries = Arc::new(self.libraries(&libraries, &path)?);
            self.objs.insert(path.clone(), (Arc::new(mesh), libraries));
        }
        let (mesh, libraries) = self.objs[&path].clone();
        if loaded.scene.meshes[index].material.is_none() {
            for slot in &mesh.slots {
                if loaded.scene.meshes[index].materials.contains_key(slot) {
                    continue;
                }
                let key = (path.clone(), slot.clone());
                if !self.named.contains_key(&key) {
                    let found = self.material(slot, &path, &libraries, &loaded.places, &place)?;
                    let material = found.material(self.rule);
                    let name = self.add_material(&mut loaded.scene, &path, &found.name, material);
                    if let Some(file) = &found.map_kd
                        && let Err(why) = self.add_texture(&mut loaded.scene, &path, &name, file, &mesh)
                    {
                        let message = format!("the texture `{file}` is not drawn: {why}");
                        self.warnings
                            .push(loaded.places.put(Report::warning(WarningCode::TextureIgnored, message), &place));
                    }
                    self.named.insert(key.clone(), name);
                }
                loaded.scene.meshes[index].materials.insert(slot.clone(), self.named[&key].clone());
            }
        }
        loaded.scene.meshes[index].geometry = Some(mesh);
        Ok(Some(path))
    }

    fn read(&mut self, path: &Path) -> Result<Vec<u8>, Report> {
        let bytes = disk::read(path, disk::MAX_MODEL_BYTES)?;
        self.files.push(ModelFile { path: path.to_owned(), sha256: disk::sha256([&bytes]) });
        Ok(bytes)
    }

    /// The material that a model calls `slot`: from its libraries, else the only one of an `.mtl` of the same name, else
    /// gray.
    fn material(
        &mut self,
        slot: &str,
        model: &Path,
        libraries: &Libraries,
        places: &Places,
        place: &[Step],
    ) -> Result<MtlMaterial, Report> {
        if let Some(m) = libraries.materials.get(slot) {
            return Ok(m.clone());
        }
        let missing = &libraries.missing;
        let same_name = model.with_extension("mtl").file_name().map(|n| n.to_string_lossy().into_owned());
        if let Some(path) = self.find_library(&same_name.unwrap_or_default(), model)
            && let [only] = self.read_library(&path)?
        {
            return Ok(only.clone());
        }
        let why = match (slot, missing.is_empty()) {
            (_, false) => format!("its material library {} is not there", missing.join(", ")),
            ("", true) => "it names no material".to_owned(),
            (slot, true) => format!("no library has its material `{slot}`"),
        };
        let shown = model.display();
        let report = Report::warning(WarningCode::NoMaterial, format!("`{shown}` is drawn gray: {why}"));
        self.warnings.push(places.put(report, place));
        Ok(MtlMaterial::gray())
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
        if self.draws_no_textures {
            return Err("the course's programs drew only the colours of its material".to_owned());
        }
        if mesh.face_uvs.is_empty() {
            return Err("the model has no texture coordinates".to_owned());
        }
        let beside = model.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let found = find(file, beside, self.search).or_else(|_| find(file, self.folder, &[]));
        let path = found.map_err(|report| report.message)?.path;
        let image = read_image(&path, true).map_err(|report| report.message)?;
        self.read(&path).map_err(|report| report.message)?;
        let pixels = Some(Arc::new(image));
        let name = path.display().to_string();
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
        let beside = model.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
        let found = find(name, beside, self.search).or_else(|_| find(name, self.folder, &[])).ok()?;
        if !self.mtls.contains_key(&found.path) {
            self.warnings.extend(found.warning);
        }
        Some(found.path)
    }

    fn read_library(&mut self, path: &Path) -> Result<&[MtlMaterial], Report> {
        if !self.mtls.contains_key(path) {
            let (read, warnings) = parse_mtl(&disk::text(path, &self.read(path)?))?;
            self.warnings.extend(warnings);
            self.mtls.insert(path.to_owned(), read);
        }
        Ok(&self.mtls[path])
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
