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
