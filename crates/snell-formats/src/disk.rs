//! Reading with a limit, writing without losing what was there.

use crate::report::{Report, Source};
use std::fs::File;
use std::io::{BufWriter, Cursor, Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;

/// The largest scene or driver text that is read, in bytes.
pub const MAX_SCENE_BYTES: u64 = 64 << 20;
/// The largest model or picture that is read, in bytes.
pub const MAX_MODEL_BYTES: u64 = 4 << 30;

/// Reads a file of at most `limit` bytes.
///
/// # Errors
/// When it cannot be opened or read, is a folder, or is larger.
pub fn read(path: &Path, limit: u64) -> Result<Vec<u8>, Report> {
    let shown = path.display();
    let failed = |e: std::io::Error| match e.kind() {
        std::io::ErrorKind::NotFound => Report::error(format!("there is no file `{shown}`")),
        _ => Report::error(format!("cannot read `{shown}`: {e}")),
    };
    let file = File::open(path).map_err(failed)?;
    let mut bytes = Vec::new();
    // The limit holds for what has no size of its own too, like a pipe.
    file.take(limit + 1).read_to_end(&mut bytes).map_err(failed)?;
    if bytes.len() as u64 > limit {
        return Err(Report::error(format!("`{shown}` is larger than {limit} bytes")));
    }
    Ok(bytes)
}

/// Reads a file of at most `limit` bytes as a [`text`].
///
/// # Errors
/// As [`read`].
pub fn read_text(path: &Path, limit: u64) -> Result<Source, Report> {
    read(path, limit).map(|bytes| text(path, &bytes))
}

/// The bytes of a file as a text. Bytes that are no UTF-8 (old comments in Latin-1) become `\u{fffd}`, a byte order mark is
/// dropped.
pub fn text(path: &Path, bytes: &[u8]) -> Source {
    let text = String::from_utf8_lossy(bytes);
    Source::new(path.display().to_string(), text.strip_prefix('\u{feff}').unwrap_or(&text))
}

/// Something to write to and to go back in.
pub trait Out: Write + Seek {}
impl<T: Write + Seek> Out for T {}

/// The temporary file that is being written, to be removed if the program has to stop at once.
static PENDING: Mutex<Option<PathBuf>> = Mutex::new(None);

/// Removes the file that is half written, if there is one: for a program that stops at once.
pub fn discard_pending() {
    if let Ok(mut pending) = PENDING.lock()
        && let Some(path) = pending.take()
    {
        // There is nobody left to tell.
        let _ = std::fs::remove_file(path);
    }
}

/// Where a file really goes, and whether it can: before hours of work are spent on what is in it.
///
/// # Errors
/// When the folder does not exist or cannot be written to, or the file is a folder or read-only.
pub fn check_writable(path: &Path) -> Result<(), Report> {
    let (target, folder) = target(path)?;
    if is_device(&target) {
        return Ok(());
    }
    tempfile::Builder::new().prefix(PREFIX).tempfile_in(folder).map(drop).map_err(|e| write_error(path, &e))
}

const PREFIX: &str = ".snell-";

fn write_error(path: &Path, e: &std::io::Error) -> Report {
    Report::error(format!("cannot write `{}`: {e}", path.display()))
}

/// A pipe or a device: written to, not replaced.
fn is_device(path: &Path) -> bool {
    path.metadata().is_ok_and(|m| !m.is_file() && !m.is_dir())
}

/// The file behind a link, and its folder.
fn target(path: &Path) -> Result<(PathBuf, PathBuf), Report> {
    let shown = path.display();
    let target =
        if path.is_symlink() { path.canonicalize().unwrap_or_else(|_| path.to_owned()) } else { path.to_owned() };
    let folder = target.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new(".")).to_owned();
    if !folder.is_dir() {
        let message = format!("cannot write `{shown}`: there is no folder `{}`", folder.display());
        return Err(Report::error(message).help(format!("create it with: mkdir -p {}", folder.display())));
    }
    match target.metadata() {
        Ok(m) if m.is_dir() => Err(Report::error(format!("cannot write `{shown}`: it is a folder"))),
        Ok(m) if m.permissions().readonly() => {
            Err(Report::error(format!("cannot write `{shown}`: it is read-only")).help("choose another name"))
        }
        _ => Ok((target, folder)),
    }
}

