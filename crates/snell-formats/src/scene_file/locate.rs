//! From a place in a scene to the bytes of its text.

use super::Syntax;
use jsonc_parser::ast::Value as Json;
use jsonc_parser::common::Ranged;
use snell::scene::Step;
use std::ops::Range;
use toml_edit::Item;

/// The bytes of the value at `steps`; of the nearest table around it, where it is left out.
pub(super) fn locate(text: &str, syntax: Syntax, steps: &[Step]) -> Option<Range<usize>> {
    match syntax {
        Syntax::Toml => {
            let document = toml_edit::Document::parse(text).ok()?;
            let mut found = None;
            let mut item = document.as_item();
            for step in steps {
                let Some(next) = toml_step(item, step) else { break };
                item = next;
                found = item.span().or(found);
            }
            // Elements of a plain array are values, not items: the array as a whole is shown.
            found
        }
        Syntax::Json => {
            let parsed = jsonc_parser::parse_to_ast(
                text,
                &jsonc_parser::CollectOptions::default(),
                &jsonc_parser::ParseOptions::default(),
            )
            .ok()?;
            let root = parsed.value?;
            let mut value = &root;
            for step in steps {
                let Some(next) = json_step(value, step) else { break };
                value = next;
            }
            let range = value.range();
            Some(range.start..range.end)
        }
    }
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
            let range = locate(text, Syntax::Json, &steps).unwrap();
            assert_eq!([steps_at(text, range.start), steps_at(text, range.end - 1)], [steps.clone(), steps]);
        }
        assert_eq!(steps_at(text, text.len()), []);
        assert_eq!(steps_at("{", 0), []);
    }
}
