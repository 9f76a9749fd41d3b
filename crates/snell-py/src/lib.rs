//! Snell for Python: what is handed over and back, and when Python's lock is held. No physics, and no settings of its own.
//!
//! `python/snell/` is the package that people see; this is its module `snell._native`.
//!
//! ```text
//!  python/snell                      snell._native                                       the library
//!  Scene ── JSON and arrays ──────▶  scene ─▶ world: NativeWorld, a compiled scene ────▶ World::new, World::edited
//!  scene.render() ────────────────▶  picture: NativePicture, its film as an array ◀──── render (watch: progress, ^C)
//!  scene.render_part() ───────────▶  part: NativePart, sums of samples ◀─────────────── PartialFilm
//!  picture.explain(x, y) ─────────▶  explain: NativeTree ◀───────────────────────────── explain
//! ```
//!
//! ```python
//! import snell
//! picture = snell.Scene.load("lecture/default").render(width=64, height=64)
//! print(picture.explain(32, 32))
//! ```

#![allow(clippy::needless_pass_by_value, reason = "what Python hands over comes by value")]
#![allow(missing_debug_implementations, reason = "Python shows them by its own classes")]

mod errors;
mod explain;
mod optics;
mod part;
mod pickle;
mod picture;
mod scene;
mod watch;
mod world;

use pyo3::prelude::*;

#[pymodule]
fn _native(module: &Bound<'_, PyModule>) -> PyResult<()> {
    module.add("__version__", env!("CARGO_PKG_VERSION"))?;
    scene::register(module)?;
    optics::register(module)?;
    module.add_class::<picture::NativePicture>()?;
    module.add_class::<part::NativePart>()?;
    module.add_function(wrap_pyfunction!(picture::png, module)?)?;
    module.add_function(wrap_pyfunction!(explain::viewer_script, module)?)?;
    module.add_class::<explain::NativeTree>()
}
