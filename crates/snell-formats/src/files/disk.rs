//! Reading with a limit, writing without losing what was there.

use super::{Files, Out, in_memory, missing, too_large};
use crate::report::Report;
use std::fs::{File, Permissions};
use std::io::{BufWriter, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::Mutex;
use std::sync::atomic::{AtomicBool, Ordering};
use tempfile::NamedTempFile;

/// The files of this machine.
#[derive(Clone, Copy, Debug, Default)]
pub struct Disk;

impl Files for Disk {
    fn read(&self, path: &Path, limit: u64) -> Result<Vec<u8>, Report> {
        let failed = |e: std::io::Error| match e.kind() {
            std::io::ErrorKind::NotFound => missing(path),
            _ => Report::error(format!("cannot read `{}`: {e}", path.display())),
        };
        let file = File::open(path).map_err(failed)?;
        let mut bytes = Vec::new();
        // The limit holds for what has no size of its own too, like a pipe.
        file.take(limit + 1).read_to_end(&mut bytes).map_err(failed)?;
        if bytes.len() as u64 > limit { Err(too_large(path, limit)) } else { Ok(bytes) }
    }

    fn is_file(&self, path: &Path) -> bool {
        path.is_file()
    }

    fn is_folder(&self, path: &Path) -> bool {
        path.is_dir()
    }

    fn list(&self, folder: &Path) -> Box<dyn Iterator<Item = PathBuf> + '_> {
        Box::new(std::fs::read_dir(folder).into_iter().flatten().flatten().map(|entry| entry.path()))
    }
}

/// Are these two names of one file? Links are followed, and where the disk does not tell `A` from `a`, neither does this.
pub fn is_same_file(a: &Path, b: &Path) -> bool {
    #[cfg(unix)]
    {
        use std::os::unix::fs::MetadataExt;
        let identity = |path: &Path| path.metadata().map(|m| (m.dev(), m.ino()));
        matches!((identity(a), identity(b)), (Ok(a), Ok(b)) if a == b)
    }
    #[cfg(not(unix))]
    {
        matches!((a.canonicalize(), b.canonicalize()), (Ok(a), Ok(b)) if a == b)
    }
}

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
    temporary(&folder, None).map(drop).map_err(|e| write_error(path, &e))
}

/// Names of temporary files.
const PREFIX: &str = ".snell-writing-";
const SUFFIX: &str = ".tmp";
/// Letters and digits between them.
const RANDOM: usize = 16;

/// A temporary file in a folder, which is locked as long as it is open; what a program left there that was killed is removed.
fn temporary(folder: &Path, permissions: Option<Permissions>) -> std::io::Result<NamedTempFile> {
    remove_abandoned(folder);
    let mut builder = tempfile::Builder::new();
    builder.prefix(PREFIX).suffix(SUFFIX).rand_bytes(RANDOM);
    if let Some(permissions) = permissions {
        builder.permissions(permissions);
    }
    for _ in 0..MOST_TRIES {
        let file = builder.tempfile_in(folder)?;
        // Disks that know no locks have no abandoned files removed either.
        let _ = file.as_file().lock();
        // Between its making and its lock another program may have taken it for an abandoned one.
        if file.path().exists() {
            return Ok(file);
        }
    }
    Err(std::io::Error::other("temporary files vanish"))
}

const MOST_TRIES: u32 = 100;

