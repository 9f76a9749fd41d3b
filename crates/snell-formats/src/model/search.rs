//! Where a file lies that another file names.

use crate::files::{Files, MAX_MODEL_BYTES};
use crate::report::{Remedy, Report, nearest};
use snell::scene::WarningCode;
use std::path::{Path, PathBuf};

/// Folders in which people keep models, in lower case; they come before other folders.
const MODEL_FOLDERS: &[&str] = &["models", "model", "obj", "objs", "mtl", "mtls", "meshes", "mesh"];

/// So many folders beside a scene are looked into; a home folder may hold thousands.
const MOST_FOLDERS: usize = 200;

/// A file that was looked for.
#[derive(Clone, Debug)]
pub struct Found {
    /// Where it lies.
    pub path: PathBuf,
    /// Whether a different file of the same name lies in another of the folders.
    pub warning: Option<Report>,
}

/// Looks for files that other files name.
#[derive(Clone, Copy, Debug)]
pub struct Finder<'a> {
    /// Where all files lie.
    pub files: &'a dyn Files,
    /// Folders in which they are looked for first.
    pub search: &'a [PathBuf],
}

impl Finder<'_> {
    /// Finds a file by the name that a scene or model in `folder` gives it: in the folders of `search`, beside it, in the
    /// folder above, in the folders that lie beside it, and in the model folders (`models`, `obj`, `mtl`, …) above. The first
    /// one found is taken, with a warning if another one is different, unless `search` asked for it. Other folders above are
    /// other people's.
    ///
    /// # Errors
    /// When it is in none of them.
    pub fn find(&self, name: &str, folder: &Path) -> Result<Found, Report> {
        self.find_in(name, &self.places(folder))
    }

    /// The same, with the [`places`](Self::places) of the folder.
    ///
    /// # Errors
    /// As [`find`](Self::find).
    pub fn find_in(&self, name: &str, places: &[PathBuf]) -> Result<Found, Report> {
        self.look_in(name, places).ok_or_else(|| self.missing(name, places))
    }

    /// The same, of what need not be there.
    pub fn look_in(&self, name: &str, places: &[PathBuf]) -> Option<Found> {
        // As it is, as a driver made on Windows means it, and without its folders.
        let slashed = name.replace('\\', "/");
        let file_name = Path::new(&slashed).file_name().map(PathBuf::from).unwrap_or_default();
        for candidate in [Path::new(name), Path::new(&slashed), file_name.as_path()] {
            let there = |folders: &[PathBuf]| -> Vec<PathBuf> {
                folders.iter().map(|f| f.join(candidate)).filter(|p| self.files.is_file(p)).collect()
            };
            if let Some(path) = there(self.search).into_iter().next() {
                return Some(Found { path, warning: None });
            }
            let found = there(places);
            if let Some(path) = found.first() {
                return Some(Found { path: path.clone(), warning: self.ambiguous(name, &found) });
            }
        }
        None
    }

    fn missing(&self, name: &str, places: &[PathBuf]) -> Report {
        let search = self.search;
        let looked: Vec<String> = search.iter().chain(places).take(8).map(|p| format!("{}/", p.display())).collect();
        let more = (search.len() + places.len()).saturating_sub(looked.len());
        let more = if more > 0 { format!(" and {more} more") } else { String::new() };
        let near = self.nearest_file(name, places).map_or(String::new(), |near| format!("did you mean `{near}`? "));
        let help = format!("{near}looked in {}{more}", looked.join(", "));
        Report::error(format!("the file `{name}` is not there")).help(help).remedy(Remedy::NameFolder)
    }

    /// Where files are looked for that a scene or model in `folder` names.
    pub fn places(&self, folder: &Path) -> Vec<PathBuf> {
        let parent = parent(folder);
        let mut places: Vec<PathBuf> = vec![folder.to_owned()];
        places.extend(parent.clone());
        places.extend(self.folders_in(folder));
        let above = parent.map(|parent| self.folders_in(&parent)).unwrap_or_default();
        places.extend(above.into_iter().filter(|folder| is_model_folder(folder)));
        places
    }

    /// The name of a file in one of the folders that is most like another.
    fn nearest_file(&self, name: &str, places: &[PathBuf]) -> Option<String> {
        let wanted = name.rsplit(['/', '\\']).next().unwrap_or(name);
        let entries = self.search.iter().chain(places).flat_map(|folder| self.files.list(folder).take(MOST_FILES));
        let files = entries.filter(|path| self.files.is_file(path));
        let names: Vec<String> = files.filter_map(|path| Some(path.file_name()?.to_str()?.to_owned())).collect();
        nearest(wanted, names.iter().map(String::as_str)).map(str::to_owned)
    }

    /// The folders in a folder, those for models first, then by name.
    fn folders_in(&self, folder: &Path) -> Vec<PathBuf> {
        let visible = |path: &PathBuf| !lower_name(path).starts_with('.') && self.files.is_folder(path);
        let mut folders: Vec<PathBuf> = self.files.list(folder).filter(visible).collect();
        folders.sort_by_cached_key(|path| (!is_model_folder(path), path.clone()));
        folders.truncate(MOST_FOLDERS);
        folders
    }

    fn ambiguous(&self, name: &str, found: &[PathBuf]) -> Option<Report> {
        if found.len() < 2 {
            return None;
        }
        let read = |path: &PathBuf| self.files.read(path, MAX_MODEL_BYTES);
        let first = read(found.first()?).ok()?;
        let other = found[1..].iter().find(|path| read(path).is_ok_and(|bytes| bytes != first))?;
        let message = format!(
            "`{name}` lies in two places with different content: {} is taken, not {}",
            found[0].display(),
            other.display()
        );
        Some(Report::warning(WarningCode::AmbiguousFile, message).remedy(Remedy::NameFolder))
    }
}

