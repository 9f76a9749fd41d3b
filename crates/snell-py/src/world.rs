//! Compiled scenes, with what their pictures need to know of them.

use crate::errors::{self, Finding, raise};
use crate::explain::Seen;
use crate::part::NativePart;
use crate::pickle::ReadyState;
use crate::picture::NativePicture;
use crate::scene::Inline;
use pyo3::prelude::*;
use snell::film::Crop;
use snell::scene::{Mesh, Problems, Scene, Warning};
use snell::world::CompiledScene;
use snell_formats::load::{Kind, ModelFile, load_with};
use snell_formats::recipe::Recipe;
use snell_formats::scene_file::{self, Syntax};
use snell_formats::{LoadOptions, Report, Source};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// A scene with its files.
pub struct Read {
    /// What is described, with the materials of its models, every mesh with its triangles.
    scene: Scene,
    models: Vec<ModelFile>,
    /// What is odd about the files.
    warnings: Vec<Finding>,
}

/// Reads the files of a scene, which Python wrote as a text and some triangles.
pub fn read_files(source: &Source, folder: &Path, inline: &Inline) -> Result<Read, Vec<Finding>> {
    let findings = |reports: &[Report]| reports.iter().map(|report| errors::report(report, Some(source))).collect();
    let loaded = load_with(source.clone(), Kind::Json, folder, &LoadOptions::default(), |scene| inline.fill(scene));
    let loaded = loaded.map_err(|reports| findings(&reports))?;
    Ok(Read { warnings: findings(&loaded.warnings), models: loaded.models.clone(), scene: loaded.into_scene() })
}

/// Do two scenes read the same files, in the same way?
pub fn reads_the_same<'a>(a: &'a Scene, b: &'a Scene) -> bool {
    read_by(a) == read_by(b)
}

/// All values that reading looks at.
fn read_by(scene: &Scene) -> impl PartialEq {
    // The normals of a model are spoken of where its mesh is flat.
    let flat = |mesh: &Mesh| mesh.file.is_some() && mesh.smooth_angle == 0.0;
    let meshes: Vec<_> = scene.meshes.iter().map(|m| (&m.file, &m.material, &m.materials, flat(m))).collect();
    let materials: Vec<_> = scene.materials.iter().map(|(name, m)| (name, &m.texture)).collect();
    let textures: Vec<_> = scene.textures.iter().map(|(name, t)| (name, &t.image, t.linear)).collect();
    (scene.render.integrator, meshes, materials, textures, scene.sky.as_ref().map(|sky| &sky.image))
}

/// What pictures need to know of the scene that they show.
pub struct Ready {
    pub name: String,
    /// What is described, without what files and arrays hold.
    pub described: Scene,
    /// The same with its files, and its triangles.
    pub scene: Arc<Scene>,
    pub folder: PathBuf,
    pub models: Vec<ModelFile>,
    compiled: OnceLock<Result<CompiledScene, Vec<Finding>>>,
    /// Of pictures that were asked for.
    digests: Mutex<Vec<(Option<Crop>, String)>>,
}

impl Ready {
    /// A scene that is compiled when someone asks for its world.
    pub fn later(name: String, described: Scene, scene: Scene, folder: PathBuf, models: Vec<ModelFile>) -> Self {
        Self {
            name,
            described,
            scene: Arc::new(scene),
            folder,
            models,
            compiled: OnceLock::new(),
            digests: Mutex::default(),
        }
    }

    fn compile(&self) -> Result<&CompiledScene, &Vec<Finding>> {
        let compile = || CompiledScene::new(self.name.as_str(), Arc::clone(&self.scene)).map_err(findings);
        self.compiled.get_or_init(compile).as_ref()
    }

    /// The scene with its world.
    pub fn compiled(&self, py: Python<'_>) -> PyResult<&CompiledScene> {
        py.detach(|| self.compile()).map_err(|findings| raise(py, "SceneError", findings.clone()))
    }

    /// How its picture is made, or this part of it.
    pub fn recipe(&self, crop: Option<Crop>) -> Recipe {
        let mut recipe = Recipe::new(&self.name, Kind::Json, &self.text(), &self.folder, &self.models);
        recipe.crop = crop;
        recipe.resolve(&self.scene);
        recipe
    }

    /// What tells it from all other pictures: the same wherever it is rendered.
    pub fn digest(&self, crop: Option<Crop>) -> String {
        let mut digests = self.digests.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, known)) = digests.iter().find(|(other, _)| *other == crop) {
            return known.clone();
        }
        let digest = self.recipe(crop).digest();
        digests.push((crop, digest.clone()));
        digest
    }

    /// The text of the scene, as a picture remembers it.
    pub fn text(&self) -> String {
        let mut scene = self.described.clone();
        for (mesh, read) in scene.meshes.iter_mut().zip(&self.scene.meshes).filter(|(mesh, _)| mesh.file.is_none()) {
            (mesh.vertices, mesh.faces) = (read.vertices.clone(), read.faces.clone());
        }
        // It was JSON before.
        scene_file::to_text(&scene, Syntax::Json).unwrap_or_default()
    }
}

/// What Python is told of the problems of a scene.
#[expect(clippy::needless_pass_by_value, reason = "for `map_err`")]
fn findings(problems: Problems) -> Vec<Finding> {
    problems.iter().map(errors::problem).collect()
}

/// What a compiled scene is pickled as.
#[derive(FromPyObject, IntoPyObject)]
#[pyo3(from_item_all)]
struct WorldState<'py> {
    ready: ReadyState<'py>,
    read_warnings: Vec<Finding>,
    warnings: Vec<Finding>,
}

