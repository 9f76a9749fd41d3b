//! Scenes between Python and files, as JSON. The arrays of meshes go beside the text.

use crate::errors::{self, Finding, raise};
use crate::world::{NativeWorld, read_files, reads_the_same};
use numpy::{PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use snell::geometry::Vec3;
use snell::scene::{Mesh, Scene};
use snell_formats::files::Recorder;
use snell_formats::load::{Kind, load, load_with};
use snell_formats::model::parse_ply;
use snell_formats::scene_file::{self, Syntax};
use snell_formats::{LoadOptions, Report, Source, builtin};
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::sync::Arc;

pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<NativeScene>()?;
    module.add_class::<NativeWorld>()?;
    module.add_function(wrap_pyfunction!(builtin_scenes, module)?)?;
    module.add_function(wrap_pyfunction!(read, module)?)?;
    module.add_function(wrap_pyfunction!(parsed, module)?)?;
    module.add_function(wrap_pyfunction!(changed, module)?)?;
    module.add_function(wrap_pyfunction!(unpacked, module)?)?;
    module.add_function(wrap_pyfunction!(write, module)?)
}

/// Vertices and faces of each mesh; `None` where it comes from a file.
pub type Triangles<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<u32>>);
type Arrays<'py> = Vec<Option<Triangles<'py>>>;
type ReadArrays<'py> = Vec<Option<(PyReadonlyArray2<'py, f64>, PyReadonlyArray2<'py, u32>)>>;

type OwnTriangles = (Vec<[f64; 3]>, Vec<[u32; 3]>);

/// The same in Rust.
pub struct Inline(Vec<Option<OwnTriangles>>);

impl Inline {
    fn copy(arrays: ReadArrays<'_>) -> Self {
        let copy = |(vertices, faces): (PyReadonlyArray2<'_, f64>, PyReadonlyArray2<'_, u32>)| {
            let (vertices, faces) = (vertices.as_array(), faces.as_array());
            let vertices = vertices.rows().into_iter().map(|row| [row[0], row[1], row[2]]).collect();
            (vertices, faces.rows().into_iter().map(|row| [row[0], row[1], row[2]]).collect())
        };
        Self(arrays.into_iter().map(|mesh| mesh.map(copy)).collect())
    }

    /// Gives meshes their triangles, but for those that have been given others.
    pub fn fill(&self, scene: &mut Scene) {
        for (mesh, arrays) in scene.meshes.iter_mut().zip(&self.0) {
            if let Some((vertices, faces)) = arrays
                && mesh.file.is_none()
                && mesh.faces.is_empty()
            {
                (mesh.vertices, mesh.faces) = (vertices.clone(), faces.clone());
            }
        }
    }
}

/// The triangles of a mesh that no file has.
fn take_arrays<'py>(py: Python<'py>, mesh: &mut Mesh) -> Option<Triangles<'py>> {
    if mesh.file.is_some() {
        return None;
    }
    if let Some(geometry) = mesh.geometry.take() {
        mesh.vertices = geometry.vertices.iter().map(|&vertex: &Vec3| vertex.into()).collect();
        mesh.faces.clone_from(&geometry.faces);
    }
    let (vertices, faces) = (std::mem::take(&mut mesh.vertices), std::mem::take(&mut mesh.faces));
    Some((PyArray2::from_owned_array(py, vertices.into()), PyArray2::from_owned_array(py, faces.into())))
}

/// A scene as Python takes it: JSON, and arrays.
fn hand_over(py: Python<'_>, mut scene: Scene) -> PyResult<(String, Arrays<'_>)> {
    let arrays = scene.meshes.iter_mut().map(|mesh| take_arrays(py, mesh)).collect();
    let text = scene_file::to_text(&scene, Syntax::Json).map_err(|report| failed(py, &[report], None))?;
    Ok((text, arrays))
}

fn failed(py: Python<'_>, reports: &[Report], ours: Option<&Source>) -> PyErr {
    raise(py, "SceneError", reports.iter().map(|report| errors::report(report, ours)).collect())
}