/// So many files of a folder are compared.
const MOST_FILES: usize = 10_000;

/// The folder above, also of a relative path without one.
fn parent(folder: &Path) -> Option<PathBuf> {
    match (folder.parent(), folder.file_name()) {
        // `..` has no name of its own: above it is one `..` more.
        (Some(parent), Some(_)) if !parent.as_os_str().is_empty() => Some(parent.to_owned()),
        _ if folder.is_absolute() && folder.parent().is_none() => None,
        _ => Some(folder.join("..")),
    }
}

fn is_model_folder(path: &Path) -> bool {
    MODEL_FOLDERS.contains(&lower_name(path).as_str())
}

fn lower_name(path: &Path) -> String {
    path.file_name().map(|n| n.to_string_lossy().to_lowercase()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::files::Disk;
    use std::fs;

    #[test]
    fn beside_above_and_in_model_folders_of_both() {
        let root = tempfile::tempdir().unwrap();
        let at = |p: &str| root.path().join(p);
        for folder in ["scenes", "models", "scenes/obj", "scenes/props", "mtl", "other"] {
            fs::create_dir(at(folder)).unwrap();
        }
        let put = |p: &str, text: &str| fs::write(at(p), text).unwrap();
        let find = |name: &str, search: &[PathBuf]| Finder { files: &Disk, search }.find(name, &at("scenes"));

        assert_eq!(find("a.obj", &[]).unwrap_err().remedy, Some(Remedy::NameFolder));
        put("scenes/an.obj", "0");
        assert!(find("am.obj", &[]).unwrap_err().help.unwrap().starts_with("did you mean `an.obj`?"));
        put("other/a.obj", "1");
        assert!(find("a.obj", &[]).is_err(), "not in just any folder above");
        put("scenes/props/a.obj", "1");
        assert_eq!(find("a.obj", &[]).unwrap().path, at("scenes/props/a.obj"), "any folder beside");
        fs::remove_file(at("scenes/props/a.obj")).unwrap();
        put("models/a.obj", "1");
        let twice = find("a.obj", &[]).unwrap();
        assert!(twice.path == at("models/a.obj") && twice.warning.is_none(), "the same twice is no question");
        put("mtl/a.obj", "2");
        let twice = find("a.obj", &[]).unwrap();
        assert!(twice.path == at("models/a.obj") && twice.warning.is_some());
        put("scenes/obj/a.obj", "3");
        assert_eq!(find("a.obj", &[]).unwrap().path, at("scenes/obj/a.obj"));
        put("scenes/a.obj", "4");
        let nearest = find("C:\\work\\a.obj", &[]).unwrap();
        assert!(nearest.path == at("scenes/a.obj") && nearest.warning.is_some());
        let asked = find("a.obj", &[at("other")]).unwrap();
        assert!(asked.path == at("other/a.obj") && asked.warning.is_none());
    }
}
