//! Lines of words and numbers, as in driver and MTL files.

use crate::report::{Report, Source};
use std::ops::Range;

/// A word and where it stands.
#[derive(Clone, Debug)]
pub(crate) struct Word<'a> {
    pub text: &'a str,
    pub range: Range<usize>,
}

/// A line with something on it: a keyword and what follows.
#[derive(Clone, Debug)]
pub(crate) struct Line<'a> {
    pub source: &'a Source,
    pub keyword: Word<'a>,
    pub rest: Vec<Word<'a>>,
}

/// The lines of a text, without comments and blank ones.
pub(crate) fn lines(source: &Source) -> Vec<Line<'_>> {
    let text: &str = &source.text;
    let mut lines = Vec::new();
    let mut start = 0;
    for line in text.split_inclusive('\n') {
        let content = line.split('#').next().unwrap_or_default();
        let mut words = words(content, start);
        if let Some(keyword) = words.next() {
            lines.push(Line { source, keyword, rest: words.collect() });
        }
        start += line.len();
    }
    lines
}

/// The words of a piece of text that starts at byte `offset`.
pub(crate) fn words(text: &str, offset: usize) -> impl Iterator<Item = Word<'_>> {
    text.split_ascii_whitespace().map(move |word| {
        let start = offset + (word.as_ptr() as usize - text.as_ptr() as usize);
        Word { text: word, range: start..start + word.len() }
    })
}

/// A finite number as people write them: `.2`, `-0`, `1e10`, `00.65`.
pub(crate) fn number(word: &Word<'_>) -> Option<f64> {
    // Rust also reads `inf` and `nan`; a driver that says so is broken.
    word.text.parse::<f64>().ok().filter(|v| v.is_finite())
}

impl Line<'_> {
    /// The whole line, for a message.
    pub fn range(&self) -> Range<usize> {
        let end = self.rest.last().map_or(self.keyword.range.end, |w| w.range.end);
        self.keyword.range.start..end
    }

    pub fn error(&self, message: impl Into<String>) -> Report {
        Report::error(message).at(self.source, self.range())
    }

    /// All words after the keyword, as numbers.
    pub fn numbers(&self, expected: &str) -> Result<Vec<f64>, Report> {
        self.rest.iter().map(|word| self.number(word, expected)).collect()
    }

    pub fn number(&self, word: &Word<'_>, expected: &str) -> Result<f64, Report> {
        number(word).ok_or_else(|| {
            Report::error(format!("expected a number, read `{}`", word.text))
                .at(self.source, word.range.clone())
                .help(format!("this line is: {expected}"))
        })
    }

    /// Exactly `N` numbers.
    pub fn exactly<const N: usize>(&self, expected: &str) -> Result<[f64; N], Report> {
        let numbers = self.numbers(expected)?;
        let count = numbers.len();
        numbers.try_into().map_err(|_| self.count(&N.to_string(), count, expected))
    }

    /// Exactly one whole number from 0 to `most`.
    pub fn whole(&self, word: &Word<'_>, most: u32, expected: &str) -> Result<u32, Report> {
        let value = self.number(word, expected)?;
        if value.fract() == 0.0 && (0.0..=f64::from(most)).contains(&value) {
            return Ok(value as u32);
        }
        let message = format!("expected a whole number from 0 to {most}, read `{}`", word.text);
        Err(Report::error(message).at(self.source, word.range.clone()).help(format!("this line is: {expected}")))
    }

    pub fn count(&self, expected: &str, read: usize, line: &str) -> Report {
        let keyword = self.keyword.text;
        self.error(format!("`{keyword}` takes {expected} values, read {read}")).help(format!("this line is: {line}"))
    }
}
