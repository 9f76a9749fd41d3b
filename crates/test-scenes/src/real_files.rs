//! Files of other people's making, which are tested with but are not part of the project.

use std::io::Write;
use std::path::{Path, PathBuf};

/// Models, drivers and pictures: `SNELL_DATA`, or `shared/data` beside the clone.
pub fn data() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    present(&std::env::var_os("SNELL_DATA").map_or(beside, PathBuf::from))
}

/// Small inputs that went wrong once, in `shared/cases` beside the clone.
pub fn cases() -> Option<PathBuf> {
    present(&Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/cases"))
}

fn present(folder: &Path) -> Option<PathBuf> {
    if folder.is_dir() {
        return folder.canonicalize().ok();
    }
    // Not by `eprintln!`, which the test harness hides where a test passes.
    let line = format!("SKIPPED: the real files are not there ({}); set SNELL_DATA\n", folder.display());
    std::io::stderr().write_all(line.as_bytes()).unwrap();
    None
}
