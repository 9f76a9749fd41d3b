//! Scenes: from Python's JSON to a world, and from files to JSON. The arrays of meshes go beside the text.

use crate::errors::{self, Finding, raise};
use crate::explain::Seen;
use crate::picture::NativePicture;
use numpy::{PyArray2, PyReadonlyArray2};
use pyo3::prelude::*;
use snell::geometry::Vec3;
use snell::geometry::bvh::Quality;
use snell::scene::{Mesh, Scene};
use snell::world::World;
use snell_formats::load::{Kind, ModelFile, load, load_with};
use snell_formats::scene_file::{self, Syntax};
use snell_formats::{LoadOptions, Report, Source, builtin};
use std::path::PathBuf;
use std::sync::Arc;

pub fn register(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add_class::<NativeScene>()?;
    module.add_function(wrap_pyfunction!(builtin_scenes, module)?)?;
    module.add_function(wrap_pyfunction!(read, module)?)?;
    module.add_function(wrap_pyfunction!(changed, module)?)?;
    module.add_function(wrap_pyfunction!(resized, module)?)?;
    module.add_function(wrap_pyfunction!(write, module)?)
}

/// Vertices and faces of each mesh; `None` where it comes from a file.
type Triangles<'py> = (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray2<u32>>);
type Arrays<'py> = Vec<Option<Triangles<'py>>>;
type ReadArrays<'py> = Vec<Option<(PyReadonlyArray2<'py, f64>, PyReadonlyArray2<'py, u32>)>>;

type OwnTriangles = (Vec<[f64; 3]>, Vec<[u32; 3]>);

/// The same in Rust.
struct Inline(Vec<Option<OwnTriangles>>);

impl Inline {
    fn copy(arrays: ReadArrays<'_>) -> Self {
        let copy = |(vertices, faces): (PyReadonlyArray2<'_, f64>, PyReadonlyArray2<'_, u32>)| {
            let (vertices, faces) = (vertices.as_array(), faces.as_array());
            let vertices = vertices.rows().into_iter().map(|row| [row[0], row[1], row[2]]).collect();
            (vertices, faces.rows().into_iter().map(|row| [row[0], row[1], row[2]]).collect())
        };
        Self(arrays.into_iter().map(|mesh| mesh.map(copy)).collect())
    }

    fn fill(self, scene: &mut Scene) {
        for (mesh, arrays) in scene.meshes.iter_mut().zip(self.0) {
            if let Some((vertices, faces)) = arrays {
                (mesh.vertices, mesh.faces) = (vertices, faces);
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
    let (text, arrays) = hand_over(py, loaded.scene)?;
    Ok((text, arrays, loaded.folder))
}

/// A scene with one value changed, as `--set` does.
#[pyfunction]
fn changed(py: Python<'_>, text: String, key: String, value: String) -> PyResult<String> {
    let source = Source::new(OURS, text);
    let mut scene = scene_file::parse(&source, Syntax::Json).map_err(|report| failed(py, &[report], Some(&source)))?;
    scene_file::set(&mut scene, &format!("{key}={value}"))
        .map_err(|report| raise(py, "SceneError", vec![(Some(key), report.message.clone(), errors::help(&report))]))?;
    hand_over(py, scene).map(|(text, _)| text)
}

/// A scene of another size in pixels, which stay square.
#[pyfunction]
fn resized(py: Python<'_>, text: String, size: [u32; 2]) -> PyResult<String> {
    let source = Source::new(OURS, text);
    let mut scene = scene_file::parse(&source, Syntax::Json).map_err(|report| failed(py, &[report], Some(&source)))?;
    scene.resize(size);
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
const OURS: &str = "the scene";

/// A compiled scene, with what its pictures need to know of it.
pub struct Ready {
    pub name: String,
    pub scene: Scene,
    pub world: World,
    /// Its text, as a picture remembers it.
    pub text: String,
    pub folder: PathBuf,
    pub models: Vec<ModelFile>,
    warnings: Vec<Finding>,
}

/// A compiled scene.
#[pyclass(frozen)]
pub struct NativeScene(Arc<Ready>);

#[pymethods]
impl NativeScene {
    /// Compiles a scene.
    #[new]
    fn new(py: Python<'_>, name: String, text: String, arrays: ReadArrays<'_>, folder: PathBuf) -> PyResult<Self> {
        let source = Source::new(OURS, text);
        let inline = Inline::copy(arrays);
        let whole = inline.0.iter().all(Option::is_none);
        let ready = py.detach(|| {
            let options = LoadOptions::default();
            let loaded = load_with(source.clone(), Kind::Json, &folder, &options, |scene| inline.fill(scene));
            let loaded = loaded.map_err(|reports| findings(&reports, &source))?;
            let world = World::build(&loaded.scene, Quality::default(), 0)
                .map_err(|problems| problems.iter().map(errors::problem).collect::<Vec<Finding>>())?;
            let mut warnings = findings(&loaded.warnings, &source);
            warnings.extend(world.warnings.iter().map(|w| (Some(errors::path(&w.place)), w.to_string(), None)));
            let mut text = source.text.to_string();
            if !whole {
                text = scene_file::to_text(&loaded.scene, Syntax::Json).map_err(|r| findings(&[r], &source))?;
            }
            let (scene, models) = (loaded.scene, loaded.models);
            Ok(Ready { name, scene, world, text, folder, models, warnings })
        });
        ready.map(|ready| Self(Arc::new(ready))).map_err(|findings| raise(py, "SceneError", findings))
    }

    /// What is odd: place, message, help.
    fn warnings(&self) -> Vec<Finding> {
        self.0.warnings.clone()
    }

    /// Renders a picture, and calls `progress(pixels, total, rays)` about twenty times a second while it lasts.
    fn render(&self, py: Python<'_>, threads: usize, progress: Option<Py<PyAny>>) -> PyResult<NativePicture> {
        NativePicture::render(py, Arc::clone(&self.0), threads, progress.as_ref())
    }

    /// Where an object is seen.
    fn find<'py>(&self, py: Python<'py>, object: String, progress: Option<Py<PyAny>>) -> PyResult<Seen<'py>> {
        crate::explain::find(py, &self.0, &object, progress.as_ref())
    }
}

fn findings(reports: &[Report], ours: &Source) -> Vec<Finding> {
    reports.iter().map(|report| errors::report(report, Some(ours))).collect()
}