/// A compiled scene.
#[pyclass(frozen, module = "snell._native")]
pub struct NativeWorld {
    ready: Arc<Ready>,
    /// What is odd about the files, and about all of it.
    read_warnings: Vec<Finding>,
    warnings: Vec<Finding>,
}

impl NativeWorld {
    /// `before`: a world whose geometry may be shared, where the scene has the same.
    pub fn compile(
        name: String,
        described: Scene,
        read: Read,
        folder: PathBuf,
        before: Option<&Self>,
    ) -> Result<Self, Vec<Finding>> {
        let Read { scene, models, warnings: read_warnings } = read;
        let ready = Ready::later(name, described, scene, folder, models);
        if let Some(Ok(before)) = before.and_then(|before| before.ready.compiled.get()) {
            let edited = before.edited(Arc::clone(&ready.scene));
            // Nobody else has it yet, so that nothing is there.
            let _ = ready.compiled.set(edited.map_err(findings));
        }
        let world = ready.compile().map_err(Clone::clone)?.world();
        let text = |w: &Warning| format!("{w}{}", errors::advice(w.code));
        let of_world = world.warnings.iter().map(|w| (Some(errors::path(&w.place)), text(w), None));
        let warnings = read_warnings.iter().cloned().chain(of_world).collect();
        Ok(Self { ready: Arc::new(ready), read_warnings, warnings })
    }

    pub fn described(&self) -> &Scene {
        &self.ready.described
    }

    /// Are the names of its files relative to this folder?
    pub fn is_in(&self, folder: &Path) -> bool {
        self.ready.folder == folder
    }

    /// A scene that reads the same files in the same way, with what was read for this one.
    pub fn read_like(&self, described: &Scene, inline: &Inline) -> Read {
        let Ready { scene: read, models, .. } = &*self.ready;
        let mut scene = described.clone();
        inline.fill(&mut scene);
        for (mesh, read) in scene.meshes.iter_mut().zip(&read.meshes) {
            mesh.geometry.clone_from(&read.geometry);
            mesh.materials.clone_from(&read.materials);
        }
        // Models add materials and textures, behind those of the scene.
        for (name, material) in &read.materials {
            scene.materials.entry(name.clone()).or_insert_with(|| material.clone());
        }
        for (name, texture) in &read.textures {
            let own = scene.textures.entry(name.clone()).or_insert_with(|| texture.clone());
            own.pixels.clone_from(&texture.pixels);
        }
        if let (Some(sky), Some(read)) = (&mut scene.sky, &read.sky) {
            sky.pixels.clone_from(&read.pixels);
        }
        Read { scene, models: models.clone(), warnings: self.read_warnings.clone() }
    }
}

#[pymethods]
impl NativeWorld {
    /// Width and height of the picture in pixels.
    #[getter]
    fn size(&self) -> (u32, u32) {
        self.ready.scene.render.size.into()
    }

    /// What is odd: place, message, help.
    fn warnings(&self) -> Vec<Finding> {
        self.warnings.clone()
    }

    /// From what `__getnewargs__` gave.
    #[new]
    fn new(py: Python<'_>, state: WorldState<'_>) -> PyResult<Self> {
        let WorldState { ready, read_warnings, warnings } = state;
        Ok(Self { ready: Arc::new(ready.read(py)?), read_warnings, warnings })
    }

    /// What a pickle of it holds.
    fn __getnewargs__<'py>(slf: &Bound<'py, Self>) -> PyResult<(WorldState<'py>,)> {
        let Self { ready, read_warnings, warnings } = slf.get();
        let ready = ReadyState::of(slf.py(), ready)?;
        Ok((WorldState { ready, read_warnings: read_warnings.clone(), warnings: warnings.clone() },))
    }

    /// Renders some samples of some rows of the picture, or of the part of it that is wanted.
    fn render_part(
        &self,
        py: Python<'_>,
        threads: usize,
        crop: Option<(u32, u32, u32, u32)>,
        rows: Option<[u32; 2]>,
        samples: Option<[u32; 2]>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<NativePart> {
        let crop = crop.map(|(x, y, width, height)| Crop { x, y, width, height });
        NativePart::render(py, &self.ready, threads, crop, rows, samples, progress.as_ref())
    }

    /// The picture that parts make; one that is not complete is refused, unless it may be `unfinished`. `seconds` are what it
    /// took.
    fn merge(
        &self,
        py: Python<'_>,
        crop: Option<(u32, u32, u32, u32)>,
        parts: Vec<PyRef<'_, NativePart>>,
        unfinished: bool,
        seconds: f64,
    ) -> PyResult<NativePicture> {
        let crop = crop.map(|(x, y, width, height)| Crop { x, y, width, height });
        NativePicture::of_parts(py, Arc::clone(&self.ready), crop, &parts, unfinished, seconds)
    }

    /// Samples per pixel.
    #[getter]
    fn spp(&self) -> u32 {
        self.ready.scene.render.spp
    }

    /// Renders a picture, or a part of it (left, top, width, height), and calls `progress(pixels, total, rays)` about twenty
    /// times a second while it lasts.
    fn render(
        &self,
        py: Python<'_>,
        threads: usize,
        crop: Option<(u32, u32, u32, u32)>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<NativePicture> {
        let crop = crop.map(|(x, y, width, height)| Crop { x, y, width, height });
        NativePicture::render(py, Arc::clone(&self.ready), threads, crop, progress.as_ref())
    }

    /// Where an object is seen.
    fn find<'py>(&self, py: Python<'py>, object: String, progress: Option<Py<PyAny>>) -> PyResult<Seen<'py>> {
        crate::explain::find(py, &self.ready, &object, progress.as_ref())
    }
}
