//! The `snell` command: a thin face on the library. It holds no physics.

#![allow(clippy::print_stdout, clippy::print_stderr, reason = "this is the program that talks to people")]

mod args;
mod check;
mod convert;
mod diff;
mod excerpt;
mod explain;
mod info;
mod paths;
mod progress;
mod recipe;
mod render;
mod say;
mod scenes;
mod solid_text;

use args::{Arguments, Command};
use clap::{CommandFactory, Parser};
use say::Failure;
use std::process::ExitCode;

fn main() -> ExitCode {
    let arguments = Arguments::parse();
    let result = match arguments.command {
        Command::Render(args) => render::run(&args),
        Command::Explain(args) => explain::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Scenes(args) => scenes::run(&args),
        Command::Convert(args) => convert::run(&args),
        Command::Diff(args) => diff::run(&args),
        Command::Check(args) => check::run(&args),
        Command::Schema => say::print(&snell_formats::scene_file::schema()),
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(shell, &mut Arguments::command(), "snell", &mut script);
            say::print(&String::from_utf8_lossy(&script))
        }
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure { code, reports }) => {
            say::reports(&reports);
            ExitCode::from(code)
        }
    }
}
