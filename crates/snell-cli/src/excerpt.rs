//! The lines around the place of a report, cut to a width that a person can read.

use crate::say::help;
use miette::{
    Diagnostic, LabeledSpan, MietteError, MietteSpanContents, Severity, SourceCode, SourceSpan, SpanContents,
};
use snell::scene::is_unprintable;
use snell_formats::Report;
use std::fmt;

/// Characters of a long line that are shown on each side of the place.
const AROUND: usize = 60;

/// A report, with only as much of its source as is shown.
#[derive(Debug)]
pub struct Excerpt<'a> {
    report: &'a Report,
    lines: Option<Lines>,
}

#[derive(Debug)]
struct Lines {
    name: String,
    text: String,
    /// Number of the first line, from 0.
    first: usize,
    /// Line and column of the place in the file, from 0.
    place: (usize, usize),
    /// The place in `text`.
    start: usize,
    length: usize,
}

impl<'a> Excerpt<'a> {
    pub fn of(report: &'a Report) -> Self {
        let lines = report.place.as_ref().map(|(source, range)| {
            let (line, column) = source.line_column(range.start);
            let start = source.text[..range.start].rfind('\n').map_or(0, |i| i + 1);
            let end = source.text[start..].find('\n').map_or(source.text.len(), |i| start + i);
            let before = &source.text[start..range.start];
            let inside = &source.text[range.start..range.end.min(end)];
            let after = &source.text[range.start + inside.len()..end];
            let cut = |text: &str| text.chars().count() > AROUND;
            let head: String = if cut(before) {
                "…".chars().chain(before.chars().skip(before.chars().count() - AROUND)).collect()
            } else {
                before.to_owned()
            };
            let tail = |text: &str| {
                if cut(text) { text.chars().take(AROUND).chain("…".chars()).collect() } else { text.to_owned() }
            };
            let (head, inside, after) = (plain(&head), plain(&tail(inside)), plain(&tail(after)));
            // A neighbour on each side gives the eye a hold, if it is short.
            let previous = source.text[..start].lines().next_back().filter(|l| !cut(l)).map(|l| plain(l) + "\n");
            let next = source.text[end..].lines().nth(1).filter(|l| !cut(l)).map(|l| format!("\n{}", plain(l)));
            let first = line - 1 - usize::from(previous.is_some());
            let previous = previous.unwrap_or_default();
            Lines {
                name: plain(&source.name),
                first,
                place: (line - 1, column - 1),
                start: previous.len() + head.len(),
                length: inside.len(),
                text: previous + &head + &inside + &after + &next.unwrap_or_default(),
            }
        });
        Self { report, lines }
    }
}

/// Text from a file without the characters that would steer a terminal.
pub fn plain(text: &str) -> String {
    text.chars().map(|c| if is_unprintable(c) && c != '\n' && c != '\t' { '\u{fffd}' } else { c }).collect()
}

impl SourceCode for Lines {
    fn read_span<'a>(
        &'a self,
        span: &SourceSpan,
        before: usize,
        after: usize,
    ) -> Result<Box<dyn SpanContents<'a> + 'a>, MietteError> {
        // Without context the place is asked for, to be named; with it the lines, to be shown.
        let (line, column) = if before + after == 0 { self.place } else { (self.first, 0) };
        let span = if before + after == 0 { *span } else { SourceSpan::from((0, self.text.len())) };
        let text = &self.text.as_bytes()[span.offset()..span.offset() + span.len()];
        Ok(Box::new(MietteSpanContents::new_named(self.name.clone(), text, span, line, column, 3)))
    }
}

impl fmt::Display for Excerpt<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&plain(&self.report.to_string()))
    }
}

impl std::error::Error for Excerpt<'_> {}

impl Diagnostic for Excerpt<'_> {
    fn severity(&self) -> Option<Severity> {
        Some(if self.report.warning.is_some() { Severity::Warning } else { Severity::Error })
    }
    fn help<'a>(&'a self) -> Option<Box<dyn fmt::Display + 'a>> {
        help(self.report).map(|help| Box::new(plain(&help)) as Box<dyn fmt::Display>)
    }
    fn source_code(&self) -> Option<&dyn SourceCode> {
        self.lines.as_ref().map(|lines| lines as &dyn SourceCode)
    }
    fn labels(&self) -> Option<Box<dyn Iterator<Item = LabeledSpan> + '_>> {
        let lines = self.lines.as_ref()?;
        Some(Box::new(std::iter::once(LabeledSpan::underline(lines.start..lines.start + lines.length))))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use snell_formats::Source;

    #[test]
    fn a_long_line_is_cut_around_the_place() {
        let text = format!("a\n{}BAD{}\nb\n", "x".repeat(70_000), "\u{1b}y".repeat(70_000));
        let source = Source::new("long", text);
        let report = Report::error("bad").at(&source, 70_002..70_005);
        let lines = Excerpt::of(&report).lines.unwrap();
        assert_eq!((lines.first, lines.place), (0, (1, 70_000)));
        assert!(lines.text.len() < 400 && !lines.text.contains('\u{1b}'), "{}", lines.text);
        assert_eq!(&lines.text[lines.start..lines.start + lines.length], "BAD");
    }
}