/// A text that Python wrote.
fn parse(py: Python<'_>, text: String) -> PyResult<(Source, Scene)> {
    let source = Source::new(OURS, text);
    match py.detach(|| scene_file::parse(&source, Syntax::Json)) {
        Ok(scene) => Ok((source, scene)),
        Err(report) => Err(failed(py, &[report], Some(&source))),
    }
}

/// Changes a value, as `--set` does. The place of what is wrong with that is the key.
fn set(scene: &mut Scene, key: &str, value: &str) -> Result<(), Finding> {
    let changed = scene_file::set(scene, &format!("{key}={value}"));
    changed.map(drop).map_err(|report| (Some(key.to_owned()), report.message.clone(), errors::help(&report)))
}

/// Names and texts of the built-in scenes.
#[pyfunction]
fn builtin_scenes() -> Vec<(&'static str, &'static str)> {
    builtin::SCENES.to_vec()
}

/// Reads a scene file, a driver, an NFF file or a built-in scene: JSON, arrays, and the folder of its files.
#[pyfunction]
fn read(py: Python<'_>, name: String) -> PyResult<(String, Arrays<'_>, PathBuf)> {
    let loaded = py.detach(|| load(&name, &LoadOptions::default()));
    let loaded = loaded.map_err(|reports| failed(py, &reports, None))?;
    let folder = loaded.folder.clone();
    let (text, arrays) = hand_over(py, loaded.into_scene())?;
    Ok((text, arrays, folder))
}

/// A scene in JSON that someone else wrote.
#[pyfunction]
fn parsed(py: Python<'_>, text: String) -> PyResult<(String, Arrays<'_>)> {
    let (_, scene) = parse(py, text)?;
    hand_over(py, scene)
}

/// A scene in TOML, some of whose models are the meshes that [`NativeScene::packed`] made files of: those become arrays again.
#[pyfunction]
fn unpacked(py: Python<'_>, text: String, packed: Vec<(String, Vec<u8>)>) -> PyResult<(String, Arrays<'_>)> {
    let source = Source::new(OURS, text);
    let scene = py.detach(|| {
        let mut scene = scene_file::parse(&source, Syntax::Toml)?;
        for mesh in &mut scene.meshes {
            if let Some((name, bytes)) = packed.iter().find(|(name, _)| mesh.file.as_ref() == Some(name)) {
                mesh.geometry = Some(Arc::new(parse_ply(name, bytes)?.mesh));
                mesh.file = None;
            }
        }
        Ok(scene)
    });
    hand_over(py, scene.map_err(|report: Report| failed(py, &[report], Some(&source)))?)
}

/// A scene with one value changed.
#[pyfunction]
fn changed(py: Python<'_>, text: String, key: String, value: String) -> PyResult<String> {
    let (_, mut scene) = parse(py, text)?;
    set(&mut scene, &key, &value).map_err(|finding| raise(py, "SceneError", vec![finding]))?;
    hand_over(py, scene).map(|(text, _)| text)
}

/// Writes a scene file, by its ending as TOML or JSON.
#[pyfunction]
fn write(py: Python<'_>, path: PathBuf, text: String, arrays: ReadArrays<'_>) -> PyResult<()> {
    let source = Source::new(OURS, text);
    let inline = Inline::copy(arrays);
    let syntax = if path.extension().is_some_and(|ending| ending == "json") { Syntax::Json } else { Syntax::Toml };
    py.detach(|| {
        let mut scene = scene_file::parse(&source, Syntax::Json)?;
        inline.fill(&mut scene);
        // Who saves a scene under the name of a file means that file.
        scene_file::save(scene, &path, syntax, "").map(drop)
    })
    .map_err(|report| failed(py, &[report], Some(&source)))
}

/// What the text that Python wrote is called.
pub const OURS: &str = "the scene";

/// A scene as it is described. Nothing of it has been compiled, and no file been read.
#[pyclass(frozen, module = "snell._native")]
pub struct NativeScene {
    name: String,
    /// Without the triangles.
    source: Source,
    scene: Scene,
    inline: Inline,
    folder: PathBuf,
}

