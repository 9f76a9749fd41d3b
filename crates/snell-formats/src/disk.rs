//! Reading with a limit, writing without losing what was there.

use crate::report::{Report, Source};
use std::fs::File;
use std::io::{BufWriter, Read, Write};
use std::path::Path;

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

/// Reads a text. Bytes that are no UTF-8 (old comments in Latin-1) become `\u{fffd}`, a byte order mark is dropped.
///
/// # Errors
/// As [`read`].
pub fn read_text(path: &Path, limit: u64) -> Result<Source, Report> {
    let bytes = read(path, limit)?;
    let text = String::from_utf8_lossy(&bytes);
    Ok(Source::new(path.display().to_string(), text.strip_prefix('\u{feff}').unwrap_or(&text)))
}

/// Writes a file under a temporary name in the same folder and renames it when all is written, so that a failure or an
/// interruption leaves what was there before.
///
/// # Errors
/// When the folder does not exist, or writing fails.
pub fn write(path: &Path, content: impl FnOnce(&mut dyn Write) -> std::io::Result<()>) -> Result<(), Report> {
    let shown = path.display();
    let failed = |e: std::io::Error| Report::error(format!("cannot write `{shown}`: {e}"));
    let folder = path.parent().filter(|p| !p.as_os_str().is_empty()).unwrap_or(Path::new("."));
    if !folder.is_dir() {
        let message = format!("cannot write `{shown}`: there is no folder `{}`", folder.display());
        return Err(Report::error(message).help(format!("create it with: mkdir -p {}", folder.display())));
    }
    if path.is_dir() {
        return Err(Report::error(format!("cannot write `{shown}`: it is a folder")));
    }
    let mut builder = tempfile::Builder::new();
    builder.prefix(".snell-").suffix(".tmp");
    #[cfg(unix)]
    {
        // Like any other new file: what the umask allows, not only the owner.
        use std::os::unix::fs::PermissionsExt;
        builder.permissions(std::fs::Permissions::from_mode(0o666));
    }
    let temporary = builder.tempfile_in(folder).map_err(failed)?;
    let mut writer = BufWriter::new(&temporary);
    content(&mut writer).and_then(|()| writer.flush()).map_err(failed)?;
    drop(writer);
    temporary.persist(path).map_err(|e| failed(e.error))?;
    Ok(())
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