/// Removes temporary files whose program is gone, which left them without a lock; once for each folder.
fn remove_abandoned(folder: &Path) {
    static LOOKED_AT: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());
    let Ok(mut looked_at) = LOOKED_AT.lock() else { return };
    if looked_at.iter().any(|other| other == folder) {
        return;
    }
    looked_at.push(folder.to_owned());
    let Ok(entries) = std::fs::read_dir(folder) else { return };
    for entry in entries.flatten() {
        let name = entry.file_name();
        let random = name.to_str().and_then(|name| name.strip_prefix(PREFIX)?.strip_suffix(SUFFIX));
        if random.is_some_and(|r| r.len() == RANDOM && r.bytes().all(|b| b.is_ascii_alphanumeric()))
            && entry.file_type().is_ok_and(|kind| kind.is_file())
            && let Ok(file) = File::options().write(true).open(entry.path())
            && file.try_lock().is_ok()
        {
            // Somebody else may have removed it, or may have to.
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

fn write_error(path: &Path, e: &std::io::Error) -> Report {
    Report::error(format!("cannot write `{}`: {e}", path.display()))
}

/// A pipe or a device: written to, not replaced.
fn is_device(path: &Path) -> bool {
    path.metadata().is_ok_and(|m| !m.is_file() && !m.is_dir())
}

/// What a path names, also where links lead to a file that is not there yet.
pub fn behind_links(path: &Path) -> PathBuf {
    let mut target = path.to_owned();
    // As many as Linux follows.
    for _ in 0..40 {
        let Ok(next) = target.read_link() else { break };
        target = target.parent().unwrap_or(Path::new("")).join(next);
    }
    target
}

/// The file behind a link, and its folder.
fn target(path: &Path) -> Result<(PathBuf, PathBuf), Report> {
    let shown = path.display();
    let target = behind_links(path);
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

/// Is a pipe or a device being written to, which may take for ever?
static WAITING: AtomicBool = AtomicBool::new(false);

/// Is somebody waited for who may never come, like the reader of a pipe?
pub fn is_waiting() -> bool {
    WAITING.load(Ordering::Relaxed)
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
        let bytes = in_memory(content).map_err(failed)?;
        WAITING.store(true, Ordering::Relaxed);
        // A pipe without a reader is waited for here.
        let written =
            File::options().write(true).open(&target).and_then(|mut file| file.write_all(&bytes)).map_err(failed);
        WAITING.store(false, Ordering::Relaxed);
        return written;
    }
    // Like any other new file: what the umask allows, not only the owner; like the old one, if there is one.
    #[cfg(unix)]
    let permissions = {
        use std::os::unix::fs::PermissionsExt;
        Some(target.metadata().map_or_else(|_| Permissions::from_mode(0o666), |m| m.permissions()))
    };
    #[cfg(not(unix))]
    let permissions = None;
    let temporary = temporary(&folder, permissions).map_err(failed)?;
    let note = |path: Option<PathBuf>| PENDING.lock().map(|mut pending| *pending = path);
    let _ = note(Some(temporary.path().to_owned()));
    let mut writer = BufWriter::new(&temporary);
    content(&mut writer).and_then(|()| writer.flush()).map_err(failed)?;
    drop(writer);
    let written = temporary.persist(&target).map(drop).map_err(|e| failed(e.error));
    let _ = note(None);
    written
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
        let (later, early) = (folder.path().join("later"), folder.path().join("early"));
        std::os::unix::fs::symlink("later", &early).unwrap();
        write(&early, |w| w.write_all(b"new")).unwrap();
        assert!(early.is_symlink() && std::fs::read(&later).unwrap() == b"new");
        let mut permissions = real.metadata().unwrap().permissions();
        permissions.set_readonly(true);
        std::fs::set_permissions(&real, permissions).unwrap();
        assert!(check_writable(&link).unwrap_err().message.contains("read-only"));
        assert!(write(&link, |w| w.write_all(b"newer")).is_err());
    }

    #[test]
    fn what_a_killed_program_left_is_removed_and_nothing_else() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        // Left behind; in use; a person's own.
        std::fs::write(at(".snell-writing-Ab3xYzAb3xYz0123.tmp"), b"half a picture").unwrap();
        let mut builder = tempfile::Builder::new();
        let used = builder.prefix(PREFIX).suffix(SUFFIX).rand_bytes(RANDOM).tempfile_in(folder.path()).unwrap();
        used.as_file().lock().unwrap();
        for name in
            [".snell-backup.tmp", ".snell-writing-notes.tmp", ".snell-writing-Ab3xYzAb3xYz012!.tmp", ".snell-writing-"]
        {
            std::fs::write(at(name), b"mine").unwrap();
        }
        write(&at("new.txt"), |w| w.write_all(b"new")).unwrap();
        assert!(!at(".snell-writing-Ab3xYzAb3xYz0123.tmp").exists());
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), 6);
        assert!(used.path().exists());
    }

    #[cfg(unix)]
    #[test]
    fn links_are_other_names_of_one_file() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        std::fs::write(at("a"), b"").unwrap();
        std::fs::write(at("b"), b"").unwrap();
        std::fs::hard_link(at("a"), at("hard")).unwrap();
        std::os::unix::fs::symlink(at("a"), at("soft")).unwrap();
        std::os::unix::fs::symlink(at("none"), at("dangling")).unwrap();
        for (name, same) in
            [("a", true), ("hard", true), ("soft", true), ("b", false), ("none", false), ("dangling", false)]
        {
            assert_eq!(is_same_file(&at("a"), &at(name)), same, "{name}");
        }
        assert!(!is_same_file(&at("none"), &at("none")), "what is not there is nobody's input");
    }

    #[test]
    fn the_limit_holds() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("big");
        std::fs::write(&path, [0; 11]).unwrap();
        assert!(Disk.read(&path, 10).is_err());
        assert_eq!(Disk.read(&path, 11).unwrap().len(), 11);
    }
}
