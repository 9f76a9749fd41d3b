//! Models: OBJ and MTL, PLY, STL, and where they lie.

mod mtl;
mod obj;
mod ply;
pub(crate) mod polygon;
mod search;
mod stl;
mod write;

pub use mtl::{Mirror, MtlMaterial, MtlRule, parse_mtl};
pub use obj::{ObjModel, parse_obj};
pub use ply::parse_ply;
pub use search::{Found, find};
pub use stl::parse_stl;
pub use write::write_obj;

use crate::disk;
use crate::report::Report;
use snell::geometry::TriangleMesh;
use std::path::Path;

/// Reads a model by the ending of its name: `.obj`, `.ply` or `.stl`. Materials are left to those who draw it.
///
/// # Errors
/// Another ending, and what the readers do not take.
pub fn parse_model(path: &Path, bytes: &[u8]) -> Result<ObjModel, Report> {
    let name = path.display().to_string();
    let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    let plain = |mesh| ObjModel { mesh, libraries: Vec::new(), warnings: Vec::new() };
    match &*ending {
        "obj" => parse_obj(&disk::text(path, bytes)),
        "ply" => parse_ply(&name, bytes).map(plain),
        "stl" => parse_stl(&name, bytes).map(plain),
        _ => Err(Report::error(format!("`{name}` is no model: models end in .obj, .ply or .stl"))),
    }
}

/// A mesh of which the file says no materials: all faces have the one without a name.
fn without_materials(mut mesh: TriangleMesh) -> TriangleMesh {
    mesh.face_slots = vec![0; mesh.faces.len()];
    mesh.slots = vec![String::new()];
    mesh
}
