//! Reports and problems as Python exceptions.

use pyo3::prelude::*;
use snell::scene::{self, Problem, Step, WarningCode};
use snell_formats::report::Remedy;
use snell_formats::scene_file::steps_at;
use snell_formats::{Report, Source};

/// What the exceptions of `snell.errors` are made of: place, message, help.
pub type Finding = (Option<String>, String, Option<String>);

/// An exception of `snell.errors`.
pub fn raise(py: Python<'_>, class: &str, findings: Vec<Finding>) -> PyErr {
    let made = py.import("snell.errors").and_then(|module| module.getattr(class)?.call1((findings,)));
    made.map_or_else(|error| error, PyErr::from_value)
}

/// The way to a value, like `sphere[2].radius`.
pub fn path(steps: &[Step]) -> String {
    let mut path = String::new();
    for step in steps {
        match step {
            Step::Key(key) if path.is_empty() => path += key,
            Step::Key(key) => path = path + "." + key,
            Step::Index(index) => path = format!("{path}[{index}]"),
        }
    }
    path
}

pub fn problem(problem: &Problem) -> Finding {
    (Some(path(&problem.place)), problem.message.clone(), help(&Report::from(problem)))
}

/// What to do about a report: in the scene, and from Python or a shell.
pub fn help(report: &Report) -> Option<String> {
    let here = report.remedy.as_ref().and_then(|remedy| match remedy {
        Remedy::Scene(scene::Remedy::CheckMesh) | Remedy::CheckModel(_) => {
            Some("the command `snell check` shows what is wrong with a model and can repair it")
        }
        Remedy::Scene(scene::Remedy::RepairMesh) => {
            Some("the command `snell check --repair` turns the faces of a model")
        }
        Remedy::ListScenes => Some("`list(snell.scenes)` names the built-in ones"),
        // Python has no such settings.
        Remedy::NameFolder | Remedy::NameDialect | Remedy::MakeAgain(_) => None,
    });
    match (&report.help, here) {
        (Some(help), Some(here)) if help.ends_with('?') => Some(format!("{help} {here}")),
        (Some(help), Some(here)) => Some(format!("{help}; {here}")),
        (help, here) => help.clone().or(here.map(str::to_owned)),
    }
}

/// What Python adds to a warning of a picture.
pub fn advice(warning: WarningCode) -> &'static str {
    if warning == WarningCode::StrayExit { " The command `snell check` shows where" } else { "" }
}

/// A report. In `ours`, the text that Python wrote in JSON, its place is a key; in a file a line and a column.
pub fn report(report: &Report, ours: Option<&Source>) -> Finding {
    let place = report.place.as_ref().map(|(source, range)| match ours {
        Some(ours) if ours.name == source.name => path(&steps_at(&source.text, range.end.saturating_sub(1))),
        _ => {
            let (line, column) = source.line_column(range.start);
            format!("{}:{line}:{column}", source.name)
        }
    });
    (place.filter(|place| !place.is_empty()), report.message.clone(), help(report))
}
