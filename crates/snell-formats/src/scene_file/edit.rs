//! `--set material.glass.eta=2.42`: changing one value of a scene.

use super::{Syntax, parse, to_text};
use crate::report::{Report, Source, nearest};
use toml_edit::{DocumentMut, Item, TableLike, Value};

/// Gives a scene the layout of a file made by hand: `[material.NAME]`, `[[sphere]]`, and short lists on one line.
pub(super) fn for_people(document: &mut DocumentMut) {
    for (_, item) in document.iter_mut() {
        if let Some(list) = item.as_array().filter(|a| a.iter().any(Value::is_inline_table)) {
            let tables =
                list.iter().filter_map(Value::as_inline_table).cloned().map(toml_edit::InlineTable::into_table);
            *item = Item::ArrayOfTables(tables.collect());
        } else if let Some(inline) = item.as_inline_table().cloned() {
            let mut table = inline.into_table();
            for (_, item) in table.iter_mut() {
                if let Some(inner) = item.as_inline_table().cloned() {
                    *item = Item::Table(inner.into_table());
                }
            }
            // `[material]` alone would be an empty header.
            table.set_implicit(true);
            *item = Item::Table(table);
        }
    }
}

/// Changes one value of a scene text and returns the new text, as TOML.
///
/// `change` is `key=value`. The key names a value with dots; elements of a list go by name or by number from 1:
/// `camera.near`, `material.glass.eta`, `sphere.glass.radius`, `light.2.color`. The value is TOML; a bare word is a text.
///
/// # Errors
/// When the change has no `=`, or its key does not lead to a table of the scene.
pub fn set(source: &Source, syntax: Syntax, change: &str) -> Result<Source, Report> {
    let Some((key, value)) = change.split_once('=') else {
        let help = "write KEY=VALUE, like --set material.glass.eta=2.42";
        return Err(Report::error(format!("`--set {change}` has no `=`")).help(help));
    };
    let text = match syntax {
        Syntax::Toml => source.text.to_string(),
        Syntax::Json => to_text(&parse(source, syntax)?, Syntax::Toml)?,
    };
    let mut document: DocumentMut = text
        .parse()
        .map_err(|e: toml_edit::TomlError| Report::error(e.message()).at(source, e.span().unwrap_or(0..0)))?;
    let steps: Vec<&str> = key.trim().split('.').map(str::trim).collect();
    let Some((last, tables)) = steps.split_last().filter(|_| steps.iter().all(|s| !s.is_empty())) else {
        return Err(Report::error(format!("`{key}` is no key of a scene")).help("like material.glass.eta"));
    };
    find(document.as_table_mut(), tables, "")?.insert(last, Item::Value(parse_value(value)));
    Ok(Source::new(source.name.clone(), document.to_string()))
}

/// The table at the end of a path. It must exist: a misspelt name would make a new one that nothing uses.
fn find<'a>(table: &'a mut dyn TableLike, path: &[&str], walked: &str) -> Result<&'a mut dyn TableLike, Report> {
    let Some((step, rest)) = path.split_first() else { return Ok(table) };
    let shown = |step: &str| if walked.is_empty() { step.to_owned() } else { format!("{walked}.{step}") };
    let known: Vec<String> = table.iter().map(|(key, _)| key.to_owned()).collect();
    let walked = shown(step);
    match table.get_mut(step) {
        None => Err(unknown(&walked, step, &known)),
        Some(Item::ArrayOfTables(list)) => {
            let Some((element, rest)) = rest.split_first() else {
                let help = "name the element by its name or number, like sphere.1.radius";
                return Err(Report::error(format!("`{walked}` is a list")).help(help));
            };
            let name = |(i, t): (usize, &toml_edit::Table)| {
                t.get("name").and_then(Item::as_str).map_or((i + 1).to_string(), str::to_owned)
            };
            let names: Vec<String> = list.iter().enumerate().map(name).collect();
            let by_number = || element.parse::<usize>().ok()?.checked_sub(1);
            let index = names.iter().position(|n| n == element).or_else(by_number);
            let walked = format!("{walked}.{element}");
            match index.and_then(|i| list.get_mut(i)) {
                Some(table) => find(table, rest, &walked),
                None => Err(unknown(&walked, element, &names)),
            }
        }
        Some(item) => match item.as_table_like_mut() {
            Some(table) => find(table, rest, &walked),
            None => Err(Report::error(format!("`{walked}` has no keys of its own"))),
        },
    }
}

fn unknown(walked: &str, step: &str, known: &[String]) -> Report {
    let list = known.join(", ");
    let help = match nearest(step, known.iter().map(String::as_str)) {
        Some(near) => format!("did you mean `{near}`? Known here: {list}"),
        None => format!("known here: {list}"),
    };
    Report::error(format!("there is no `{walked}` in this scene")).help(help)
}

/// A TOML value; what is none is taken as a text.
fn parse_value(text: &str) -> Value {
    text.trim().parse().unwrap_or_else(|_| Value::from(text.trim()))
}
