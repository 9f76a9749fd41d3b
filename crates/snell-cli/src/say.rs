//! Talking to people: results on stdout, everything else on stderr.

use crate::excerpt::{Excerpt, plain};
use miette::{GraphicalReportHandler, GraphicalTheme, ThemeCharacters, ThemeStyles};
use snell::scene::{self, WarningCode};
use snell_formats::Report;
use snell_formats::report::Remedy;
use std::io::{ErrorKind, IsTerminal, Write};

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

/// More warnings of one kind than this are counted, not shown.
const SHOWN: usize = 3;
/// The same of errors.
const SHOWN_ERRORS: usize = 20;

/// The reports that are shown, and a line for each kind of which more were found. Errors come last, where people look.
pub fn shown(reports: &[Report]) -> (Vec<&Report>, Vec<String>, Vec<&Report>) {
    let mut kinds: Vec<(WarningCode, usize)> = Vec::new();
    let mut warnings = Vec::new();
    for report in reports {
        let Some(code) = report.warning else { continue };
        let kind = kinds.iter().position(|(known, _)| *known == code).unwrap_or(kinds.len());
        if kind == kinds.len() {
            kinds.push((code, 0));
        }
        kinds[kind].1 += 1;
        if kinds[kind].1 <= SHOWN {
            warnings.push(report);
        }
    }
    let more = |&(code, count): &(WarningCode, usize)| {
        (count > SHOWN).then(|| format!("… and {} more of {}", count - SHOWN, code.code()))
    };
    let mut lines: Vec<String> = kinds.iter().filter_map(more).collect();
    let mut errors: Vec<&Report> = reports.iter().filter(|report| report.warning.is_none()).collect();
    if errors.len() > SHOWN_ERRORS {
        lines.push(format!("… and {} more errors", errors.len() - SHOWN_ERRORS));
        errors.truncate(SHOWN_ERRORS);
    }
    (warnings, lines, errors)
}

/// What to do about a report: in the file, and with this command.
pub fn help(report: &Report) -> Option<String> {
    let here = report.remedy.as_ref().map(|remedy| match remedy {
        Remedy::Scene(scene::Remedy::CheckMesh) => {
            "`snell check` shows what is wrong with a model and can repair it".to_owned()
        }
        Remedy::Scene(scene::Remedy::RepairMesh) => "`snell check --repair` turns the faces of a model".to_owned(),
        Remedy::ListScenes => "`snell scenes` lists the built-in ones".to_owned(),
        Remedy::NameFolder => "name another folder with --search DIR".to_owned(),
        Remedy::NameDialect => "say which year it is of with --dialect".to_owned(),
        Remedy::CheckModel(file) => format!("`snell check {file}` says whether it is a solid"),
        Remedy::MakeAgain(file) => {
            format!("if Snell made it, `snell info {file}` says how, and `snell render --from {file}` makes it again")
        }
    });
    match (&report.help, here) {
        // Questions end with their own mark.
        (Some(help), Some(here)) if help.ends_with('?') => Some(format!("{help} {here}")),
        (Some(help), Some(here)) => Some(format!("{help}; {here}")),
        (help, here) => help.clone().or(here),
    }
}

/// What this command adds to a warning of a picture.
pub fn advice(warning: WarningCode) -> &'static str {
    if warning == WarningCode::StrayExit { " `snell check` shows where" } else { "" }
}

/// Writes reports to stderr.
pub fn reports(reports: &[Report]) {
    let (warnings, more, errors) = shown(reports);
    warnings.into_iter().for_each(report);
    for line in &more {
        tell(line);
    }
    errors.into_iter().for_each(report);
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
    tell_styled(text.trim());
}

/// Writes a line to stderr, without characters that steer a terminal.
pub fn tell(line: &str) {
    tell_styled(&plain(line));
}

/// The same with our own colours in it. Where nothing can be written, nobody is told, and the work goes on.
pub fn tell_styled(line: &str) {
    let _ = writeln!(std::io::stderr().lock(), "{line}");
}

/// Writes text to stdout. A reader that has gone away (`| head`) is no error.
pub fn print(text: &str) -> Outcome {
    print_bytes(text.as_bytes())
}

/// Writes bytes to stdout. A reader that has gone away is no error.
pub fn print_bytes(bytes: &[u8]) -> Outcome {
    let mut out = std::io::stdout().lock();
    match out.write_all(bytes).and_then(|()| out.flush()) {
        Err(e) if e.kind() != ErrorKind::BrokenPipe => {
            Err(Failure::new(FAILED, Report::error(format!("cannot write to standard output: {e}"))))
        }
        _ => Ok(()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use snell::scene::WarningCode;

    #[test]
    fn the_error_is_shown_after_any_number_of_warnings() {
        let warning = |i: usize| Report::warning(WarningCode::ALL[i % 2], format!("warning {i}"));
        let mut reports: Vec<Report> = (0..50).map(warning).collect();
        reports.insert(17, Report::error("the error"));
        let (warnings, more, errors) = shown(&reports);
        assert_eq!((warnings.len(), errors.len()), (6, 1));
        assert_eq!(errors[0].message, "the error");
        assert!(more.len() == 2 && more[0].contains("22 more of W001"), "{more:?}");
    }
}
