//! Saving a scene, with what is large in files beside it.

use super::{Syntax, to_text};
use crate::disk;
use crate::model::{PLY_HEAD, write_ply};
use crate::report::Report;
use snell::geometry::TriangleMesh;
use snell::scene::{Mesh, Scene};
use std::io::Read;
use std::path::{Path, PathBuf};

/// A mesh with more triangles does not become text: that would take ten times the room, and a hundred times the memory to read.
const MOST_FACES: usize = 1000;

/// Writes a scene into a file, with meshes of more than 1000 triangles as PLY files beside it, to the bit; returns all files that
/// were written. `heading` stands before the text. `may_write` is asked of the scene file before anything is written; a file beside
/// it that is there already is replaced only if it is from here.
///
/// # Errors
/// When a file must not be written, a value has no form in a file, what is written would be too large to be read, or writing fails.
pub fn save(
    mut scene: Scene,
    output: &Path,
    syntax: Syntax,
    heading: &str,
    may_write: impl Fn(&Path) -> Result<(), Report>,
) -> Result<Vec<PathBuf>, Report> {
    let mut beside: Vec<(PathBuf, TriangleMesh)> = Vec::new();
    for (number, mesh) in scene.meshes.iter_mut().enumerate() {
        if let Some(triangles) = take_triangles(mesh) {
            let stem = output.file_stem().unwrap_or_default().to_string_lossy();
            let file = format!("{stem}-mesh-{}.ply", number + 1);
            beside.push((output.with_file_name(&file), triangles));
            mesh.name.get_or_insert_with(|| format!("mesh {}", number + 1));
            mesh.file = Some(file);
        }
    }
    let text = heading.to_owned() + &to_text(&scene, syntax)?;
    if text.len() as u64 > disk::MAX_SCENE_BYTES {
        let message =
            format!("this scene has {} bytes as text; more than {} are not read", text.len(), disk::MAX_SCENE_BYTES);
        return Err(Report::error(message).help("put what stands in many places into one [[mesh]] with `instances`"));
    }
    let paths: Vec<PathBuf> = beside.iter().map(|(path, _)| path.clone()).chain([output.to_owned()]).collect();
    for path in &paths {
        if path != output && path.exists() {
            is_from_here(path)?;
        }
    }
    may_write(output)?;
    for (path, triangles) in &beside {
        disk::write(path, |out| write_ply(triangles, out))?;
    }
    disk::write(output, |out| out.write_all(text.as_bytes()))?;
    Ok(paths)
}

/// Was this file written by [`write_ply`]? Whatever else has its name is somebody's work.
fn is_from_here(path: &Path) -> Result<(), Report> {
    let mut start = Vec::new();
    let read = std::fs::File::open(path).and_then(|file| file.take(200).read_to_end(&mut start));
    if read.is_ok() && start.starts_with(PLY_HEAD.as_bytes()) {
        return disk::check_writable(path);
    }
    let message = format!("`{}`, where a large mesh would go, exists and is not from Snell", path.display());
    Err(Report::error(message).help("choose another name for the scene"))
}

/// The triangles of a mesh that has no file and is too large for a text.
fn take_triangles(mesh: &mut Mesh) -> Option<TriangleMesh> {
    if mesh.file.is_some() || mesh.faces.len() <= MOST_FACES {
        return None;
    }
    let vertices = std::mem::take(&mut mesh.vertices).into_iter().map(Into::into).collect();
    Some(TriangleMesh { vertices, faces: std::mem::take(&mut mesh.faces), ..TriangleMesh::default() })
}
