//! `--set material.glass.eta=2.42`: changing one value of a scene.

use super::{Syntax, parse, to_text};
use crate::report::{Report, Source, nearest};
use toml_edit::{Array, DocumentMut, Item, Key, TableLike, Value};

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
/// `change` is `key=value`. The key names a value with dots, as in TOML, quotes included; elements of a list go by name
/// or by number from 1: `camera.near`, `material.glass.eta`, `sphere.glass.radius`, `light.2.color`, `material."x.y".kd`.
/// The value is TOML; a bare word is a text.
///
/// # Errors
/// When the change has no `=`, or its key does not lead to a table of the scene.
pub fn set(source: &Source, syntax: Syntax, change: &str) -> Result<Source, Report> {
    // The first `=` outside quotes: names may hold one.
    let mut quoted = false;
    let equals = change.char_indices().find(|&(_, c)| {
        quoted ^= c == '"';
        c == '=' && !quoted
    });
    let Some((key, value)) = equals.map(|(i, _)| (&change[..i], &change[i + 1..])) else {
        let help = "write KEY=VALUE, like --set material.glass.eta=2.42";
        return Err(Report::error(format!("`--set {change}` has no `=`")).help(help));
    };
    let no_key = || Report::error(format!("`{key}` is no key of a scene")).help("like material.glass.eta");
    let text = match syntax {
        Syntax::Toml => source.text.to_string(),
        Syntax::Json => to_text(&parse(source, syntax)?, Syntax::Toml)?,
    };
    let mut document: DocumentMut = text
        .parse()
        .map_err(|e: toml_edit::TomlError| Report::error(e.message()).at(source, e.span().unwrap_or(0..0)))?;
    let keys = Key::parse(key.trim()).map_err(|_| no_key())?;
    let keys: Vec<&str> = keys.iter().map(Key::get).collect();
    let (last, path) = keys.split_last().ok_or_else(no_key)?;
    let new = parse_value(value);
    match find(Place::Table(document.as_table_mut()), path, "")? {
        Place::Table(table) => {
            table.insert(last, Item::Value(new));
        }
        Place::List(list) => {
            let index = last.parse::<usize>().ok().and_then(|n| n.checked_sub(1)).filter(|&i| i < list.len());
            let Some(index) = index else {
                let help = format!("it has {} elements, counted from 1", list.len());
                return Err(Report::error(format!("there is no `{}` in this scene", keys.join("."))).help(help));
            };
            list.replace(index, new);
        }
    }
    let name = source.name.strip_suffix(CHANGED).unwrap_or(&source.name);
    Ok(Source::new(format!("{name}{CHANGED}"), document.to_string()))
}

/// What the name of a changed text ends with, so that nobody looks for the change in the file.
const CHANGED: &str = " with --set";

/// Where a value can be put.
enum Place<'a> {
    Table(&'a mut dyn TableLike),
    List(&'a mut Array),
}

/// The table or list at the end of a path. It must exist: a misspelt name would make a new one that nothing uses.
fn find<'a>(place: Place<'a>, path: &[&str], walked: &str) -> Result<Place<'a>, Report> {
    let Some((step, rest)) = path.split_first() else { return Ok(place) };
    let walked = if walked.is_empty() { (*step).to_owned() } else { format!("{walked}.{step}") };
    let leaf = |walked: &str| Report::error(format!("`{walked}` has no keys of its own"));
    let list_itself = |walked: &str| {
        let help = "name the element by its name or number, like sphere.1.radius";
        Report::error(format!("`{walked}` is a list")).help(help)
    };
    match place {
        Place::List(list) => {
            // `sphere = [{ … }, { … }]` has names like `[[sphere]]`; other elements have numbers.
            let names = names(list.iter().map(|v| v.as_inline_table().map(|t| t as &dyn TableLike)));
            match position(&names, step).and_then(|i| list.get_mut(i)) {
                None => Err(unknown(&walked, step, &names)),
                Some(Value::InlineTable(table)) => find(Place::Table(table), rest, &walked),
                Some(Value::Array(inner)) => find(Place::List(inner), rest, &walked),
                Some(_) => Err(leaf(&walked)),
            }
        }
        Place::Table(table) => {
            let known: Vec<String> = table.iter().map(|(key, _)| key.to_owned()).collect();
            match table.get_mut(step) {
                None => Err(unknown(&walked, step, &known)),
                Some(Item::ArrayOfTables(list)) => {
                    let Some((element, rest)) = rest.split_first() else { return Err(list_itself(&walked)) };
                    let names = names(list.iter().map(|t| Some(t as &dyn TableLike)));
                    let walked = format!("{walked}.{element}");
                    match position(&names, element).and_then(|i| list.get_mut(i)) {
                        Some(table) => find(Place::Table(table), rest, &walked),
                        None => Err(unknown(&walked, element, &names)),
                    }
                }
                Some(Item::Value(Value::Array(list))) => find(Place::List(list), rest, &walked),
                Some(item) => match item.as_table_like_mut() {
                    Some(table) => find(Place::Table(table), rest, &walked),
                    None => Err(leaf(&walked)),
                },
            }
        }
    }
}

/// What the elements of a list are called: by their `name`, or their number from 1.
fn names<'a>(elements: impl Iterator<Item = Option<&'a dyn TableLike>>) -> Vec<String> {
    let name = |(i, t): (usize, Option<&dyn TableLike>)| {
        t.and_then(|t| t.get("name")?.as_str()).map_or((i + 1).to_string(), str::to_owned)
    };
    elements.enumerate().map(name).collect()
}

fn position(names: &[String], element: &str) -> Option<usize> {
    names.iter().position(|n| n == element).or_else(|| element.parse::<usize>().ok()?.checked_sub(1))
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
