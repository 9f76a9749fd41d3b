//! Pictures, whose numbers Python sees where they are.

use crate::errors::{self, raise};
use crate::explain::NativeTree;
use crate::part::NativePart;
use crate::pickle::{ReadyState, aligned};
use crate::watch::{unless_stopped, watched};
use crate::world::Ready;
use numpy::ndarray::{Array, ArrayView3, Dim, Dimension, ErrorKind, IntoDimension, ShapeError};
use numpy::{PyArray, PyArray1, PyArray2, PyArray3, PyArrayMethods, PyReadonlyArray3, PyUntypedArrayMethods};
use pyo3::exceptions::{PyKeyboardInterrupt, PyRuntimeError};
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use snell::explain::{Channels, ViewScene, black_picture, channels, hits};
use snell::film::transfer::{Encoding, Rounding, Transfer};
use snell::film::{Crop, Film, Rgb};
use snell::render::{Grid, Options, PartialFilm, RenderError, Rendered, render};
use snell::scene::Warning;
use snell::trace::Statistics;
use snell::world::CompiledScene;
use snell_formats::picture::{self, Format, Writing};
use snell_formats::{Report, part};
use std::path::PathBuf;
use std::sync::Arc;
use std::time::Instant;

/// A film, and the scene that it shows.
#[pyclass(frozen, module = "snell._native")]
pub struct NativePicture {
    film: Film,
    ready: Arc<Ready>,
    seconds: f64,
    rays: u64,
    /// Number and name, and the whole text.
    warnings: Vec<(String, String)>,
}

/// What a picture is pickled as.
#[derive(FromPyObject, IntoPyObject)]
#[pyo3(from_item_all)]
struct PictureState<'py> {
    ready: ReadyState<'py>,
    full_size: (u32, u32),
    region: (u32, u32, u32, u32),
    numbers: Bound<'py, PyArray3<f64>>,
    finished: Bound<'py, PyArray1<bool>>,
    seconds: f64,
    rays: u64,
    warnings: Vec<(String, String)>,
}

impl NativePicture {
    /// Renders, and ^C ends it with what is done by then.
    pub fn render(
        py: Python<'_>,
        ready: Arc<Ready>,
        threads: usize,
        crop: Option<Crop>,
        progress: Option<&Py<PyAny>>,
    ) -> PyResult<Self> {
        let started = Instant::now();
        let compiled = ready.compiled(py)?;
        let (world, settings) = (compiled.world(), compiled.settings());
        let (rendered, stopped) = watched(py, threads, crop, progress, |options| render(world, &settings, options));
        let seconds = started.elapsed().as_secs_f64();
        match stopped {
            Some(error) if !error.is_instance_of::<PyKeyboardInterrupt>(py) => return Err(error),
            _ => {}
        }
        let failed = |error: RenderError| match error {
            RenderError::CropOutside { .. } => {
                raise(py, "SceneError", vec![(Some("crop".to_owned()), error.to_string(), None)])
            }
            _ => raise(py, "RenderError", vec![(None, error.to_string(), None)]),
        };
        let Rendered { film, statistics } = rendered.map_err(failed)?;
        let warnings = warnings(compiled, &film, &statistics);
        Ok(Self { film, ready, seconds, rays: statistics.rays.total(), warnings })
    }

    /// The picture that parts make, which must be complete unless it is `unfinished`.
    pub fn of_parts(
        py: Python<'_>,
        ready: Arc<Ready>,
        wanted: Option<Crop>,
        parts: &[PyRef<'_, NativePart>],
        unfinished: bool,
        seconds: f64,
    ) -> PyResult<Self> {
        let compiled = ready.compiled(py)?;
        let (world, settings) = (compiled.world(), compiled.settings());
        let refused = |place: &str, message| raise(py, "PictureError", vec![(Some(place.to_owned()), message, None)]);
        let crop = Options { crop: wanted, ..Options::default() }.crop_of(world);
        let crop = crop.map_err(|error| refused("crop", error.to_string()))?;
        let of = ready.digest(wanted);
        if parts.iter().any(|part| part.of != of) {
            let message = "not all are of this picture: they are of another scene, or made with other settings";
            return Err(refused("parts", message.to_owned()));
        }
        let nothing = PartialFilm::new(world.camera.size, crop, Grid::new(crop, u32::MAX, []));
        let all = NativePart::together(py, &nothing, parts)?;
        if let Some(report) = part::incomplete(&all.missing(0..settings.spp)).filter(|_| !unfinished) {
            return Err(refused("parts", report.message));
        }
        let film = py.detach(|| all.film(settings.spp));
        let film = film.map_err(|error| raise(py, "RenderError", vec![(None, error.to_string(), None)]))?;
        let statistics = all.statistics();
        let warnings = warnings(compiled, &film, &statistics);
        Ok(Self { film, ready, seconds, rays: statistics.rays.total(), warnings })
    }

    /// Rows and columns.
    fn shape(&self) -> [usize; 2] {
        [self.film.crop.height as usize, self.film.crop.width as usize]
    }

    fn encoding(&self) -> Encoding {
        self.ready.scene.render.encoding()
    }

    /// What `snell render --from` needs to make it again, with the settings that the scene leaves out.
    fn recipe(&self) -> String {
        let whole = self.film.crop.width == self.film.full_size[0] && self.film.crop.height == self.film.full_size[1];
        let mut recipe = self.ready.recipe((!whole).then_some(self.film.crop));
        recipe.remember(&self.film);
        recipe.to_json()
    }
}

#[pymethods]
impl NativePicture {
    /// The film, height x width x 3, where it is: it lives as long as an array of it does, and cannot be written to.
    #[getter]
    #[allow(unsafe_code, reason = "NumPy is shown memory that it does not own")]
    fn array<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let film = &slf.get().film;
        let shape = (film.crop.height as usize, film.crop.width as usize, 3);
        let view = ArrayView3::from_shape(shape, film.numbers()).map_err(no_shape)?;
        // SAFETY: the film of a frozen class is neither moved nor changed while `slf` lives, which the array keeps alive, and
        // NumPy lets nobody write to it.
        let array = unsafe { PyArray3::borrow_from_array(&view, slf.clone().into_any()) };
        array.try_readwrite()?.make_nonwriteable();
        Ok(array)
    }

