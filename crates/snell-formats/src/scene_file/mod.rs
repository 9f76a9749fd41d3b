//! Scene files: TOML made for people, and the same as JSON.

mod edit;
mod layout;
mod locate;
mod rewrite;
#[cfg(feature = "disk")]
mod save;
mod write;

pub(crate) use edit::split;
pub use edit::{keys, set};
pub use locate::steps_at;
pub use rewrite::rewrite;
#[cfg(feature = "disk")]
pub use save::{pack, save};
pub use write::to_text;

use crate::memory;
use crate::report::{Report, Source, known_names};
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
        Syntax::Toml => {
            let help = "write what is large as a model, and name its file in a [[mesh]]";
            enough_memory(source).map_err(|report| report.help(help))?;
            toml_edit::de::from_str(&source.text).map_err(|e| {
                let range = e.span().unwrap_or(0..0);
                explain(e.message(), &source.text[range.clone()]).at(source, range)
            })
        }
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

/// Times the size of a TOML text that reading it takes: 57 to 61 for meshes and spheres written out, 115 for instances.
const TOML_MEMORY: u64 = 128;

/// Refuses a TOML text that there is no memory to read.
pub(crate) fn enough_memory(source: &Source) -> Result<(), Report> {
    let needed = TOML_MEMORY * source.text.len() as u64;
    if needed <= 1 << 30 {
        return Ok(());
    }
    memory::check("a TOML file of this size", needed).map_err(|report| report.at(source, 0..0))
}

/// Says what serde says in our words, with the nearest known key.
fn explain(message: &str, read: &str) -> Report {
    let mut quoted = message.split('`').skip(1).step_by(2);
    if message.starts_with("unknown field") || message.starts_with("unknown variant") {
        let what = if message.starts_with("unknown field") { "key" } else { "value" };
        let word = quoted.next().unwrap_or_default();
        let known: Vec<&str> = quoted.collect();
        return Report::error(format!("unknown {what} `{word}`")).help(known_names(word, known.iter().copied()));
    }
    if let Some(key) = message.strip_prefix("missing field ") {
        let help = match key {
            "`integrator`" => {
                "say which model of light: whitted (real optics), lecture, course2018 or course2020".to_owned()
            }
            "`snell`" => "start the file with `snell = 1`, the version of the format".to_owned(),
            _ => format!("add {key}"),
        };
        return Report::error(format!("{key} is missing")).help(help);
    }
    let read = read.lines().next().unwrap_or_default();
    // Serde names the types of Rust.
    let message =
        message.replace("expected f64", "expected a number").replace("expected u32", "expected a whole number");
    let report =
        if read.is_empty() { Report::error(&*message) } else { Report::error(format!("{message}, read `{read}`")) };
    match &*message {
        "invalid type: map, expected a sequence" => {
            report.help("of these a scene may have many: write [[…]] with two brackets")
        }
        m if m.contains("escape") => report.help("write / instead of \\ in the names of files, or put the text in '…'"),
        _ => report,
    }
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
    let report = Report::from(problem);
    match places(&[&problem.place], source, syntax).pop().flatten() {
        Some(range) => report.at(source, range),
        None => report,
    }
}

/// Where values stand in the text; where one is left out, where it would belong.
pub fn places(steps: &[&[Step]], source: &Source, syntax: Syntax) -> Vec<Option<Range<usize>>> {
    locate(&source.text, syntax, steps)
}

#[cfg(test)]
mod tests;
