//! From a place in a scene to the bytes of its text.

use super::Syntax;
use jsonc_parser::ast::Value as Json;
use jsonc_parser::common::Ranged;
use snell::scene::Step;
use std::ops::Range;
use toml_edit::Item;

/// The bytes of the value at each of these places; of the nearest table around it, where it is left out.
pub(super) fn locate(text: &str, syntax: Syntax, places: &[&[Step]]) -> Vec<Option<Range<usize>>> {
    // A large text is taken apart once for all of them, and not at all for none.
    if places.is_empty() {
        return Vec::new();
    }
    match syntax {
        Syntax::Toml => {
            let document = toml_edit::Document::parse(text).ok();
            let of = |steps: &&[Step]| in_toml(document.as_ref()?.as_item(), steps);
            places.iter().map(of).collect()
        }
        Syntax::Json => {
            let (collect, parse) = (jsonc_parser::CollectOptions::default(), jsonc_parser::ParseOptions::default());
            let root = jsonc_parser::parse_to_ast(text, &collect, &parse).ok().and_then(|parsed| parsed.value);
            let of = |steps: &&[Step]| Some(in_json(root.as_ref()?, steps));
            places.iter().map(of).collect()
        }
    }
}

fn in_toml(root: &Item, steps: &[Step]) -> Option<Range<usize>> {
    let (mut item, mut found) = (root, None);
    for step in steps {
        let Some(next) = toml_step(item, step) else { break };
        item = next;
        found = item.span().or(found);
    }
    // Elements of a plain array are values, not items: the array as a whole is shown.
    found
}

fn in_json(root: &Json<'_>, steps: &[Step]) -> Range<usize> {
    let mut value = root;
    for step in steps {
        let Some(next) = json_step(value, step) else { break };
        value = next;
    }
    let range = value.range();
    range.start..range.end
}

/// The way to the innermost value of a JSON text around a byte: the inverse of `locate`.
pub fn steps_at(json: &str, offset: usize) -> Vec<Step> {
    let mut steps = Vec::new();
    let (collect, parse) = (jsonc_parser::CollectOptions::default(), jsonc_parser::ParseOptions::default());
    let root = jsonc_parser::parse_to_ast(json, &collect, &parse).ok().and_then(|parsed| parsed.value);
    let around = |value: &Json<'_>| (value.range().start..value.range().end).contains(&offset);
    let mut at = root.as_ref();
    while let Some(value) = at {
        at = match value {
            Json::Object(object) => {
                let found = object.properties.iter().find(|p| (p.range().start..p.range().end).contains(&offset));
                steps.extend(found.map(|property| Step::from(property.name.as_str())));
                found.map(|property| &property.value)
            }
            Json::Array(array) => {
                let found = array.elements.iter().position(around);
                steps.extend(found.map(Step::from));
                found.map(|index| &array.elements[index])
            }
            _ => None,
        };
    }
    steps
}

fn toml_step<'a>(item: &'a Item, step: &Step) -> Option<&'a Item> {
    match step {
        Step::Key(key) => item.get(key.as_str()),
        Step::Index(index) => item.get(index),
    }
}

fn json_step<'a>(value: &'a Json<'a>, step: &Step) -> Option<&'a Json<'a>> {
    match (value, step) {
        (Json::Object(object), Step::Key(key)) => object.get(key).map(|property| &property.value),
        (Json::Array(array), Step::Index(index)) => array.elements.get(*index),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn there_and_back() {
        let text = r#"{"snell": 1, "sphere": [{"radius": 1}, {"center": [0, 0, "x"], "radius": 2}]}"#;
        for steps in [
            vec![Step::from("snell")],
            vec![Step::from("sphere"), Step::from(0), Step::from("radius")],
            vec![Step::from("sphere"), Step::from(1), Step::from("center"), Step::from(2)],
        ] {
            let range = locate(text, Syntax::Json, &[&steps]).remove(0).unwrap();
            assert_eq!([steps_at(text, range.start), steps_at(text, range.end - 1)], [steps.clone(), steps]);
        }
        assert_eq!(steps_at(text, text.len()), []);
        assert_eq!(steps_at("{", 0), []);
    }
}
