//! Errors and warnings with a place in a file.

use snell::scene::{self, Problem, WarningCode};
use std::fmt;
use std::ops::Range;
use std::sync::Arc;

/// A text and where it comes from.
#[derive(Clone, Debug)]
pub struct Source {
    /// File name, for messages.
    pub name: Arc<str>,
    /// The whole text.
    pub text: Arc<str>,
}

impl Source {
    /// A text with a name. Lines end with LF from here on, whatever they ended with.
    pub fn new(name: impl Into<Arc<str>>, text: impl Into<Arc<str>>) -> Self {
        let text: Arc<str> = text.into();
        let text = if text.contains('\r') { text.replace("\r\n", "\n").replace('\r', "\n").into() } else { text };
        Self { name: name.into(), text }
    }

    /// Line and column of a byte, both from 1; columns count characters.
    pub fn line_column(&self, offset: usize) -> (usize, usize) {
        let offset = (0..=offset.min(self.text.len())).rev().find(|&i| self.text.is_char_boundary(i)).unwrap_or(0);
        let before = &self.text[..offset];
        let start = before.rfind('\n').map_or(0, |i| i + 1);
        (before.matches('\n').count() + 1, before[start..].chars().count() + 1)
    }
}

/// What helps besides a change of the file: whoever shows the report says how it is done there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Remedy {
    /// What the engine knows of.
    Scene(scene::Remedy),
    /// To look at which scenes are built in.
    ListScenes,
    /// To name another folder for what a scene or model reads.
    NameFolder,
    /// To say which year a driver is of.
    NameDialect,
    /// To look at whether the model in this file is a solid.
    CheckModel(String),
    /// To ask the picture in this file how it was made, or to make it again.
    MakeAgain(String),
}

/// One thing that is wrong, or odd, with a file.
#[derive(Clone, Debug)]
pub struct Report {
    /// What was read and what was expected.
    pub message: String,
    /// What to do about it in the file.
    pub help: Option<String>,
    /// What to do about it elsewhere.
    pub remedy: Option<Remedy>,
    /// Where.
    pub place: Option<(Source, Range<usize>)>,
    /// For a warning which one; `None` for an error.
    pub warning: Option<WarningCode>,
}

impl Report {
    /// An error without a place.
    pub fn error(message: impl Into<String>) -> Self {
        Self { message: in_short(message.into()), help: None, remedy: None, place: None, warning: None }
    }

    /// A warning without a place.
    pub fn warning(code: WarningCode, message: impl Into<String>) -> Self {
        Self { warning: Some(code), ..Self::error(message) }
    }

    /// The same, at a range of bytes in a text.
    #[must_use]
    pub fn at(mut self, source: &Source, range: Range<usize>) -> Self {
        let end = source.text.len();
        let range = range.start.min(end)..range.end.clamp(range.start.min(end), end);
        self.place = Some((source.clone(), range));
        self
    }

    /// The same, with advice.
    #[must_use]
    pub fn help(mut self, help: impl Into<String>) -> Self {
        self.help = Some(in_short(help.into()));
        self
    }

    /// The same, with what helps elsewhere.
    #[must_use]
    pub fn remedy(mut self, remedy: Remedy) -> Self {
        self.remedy = Some(remedy);
        self
    }
}

impl fmt::Display for Report {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.warning {
            Some(code) => write!(f, "{}: {}", code.code(), self.message),
            None => f.write_str(&self.message),
        }
    }
}

impl std::error::Error for Report {}

impl From<&Problem> for Report {
    /// Without its place, which is one in a scene and not yet one in a text.
    fn from(problem: &Problem) -> Self {
        let remedy = problem.remedy.map(Remedy::Scene);
        let report = Self { remedy, ..Self::error(problem.message.as_str()) };
        problem.help.iter().fold(report, |report, help| report.help(help.as_str()))
    }
}

/// Where several things can be wrong, one of them.
impl From<Report> for Vec<Report> {
    fn from(report: Report) -> Self {
        vec![report]
    }
}

/// Longer words, and longer texts in quotes, are cut in the middle: a file may hold one of a million characters.
const LONGEST_WORD: usize = 200;

