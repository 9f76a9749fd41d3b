//! Scene files: TOML made for people, and the same as JSON.

mod edit;
mod locate;

pub use edit::set;
pub use locate::steps_at;

use crate::report::{Report, Source, nearest};
use locate::locate;
use snell::scene::{Problem, Scene, Step};
use std::ops::Range;

/// The two ways to write a scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Syntax {
    /// Made for people.
    Toml,
    /// Made for programs.
    Json,
}

/// Reads a scene text. What the numbers mean is not checked yet.
///
/// # Errors
/// Syntax errors, unknown keys, missing keys, wrong types.
pub fn parse(source: &Source, syntax: Syntax) -> Result<Scene, Report> {
    match syntax {
        Syntax::Toml => toml_edit::de::from_str(&source.text).map_err(|e| {
            let range = e.span().unwrap_or(0..0);
            explain(e.message(), &source.text[range.clone()]).at(source, range)
        }),
        Syntax::Json if !source.text.trim_start().starts_with('{') => {
            Err(Report::error("a scene in JSON is an object, and starts with `{`").at(source, 0..0))
        }
        Syntax::Json => serde_json::from_str(&source.text).map_err(|e| {
            let range = json_range(&source.text, e.line(), e.column());
            let message = e.to_string();
            let message = message.rsplit_once(" at line ").map_or(message.as_str(), |(before, _)| before);
            explain(message, &source.text[range.clone()]).at(source, range)
        }),
    }
}

/// Says what serde says in our words, with the nearest known key.
fn explain(message: &str, read: &str) -> Report {
    let mut quoted = message.split('`').skip(1).step_by(2);
    if message.starts_with("unknown field") || message.starts_with("unknown variant") {
        let what = if message.starts_with("unknown field") { "key" } else { "value" };
        let word = quoted.next().unwrap_or_default();
        let known: Vec<&str> = quoted.collect();
        let list = known.join(", ");
        let help = match nearest(word, known.iter().copied()) {
            Some(near) => format!("did you mean `{near}`? Known here: {list}"),
            None => format!("known here: {list}"),
        };
        return Report::error(format!("unknown {what} `{word}`")).help(help);
    }
    if let Some(key) = message.strip_prefix("missing field ") {
        let help = match key {
            "`integrator`" => "say which model of light: lecture, course2018 or course2020".to_owned(),
            "`snell`" => "start the file with `snell = 1`, the version of the format".to_owned(),
            _ => format!("add {key}"),
        };
        return Report::error(format!("{key} is missing")).help(help);
    }
    let read = read.lines().next().unwrap_or_default();
    if read.is_empty() { Report::error(message) } else { Report::error(format!("{message}, read `{read}`")) }
}

/// The token at a place that `serde_json` names: line and column from 1, the column after the token.
fn json_range(text: &str, line: usize, column: usize) -> Range<usize> {
    let start: usize = text.split_inclusive('\n').take(line.saturating_sub(1)).map(str::len).sum();
    let mut at = (start + column.saturating_sub(1)).min(text.len());
    while !text.is_char_boundary(at) {
        at -= 1;
    }
    let end = text[at..].chars().next().map_or(at, |c| at + c.len_utf8());
    let before = text[..at].char_indices().rfind(|(_, c)| c.is_whitespace() || "[]{},:".contains(*c));
    before.map_or(0, |(i, c)| i + c.len_utf8())..end
}

/// Puts a problem of a scene at its place in the text.
pub fn report(problem: &Problem, source: &Source, syntax: Syntax) -> Report {
    let mut report = Report::error(problem.message.clone());
    report.help.clone_from(&problem.help);
    match place(&problem.place, source, syntax) {
        Some(range) => report.at(source, range),
        None => report,
    }
}

/// Where a value stands in the text; where it is left out, where it would belong.
pub fn place(steps: &[Step], source: &Source, syntax: Syntax) -> Option<Range<usize>> {
    locate(&source.text, syntax, steps)
}

/// Writes a scene as text. Every number comes back to the bit.
///
/// # Errors
/// When a value has no form in a file.
pub fn to_text(scene: &Scene, syntax: Syntax) -> Result<String, Report> {
    let failed = |e: String| Report::error(format!("this scene cannot be written: {e}"));
    match syntax {
        Syntax::Toml => {
            let mut document = toml_edit::ser::to_document(scene).map_err(|e| failed(e.to_string()))?;
            edit::for_people(&mut document);
            Ok(document.to_string())
        }
        Syntax::Json => serde_json::to_string_pretty(scene).map(|text| text + "\n").map_err(|e| failed(e.to_string())),
    }
}

/// The JSON Schema of scene files.
pub fn schema() -> String {
    let mut schema = schemars::schema_for!(Scene);
    schema.insert("title".to_owned(), "Snell scene, version 1".into());
    serde_json::to_string_pretty(&schema).unwrap_or_default() + "\n"
}

#[cfg(test)]
mod tests;
