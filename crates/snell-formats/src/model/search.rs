//! Where a file lies that another file names.

use crate::disk;
use crate::report::Report;
use snell::scene::WarningCode;
use std::path::{Path, PathBuf};

/// Folders beside a scene in which people keep its models, in lower case.
const MODEL_FOLDERS: &[&str] = &["models", "model", "obj", "objs", "mtl", "mtls", "meshes", "mesh"];

/// A file that was looked for.
#[derive(Clone, Debug)]
pub struct Found {
    /// Where it lies.
    pub path: PathBuf,
    /// Whether another file of the same name was as near.
    pub warning: Option<Report>,
}

/// Finds a file by the name that a scene or model in `folder` gives it: in the folders of `search`, beside it, in the
/// folder above, and in the model folders (`models`, `obj`, `mtl`, …) of both. The nearest wins; of equally near ones the
/// first, with a warning if they differ.
///
/// # Errors
/// When it is in none of them.
pub fn find(name: &str, folder: &Path, search: &[PathBuf]) -> Result<Found, Report> {
    // A driver made on Windows.
    let name = name.replace('\\', "/");
    let parent = parent(folder);
    let mut places: Vec<Vec<PathBuf>> = search.iter().map(|folder| vec![folder.clone()]).collect();
    places.push(vec![folder.to_owned()]);
    places.extend(parent.clone().map(|p| vec![p]));
    places.push(model_folders(folder));
    places.extend(parent.as_deref().map(model_folders));

    let file_name = Path::new(&name).file_name().map(PathBuf::from).unwrap_or_default();
    for candidate in [Path::new(&name), file_name.as_path()] {
        for folders in &places {
            let found: Vec<PathBuf> = folders.iter().map(|f| f.join(candidate)).filter(|p| p.is_file()).collect();
            if let Some(path) = found.first() {
                return Ok(Found { path: path.clone(), warning: ambiguous(&name, &found) });
            }
        }
    }
    let looked: Vec<String> = places.iter().flatten().map(|p| format!("{}/", p.display())).collect();
    let help = format!("looked in {}; name another folder with --search DIR", looked.join(", "));
    Err(Report::error(format!("the file `{name}` is not there")).help(help))
}

/// The folder above, also of a relative path without one.
fn parent(folder: &Path) -> Option<PathBuf> {
    match folder.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => Some(parent.to_owned()),
        _ if folder.is_absolute() => None,
        _ => Some(folder.join("..")),
    }
}

fn model_folders(folder: &Path) -> Vec<PathBuf> {
    let Ok(entries) = std::fs::read_dir(folder) else { return Vec::new() };
    let is_model_folder = |path: &PathBuf| {
        let name = path.file_name().map(|n| n.to_string_lossy().to_lowercase()).unwrap_or_default();
        MODEL_FOLDERS.contains(&name.as_str()) && path.is_dir()
    };
    let mut folders: Vec<PathBuf> = entries.flatten().map(|e| e.path()).filter(is_model_folder).collect();
    folders.sort();
    folders
}

fn ambiguous(name: &str, found: &[PathBuf]) -> Option<Report> {
    let first = disk::read(found.first()?, disk::MAX_MODEL_BYTES).ok()?;
    let other = found[1..].iter().find(|p| disk::read(p, disk::MAX_MODEL_BYTES).is_ok_and(|b| b != first))?;
    let message = format!(
        "`{name}` lies in two places with different content: {} is taken, not {}",
        found[0].display(),
        other.display()
    );
    Some(Report::warning(WarningCode::AmbiguousFile, message).help("say which with --search DIR"))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn beside_above_and_in_model_folders_of_both() {
        let root = tempfile::tempdir().unwrap();
        let at = |p: &str| root.path().join(p);
        for folder in ["scenes", "models", "scenes/obj", "mtl", "other"] {
            fs::create_dir(at(folder)).unwrap();
        }
        let put = |p: &str, text: &str| fs::write(at(p), text).unwrap();
        let find = |name: &str, search: &[PathBuf]| find(name, &at("scenes"), search);

        assert!(find("a.obj", &[]).unwrap_err().help.unwrap().contains("--search"));
        put("models/a.obj", "1");
        assert_eq!(find("a.obj", &[]).unwrap().path, at("models/a.obj"));
        put("mtl/a.obj", "2");
        let twice = find("a.obj", &[]).unwrap();
        assert!(twice.path == at("models/a.obj") && twice.warning.is_some());
        put("mtl/a.obj", "1");
        assert!(find("a.obj", &[]).unwrap().warning.is_none(), "the same twice is no question");
        put("scenes/obj/a.obj", "3");
        assert_eq!(find("a.obj", &[]).unwrap().path, at("scenes/obj/a.obj"));
        put("scenes/a.obj", "4");
        assert_eq!(find("C:\\work\\a.obj", &[]).unwrap().path, at("scenes/a.obj"));
        put("other/a.obj", "5");
        assert_eq!(find("a.obj", &[at("other")]).unwrap().path, at("other/a.obj"));
    }
}