/// A message without the middle of its longest words.
fn in_short(text: String) -> String {
    if text.len() <= LONGEST_WORD {
        return text;
    }
    // What is quoted is one word, spaces and all.
    let quoted = |(number, part): (usize, &str)| {
        if number % 2 == 1 { cut(part) } else { part.split(' ').map(cut).collect::<Vec<_>>().join(" ") }
    };
    text.split('`').enumerate().map(quoted).collect::<Vec<_>>().join("`")
}

fn cut(word: &str) -> String {
    let count = if word.len() <= LONGEST_WORD { 0 } else { word.chars().count() };
    if count <= LONGEST_WORD {
        return word.to_owned();
    }
    let half = (LONGEST_WORD - 1) / 2;
    word.chars().take(half).chain(['…']).chain(word.chars().skip(count - half)).collect()
}

/// Longer lists of names are counted.
const LISTED: usize = 20;

/// Names in a message.
pub fn list<'a>(names: impl IntoIterator<Item = &'a str>) -> String {
    let mut names = names.into_iter();
    let first: Vec<&str> = names.by_ref().take(LISTED).collect();
    match (first.is_empty(), names.count()) {
        (true, _) => "none".to_owned(),
        (false, 0) => first.join(", "),
        (false, more) => format!("{} … and {more} more", first.join(", ")),
    }
}

/// Which names there are, the one most like `word` first.
pub fn known_names<'a>(word: &str, known: impl IntoIterator<Item = &'a str, IntoIter: Clone>) -> String {
    let known = known.into_iter();
    let near = nearest(word, known.clone()).map_or(String::new(), |near| format!("did you mean `{near}`? "));
    format!("{near}Known here: {}", list(known))
}

/// The known word that is nearest to a misspelt one, if any is near.
pub fn nearest<'a>(word: &str, known: impl IntoIterator<Item = &'a str>) -> Option<&'a str> {
    known
        .into_iter()
        .map(|candidate| {
            (strsim::normalized_damerau_levenshtein(&word.to_lowercase(), &candidate.to_lowercase()), candidate)
        })
        .filter(|(score, _)| *score > 0.6)
        .max_by(|a, b| a.0.total_cmp(&b.0))
        .map(|(_, candidate)| candidate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_and_columns_count_from_one_and_in_characters() {
        let source = Source::new("x", "ab\nüx\n");
        assert_eq!(source.line_column(0), (1, 1));
        assert_eq!(source.line_column(5), (2, 2), "ü has two bytes and one column");
        assert_eq!(source.line_column(4), (2, 1), "inside ü is ü");
        assert_eq!(source.line_column(99), (3, 1));
        assert_eq!(&*Source::new("x", "a\r\nb\rc\n").text, "a\nb\nc\n");
    }

    #[test]
    fn long_words_are_cut_in_the_middle() {
        let (word, short) = ("x".repeat(300), "y".repeat(200));
        for text in [format!("read {word} here"), format!("read `a {word} b` here")] {
            let message = Report::error(text).message;
            assert!(message.chars().count() <= 220 && message.contains('…') && message.ends_with(" here"), "{message}");
        }
        let message = format!("read `{short}` and {short}");
        assert_eq!(Report::error(message.clone()).message, message);
        let many: Vec<String> = (0..1000).map(|i| i.to_string()).collect();
        assert_eq!(list(many.iter().map(String::as_str)).matches(',').count(), 19);
        assert!(known_names("glas", ["glass", "green"]).starts_with("did you mean `glass`? Known here: glass, green"));
    }

    #[test]
    fn every_warning_is_documented() {
        let docs = include_str!("../../../docs/warnings.md");
        for code in WarningCode::ALL {
            assert!(docs.contains(&format!("| `{}` |", code.code())), "{} is not in docs/warnings.md", code.code());
        }
    }

    #[test]
    fn the_nearest_word_is_near() {
        assert_eq!(nearest("radus", ["center", "radius"]), Some("radius"));
        assert_eq!(nearest("zzz", ["center", "radius"]), None);
    }
}
