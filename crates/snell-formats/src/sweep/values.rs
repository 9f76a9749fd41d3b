//! `--sweep KEY=VALUES`: the values that a key takes, one after the other.

use super::{MOST_PICTURES, SceneKey};
use crate::report::{Report, Source};
use crate::scene_file;
use toml_edit::Value;

const EXPECTED: &str = "write A:B:N, N numbers evenly from A to B, like 1.3:1.7:9, or a list with a value for each picture, like [\"BK7\", \"SF10\"]";

/// A key, and what it is set to.
#[derive(Debug)]
pub(super) struct Axis {
    pub key: SceneKey,
    pub values: Vec<AxisValue>,
}

#[derive(Debug)]
pub(super) struct AxisValue {
    /// As `--set` takes it.
    pub text: String,
    /// As the name of a picture has it, or why there is none.
    pub name: Result<String, String>,
}

impl Axis {
    pub fn parse(argument: &str) -> Result<Self, Report> {
        let source = Source::new("--sweep", argument);
        let at = |report: Report| report.at(&source, 0..argument.len());
        let Some((key, values)) = scene_file::split(argument) else {
            return Err(
                at(Report::error(format!("`{argument}` has no `=`")).help("like material.glass.eta=1.3:1.7:9")),
            );
        };
        let (parts, text) = (scene_file::keys(argument), key.trim().to_owned());
        if parts.is_empty() {
            return Err(at(Report::error(format!("`{key}` is no key of a scene")).help("like material.glass.eta")));
        }
        let key = SceneKey { text, parts, range: 0..key.len(), source: source.clone() };
        let values = if values.trim_start().starts_with('[') { list(values) } else { range(values) }.map_err(at)?;
        Ok(Self { key, values })
    }
}

fn list(text: &str) -> Result<Vec<AxisValue>, Report> {
    let no_list = |why: &str| {
        let why = why.lines().next().unwrap_or_default();
        Report::error(format!("expected a list, read `{}`: {why}", text.trim())).help(EXPECTED)
    };
    let value: Value = text.trim().parse().map_err(|e: toml_edit::TomlError| no_list(e.message()))?;
    let array = value.as_array().ok_or_else(|| no_list("it is none"))?;
    if array.is_empty() {
        return Err(Report::error("a list without values makes no pictures").help(EXPECTED));
    }
    let of = |value: &Value| {
        if !is_finite(value) {
            return Err(Report::error(format!("expected finite numbers, read `{}`", plain(value))));
        }
        Ok(AxisValue { text: plain(value), name: name(value) })
    };
    array.iter().map(of).collect()
}

/// Numbers evenly from one to another.
fn range(text: &str) -> Result<Vec<AxisValue>, Report> {
    let no_range = || Report::error(format!("expected values, read `{}`", text.trim())).help(EXPECTED);
    let parts: Vec<&str> = text.split(':').map(str::trim).collect();
    let &[first, last, count] = parts.as_slice() else { return Err(no_range()) };
    let number = |text: &str| {
        let number = text.parse::<f64>().ok().filter(|n| n.is_finite());
        number.ok_or_else(|| Report::error(format!("expected a finite number, read `{text}`")).help(EXPECTED))
    };
    let (first, last) = (number(first)?, number(last)?);
    let counted = count.parse::<usize>().ok().filter(|n| (1..=MOST_PICTURES).contains(n));
    let count = counted.ok_or_else(|| {
        let message = format!("expected how many values, a whole number from 1 to {MOST_PICTURES}, read `{count}`");
        Report::error(message).help(EXPECTED)
    })?;
    if (count == 1) != (first == last) {
        let message = format!("{count} different values cannot go from {first} to {last}");
        return Err(Report::error(message).help("one value is A:A:1, two are A:B:2"));
    }
    let of = |step| {
        let text = number_text(between(first, last, step, count - 1));
        AxisValue { name: Ok(text.clone()), text }
    };
    Ok((0..count).map(of).collect())
}

/// The number `step` of `steps` on the way from `first` to `last`. Both ends are as they are. Those between are rounded to 15 digits
/// of the larger end, where steps are not that small: 1.35, not 1.3499999999999999.
fn between(first: f64, last: f64, step: usize, steps: usize) -> f64 {
    if step == 0 {
        return first;
    }
    if step == steps {
        return last;
    }
    let part = step as f64 / steps as f64;
    let value = first * (1.0 - part) + last * part;
    let exponent = format!("{:e}", first.abs().max(last.abs()));
    let exponent: i32 = exponent.rsplit_once('e').and_then(|(_, digits)| digits.parse().ok()).unwrap_or(0);
    let decimals = usize::try_from(14 - exponent).unwrap_or(0);
    let rounded: f64 = format!("{value:.decimals$}").parse().unwrap_or(value);
    let step = (last - first).abs() / steps as f64;
    // Zero has no sign here. An eighth of a percent of a step is not seen, and keeps steps apart.
    if (rounded - value).abs() < step / 1000.0 { rounded + 0.0 } else { value }
}

/// A number as TOML, the shortest that is read as the same: whole ones without a point, so that keys of whole numbers take them.
pub(super) fn number_text(number: f64) -> String {
    let is_whole = number.fract() == 0.0 && number.abs() <= MOST_WHOLE && !(number == 0.0 && number.is_sign_negative());
    if is_whole { format!("{number:.0}") } else { format!("{number:?}") }
}

/// Up to here every whole number is one of `f64`.
pub(super) const MOST_WHOLE: f64 = 9_007_199_254_740_992.0;

/// A value as TOML, without the spaces and comments around it.
pub(super) fn plain(value: &Value) -> String {
    let mut value = value.clone();
    value.decor_mut().clear();
    value.to_string().trim().to_owned()
}

pub(super) fn is_finite(value: &Value) -> bool {
    match value {
        Value::Float(float) => float.value().is_finite(),
        Value::Array(array) => array.iter().all(is_finite),
        Value::InlineTable(table) => table.iter().all(|(_, value)| is_finite(value)),
        _ => true,
    }
}

/// A value as part of a file name.
fn name(value: &Value) -> Result<String, String> {
    match value {
        Value::Integer(whole) => Ok(whole.value().to_string()),
        Value::Float(float) => Ok(number_text(*float.value())),
        Value::Boolean(is) => Ok(is.value().to_string()),
        Value::String(text) => {
            let text = text.value();
            let is_odd = |c: char| matches!(c, '/' | '\\') || c.is_control();
            match text.chars().find(|c| is_odd(*c)) {
                Some(odd) => Err(format!("`{}` holds {odd:?}, which no file name may", text.escape_debug())),
                None if text.is_empty() => Err("a text without letters is no part of a file name".to_owned()),
                None => Ok(text.clone()),
            }
        }
        Value::Array(array) => Ok(array.iter().map(name).collect::<Result<Vec<_>, _>>()?.join(",")),
        Value::InlineTable(_) | Value::Datetime(_) => Err(format!("`{}` is no part of a file name", plain(value))),
    }
}
