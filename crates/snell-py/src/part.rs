//! Some samples of a picture, which go from process to process and join to its bits.

use crate::errors::raise;
use crate::pickle::aligned;
use crate::watch::watched;
use crate::world::Ready;
use numpy::{PyArray1, PyArray2, PyArrayMethods, PyUntypedArrayMethods};
use pyo3::prelude::*;
use snell::film::{Crop, Rgb};
use snell::render::{Grid, Options, PartialFilm, Piece, RenderError, TILE_SIZE};
use snell_formats::part;
use std::time::Instant;

/// Sums of samples, and of which picture they are.
#[pyclass(frozen, module = "snell._native")]
pub struct NativePart {
    pub film: PartialFilm,
    /// Digest of the recipe of the picture, which is another one wherever the film would be.
    pub of: String,
    /// Samples per pixel of the picture.
    pub spp: u32,
    seconds: f64,
}

type Rectangle = (u32, u32, u32, u32);
/// Left, top, width, height, and ranges of samples.
type Pieces = Vec<(Rectangle, Vec<(u32, u32)>)>;

/// What a part is pickled as.
#[derive(FromPyObject, IntoPyObject)]
#[pyo3(from_item_all)]
struct PartState<'py> {
    of: String,
    spp: u32,
    seconds: f64,
    size: (u32, u32),
    crop: Rectangle,
    pieces: Pieces,
    /// As in the file of a part: piece by piece, row by row, pixel by pixel, block by block.
    sums: Bound<'py, PyArray2<f64>>,
    lost: Bound<'py, PyArray1<u64>>,
    /// As JSON.
    statistics: String,
}

fn crop((x, y, width, height): Rectangle) -> Crop {
    Crop { x, y, width, height }
}

fn rectangle(Crop { x, y, width, height }: Crop) -> Rectangle {
    (x, y, width, height)
}

fn broken(py: Python<'_>, place: &str, message: String) -> PyErr {
    raise(py, "PictureError", vec![(Some(place.to_owned()), message, None)])
}

impl NativePart {
    /// Renders these samples of these rows.
    pub fn render(
        py: Python<'_>,
        ready: &Ready,
        threads: usize,
        wanted: Option<Crop>,
        rows: Option<[u32; 2]>,
        samples: Option<[u32; 2]>,
        progress: Option<&Py<PyAny>>,
    ) -> PyResult<Self> {
        let compiled = ready.compiled(py)?;
        let (world, settings) = (compiled.world(), compiled.settings());
        let refused = |place: &str, message| raise(py, "SceneError", vec![(Some(place.to_owned()), message, None)]);
        let whole = Options { crop: wanted, ..Options::default() }.crop_of(world);
        let whole = whole.map_err(|error| refused("crop", error.to_string()))?;
        let [first, end] = rows.unwrap_or([whole.y, whole.y + whole.height]);
        if first >= end || first < whole.y || end > whole.y + whole.height {
            let message = format!(
                "expected rows from {} to {}, the last one excluded, read {first} to {end}",
                whole.y,
                whole.y + whole.height
            );
            return Err(refused("rows", message));
        }
        let rect = Crop { y: first, height: end - first, ..whole };
        let [first, end] = samples.unwrap_or([0, settings.spp]);
        let mut film = PartialFilm::new(world.camera.size, rect, Grid::new(rect, TILE_SIZE, []));
        let started = Instant::now();
        let (rendered, stopped) =
            watched(py, threads, None, progress, |options| film.render(world, &settings, first..end, options, None));
        if let Some(error) = stopped {
            return Err(error);
        }
        rendered.map_err(|error| match error {
            RenderError::SamplesOutside { .. } => refused("samples", error.to_string()),
            _ => raise(py, "RenderError", vec![(None, error.to_string(), None)]),
        })?;
        let seconds = started.elapsed().as_secs_f64();
        Ok(Self { film, of: ready.digest(wanted), spp: settings.spp, seconds })
    }

    /// What parts have together; `first` may have nothing yet.
    pub fn together(py: Python<'_>, first: &PartialFilm, parts: &[PyRef<'_, Self>]) -> PyResult<PartialFilm> {
        let films: Vec<&PartialFilm> = parts.iter().map(|part| &part.film).collect();
        py.detach(|| first.joined(&films)).map_err(|error| broken(py, "parts", error.to_string()))
    }
}

#[pymethods]
impl NativePart {
    /// Seconds that it took to render.
    #[getter]
    fn seconds(&self) -> f64 {
        self.seconds
    }

    /// Rays that were traced for it.
    #[getter]
    fn rays(&self) -> u64 {
        self.film.statistics().rays.total()
    }

