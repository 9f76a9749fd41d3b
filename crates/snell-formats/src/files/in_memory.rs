//! Files in memory.

use super::{Files, missing, too_large};
use crate::report::Report;
use std::collections::BTreeMap;
use std::path::{Component, Path, PathBuf};

/// Files by their names, with `/` between folders, as a browser is given them.
#[derive(Clone, Debug, Default)]
pub struct InMemory {
    files: BTreeMap<PathBuf, Vec<u8>>,
}

impl InMemory {
    /// Adds a file, or replaces it.
    pub fn insert(&mut self, path: impl AsRef<Path>, bytes: Vec<u8>) {
        self.files.insert(plain(path.as_ref()), bytes);
    }
}

/// A path without `.` and `..`; above the topmost folder there is that folder again.
fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        match part {
            Component::Normal(name) => plain.push(name),
            Component::ParentDir => drop(plain.pop()),
            Component::CurDir | Component::RootDir | Component::Prefix(_) => {}
        }
    }
    plain
}

impl Files for InMemory {
    fn read(&self, path: &Path, limit: u64) -> Result<Vec<u8>, Report> {
        let bytes = self.files.get(&plain(path)).ok_or_else(|| missing(path))?;
        if bytes.len() as u64 > limit { Err(too_large(path, limit)) } else { Ok(bytes.clone()) }
    }

    fn is_file(&self, path: &Path) -> bool {
        self.files.contains_key(&plain(path))
    }

    fn is_folder(&self, path: &Path) -> bool {
        let folder = plain(path);
        self.files.keys().any(|file| file.starts_with(&folder) && *file != folder)
    }

    fn list(&self, folder: &Path) -> Box<dyn Iterator<Item = PathBuf> + '_> {
        let (shown, folder) = (folder.to_owned(), plain(folder));
        let first =
            move |file: &PathBuf| Some(file.strip_prefix(&folder).ok()?.components().next()?.as_os_str().to_owned());
        let mut names: Vec<_> = self.files.keys().filter_map(first).collect();
        names.dedup();
        Box::new(names.into_iter().map(move |name| shown.join(name)))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lead_to_files_however_they_are_written() {
        let mut files = InMemory::default();
        files.insert("scenes/a.toml", b"a".to_vec());
        files.insert("./scenes/models/b.obj", b"b".to_vec());
        for name in
            ["scenes/models/b.obj", "scenes/./models/b.obj", "/x/../scenes/models/b.obj", "../scenes/models/b.obj"]
        {
            assert_eq!(files.read(Path::new(name), 1).ok(), Some(b"b".to_vec()), "{name}");
        }
        assert!(files.read(Path::new("scenes/a.toml"), 0).is_err() && files.read(Path::new("a.toml"), 9).is_err());
        assert!(files.is_folder(Path::new("scenes/models")) && !files.is_folder(Path::new("scenes/a.toml")));
        assert!(files.is_file(Path::new("scenes/a.toml")) && !files.is_file(Path::new("scenes")));
        let listed: Vec<PathBuf> = files.list(Path::new("x/../scenes")).collect();
        assert_eq!(listed, ["x/../scenes/a.toml", "x/../scenes/models"].map(PathBuf::from));
        assert_eq!(files.list(Path::new(".")).collect::<Vec<_>>(), [PathBuf::from("./scenes")]);
    }
}
