//! Work without Python's lock, which ^C ends.

use pyo3::prelude::*;
use snell::film::Crop;
use snell::render::{Options, Progress};
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::mpsc::{RecvTimeoutError, channel};
use std::time::Duration;

/// So often Python is asked whether someone has pressed ^C.
const LOOK: Duration = Duration::from_millis(50);

/// Works on threads of its own, while this one asks Python for signals and tells `progress` how far it is. The second is what
/// that failed with, which has ended the work.
pub fn watched<T: Send>(
    py: Python<'_>,
    threads: usize,
    crop: Option<Crop>,
    progress: Option<&Py<PyAny>>,
    work: impl FnOnce(&Options<'_>) -> T + Send,
) -> (T, Option<PyErr>) {
    let cancel = AtomicBool::new(false);
    let [pixels, total, rays] = [AtomicU64::new(0), AtomicU64::new(0), AtomicU64::new(0)];
    let count = |done: Progress| {
        total.store(done.total_pixels, Ordering::Relaxed);
        pixels.fetch_max(done.pixels, Ordering::Relaxed);
        rays.fetch_max(done.rays, Ordering::Relaxed);
    };
    let options = Options { threads, crop, progress: Some(&count), cancel: Some(&cancel), ..Options::default() };
    let tell = |py: Python<'_>| {
        let seen = (pixels.load(Ordering::Relaxed), total.load(Ordering::Relaxed), rays.load(Ordering::Relaxed));
        // Nothing is finished yet.
        let progress = progress.filter(|_| seen.1 > 0);
        progress.map_or(Ok(()), |progress| progress.call1(py, seen).map(drop))
    };
    let look = || Python::attach(|py| py.check_signals().and_then(|()| tell(py)));
    py.detach(|| {
        std::thread::scope(|scope| {
            let (over, is_over) = channel::<()>();
            let worker = scope.spawn(|| {
                let result = work(&options);
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
            let result = worker.join();
            if stopped.is_none() {
                // So that whoever counts knows that it is over.
                stopped = Python::attach(|py| tell(py).err());
            }
            match result {
                Ok(result) => (result, stopped),
                Err(panic) => std::panic::resume_unwind(panic),
            }
        })
    })
}

/// What work came to that is worth nothing by halves.
pub fn unless_stopped<T>((result, stopped): (Option<T>, Option<PyErr>)) -> PyResult<T> {
    match stopped {
        Some(error) => Err(error),
        None => result.ok_or_else(|| pyo3::exceptions::PyRuntimeError::new_err("it was stopped by nobody")),
    }
}
