//! Running the `snell` command as a person would.

#![allow(dead_code, reason = "every test file uses some of it")]

use std::path::Path;
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
