//! What pictures are pickled as: the film, and the scene with all that was read from files, so that the files may be gone.
//! The tree over the scene is not: it is built again where someone asks for it.

use crate::errors::{Finding, raise};
use crate::scene::{OURS, Triangles};
use crate::world::Ready;
use numpy::ndarray::{Array2, Dimension};
use numpy::{Element, PyArray, PyArray1, PyArray2, PyArrayMethods};
use pyo3::prelude::*;
use snell::geometry::TriangleMesh;
use snell::scene::Scene;
use snell::texture::Image;
use snell_formats::Source;
use snell_formats::load::ModelFile;
use snell_formats::scene_file::{self, Syntax};
use std::path::PathBuf;
use std::sync::Arc;

/// A scene that has been read.
#[derive(FromPyObject, IntoPyObject)]
#[pyo3(from_item_all)]
pub struct ReadyState<'py> {
    /// The version that wrote it, the only one to read it.
    version: String,
    name: String,
    folder: PathBuf,
    models: Vec<(PathBuf, String)>,
    /// As JSON, without what arrays and files hold: as it is described, and with its files.
    described: String,
    scene: String,
    /// The triangles written out of each mesh.
    written: Vec<Triangles<'py>>,
    /// Models, and for each mesh the number of its one.
    models_read: Vec<ModelState<'py>>,
    model_of: Vec<Option<usize>>,
    /// Pictures; for each texture the number of its one; that of the sky.
    images: Vec<ImageState<'py>>,
    image_of: Vec<Option<usize>>,
    sky_image: Option<usize>,
}

#[derive(FromPyObject, IntoPyObject)]
#[pyo3(from_item_all)]
struct ModelState<'py> {
    vertices: Bound<'py, PyArray2<f64>>,
    faces: Bound<'py, PyArray2<u32>>,
    face_slots: Bound<'py, PyArray1<u32>>,
    slots: Vec<String>,
    uvs: Bound<'py, PyArray2<f64>>,
    face_uvs: Bound<'py, PyArray2<u32>>,
}

#[derive(FromPyObject, IntoPyObject)]
#[pyo3(from_item_all)]
struct ImageState<'py> {
    width: usize,
    height: usize,
    pixels: Bound<'py, PyArray2<f32>>,
    alpha: Option<Bound<'py, PyArray1<f32>>>,
}

/// Each thing once, and for each mention the number of its thing.
fn numbered<T>(all: impl Iterator<Item = Option<Arc<T>>>) -> (Vec<Arc<T>>, Vec<Option<usize>>) {
    let mut known: Vec<Arc<T>> = Vec::new();
    let mut number = |thing: Arc<T>| {
        known.iter().position(|other| Arc::ptr_eq(other, &thing)).unwrap_or_else(|| {
            known.push(thing);
            known.len() - 1
        })
    };
    let numbers = all.map(|thing| thing.map(&mut number)).collect();
    (known, numbers)
}

impl<'py> ReadyState<'py> {
    pub fn of(py: Python<'py>, ready: &Ready) -> PyResult<Self> {
        let Ready { name, folder, models, scene, .. } = ready;
        let mut bare = Scene::clone(scene);
        for mesh in &mut bare.meshes {
            (mesh.vertices, mesh.faces) = (Vec::new(), Vec::new());
        }
        let text = |scene: &Scene| {
            let failed = |report: snell_formats::Report| broken(py, report.message);
            scene_file::to_text(scene, Syntax::Json).map_err(failed)
        };
        let (read, model_of) = numbered(scene.meshes.iter().map(|mesh| mesh.geometry.clone()));
        let sky = scene.sky.as_ref().and_then(|sky| sky.pixels.clone());
        let pixels = scene.textures.values().map(|texture| texture.pixels.clone());
        let (images, mut image_of) = numbered(pixels.chain([sky]));
        let sky_image = image_of.pop().flatten();
        Ok(Self {
            version: env!("CARGO_PKG_VERSION").to_owned(),
            name: name.clone(),
            folder: folder.clone(),
            models: models.iter().map(|file| (file.path.clone(), file.sha256.clone())).collect(),
            described: text(&ready.described)?,
            scene: text(&bare)?,
            written: scene.meshes.iter().map(|mesh| (rows(py, &mesh.vertices), rows(py, &mesh.faces))).collect(),
            models_read: read.iter().map(|mesh| ModelState::of(py, mesh)).collect(),
            model_of,
            images: images.iter().map(|image| ImageState::of(py, image)).collect(),
            image_of,
            sky_image,
        })
    }

