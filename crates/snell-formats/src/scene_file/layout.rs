//! The layout of a scene file made by hand.

use toml_edit::{DocumentMut, Item, Value};

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
