//! Scenes by their names: files on disk, or built-in ones.

use super::{Kind, LoadOptions, Loaded, load_bytes, load_text};
use crate::builtin;
use crate::files::{Disk, Files, MAX_SCENE_BYTES};
use crate::given::given_file;
use crate::report::{Report, nearest};
use std::path::Path;

/// A name with one of these is meant as a file.
const ENDINGS: &[&str] =
    &["txt", "toml", "json", "nff", "obj", "ply", "stl", "mtl", "png", "ppm", "exr", "npy", "glb", "gltf"];

/// Reads a scene file, a driver, an NFF file, or a built-in scene.
///
/// # Errors
/// Everything that keeps the file from being read.
pub fn load(name: &str, options: &LoadOptions) -> Result<Loaded, Vec<Report>> {
    let path = Path::new(name);
    if path.is_dir() {
        return Err(vec![Report::error(format!("`{name}` is a folder")).help("name the scene file in it")]);
    }
    if !path.exists() {
        return match builtin::find(name) {
            Ok(source) => load_text(source, Kind::Toml, Path::new("."), options),
            Err(_) if path.extension().is_some_and(|e| ENDINGS.iter().any(|ending| e.eq_ignore_ascii_case(ending))) => {
                Err(vec![no_file(path)])
            }
            Err(report) => {
                let file = near_file(path).map(|near| format!("did you mean the file `{near}`?"));
                let help: Vec<String> = file.into_iter().chain(report.help).collect();
                let missing = Report::error(format!("there is no file and no built-in scene `{name}`"));
                let missing = Report { remedy: report.remedy, ..missing };
                Err(vec![if help.is_empty() { missing } else { missing.help(help.join(" ")) }])
            }
        };
    }
    let bytes = Disk.read(path, MAX_SCENE_BYTES).map_err(|report| given_file(path).no_scene(name).unwrap_or(report))?;
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let mut loaded = load_bytes(name, path, &bytes, folder, options)?;
    loaded.path = Some(path.to_owned());
    Ok(loaded)
}

/// There is no such file, but perhaps one of nearly that name.
fn no_file(path: &Path) -> Report {
    let report = Report::error(format!("there is no file `{}`", path.display()));
    match near_file(path) {
        Some(near) => report.help(format!("did you mean `{near}`?")),
        None => report,
    }
}

/// The file of the same folder whose name is most like another.
fn near_file(path: &Path) -> Option<String> {
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    let names =
        std::fs::read_dir(folder).into_iter().flatten().flatten().filter_map(|e| e.file_name().into_string().ok());
    let (names, wanted): (Vec<String>, _) = (names.collect(), path.file_name().unwrap_or_default().to_string_lossy());
    let near = nearest(&wanted, names.iter().map(String::as_str))?;
    Some(path.with_file_name(near).display().to_string())
}
