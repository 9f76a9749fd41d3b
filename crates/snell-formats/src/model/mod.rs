//! Models: OBJ and MTL, PLY, STL, and where they lie.

mod mtl;
mod obj;
mod ply;
pub(crate) mod polygon;
mod search;
mod stl;
mod write;

pub use mtl::{Mirror, MtlMaterial, MtlRule, parse_mtl};
pub use obj::parse_obj;
pub use ply::parse_ply;
pub(crate) use search::{Finder, Found};
pub use stl::parse_stl;
pub use write::{write_obj, write_ply};

use crate::given::{Given, given};
use crate::report::Report;
use crate::text::decode;
use snell::geometry::TriangleMesh;
use snell::scene::WarningCode;
use std::path::Path;

/// A kind of model file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Format {
    /// Wavefront OBJ.
    Obj,
    /// PLY, as text or as bytes.
    Ply,
    /// STL, as text or as bytes.
    Stl,
}

impl Format {
    /// What such a file is, in words.
    pub fn words(self) -> &'static str {
        match self {
            Self::Obj => "a Wavefront OBJ model",
            Self::Ply => "a PLY model",
            Self::Stl => "an STL model",
        }
    }
}

/// What a model file says.
#[derive(Clone, Debug, Default)]
pub struct Model {
    /// The triangles. Slot names are those of OBJ's `usemtl`; faces before the first, and those of other formats, have the empty
    /// name.
    pub mesh: TriangleMesh,
    /// Files of materials that it names, each once.
    pub libraries: Vec<String>,
    /// Does it have normals? They are not drawn: smoothing is the scene's own.
    pub has_normals: bool,
    /// A corner whose texture coordinates are not in the file. Its faces have none, which matters where a texture is drawn.
    pub lost_uv: Option<Report>,
    /// What is odd, or not drawn.
    pub warnings: Vec<Report>,
}

/// Reads a model, by its content or the ending of its name: `.obj`, `.ply` or `.stl`. Materials are left to those who draw it.
///
/// # Errors
/// Another ending, and what the readers do not take.
pub fn parse_model(path: &Path, bytes: &[u8]) -> Result<Model, Report> {
    let name = path.display().to_string();
    let what = given(path, bytes);
    let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    match (what, &*ending) {
        (Given::Model(Format::Ply), _) => parse_ply(&name, bytes),
        (Given::Model(Format::Stl), _) => parse_stl(&name, bytes),
        (Given::Model(Format::Obj), _) | (Given::Text, "obj") => {
            let (source, warning) = decode(&name, bytes);
            let mut model = parse_obj(&source)?;
            model.warnings.extend(warning);
            Ok(model)
        }
        (what, _) => {
            let what = what.words().map_or(String::new(), |what| format!(" but {what}"));
            Err(Report::error(format!("`{name}` is no model{what}: models are OBJ, PLY or STL")))
        }
    }
}

/// A mesh of which the file says no materials: all faces have the one without a name.
fn without_materials(mut mesh: TriangleMesh) -> TriangleMesh {
    mesh.face_slots = vec![0; mesh.faces.len()];
    mesh.slots = vec![String::new()];
    mesh
}

/// W109 about things that are read but not drawn, each once; none if there are none.
fn not_drawn<'a>(name: &str, things: impl IntoIterator<Item = &'a str>) -> Option<Report> {
    let mut named: Vec<&str> = Vec::new();
    for thing in things {
        if !named.contains(&thing) {
            named.push(thing);
        }
    }
    (!named.is_empty()).then(|| {
        let message = format!("`{name}` has more than is drawn: {}", crate::report::list(named));
        Report::warning(WarningCode::NotDrawn, message)
    })
}
