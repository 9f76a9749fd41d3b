//! Writing a scene as text.

use super::Syntax;
use super::layout::for_people;
use crate::report::Report;
use serde::Serialize;
use snell::scene::Scene;
use std::collections::BTreeMap;

/// Writes a scene as text. Every number comes back to the bit.
///
/// # Errors
/// When a value has no form in a file.
pub fn to_text(scene: &Scene, syntax: Syntax) -> Result<String, Report> {
    match syntax {
        Syntax::Toml => to_toml(scene).map_err(|e| cannot_be_written(&e)),
        Syntax::Json => serde_json::to_string_pretty(scene).map(|text| text + "\n").map_err(|e| cannot_be_written(&e)),
    }
}

fn cannot_be_written(why: &dyn std::fmt::Display) -> Report {
    Report::error(format!("this scene cannot be written: {why}"))
}

/// One table after the other: as one document, a hundred thousand spheres would take a hundred times the memory of their text.
fn to_toml(scene: &Scene) -> Result<String, toml_edit::ser::Error> {
    // Each field by name: one that is added does not compile until it is written here.
    let Scene {
        snell,
        schema,
        ambient,
        background,
        sky,
        eta_outside,
        render,
        camera,
        lights,
        materials,
        textures,
        spheres,
        meshes,
        planes,
        boxes,
        discs,
        lathes,
    } = scene;
    let settings = Scene {
        snell: *snell,
        schema: schema.clone(),
        ambient: *ambient,
        background: *background,
        sky: sky.clone(),
        eta_outside: *eta_outside,
        ..Scene::new(render.clone(), camera.clone())
    };
    let mut text = document(&settings)?;
    lists(&mut text, "light", lights)?;
    names(&mut text, "material", materials)?;
    names(&mut text, "texture", textures)?;
    lists(&mut text, "sphere", spheres)?;
    lists(&mut text, "mesh", meshes)?;
    lists(&mut text, "plane", planes)?;
    lists(&mut text, "box", boxes)?;
    lists(&mut text, "disc", discs)?;
    lists(&mut text, "lathe", lathes)?;
    Ok(text)
}

fn document(value: &impl Serialize) -> Result<String, toml_edit::ser::Error> {
    let mut document = toml_edit::ser::to_document(value)?;
    for_people(&mut document);
    Ok(document.to_string())
}

fn lists<T: Serialize>(text: &mut String, key: &str, elements: &[T]) -> Result<(), toml_edit::ser::Error> {
    for element in elements {
        text.push('\n');
        text.push_str(&document(&BTreeMap::from([(key, [element])]))?);
    }
    Ok(())
}

fn names<'a, T: Serialize + 'a>(
    text: &mut String,
    key: &str,
    named: impl IntoIterator<Item = (&'a String, &'a T)>,
) -> Result<(), toml_edit::ser::Error> {
    for (name, value) in named {
        text.push('\n');
        text.push_str(&document(&BTreeMap::from([(key, BTreeMap::from([(name, value)]))]))?);
    }
    Ok(())
}