    pub fn read(self, py: Python<'py>) -> PyResult<Ready> {
        if self.version != env!("CARGO_PKG_VERSION") {
            let message = format!("pickled by Snell {}, and this is {}", self.version, env!("CARGO_PKG_VERSION"));
            let help = "a PNG or EXR is read by every version: save the picture there, and render it --from that";
            return Err(raise(py, "PictureError", vec![(Some("pickle".to_owned()), message, Some(help.to_owned()))]));
        }
        let parse = |text: String| {
            scene_file::parse(&Source::new(OURS, text), Syntax::Json).map_err(|report| broken(py, report.message))
        };
        let (described, mut scene) = (parse(self.described)?, parse(self.scene)?);
        let read = self.models_read.iter().map(|model| model.read().map(Arc::new)).collect::<PyResult<Vec<_>>>()?;
        let images = self.images.iter().map(|image| image.read(py).map(Arc::new)).collect::<PyResult<Vec<_>>>()?;
        for ((mesh, (vertices, faces)), model) in scene.meshes.iter_mut().zip(&self.written).zip(&self.model_of) {
            (mesh.vertices, mesh.faces) = (arrays(vertices)?, arrays(faces)?);
            mesh.geometry = model.and_then(|number| read.get(number).cloned());
        }
        for (texture, image) in scene.textures.values_mut().zip(&self.image_of) {
            texture.pixels = image.and_then(|number| images.get(number).cloned());
        }
        if let Some(sky) = &mut scene.sky {
            sky.pixels = self.sky_image.and_then(|number| images.get(number).cloned());
        }
        let models = self.models.into_iter().map(|(path, sha256)| ModelFile { path, sha256 }).collect();
        Ok(Ready::later(self.name, described, scene, self.folder, models))
    }
}

impl<'py> ModelState<'py> {
    fn of(py: Python<'py>, mesh: &TriangleMesh) -> Self {
        let vertices: Vec<[f64; 3]> = mesh.vertices.iter().map(|&vertex| vertex.into()).collect();
        Self {
            vertices: rows(py, &vertices),
            faces: rows(py, &mesh.faces),
            face_slots: PyArray1::from_slice(py, &mesh.face_slots),
            slots: mesh.slots.clone(),
            uvs: rows(py, &mesh.uvs),
            face_uvs: rows(py, &mesh.face_uvs),
        }
    }

    fn read(&self) -> PyResult<TriangleMesh> {
        Ok(TriangleMesh {
            vertices: arrays::<f64, 3>(&self.vertices)?.into_iter().map(Into::into).collect(),
            faces: arrays(&self.faces)?,
            face_slots: aligned(&self.face_slots)?.to_vec()?,
            slots: self.slots.clone(),
            uvs: arrays(&self.uvs)?,
            face_uvs: arrays(&self.face_uvs)?,
        })
    }
}

impl<'py> ImageState<'py> {
    fn of(py: Python<'py>, image: &Image) -> Self {
        Self {
            width: image.width(),
            height: image.height(),
            pixels: rows(py, image.pixels()),
            alpha: image.alpha().map(|alpha| PyArray1::from_slice(py, alpha)),
        }
    }

    fn read(&self, py: Python<'_>) -> PyResult<Image> {
        let pixels = arrays(&self.pixels)?;
        let image = match &self.alpha {
            Some(alpha) => Image::with_alpha(self.width, self.height, pixels, aligned(alpha)?.to_vec()?),
            None => Image::new(self.width, self.height, pixels),
        };
        image.map_err(|error| broken(py, error.to_string()))
    }
}

fn rows<'py, T: Element + Copy, const N: usize>(py: Python<'py>, rows: &[[T; N]]) -> Bound<'py, PyArray2<T>>
where
    Array2<T>: From<Vec<[T; N]>>,
{
    PyArray2::from_owned_array(py, rows.to_vec().into())
}

/// The same numbers where the processor can read them: what comes over a network (protocol 5 of pickle, Dask) may lie anywhere.
pub fn aligned<'py, T: Element, D: Dimension>(
    array: &Bound<'py, PyArray<T, D>>,
) -> PyResult<Bound<'py, PyArray<T, D>>> {
    let is_aligned: bool = array.getattr("flags")?.getattr("aligned")?.extract()?;
    Ok(if is_aligned { array.clone() } else { array.call_method0("copy")?.cast_into()? })
}

fn arrays<T: Element + Copy, const N: usize>(array: &Bound<'_, PyArray2<T>>) -> PyResult<Vec<[T; N]>> {
    let numbers = aligned(array)?.to_vec()?;
    Ok(numbers.as_chunks::<N>().0.to_vec())
}

fn broken(py: Python<'_>, message: String) -> PyErr {
    let finding: Finding = (Some("pickle".to_owned()), message, None);
    raise(py, "PictureError", vec![finding])
}
