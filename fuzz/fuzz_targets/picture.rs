//! Picture files: the first byte chooses the format, the rest is the file.
#![no_main]

use libfuzzer_sys::fuzz_target;
use snell_formats::picture;
use std::sync::LazyLock;

static FOLDER: LazyLock<tempfile::TempDir> = LazyLock::new(|| tempfile::tempdir().unwrap());

fuzz_target!(|data: &[u8]| {
    let Some((kind, bytes)) = data.split_first() else { return };
    let path = FOLDER.path().join(["a.png", "a.ppm", "a.exr", "a.npy"][usize::from(kind % 4)]);
    std::fs::write(&path, bytes).unwrap();
    let _ = picture::read(&path);
});
