//! Where files come from: a disk (the feature `disk`), or memory, as in a browser.

#[cfg(feature = "disk")]
pub mod disk;
mod in_memory;
#[cfg(feature = "disk")]
mod recorder;

#[cfg(feature = "disk")]
pub use disk::Disk;
pub use in_memory::InMemory;
#[cfg(feature = "disk")]
pub use recorder::{Named, Recorder};

use crate::report::Report;
use std::fmt::Debug;
use std::io::{Cursor, Seek, Write};
use std::path::{Path, PathBuf};

/// The largest scene or driver text that is read, in bytes.
pub const MAX_SCENE_BYTES: u64 = 64 << 20;
/// The largest model or picture that is read, in bytes.
pub const MAX_MODEL_BYTES: u64 = 4 << 30;

/// Files that a scene may name.
pub trait Files: Debug + Send + Sync {
    /// The bytes of a file, at most `limit`.
    ///
    /// # Errors
    /// When it cannot be read, is a folder, or is larger.
    fn read(&self, path: &Path, limit: u64) -> Result<Vec<u8>, Report>;

    /// Is there a file of this name?
    fn is_file(&self, path: &Path) -> bool;

    /// Is there a folder of this name?
    fn is_folder(&self, path: &Path) -> bool;

    /// What lies in a folder, in any order; nothing if there is no such folder.
    fn list(&self, folder: &Path) -> Box<dyn Iterator<Item = PathBuf> + '_>;
}

fn missing(path: &Path) -> Report {
    Report::error(format!("there is no file `{}`", path.display()))
}

fn too_large(path: &Path, limit: u64) -> Report {
    Report::error(format!("`{}` is larger than {limit} bytes", path.display()))
}

/// Something to write to and to go back in.
pub trait Out: Write + Seek {}
impl<T: Write + Seek> Out for T {}

/// What would be written, in memory.
///
/// # Errors
/// When writing fails.
pub fn in_memory(content: impl FnOnce(&mut dyn Out) -> std::io::Result<()>) -> std::io::Result<Vec<u8>> {
    let mut bytes = Cursor::new(Vec::new());
    content(&mut bytes)?;
    Ok(bytes.into_inner())
}

/// SHA-256 of some bytes, in hexadecimal.
pub fn sha256(bytes: impl IntoIterator<Item = impl AsRef<[u8]>>) -> String {
    use sha2::Digest;
    let mut hash = sha2::Sha256::new();
    for part in bytes {
        hash.update(part.as_ref());
    }
    hash.finalize().iter().fold(String::new(), |text, byte| text + &format!("{byte:02x}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sha256_of_the_empty_text_is_the_published_one() {
        assert!(sha256([b""]).starts_with("e3b0c44298fc1c149afbf4c8996fb924"));
    }
}
