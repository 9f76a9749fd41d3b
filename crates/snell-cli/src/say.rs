//! Talking to people: results on stdout, everything else on stderr.

use crate::excerpt::{Excerpt, plain};
use miette::{GraphicalReportHandler, GraphicalTheme, ThemeCharacters, ThemeStyles};
use snell_formats::Report;
use std::io::{IsTerminal, Write};

/// Exit code: the command did what it should and found a difference, or failed on the way.
pub const FAILED: u8 = 1;
/// Exit code: the command was called in a wrong way.
pub const USAGE: u8 = 2;
/// Exit code: the scene cannot be drawn.
pub const SCENE: u8 = 3;
/// Exit code: stopped by ^C.
pub const INTERRUPTED: u8 = 130;

/// Why a command ends without success.
#[derive(Debug)]
pub struct Failure {
    pub code: u8,
    /// What to say about it; empty if all is said.
    pub reports: Vec<Report>,
}

impl Failure {
    pub fn new(code: u8, report: Report) -> Self {
        Self { code, reports: vec![report] }
    }
}

pub type Outcome = Result<(), Failure>;

/// Gives a report an exit code.
pub trait OrFail<T> {
    fn or_fail(self, code: u8) -> Result<T, Failure>;
}

impl<T> OrFail<T> for Result<T, Report> {
    fn or_fail(self, code: u8) -> Result<T, Failure> {
        self.map_err(|report| Failure::new(code, report))
    }
}

impl<T> OrFail<T> for Result<T, Vec<Report>> {
    fn or_fail(self, code: u8) -> Result<T, Failure> {
        self.map_err(|reports| Failure { code, reports })
    }
}

/// May what is written there be coloured? `NO_COLOR` says no (no-color.org).
pub fn colored(stream: &impl IsTerminal) -> bool {
    stream.is_terminal() && std::env::var_os("NO_COLOR").is_none_or(|v| v.is_empty())
}

/// More reports of one kind than this are counted, not shown.
pub const SHOWN: usize = 20;

/// Writes reports to stderr, the first ones in full.
pub fn reports(reports: &[Report]) {
    for shown in &reports[..reports.len().min(SHOWN)] {
        report(shown);
    }
    more(reports.len());
}

/// Says how many were not shown.
pub fn more(count: usize) {
    if count > SHOWN {
        eprintln!("… and {} more like these", count - SHOWN);
    }
}

/// Writes a report with its place in the source to stderr.
pub fn report(report: &Report) {
    let styles = if colored(&std::io::stderr()) { ThemeStyles::ansi() } else { ThemeStyles::none() };
    let characters =
        ThemeCharacters { error: "error:".to_owned(), warning: "warning:".to_owned(), ..ThemeCharacters::unicode() };
    let handler = GraphicalReportHandler::new_themed(GraphicalTheme { characters, styles }).with_width(100);
    let mut text = String::new();
    if handler.render_report(&mut text, &Excerpt::of(report)).is_err() {
        text = plain(&report.to_string());
    }
    eprintln!("{}", text.trim());
}

/// Writes text to stdout. A reader that has gone away (`| head`) is no error.
#[expect(clippy::unnecessary_wraps, reason = "the last step of a command")]
pub fn print(text: &str) -> Outcome {
    let mut out = std::io::stdout().lock();
    let _ = out.write_all(text.as_bytes()).and_then(|()| out.flush());
    Ok(())
}