/// Writes a file under a temporary name in the same folder and renames it when all is written, so that a failure or an
/// interruption leaves what was there before.
///
/// # Errors
/// As [`check_writable`], or when writing fails.
pub fn write(path: &Path, content: impl FnOnce(&mut dyn Out) -> std::io::Result<()>) -> Result<(), Report> {
    let (target, folder) = target(path)?;
    let failed = |e: std::io::Error| write_error(path, &e);
    if is_device(&target) {
        // What cannot be renamed over cannot be gone back in either.
        let mut bytes = Cursor::new(Vec::new());
        content(&mut bytes).map_err(failed)?;
        return File::create(&target).and_then(|mut file| file.write_all(bytes.get_ref())).map_err(failed);
    }
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).suffix(".tmp");
    #[cfg(unix)]
    {
        // Like any other new file: what the umask allows, not only the owner; like the old one, if there is one.
        use std::os::unix::fs::PermissionsExt;
        let old = target.metadata().map(|m| m.permissions());
        builder.permissions(old.unwrap_or_else(|_| std::fs::Permissions::from_mode(0o666)));
    }
    let temporary = builder.tempfile_in(folder).map_err(failed)?;
    let note = |path: Option<PathBuf>| PENDING.lock().map(|mut pending| *pending = path);
    let _ = note(Some(temporary.path().to_owned()));
    let mut writer = BufWriter::new(&temporary);
    content(&mut writer).and_then(|()| writer.flush()).map_err(failed)?;
    drop(writer);
    let written = temporary.persist(&target).map(drop).map_err(|e| failed(e.error));
    let _ = note(None);
    written
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
    fn a_failed_write_leaves_the_old_file_and_no_litter() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("kept.txt");
        write(&path, |w| w.write_all(b"old")).unwrap();
        write(&path, |w| {
            w.write_all(b"new, but")?;
            Err(std::io::Error::other("the disk is full"))
        })
        .unwrap_err();
        assert_eq!(std::fs::read(&path).unwrap(), b"old");
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 1);
        let error = write(&folder.path().join("no/such/x"), |_| Ok(())).unwrap_err();
        assert!(error.help.unwrap().contains("mkdir"));
    }

    #[cfg(unix)]
    #[test]
    fn links_are_followed_and_read_only_files_kept() {
        let folder = tempfile::tempdir().unwrap();
        let (real, link) = (folder.path().join("real"), folder.path().join("link"));
        std::fs::write(&real, b"old").unwrap();
        std::os::unix::fs::symlink(&real, &link).unwrap();
        write(&link, |w| w.write_all(b"new")).unwrap();
        assert!(link.is_symlink() && std::fs::read(&real).unwrap() == b"new");
        let mut permissions = real.metadata().unwrap().permissions();
        permissions.set_readonly(true);
        std::fs::set_permissions(&real, permissions).unwrap();
        assert!(check_writable(&link).unwrap_err().message.contains("read-only"));
        assert!(write(&link, |w| w.write_all(b"newer")).is_err());
    }

    #[test]
    fn the_limit_holds() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("big");
        std::fs::write(&path, [0; 11]).unwrap();
        assert!(read(&path, 10).is_err());
        assert_eq!(read(&path, 11).unwrap().len(), 11);
    }

    #[test]
    fn sha256_of_the_empty_text_is_the_published_one() {
        assert!(sha256([b""]).starts_with("e3b0c44298fc1c149afbf4c8996fb924"));
    }
}