    /// Left, top, width, height in the whole picture.
    #[getter]
    fn region(&self) -> (u32, u32, u32, u32) {
        let Crop { x, y, width, height } = self.film.crop;
        (x, y, width, height)
    }

    /// Width and height of the whole picture.
    #[getter]
    fn full_size(&self) -> (u32, u32) {
        self.film.full_size.into()
    }

    /// Is every pixel done?
    #[getter]
    fn finished(&self) -> bool {
        self.film.is_finished()
    }

    /// Seconds that it took to render.
    #[getter]
    fn seconds(&self) -> f64 {
        self.seconds
    }

    /// Rays that were traced for it.
    #[getter]
    fn rays(&self) -> u64 {
        self.rays
    }

    /// What was found while rendering: number and name, and the whole text.
    fn warnings(&self) -> Vec<(String, String)> {
        self.warnings.clone()
    }

    /// As a PNG of 8 bit.
    fn png<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = py.detach(|| picture::png_bytes(&self.film, self.encoding(), 0, Some(&self.recipe())));
        bytes.map(|bytes| PyBytes::new(py, &bytes)).map_err(|report| failed(py, &report))
    }

    /// Writes it, in the format of the ending.
    fn save(&self, py: Python<'_>, path: PathBuf, bits: u8, binary: bool) -> PyResult<()> {
        let written = py.detach(|| {
            let format = match Format::of(&path)? {
                Format::Png { .. } => Format::Png { sixteen_bit: bits == 16 },
                Format::Ppm { .. } => Format::Ppm { binary },
                other => other,
            };
            let writing = Writing { format, encoding: self.encoding(), threads: 0 };
            writing.write(&path, &self.film, Some(&self.recipe()))
        });
        written.map_err(|report| failed(py, &report))
    }

    /// A part of it, by left, top, width, height in the whole picture.
    fn part(&self, x: u32, y: u32, width: u32, height: u32) -> Option<Self> {
        let film = self.film.part(Crop { x, y, width, height })?;
        let (ready, warnings) = (Arc::clone(&self.ready), self.warnings.clone());
        Some(Self { film, ready, seconds: self.seconds, rays: self.rays, warnings })
    }

    /// What the camera's rays met: depth, normal, number of the object; and the names of the objects.
    fn channels<'py>(&self, py: Python<'py>, progress: Option<Py<PyAny>>) -> PyResult<NativeChannels<'py>> {
        let compiled = self.ready.compiled(py)?;
        let (world, settings) = (compiled.world(), compiled.settings());
        let crop = Some(self.film.crop);
        let work = watched(py, 0, crop, progress.as_ref(), |options| channels(world, &settings, options));
        let Channels { depth, normal, object } = unless_stopped(work)?;
        let normal: Vec<f64> = normal.into_iter().flatten().collect();
        let [height, width] = self.shape();
        Ok((
            shaped(py, [height, width], depth)?,
            shaped(py, [height, width, 3], normal)?,
            shaped(py, [height, width], object)?,
            world.objects.iter().map(|object| object.name.clone()).collect(),
        ))
    }

    /// How many surfaces the rays of each pixel met.
    fn hits<'py>(&self, py: Python<'py>, progress: Option<Py<PyAny>>) -> PyResult<Bound<'py, PyArray2<u32>>> {
        let compiled = self.ready.compiled(py)?;
        let (world, settings) = (compiled.world(), compiled.settings());
        let crop = Some(self.film.crop);
        let work = watched(py, 0, crop, progress.as_ref(), |options| hits(world, &settings, options));
        shaped(py, self.shape(), unless_stopped(work)?)
    }

    /// The scene as the viewer draws it, in JSON.
    fn view(&self, py: Python<'_>) -> PyResult<String> {
        Ok(serde_json::to_string(&ViewScene::of(self.ready.compiled(py)?)).unwrap_or_default())
    }

    /// Why a pixel of the whole picture has its colour.
    fn explain(&self, py: Python<'_>, x: u32, y: u32) -> PyResult<Option<NativeTree>> {
        NativeTree::of(py, &self.ready, x, y)
    }

    /// From what `__getnewargs__` gave.
    #[new]
    fn new(py: Python<'_>, state: PictureState<'_>) -> PyResult<Self> {
        let PictureState {
            ready,
            full_size,
            region: (x, y, width, height),
            numbers,
            finished,
            seconds,
            rays,
            warnings,
        } = state;
        let ready = Arc::new(ready.read(py)?);
        let mut film = Film::new(full_size.into(), Crop { x, y, width, height })
            .map_err(|error| raise(py, "PictureError", vec![(None, error.to_string(), None)]))?;
        let (colors, marks) = (numbers.shape(), finished.len());
        if colors != [height as usize, width as usize, 3] || marks != film.pixels.len() {
            let message = format!(
                "expected {width} x {height} pixels, read an array of {colors:?}, and for {marks} of them whether they are finished"
            );
            return Err(raise(py, "PictureError", vec![(Some("pickle".to_owned()), message, None)]));
        }
        let numbers = aligned(&numbers)?.readonly();
        for (pixel, color) in film.pixels.iter_mut().zip(numbers.as_array().rows()) {
            *pixel = Rgb::new(color[0], color[1], color[2]);
        }
        film.finished = finished.to_vec()?;
        Ok(Self { film, ready, seconds, rays, warnings })
    }

    /// What a pickle of it holds.
    fn __getnewargs__<'py>(slf: &Bound<'py, Self>) -> PyResult<(PictureState<'py>,)> {
        let Self { film, ready, seconds, rays, warnings } = slf.get();
        let state = PictureState {
            ready: ReadyState::of(slf.py(), ready)?,
            full_size: film.full_size.into(),
            region: slf.get().region(),
            numbers: Self::array(slf)?,
            finished: PyArray1::from_slice(slf.py(), &film.finished),
            seconds: *seconds,
            rays: *rays,
            warnings: warnings.clone(),
        };
        Ok((state,))
    }

    /// Itself: nothing of it can be changed.
    fn __deepcopy__(slf: Py<Self>, _memo: Py<PyAny>) -> Py<Self> {
        slf
    }
}

