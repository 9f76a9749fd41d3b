//! A scene as it is read from disk, with everything that was read for it, so that it can be seen when any of that changes.

use snell_formats::files::{Disk, Files, MAX_SCENE_BYTES, sha256};
use snell_formats::load::load_bytes;
use snell_formats::{LoadOptions, Loaded, Report};
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::{Component, Path, PathBuf};
use std::sync::{Arc, Mutex};
use std::time::SystemTime;

/// What a page needs to load a scene.
pub struct Snapshot {
    pub name: String,
    pub text: Vec<u8>,
    /// What the scene names, by names that lead there from that of the scene.
    pub files: Vec<(String, Vec<u8>)>,
}

/// What a scene depends on, as it was when it was read.
#[derive(Clone, PartialEq)]
pub struct Watched(BTreeMap<PathBuf, Option<State>>);

impl Watched {
    /// The same files as they are now.
    pub fn now(&self) -> Self {
        Self(self.0.keys().map(|path| (path.clone(), State::of(path))).collect())
    }
}

/// Enough of a file to see that it has changed.
#[derive(Clone, Debug, PartialEq)]
struct State {
    modified: Option<SystemTime>,
    length: u64,
    /// Of a small file, as the clocks of some disks count whole seconds.
    sha256: Option<String>,
}

const SMALL: u64 = 1 << 16;

impl State {
    fn of(path: &Path) -> Option<Self> {
        let about = path.metadata().ok()?;
        let is_small = about.is_file() && about.len() <= SMALL;
        let bytes = if is_small { Disk.read(path, SMALL).ok() } else { None };
        Some(Self { modified: about.modified().ok(), length: about.len(), sha256: bytes.map(|bytes| sha256([bytes])) })
    }
}

/// Reads a scene file; `shown` is what it is called. Whether or not it can be read, what was looked at is told.
pub fn read(shown: &str, path: &Path) -> (Result<(Loaded, Snapshot), Vec<Report>>, Watched) {
    let folder = path.parent().unwrap_or(Path::new("")).to_owned();
    let reader = Arc::new(Reader { folder, looked_at: Mutex::default(), read: Mutex::default() });
    let result = scene(shown, path, &reader);
    let mut looked_at = reader.looked_at.lock().map(|mut all| std::mem::take(&mut *all)).unwrap_or_default();
    if result.is_ok() {
        // Where else a file might have lain is of interest only as long as it lies nowhere.
        looked_at.retain(|_, state| state.is_some());
    }
    (result, Watched(looked_at))
}

fn scene(shown: &str, path: &Path, reader: &Arc<Reader>) -> Result<(Loaded, Snapshot), Vec<Report>> {
    reader.note(path);
    let text = Disk.read(path, MAX_SCENE_BYTES)?;
    let options = LoadOptions { files: Arc::clone(reader) as _, ..LoadOptions::default() };
    // The names of files begin in its folder, as they do in a page.
    let name = PathBuf::from(path.file_name().unwrap_or(OsStr::new("scene")));
    let loaded = load_bytes(shown, &name, &text, Path::new(""), &options)?;
    let read = reader.read.lock().map(|mut read| std::mem::take(&mut *read)).unwrap_or_default();
    // Files above the folder of the scene are below one that all of them are in.
    let above = read.keys().map(|file| steps_up(file)).max().unwrap_or(0);
    let folder = std::path::absolute(&reader.folder).unwrap_or_default();
    let folders: Vec<&OsStr> = folder.iter().collect();
    let prefix: PathBuf = folders[folders.len().saturating_sub(above)..].iter().collect();
    let files = read.into_iter().map(|(file, bytes)| (name_within(&prefix.join(file)), bytes)).collect();
    Ok((loaded, Snapshot { name: name_within(&prefix.join(name)), text, files }))
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

/// The disk as seen from the folder of a scene. It remembers what was looked at, and what was read.
#[derive(Debug)]
struct Reader {
    folder: PathBuf,
    looked_at: Mutex<BTreeMap<PathBuf, Option<State>>>,
    read: Mutex<BTreeMap<PathBuf, Vec<u8>>>,
}

impl Reader {
    /// Before it is read, so that no change meanwhile is lost.
    fn note(&self, path: &Path) {
        if let Ok(mut looked_at) = self.looked_at.lock() {
            looked_at.entry(path.to_owned()).or_insert_with(|| State::of(path));
        }
    }
}

impl Files for Reader {
    fn read(&self, path: &Path, limit: u64) -> Result<Vec<u8>, Report> {
        let file = self.folder.join(path);
        self.note(&file);
        let bytes = Disk.read(&file, limit)?;
        if let Ok(mut read) = self.read.lock() {
            read.insert(path.to_owned(), bytes.clone());
        }
        Ok(bytes)
    }

    fn is_file(&self, path: &Path) -> bool {
        let file = self.folder.join(path);
        let is_file = Disk.is_file(&file);
        if !is_file {
            self.note(&file);
        }
        is_file
    }

    fn is_folder(&self, path: &Path) -> bool {
        Disk.is_folder(&self.folder.join(path))
    }

    fn list(&self, folder: &Path) -> Box<dyn Iterator<Item = PathBuf> + '_> {
        let shown = folder.to_owned();
        let on_disk = if folder.as_os_str().is_empty() && self.folder.as_os_str().is_empty() {
            PathBuf::from(".")
        } else {
            self.folder.join(folder)
        };
        let names: Vec<_> = Disk.list(&on_disk).filter_map(|path| Some(path.file_name()?.to_owned())).collect();
        Box::new(names.into_iter().map(move |name| shown.join(name)))
    }
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
