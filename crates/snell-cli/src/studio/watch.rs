//! A scene as it is read from disk, with everything that was read for it, so that it can be seen when any of that changes.

use snell_formats::files::{Disk, Files, MAX_SCENE_BYTES, Recorder, sha256};
use snell_formats::load::load_bytes;
use snell_formats::{LoadOptions, Loaded, Report};
use std::collections::BTreeMap;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
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
    let reader = Arc::new(Reader { disk: Recorder::new(folder), looked_at: Mutex::default() });
    let result = scene(shown, path, &reader);
    let mut looked_at = reader.looked_at.lock().map(|mut all| std::mem::take(&mut *all)).unwrap_or_default();
    if result.is_ok() {
        // Where else a file might have lain is of interest only as long as it lies nowhere.
        looked_at.retain(|_, state| state.is_some());
    }
    (result, Watched(looked_at))
}

fn scene(shown: &str, path: &Path, reader: &Arc<Reader>) -> Result<(Loaded, Snapshot), Vec<Report>> {
    reader.note(path.to_owned());
    let text = Disk.read(path, MAX_SCENE_BYTES)?;
    let options = LoadOptions { files: Arc::clone(reader) as _, ..LoadOptions::default() };
    // The names of files begin in its folder, as they do in a page.
    let name = path.file_name().unwrap_or(OsStr::new("scene"));
    let loaded = load_bytes(shown, Path::new(name), &text, Path::new(""), &options)?;
    let (name, files) = reader.disk.take(name);
    Ok((loaded, Snapshot { name, text, files }))
}

/// The disk as seen from the folder of a scene. It remembers what was looked at, and what was read.
#[derive(Debug)]
struct Reader {
    disk: Recorder,
    looked_at: Mutex<BTreeMap<PathBuf, Option<State>>>,
}

impl Reader {
    /// Before it is read, so that no change meanwhile is lost.
    fn note(&self, path: PathBuf) {
        if let Ok(mut looked_at) = self.looked_at.lock() {
            looked_at.entry(path).or_insert_with_key(|path| State::of(path));
        }
    }
}

impl Files for Reader {
    fn read(&self, path: &Path, limit: u64) -> Result<Vec<u8>, Report> {
        self.note(self.disk.path(path));
        self.disk.read(path, limit)
    }

    fn is_file(&self, path: &Path) -> bool {
        let is_file = self.disk.is_file(path);
        if !is_file {
            self.note(self.disk.path(path));
        }
        is_file
    }

    fn is_folder(&self, path: &Path) -> bool {
        self.disk.is_folder(path)
    }

    fn list(&self, folder: &Path) -> Box<dyn Iterator<Item = PathBuf> + '_> {
        self.disk.list(folder)
    }
}
