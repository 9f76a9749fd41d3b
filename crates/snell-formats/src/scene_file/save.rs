//! Saving a scene, with what is large in files beside it.

use super::{Syntax, to_text};
use crate::files::disk::{self, Disk};
use crate::files::{Files, MAX_SCENE_BYTES, Named, sha256};
use crate::model::write_ply;
use crate::report::Report;
use snell::geometry::TriangleMesh;
use snell::scene::{Mesh, Scene};
use std::path::{Path, PathBuf};

/// A mesh with more triangles does not become text: that would take ten times the room, and a hundred times the memory to read.
const MOST_FACES: usize = 1000;

/// Writes a scene into a file, with large meshes as PLY files beside it, as [`pack`] has them; returns all files that belong to it.
/// `heading` stands before the text.
///
/// # Errors
/// When a value has no form in a file, what is written would be too large to be read, or writing fails.
pub fn save(scene: Scene, output: &Path, syntax: Syntax, heading: &str) -> Result<Vec<PathBuf>, Report> {
    let target = disk::behind_links(output);
    let (text, beside) = pack(scene, &target.file_stem().unwrap_or_default().to_string_lossy(), syntax)?;
    let text = heading.to_owned() + &text;
    if text.len() as u64 > MAX_SCENE_BYTES {
        let message =
            format!("this scene has {} bytes as text; more than {} are not read", text.len(), MAX_SCENE_BYTES);
        return Err(Report::error(message).help("put what stands in many places into one [[mesh]] with `instances`"));
    }
    let beside: Vec<_> = beside.into_iter().map(|(name, bytes)| (target.with_file_name(name), bytes)).collect();
    for (path, bytes) in &beside {
        let there = path.symlink_metadata().is_ok();
        if !there {
            disk::write(path, |out| out.write_all(bytes))?;
        } else if !Disk.read(path, bytes.len() as u64).is_ok_and(|old| old == *bytes) {
            let message = format!("`{}`, where a large mesh would go, is something else", path.display());
            return Err(Report::error(message).help("choose another name for the scene"));
        }
    }
    disk::write(output, |out| out.write_all(text.as_bytes()))?;
    Ok(beside.into_iter().map(|(path, _)| path).chain([output.to_owned()]).collect())
}

/// A scene as a text, and its meshes of more than 1000 triangles as PLY files, to the bit, by their names. Those are made of `stem` and of
/// their content, so that none of them ever takes the place of another.
///
/// # Errors
/// When a value has no form in a file.
pub fn pack(mut scene: Scene, stem: &str, syntax: Syntax) -> Result<(String, Named), Report> {
    let mut beside = Vec::new();
    for (number, mesh) in scene.meshes.iter_mut().enumerate() {
        if let Some(triangles) = take_triangles(mesh) {
            let mut bytes = Vec::new();
            write_ply(&triangles, &mut bytes).map_err(|e| Report::error(format!("a mesh cannot be written: {e}")))?;
            let file = format!("{stem}-mesh-{}.ply", &sha256([&bytes])[..12]);
            beside.push((file.clone(), bytes));
            mesh.name.get_or_insert_with(|| format!("mesh {}", number + 1));
            mesh.file = Some(file);
        }
    }
    Ok((to_text(&scene, syntax)?, beside))
}

/// The triangles of a mesh that has no file and is too large for a text.
fn take_triangles(mesh: &mut Mesh) -> Option<TriangleMesh> {
    if mesh.file.is_some() || mesh.faces.len() <= MOST_FACES {
        return None;
    }
    let vertices = std::mem::take(&mut mesh.vertices).into_iter().map(Into::into).collect();
    Some(TriangleMesh { vertices, faces: std::mem::take(&mut mesh.faces), ..TriangleMesh::default() })
}
