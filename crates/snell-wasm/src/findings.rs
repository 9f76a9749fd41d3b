//! Reports as JavaScript sees them.

use js_sys::{Error, Reflect};
use serde::Serialize;
use snell::scene::{self, WarningCode};
use snell_formats::Report;
use snell_formats::report::Remedy;
use wasm_bindgen::JsValue;

/// One thing that is wrong, or odd.
#[derive(Serialize)]
struct Finding<'a> {
    /// Of a warning: `W009`.
    #[serde(skip_serializing_if = "Option::is_none")]
    code: Option<&'static str>,
    message: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    help: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    place: Option<Place<'a>>,
}

/// Where. Lines and columns count from 1, columns in characters; the end is behind the last one.
#[derive(Serialize)]
struct Place<'a> {
    file: &'a str,
    line: usize,
    column: usize,
    end_line: usize,
    end_column: usize,
}

impl<'a> From<&'a Report> for Finding<'a> {
    fn from(report: &'a Report) -> Self {
        let place = report.place.as_ref().map(|(source, range)| {
            let ((line, column), (end_line, end_column)) =
                (source.line_column(range.start), source.line_column(range.end));
            Place { file: &source.name, line, column, end_line, end_column }
        });
        let code = report.warning.map(WarningCode::code);
        Self { code, message: &report.message, help: help(report), place }
    }
}

/// What to do about a report: in the scene, and in a browser.
fn help(report: &Report) -> Option<String> {
    let here = report.remedy.as_ref().and_then(|remedy| match remedy {
        Remedy::Scene(scene::Remedy::CheckMesh) | Remedy::CheckModel(_) => {
            Some("the command `snell check` shows what is wrong with a model and can repair it")
        }
        Remedy::Scene(scene::Remedy::RepairMesh) => {
            Some("the command `snell check --repair` turns the faces of a model")
        }
        Remedy::NameFolder => Some("add the file that is missing"),
        // There are no such settings here, and the list of scenes is on the page.
        Remedy::ListScenes | Remedy::NameDialect | Remedy::MakeAgain(_) => None,
    });
    match (&report.help, here) {
        (Some(help), Some(here)) if help.ends_with('?') => Some(format!("{help} {here}")),
        (Some(help), Some(here)) => Some(format!("{help}; {here}")),
        (help, here) => help.clone().or(here.map(str::to_owned)),
    }
}

/// Reports as a list in JSON.
pub fn json(reports: &[Report]) -> String {
    let findings: Vec<Finding<'_>> = reports.iter().map(Finding::from).collect();
    // Texts and whole numbers always have a form.
    serde_json::to_string(&findings).unwrap_or_default()
}

/// What is thrown: an `Error` whose `findings` are the reports.
pub fn thrown(reports: &[Report]) -> JsValue {
    let messages: Vec<String> = reports.iter().map(ToString::to_string).collect();
    let error = Error::new(&messages.join("\n"));
    // An error that was just made takes any property.
    let _ = Reflect::set(&error, &"findings".into(), &json(reports).into());
    error.into()
}
