//! Reading that remembers what was read, so that a page in a browser can be given the same files.

use super::{Disk, Files};
use crate::report::Report;
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::{Component, Path, PathBuf};
use std::sync::Mutex;

/// The disk as seen from the folder of a scene. It remembers what was read.
#[derive(Debug)]
pub struct Recorder {
    folder: PathBuf,
    read: Mutex<BTreeMap<PathBuf, Vec<u8>>>,
}

/// Names with the bytes of their files.
pub type Named = Vec<(String, Vec<u8>)>;

impl Recorder {
    /// Names that are read begin in this folder.
    pub fn new(folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into(), read: Mutex::default() }
    }

    /// Where a file is on the disk.
    pub fn path(&self, name: &Path) -> PathBuf {
        self.folder.join(name)
    }

    /// Hands over what was read since the last time, under the names that it needs in memory, and the scene's name there: where
    /// files lie above the scene's folder, all names begin in a folder that holds them all.
    pub fn take(&self, scene: &OsStr) -> (String, Named) {
        let read = self.read.lock().map(|mut read| std::mem::take(&mut *read)).unwrap_or_default();
        let above = read.keys().map(|file| steps_up(file)).max().unwrap_or(0);
        let folder = std::path::absolute(&self.folder).unwrap_or_default();
        let folders: Vec<&OsStr> = folder.iter().collect();
        let prefix: PathBuf = folders[folders.len().saturating_sub(above)..].iter().collect();
        let files = read.into_iter().map(|(file, bytes)| (name_within(&prefix.join(file)), bytes)).collect();
        (name_within(&prefix.join(scene)), files)
    }
}

impl Files for Recorder {
    fn read(&self, path: &Path, limit: u64) -> Result<Vec<u8>, Report> {
        let bytes = Disk.read(&self.path(path), limit)?;
        if let Ok(mut read) = self.read.lock() {
            read.insert(path.to_owned(), bytes.clone());
        }
        Ok(bytes)
    }

    fn is_file(&self, path: &Path) -> bool {
        Disk.is_file(&self.path(path))
    }

    fn is_folder(&self, path: &Path) -> bool {
        Disk.is_folder(&self.path(path))
    }

    fn list(&self, folder: &Path) -> Box<dyn Iterator<Item = PathBuf> + '_> {
        let shown = folder.to_owned();
        let on_disk = if folder.as_os_str().is_empty() && self.folder.as_os_str().is_empty() {
            PathBuf::from(".")
        } else {
            self.path(folder)
        };
        let names: Vec<_> = Disk.list(&on_disk).filter_map(|path| Some(path.file_name()?.to_owned())).collect();
        Box::new(names.into_iter().map(move |name| shown.join(name)))
    }
}

/// How far above a folder a relative name leads at most.
fn steps_up(file: &Path) -> usize {
    let (mut depth, mut most) = (0_isize, 0);
    for part in file.components() {
        match part {
            Component::ParentDir => depth -= 1,
            Component::Normal(_) => depth += 1,
            Component::CurDir | Component::RootDir | Component::Prefix(_) => {}
        }
        most = most.max(-depth);
    }
    most.unsigned_abs()
}

/// A name without `.` and `..`, with `/` between folders.
fn name_within(path: &Path) -> String {
    let mut parts = Vec::new();
    for part in path.components() {
        match part {
            Component::Normal(name) => parts.push(name.to_string_lossy()),
            Component::ParentDir => drop(parts.pop()),
            Component::CurDir | Component::RootDir | Component::Prefix(_) => {}
        }
    }
    parts.join("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_above_the_scene_stay_in_their_places() {
        for (file, up) in [("a", 0), ("a/../b", 0), ("../a", 1), ("a/../../../b", 2), ("./../x/y", 1), ("/a/b", 0)] {
            assert_eq!(steps_up(Path::new(file)), up, "{file}");
        }
        assert_eq!(name_within(Path::new("scenes/../models/./a.obj")), "models/a.obj");
    }
}
