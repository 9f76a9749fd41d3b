//! The JSON Schemas of what Snell reads and writes, from the types that read and write it. The types of the viewer (TypeScript) are
//! made of them, and those of Python compared with them.

use schemars::generate::SchemaSettings;
use snell::explain::{Explanation, ViewScene};
use snell::scene::Scene;

/// A kind of JSON, all of version 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// A scene file.
    Scene,
    /// The tree of a pixel ([`Explanation`]).
    RayTree,
    /// What the viewer shows of a scene ([`ViewScene`]).
    View,
}

impl Form {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Scene, Self::RayTree, Self::View];

    /// The name: its schema is published as `docs/NAME.schema.json`.
    pub fn name(self) -> &'static str {
        match self {
            Self::Scene => "scene",
            Self::RayTree => "ray-tree",
            Self::View => "view",
        }
    }

    /// The JSON Schema.
    pub fn schema(self) -> String {
        // What is written has all its keys; what is read may leave out those with a default.
        let (read, written) = (SchemaSettings::draft2020_12(), SchemaSettings::draft2020_12().for_serialize());
        let (mut schema, title) = match self {
            Self::Scene => (read.into_generator().into_root_schema_for::<Scene>(), "Snell scene, version 1"),
            Self::RayTree => {
                (written.into_generator().into_root_schema_for::<Explanation>(), "Snell ray tree, version 1")
            }
            Self::View => (written.into_generator().into_root_schema_for::<ViewScene>(), "Snell view, version 1"),
        };
        schema.insert("title".to_owned(), title.into());
        serde_json::to_string_pretty(&schema).unwrap_or_default() + "\n"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_published_schemas_are_these() {
        for form in Form::ALL {
            let name = format!("docs/{}.schema.json", form.name());
            let path = format!("{}/../../{name}", env!("CARGO_MANIFEST_DIR"));
            let published = std::fs::read_to_string(path).unwrap_or_default();
            assert!(published == form.schema(), "{name} is out of date: run `make schemas`");
        }
    }
}