#[pymethods]
impl NativeScene {
    /// Reads what Python says.
    #[new]
    fn new(py: Python<'_>, name: String, text: String, arrays: ReadArrays<'_>, folder: PathBuf) -> PyResult<Self> {
        let (source, scene) = parse(py, text)?;
        Ok(Self { name, source, scene, inline: Inline::copy(arrays), folder })
    }

    /// Compiles it, with some values changed by the keys of `--set`, in another size, of which one side alone keeps the shape.
    ///
    /// `before` is the same scene with other values: its files are not read again if they are used in the same way, however
    /// they have changed meanwhile.
    fn compiled(
        &self,
        py: Python<'_>,
        changes: Vec<(String, String)>,
        width: Option<u32>,
        height: Option<u32>,
        before: Option<&NativeWorld>,
    ) -> PyResult<NativeWorld> {
        let mut scene = self.scene.clone();
        let made = py.detach(|| {
            changes.iter().try_for_each(|(key, value)| set(&mut scene, key, value)).map_err(|finding| vec![finding])?;
            resize(&mut scene, width, height);
            let before =
                before.filter(|before| before.is_in(&self.folder) && reads_the_same(before.described(), &scene));
            let read = match before {
                Some(before) => before.read_like(&scene, &self.inline),
                None if scene == self.scene => read_files(&self.source, &self.folder, &self.inline)?,
                None => {
                    let text = scene_file::to_text(&scene, Syntax::Json);
                    let text = text.map_err(|report| vec![errors::report(&report, None)])?;
                    read_files(&Source::new(OURS, text), &self.folder, &self.inline)?
                }
            };
            NativeWorld::compile(self.name.clone(), scene, read, self.folder.clone(), before)
        });
        made.map_err(|findings: Vec<Finding>| raise(py, "SceneError", findings))
    }

    /// What a page in a browser needs to load it: what it is called there, its text in TOML, the files that it reads, and the meshes
    /// that are too large for a text, as files.
    fn packed<'py>(&self, py: Python<'py>, stem: &str) -> PyResult<(String, String, Files<'py>, Files<'py>)> {
        let packed = py.detach(|| {
            let mut scene = self.scene.clone();
            self.inline.fill(&mut scene);
            let (text, meshes) = scene_file::pack(scene, stem, Syntax::Toml).map_err(|report| vec![report])?;
            let recorder = Arc::new(Recorder::new(&self.folder));
            let options = LoadOptions { files: Arc::clone(&recorder) as _, ..LoadOptions::default() };
            load_with(self.source.clone(), Kind::Json, Path::new(""), &options, |scene| self.inline.fill(scene))?;
            let (name, files) = recorder.take(OsStr::new(&format!("{stem}.toml")));
            Ok((name, text, files, meshes))
        });
        let (name, text, files, meshes) =
            packed.map_err(|reports: Vec<Report>| failed(py, &reports, Some(&self.source)))?;
        let bytes = |files: Vec<(String, Vec<u8>)>| {
            files.into_iter().map(|(name, bytes)| (name, PyBytes::new(py, &bytes))).collect()
        };
        Ok((name, text, bytes(files), bytes(meshes)))
    }
}

/// Names with the bytes of their files.
type Files<'py> = Vec<(String, Bound<'py, PyBytes>)>;

/// Gives a picture another size. A side that is left out follows from the shape that it has.
fn resize(scene: &mut Scene, width: Option<u32>, height: Option<u32>) {
    let [old_width, old_height] = scene.render.size.map(|side| f64::from(side.max(1)));
    let scaled = |side: u32, by: f64, of: f64| ((f64::from(side) * by / of).round_ties_even() as u32).max(1);
    match (width, height) {
        (Some(width), Some(height)) => drop(scene.resize([width, height])),
        (Some(width), None) => drop(scene.resize([width, scaled(width, old_height, old_width)])),
        (None, Some(height)) => drop(scene.resize([scaled(height, old_width, old_height), height])),
        (None, None) => {}
    }
}
