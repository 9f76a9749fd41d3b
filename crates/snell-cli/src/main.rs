//! The `snell` command: a thin face on the library. It holds no physics.
//!
//! ```text
//!  arguments ── args ─▶ a verb: render, explain, diff, convert, check, studio, … ── output ─▶ a file, or standard output
//!                           ▲      │                                              │
//!  a scene, a picture ── input     ├─▶ progress: how far it is, on stderr         └─▶ say: reports on stderr, exit codes
//!  that remembers one, ── recipe   └─▶ signals: ^C and SIGTERM, which leave a picture that is whole
//!  or standard input
//! ```
//!
//! ```sh
//! snell render lecture/default -o a.png   # makes a picture, which remembers how it was made
//! snell explain a.png 256,256             # why a pixel of it has its colour
//! ```

mod args;
mod check;
mod claim;
mod convert;
mod diff;
mod excerpt;
mod explain;
mod info;
mod input;
mod kept;
mod machine;
mod many;
mod merge;
mod output;
mod paths;
mod progress;
mod ready;
mod recipe;
mod render;
mod say;
mod scenes;
mod signals;
mod solid_text;
mod studio;

use args::{Arguments, Command};
use clap::error::ErrorKind;
use clap::{CommandFactory, Parser};
use excerpt::plain;
use say::{Failure, Outcome, USAGE};
use snell_formats::Report;
use std::process::ExitCode;

fn main() -> ExitCode {
    signals::end_with_an_error_instead_of_abort();
    let result = match Arguments::try_parse() {
        Ok(arguments) => run(arguments.command),
        Err(answer) => answer_with(&answer),
    };
    match result {
        Ok(()) => ExitCode::SUCCESS,
        Err(Failure { code, reports }) => {
            say::reports(&reports);
            ExitCode::from(code)
        }
    }
}

/// Help and version, or what is wrong with what was typed.
fn answer_with(answer: &clap::Error) -> Outcome {
    if answer.kind() == ErrorKind::InvalidUtf8
        && let Some(odd) = std::env::args_os().find(|argument| argument.to_str().is_none())
    {
        let report = Report::error(format!("`{}` is no UTF-8 text", odd.to_string_lossy()));
        let help = "rename the file, or go into its folder and use a name without such bytes";
        return Err(Failure::new(USAGE, report.help(help)));
    }
    // What was typed stands in the answer as it is, and may steer a terminal: it is asked again without that.
    let typed = std::env::args_os().map(|argument| plain(&argument.to_string_lossy()));
    let again = Arguments::try_parse_from(typed).err().filter(|again| again.kind() == answer.kind());
    let text = again.as_ref().unwrap_or(answer).render();
    let styled = |stream: &dyn Fn() -> bool| if stream() { text.ansi().to_string() } else { text.to_string() };
    if answer.use_stderr() {
        say::tell_styled(styled(&|| say::colored(&std::io::stderr())).trim_end());
        return Err(Failure { code: USAGE, reports: Vec::new() });
    }
    say::print(&styled(&|| say::colored(&std::io::stdout())))
}

fn run(command: Command) -> Outcome {
    match command {
        Command::Render(args) => render::run(&args),
        Command::Explain(args) => explain::run(&args),
        Command::Info(args) => info::run(&args),
        Command::Scenes(args) => scenes::run(&args),
        Command::Studio(args) => studio::run(&args),
        Command::Convert(args) => convert::run(&args),
        Command::Diff(args) => diff::run(&args),
        Command::Merge(args) => merge::run(&args),
        Command::Check(args) => check::run(&args),
        Command::Schema { form } => say::print(&form.schema()),
        Command::Completions { shell } => {
            let mut script = Vec::new();
            clap_complete::generate(shell, &mut Arguments::command(), "snell", &mut script);
            say::print(&String::from_utf8_lossy(&script))
        }
    }
}