/// What is odd about a picture: number and name, and the whole text.
fn warnings(compiled: &CompiledScene, film: &Film, statistics: &Statistics) -> Vec<(String, String)> {
    let black = black_picture(compiled, film);
    let found = snell::render::warnings(statistics, compiled.world(), &compiled.settings()).into_iter().chain(black);
    let text = |warning: Warning| format!("{warning}{}", errors::advice(warning.code));
    found.map(|warning| (warning.code.code().to_owned(), text(warning))).collect()
}

/// Depth, normal and object; the names of the objects.
type NativeChannels<'py> =
    (Bound<'py, PyArray2<f64>>, Bound<'py, PyArray3<f64>>, Bound<'py, PyArray2<i32>>, Vec<String>);

/// Numbers row by row as an array, which takes them over.
pub fn shaped<T: numpy::Element, const N: usize>(
    py: Python<'_>,
    shape: [usize; N],
    numbers: Vec<T>,
) -> PyResult<Bound<'_, PyArray<T, Dim<[usize; N]>>>>
where
    Dim<[usize; N]>: Dimension,
    [usize; N]: IntoDimension<Dim = Dim<[usize; N]>>,
{
    let array = Array::from_shape_vec(shape.into_dimension(), numbers).map_err(no_shape)?;
    Ok(PyArray::from_owned_array(py, array))
}

fn no_shape(error: ShapeError) -> PyErr {
    PyRuntimeError::new_err(error.to_string())
}

/// An array of height x width x 3, from 0 to 1, as a PNG of 8 bit.
#[pyfunction]
pub fn png<'py>(py: Python<'py>, array: PyReadonlyArray3<'py, f64>) -> PyResult<Bound<'py, PyBytes>> {
    let array = array.as_array();
    let (height, width, channels) = array.dim();
    let size = u32::try_from(width).ok().zip(u32::try_from(height).ok()).filter(|_| channels == 3);
    let Some((width, height)) = size else {
        return Err(no_shape(ShapeError::from_kind(ErrorKind::IncompatibleShape)));
    };
    let failed_film =
        |error: snell::film::FilmTooLarge| raise(py, "PictureError", vec![(None, error.to_string(), None)]);
    let mut film = Film::new([width, height], Crop { x: 0, y: 0, width, height }).map_err(failed_film)?;
    for (pixel, color) in film.pixels.iter_mut().zip(array.rows()) {
        *pixel = Rgb::new(color[0], color[1], color[2]);
    }
    film.finished.fill(true);
    let encoding = Encoding { transfer: Transfer::Linear, rounding: Rounding::Round };
    let bytes = py.detach(|| picture::png_bytes(&film, encoding, 0, None));
    bytes.map(|bytes| PyBytes::new(py, &bytes)).map_err(|report| failed(py, &report))
}

fn failed(py: Python<'_>, report: &Report) -> PyErr {
    raise(py, "PictureError", vec![errors::report(report, None)])
}
