//! The tree of a pixel, and where an object is seen.

use crate::errors::raise;
use crate::picture::shaped;
use crate::watch::{unless_stopped, watched};
use crate::world::Ready;
use numpy::PyArray2;
use pyo3::prelude::*;
use snell::explain::text::{Piece, Style, text};
use snell::explain::{Explanation, Sightings, explain, find as find_object};
use snell_formats::figure::figure;
use snell_formats::page::{VIEWER, page};
use snell_formats::report::known_names;
use std::sync::Arc;

/// The viewer as a script, for notebooks.
#[pyfunction]
pub fn viewer_script() -> &'static str {
    VIEWER
}

/// Why a pixel has its colour.
#[pyclass(frozen)]
pub struct NativeTree {
    explanation: Explanation,
    ready: Arc<Ready>,
}

impl NativeTree {
    pub fn of(py: Python<'_>, ready: &Arc<Ready>, x: u32, y: u32) -> PyResult<Option<Self>> {
        let compiled = ready.compiled(py)?;
        let explained = py.detach(|| explain(compiled, x, y));
        Ok(explained.map(|(explanation, _)| Self { explanation, ready: Arc::clone(ready) }))
    }
}

#[pymethods]
impl NativeTree {
    /// The JSON form.
    fn json(&self) -> String {
        // Every number in it is finite, so that there is always one.
        serde_json::to_string(&self.explanation).unwrap_or_default()
    }

    /// The tree as text, with the strongest `top` branches and `depth` bounces.
    #[pyo3(signature = (top, depth))]
    fn text(&self, top: Option<usize>, depth: Option<u32>) -> String {
        let default = Style::default();
        let style = Style { top: top.unwrap_or(default.top), depth: depth.unwrap_or(default.depth) };
        let piece = |piece| match piece {
            Piece::Words(words) => words,
            Piece::Patch(_) => String::new(),
            Piece::MoreRays(count) => more_rays(count),
        };
        text(&self.explanation, style).pieces.into_iter().map(piece).collect()
    }

    /// The same with patches of colour, as a part of a page.
    fn text_html(&self) -> String {
        let escaped = |words: &str| words.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;");
        let piece = |piece| match piece {
            Piece::Words(words) => escaped(&words),
            Piece::Patch([r, g, b]) => {
                format!("<span style=\"background:rgb({r},{g},{b});border-radius:2px\">&nbsp;&nbsp;</span> ")
            }
            Piece::MoreRays(count) => more_rays(count),
        };
        let words: String = text(&self.explanation, Style::default()).pieces.into_iter().map(piece).collect();
        format!("<pre>{words}</pre>")
    }

    /// The drawing of the angles, as SVG.
    fn figure(&self) -> String {
        figure(&self.explanation)
    }

    /// The page with the rays in 3D.
    fn html(&self, py: Python<'_>) -> PyResult<String> {
        let compiled = self.ready.compiled(py)?;
        Ok(py.detach(|| page(&self.explanation, compiled)))
    }
}

fn more_rays(count: usize) -> String {
    format!("  … {count} more rays; text(top=N, depth=N) shows more\n")
}

/// The paths by which an object is seen, with their pixels; and for each pixel which share of it the object is.
pub type Seen<'py> = (Vec<(String, u64)>, Bound<'py, PyArray2<f64>>);

/// Where an object is seen.
pub fn find<'py>(py: Python<'py>, ready: &Ready, object: &str, progress: Option<&Py<PyAny>>) -> PyResult<Seen<'py>> {
    let compiled = ready.compiled(py)?;
    let known = compiled.world().object_names();
    if !known.contains(&object) {
        let message = format!("no object is called `{object}`");
        return Err(raise(py, "SceneError", vec![(None, message, Some(known_names(object, known)))]));
    }
    let work = watched(py, 0, None, progress, |options| find_object(compiled, object, options));
    let Sightings { paths, mask } = unless_stopped(work)?;
    let paths = paths.into_iter().map(|(path, pixels)| (path.to_string(), pixels)).collect();
    let [width, height] = compiled.world().camera.size.map(|length| length as usize);
    Ok((paths, shaped(py, [height, width], mask)?))
}
