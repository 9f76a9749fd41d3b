//! Rendering without Python's lock, and pictures whose numbers Python sees where they are.

use crate::errors::{self, raise};
use crate::explain::NativeTree;
use crate::scene::Ready;
use numpy::ndarray::ArrayView3;
use numpy::{PyArray3, PyArrayMethods};
use pyo3::exceptions::PyKeyboardInterrupt;
use pyo3::prelude::*;
use pyo3::types::PyBytes;
use serde_json::json;
use snell::film::transfer::Encoding;
use snell::film::{Crop, Film};
use snell::render::{Options, Progress, RenderError, Rendered, render};
use snell_formats::picture::{self, Format};
use snell_formats::{Report, disk};
use std::path::PathBuf;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::{Duration, Instant};

/// So often Python is asked whether someone has pressed ^C.
const LOOK: Duration = Duration::from_millis(50);

/// A film, and the scene that it shows.
#[pyclass(frozen)]
pub struct NativePicture {
    film: Film,
    ready: Arc<Ready>,
    seconds: f64,
    rays: u64,
}

impl NativePicture {
    /// Renders on threads of its own, while this one asks Python for signals. ^C ends it with what is done by then.
    pub fn render(py: Python<'_>, ready: Arc<Ready>, threads: usize, progress: Option<&Py<PyAny>>) -> PyResult<Self> {
        let cancel = AtomicBool::new(false);
        let [pixels, rays] = [AtomicU64::new(0), AtomicU64::new(0)];
        let [width, height] = ready.world.camera.size.map(u64::from);
        let count = |done: Progress| {
            pixels.fetch_max(done.pixels, Ordering::Relaxed);
            rays.fetch_max(done.rays, Ordering::Relaxed);
        };
        let options = Options { threads, progress: Some(&count), cancel: Some(&cancel), ..Options::default() };
        let look = || {
            Python::attach(|py| {
                py.check_signals()?;
                let seen = (pixels.load(Ordering::Relaxed), width * height, rays.load(Ordering::Relaxed));
                progress.map_or(Ok(()), |progress| progress.call1(py, seen).map(drop))
            })
        };
        let started = Instant::now();
        let (rendered, stopped) = py.detach(|| watched(|| render(&ready.world, &options), &cancel, look));
        let seconds = started.elapsed().as_secs_f64();
        match stopped {
            Some(error) if !error.is_instance_of::<PyKeyboardInterrupt>(py) => return Err(error),
            _ => {}
        }
        let failed = |error: RenderError| raise(py, "RenderError", vec![(None, error.to_string(), None)]);
        let Rendered { film, statistics } = rendered.map_err(failed)?;
        Ok(Self { film, ready, seconds, rays: statistics.rays.total() })
    }

    fn encoding(&self) -> Encoding {
        let render = &self.ready.world.render;
        Encoding { transfer: render.transfer, rounding: render.rounding }
    }

    /// What `snell render --from` needs to make it again.
    fn recipe(&self) -> String {
        let Ready { name, text, folder, models, .. } = &*self.ready;
        let hash = self.film.is_finished().then(|| disk::sha256(self.film.bytes()));
        let whole = self.film.crop.width == self.film.full_size[0] && self.film.crop.height == self.film.full_size[1];
        let crop = (!whole).then_some(self.film.crop);
        json!({
            "snell": env!("CARGO_PKG_VERSION"), "name": name, "kind": "json", "text": text, "folder": folder,
            "models": models, "crop": crop, "film_sha256": hash,
        })
        .to_string()
    }
}

/// Does some work on another thread and looks around meanwhile. What looking fails with ends the work.
fn watched<T: Send, E: Send>(
    work: impl FnOnce() -> T + Send,
    cancel: &AtomicBool,
    look: impl Fn() -> Result<(), E>,
) -> (T, Option<E>) {
    std::thread::scope(|scope| {
        let (over, is_over) = channel::<()>();
        let worker = scope.spawn(move || {
            let result = work();
            drop(over);
            result
        });
        let mut stopped = None;
        while is_over.recv_timeout(LOOK) == Err(RecvTimeoutError::Timeout) {
            if stopped.is_none()
                && let Err(error) = look()
            {
                cancel.store(true, Ordering::Relaxed);
                stopped = Some(error);
            }
        }
        match worker.join() {
            Ok(result) => (result, stopped),
            Err(panic) => std::panic::resume_unwind(panic),
        }
    })
}

#[pymethods]
impl NativePicture {
    /// The film, height x width x 3, where it is: it lives as long as an array of it does, and cannot be written to.
    #[getter]
    #[allow(unsafe_code, reason = "NumPy is shown memory that it does not own")]
    fn array<'py>(slf: &Bound<'py, Self>) -> PyResult<Bound<'py, PyArray3<f64>>> {
        let film = &slf.get().film;
        let shape = (film.crop.height as usize, film.crop.width as usize, 3);
        let view = ArrayView3::from_shape(shape, film.numbers())
            .map_err(|error| pyo3::exceptions::PyRuntimeError::new_err(error.to_string()))?;
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

    /// As a PNG of 8 bit.
    fn png<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyBytes>> {
        let bytes = py.detach(|| picture::png_bytes(&self.film, self.encoding(), Some(&self.recipe())));
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
            picture::write(&path, format, &self.film, self.encoding(), Some(&self.recipe()))
        });
        written.map_err(|report| failed(py, &report))
    }

    /// A part of it, by left, top, width, height in the whole picture.
    fn part(&self, x: u32, y: u32, width: u32, height: u32) -> Option<Self> {
        let film = self.film.part(Crop { x, y, width, height })?;
        Some(Self { film, ready: Arc::clone(&self.ready), seconds: self.seconds, rays: self.rays })
    }

    /// Why a pixel of the whole picture has its colour.
    fn explain(&self, py: Python<'_>, x: u32, y: u32) -> Option<NativeTree> {
        py.detach(|| NativeTree::of(&self.ready, x, y))
    }
}

fn failed(py: Python<'_>, report: &Report) -> PyErr {
    raise(py, "PictureError", vec![errors::report(report, None)])
}