    /// Bytes of its numbers.
    #[getter]
    fn bytes(&self) -> u64 {
        let of_pixel = |piece: &Piece| 24 * piece.blocks().len() as u64 + 8;
        self.film.pieces().iter().map(|piece| piece.pixel_count() * of_pixel(piece)).sum()
    }

    /// What is there: left, top, width, height, and ranges of samples.
    fn pieces(&self) -> Pieces {
        let ranges = |piece: &Piece| piece.samples.iter().map(|&[first, end]| (first, end)).collect();
        self.film.pieces().iter().map(|piece| (rectangle(piece.rect), ranges(piece))).collect()
    }

    /// One that has all that parts of the same picture have.
    #[staticmethod]
    fn join(py: Python<'_>, parts: Vec<PyRef<'_, Self>>) -> PyResult<Self> {
        let Some((first, others)) = parts.split_first() else {
            return Err(broken(py, "parts", "there are none".to_owned()));
        };
        if others.iter().any(|other| other.of != first.of) {
            let message = "they are of different pictures: of other scenes, or made with other settings".to_owned();
            return Err(broken(py, "parts", message));
        }
        let film = Self::together(py, &first.film, others)?;
        let seconds = parts.iter().map(|part| part.seconds).sum();
        Ok(Self { film, of: first.of.clone(), spp: first.spp, seconds })
    }

    /// From what `__getnewargs__` gave.
    #[new]
    fn new(py: Python<'_>, state: PartState<'_>) -> PyResult<Self> {
        let PartState { of, spp, seconds, size, crop: rect, pieces, sums, lost, statistics } = state;
        let failed = |message: String| broken(py, "pickle", message);
        let (size, rect): ([u32; 2], Crop) = (size.into(), crop(rect));
        let pieces: Vec<Piece> = pieces
            .into_iter()
            .map(|(rect, samples)| Piece { rect: crop(rect), samples: samples.into_iter().map(Into::into).collect() })
            .collect();
        let counts = part::check(size, rect, spp, &pieces).map_err(failed)?;
        let read = [sums.shape()[0] as u64, lost.len() as u64];
        if read != counts || sums.shape()[1] != 3 {
            return Err(failed(format!("expected {counts:?} sums and pixels, read {read:?}")));
        }
        let statistics = serde_json::from_str(&statistics).map_err(|error| failed(error.to_string()))?;
        let (sums, lost) = (aligned(&sums)?.readonly(), aligned(&lost)?.readonly());
        let (sums, lost) = (sums.as_slice()?, lost.as_slice()?);
        let mut film = PartialFilm::new(size, rect, Grid::new(rect, u32::MAX, pieces.iter().map(|piece| piece.rect)));
        let (mut at, mut pixel) = (0, 0);
        for piece in &pieces {
            let pixels = piece.pixel_count() as usize;
            let numbers = 3 * pixels * piece.blocks().len();
            let of_piece: Vec<Rgb> =
                sums[at..at + numbers].as_chunks::<3>().0.iter().map(|&[r, g, b]| Rgb::new(r, g, b)).collect();
            film.insert(piece, &of_piece, &lost[pixel..pixel + pixels]).map_err(|twice| failed(twice.to_string()))?;
            (at, pixel) = (at + numbers, pixel + pixels);
        }
        film.count(&statistics);
        Ok(Self { film, of, spp, seconds })
    }

    /// What a pickle of it holds.
    fn __getnewargs__<'py>(slf: &Bound<'py, Self>) -> (PartState<'py>,) {
        let Self { film, of, spp, seconds } = slf.get();
        let pieces = film.pieces();
        let (mut sums, mut lost) = (Vec::new(), Vec::new());
        for piece in &pieces {
            for y in piece.rect.y..piece.rect.y + piece.rect.height {
                film.row(piece, y, &mut sums);
                film.lost_row(piece, y, &mut lost);
            }
        }
        let sums: Vec<[f64; 3]> = sums.into_iter().map(Rgb::to_array).collect();
        let state = PartState {
            of: of.clone(),
            spp: *spp,
            seconds: *seconds,
            size: film.size().into(),
            crop: rectangle(film.crop()),
            pieces: slf.get().pieces(),
            sums: PyArray2::from_owned_array(slf.py(), sums.into()),
            lost: PyArray1::from_vec(slf.py(), lost),
            statistics: serde_json::to_string(&film.statistics()).unwrap_or_default(),
        };
        (state,)
    }

    /// Itself: nothing of it can be changed.
    fn __deepcopy__(slf: Py<Self>, _memo: Py<PyAny>) -> Py<Self> {
        slf
    }
}
