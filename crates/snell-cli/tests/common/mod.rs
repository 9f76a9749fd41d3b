//! Running the `snell` command as a person would.

#![allow(dead_code, reason = "every test file uses some of it")]

use std::io::Write;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

pub fn snell(folder: &Path, arguments: &[&str]) -> Output {
    command(folder, arguments).output().unwrap()
}

pub fn command(folder: &Path, arguments: &[&str]) -> Command {
    let mut command = Command::new(env!("CARGO_BIN_EXE_snell"));
    command.current_dir(folder).args(arguments).env_remove("RUST_BACKTRACE").env_remove("SNELL_LANES");
    command
}

pub fn stderr(output: &Output) -> String {
    String::from_utf8_lossy(&output.stderr).into_owned()
}

pub fn stdout(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

/// Runs a command that must end with 0.
pub fn run(folder: &Path, arguments: &[&str]) -> Output {
    let output = snell(folder, arguments);
    assert!(output.status.success(), "snell {}\n{}", arguments.join(" "), stderr(&output));
    output
}

/// The real files that are tested with but not part of the project: `SNELL_DATA`, or `shared/data` beside the clone.
pub fn data() -> Option<PathBuf> {
    let beside = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared/data");
    let folder = std::env::var_os("SNELL_DATA").map_or(beside, PathBuf::from);
    if folder.is_dir() {
        return folder.canonicalize().ok();
    }
    // Not by `eprintln!`, which the test harness hides where a test passes.
    let line = format!("SKIPPED: the real files are not there ({}); set SNELL_DATA\n", folder.display());
    std::io::stderr().write_all(line.as_bytes()).unwrap();
    None
}
