//! `--set material.glass.eta=2.42`: changing one value of a scene.

use super::explain;
use crate::report::{Report, Source, known_names};
use indexmap::IndexMap;
use serde::de::{self, DeserializeOwned, IntoDeserializer, Visitor};
use serde::{Deserialize, Deserializer, Serialize, forward_to_deserialize_any};
use snell::scene::{Scene, Step};
use std::mem::take;
use toml_edit::{Array, DocumentMut, Item, Key, TableLike, Value};

/// Changes one value of a scene, and returns its place there.
///
/// `change` is `key=value`. The key names a value with dots, as in TOML, quotes included; elements of a list go by name
/// or by number from 1: `camera.near`, `material.glass.eta`, `sphere.glass.radius`, `light.2.color`, `material."x.y".kd`.
/// The value is TOML; a bare word is a text.
///
/// Only the part that the key names becomes text and is read again, so that a scene may be as large as it likes.
///
/// # Errors
/// When the change has no `=`, its key does not lead to a table of the scene, or what comes out is no scene. The place is in the
/// text of the change.
pub fn set(scene: &mut Scene, change: &str) -> Result<Vec<Step>, Report> {
    let source = Source::new("the change", change);
    set_in(scene, change)
        .map_err(|report| if report.place.is_some() { report } else { report.at(&source, 0..change.len()) })
}

/// The keys of a change, without their quotes; none if it is no change.
pub fn keys(change: &str) -> Vec<String> {
    let keys = split(change).and_then(|(key, _)| Key::parse(key.trim()).ok()).unwrap_or_default();
    keys.iter().map(|key| key.get().to_owned()).collect()
}

/// At the first `=` outside quotes: names may hold one.
pub(crate) fn split(change: &str) -> Option<(&str, &str)> {
    let mut quoted = None;
    let equals = change.char_indices().find(|&(_, c)| match quoted {
        None if c == '"' || c == '\'' => {
            quoted = Some(c);
            false
        }
        Some(quote) if c == quote => {
            quoted = None;
            false
        }
        quoted => c == '=' && quoted.is_none(),
    });
    equals.map(|(i, _)| (&change[..i], &change[i + 1..]))
}

fn set_in(scene: &mut Scene, change: &str) -> Result<Vec<Step>, Report> {
    let Some((key, value)) = split(change) else {
        let help = "write KEY=VALUE, like material.glass.eta=2.42";
        return Err(Report::error(format!("the change `{change}` has no `=`")).help(help));
    };
    let no_key = || Report::error(format!("`{key}` is no key of a scene")).help("like material.glass.eta");
    let keys = Key::parse(key.trim()).map_err(|_| no_key())?;
    let keys: Vec<&str> = keys.iter().map(Key::get).collect();
    let (first, path) = keys.split_first().ok_or_else(no_key)?;
    let change = Change { first, path, value: parse_value(value) };
    match *first {
        "light" => change.of_list(&mut scene.lights, |light| light.name.as_deref()),
        "sphere" => change.of_list(&mut scene.spheres, |sphere| sphere.name.as_deref()),
        "mesh" => change.of_list(&mut scene.meshes, |mesh| mesh.name.as_deref()),
        "plane" => change.of_list(&mut scene.planes, |plane| plane.name.as_deref()),
        "box" => change.of_list(&mut scene.boxes, |cuboid| cuboid.name.as_deref()),
        "disc" => change.of_list(&mut scene.discs, |disc| disc.name.as_deref()),
        "lathe" => change.of_list(&mut scene.lathes, |lathe| lathe.name.as_deref()),
        "material" => change.of_names(&mut scene.materials),
        "texture" => change.of_names(&mut scene.textures),
        _ => change.of_settings(scene),
    }
}

/// A change of what the first key names.
struct Change<'a> {
    first: &'a str,
    /// The keys behind it.
    path: &'a [&'a str],
    value: Value,
}

impl Change<'_> {
    /// Of an element of a list, or of all of it.
    fn of_list<T: Serialize + DeserializeOwned>(
        &self,
        elements: &mut Vec<T>,
        name: impl Fn(&T) -> Option<&str>,
    ) -> Result<Vec<Step>, Report> {
        let first = self.first;
        let Some((element, rest)) = self.path.split_first() else {
            let tables = self.value.as_array().filter(|array| array.iter().all(Value::is_inline_table));
            tables.ok_or_else(|| Report::error(format!("`{first}` is a list of tables")))?;
            *elements = read(self.value.clone())?;
            return Ok(vec![Step::from(first)]);
        };
        let number = || element.parse::<usize>().ok()?.checked_sub(1).filter(|&i| i < elements.len());
        let index = elements.iter().position(|e| name(e) == Some(*element)).or_else(number);
        let Some(index) = index else {
            if self.path.len() == 1 && element.parse::<usize>().is_err() {
                let help = format!("name the element by its name or number, like {first}.1.{element}");
                return Err(Report::error(format!("`{first}` is a list")).help(help));
            }
            let known: Vec<String> =
                elements.iter().enumerate().map(|(i, e)| name(e).map_or((i + 1).to_string(), str::to_owned)).collect();
            let report = unknown(&format!("{first}.{element}"), element, &known);
            let help = report.help.clone().unwrap_or_default();
            let numbers =
                if elements.is_empty() { String::new() } else { format!("; or a number from 1 to {}", elements.len()) };
            return Err(report.help(help + &numbers));
        };
        let mut steps = vec![Step::from(first), Step::from(index)];
        if rest.is_empty() {
            elements[index] = self.table()?;
        } else {
            steps.extend(self.of_table(&mut elements[index], rest, &format!("{first}.{element}"))?);
        }
        Ok(steps)
    }

    /// Of what has a name, or of a new one.
    fn of_names<T: Serialize + DeserializeOwned>(&self, named: &mut IndexMap<String, T>) -> Result<Vec<Step>, Report> {
        let first = self.first;
        let Some((name, rest)) = self.path.split_first() else {
            return Err(
                Report::error(format!("`{first}` is a table of names")).help(format!("like {first}.NAME.KEY=VALUE"))
            );
        };
        let mut steps = vec![Step::from(first), Step::from(*name)];
        if rest.is_empty() {
            named.insert((*name).to_owned(), self.table()?);
            return Ok(steps);
        }
        let walked = format!("{first}.{name}");
        let Some(value) = named.get_mut(*name) else {
            let known: Vec<String> = named.keys().cloned().collect();
            return Err(unknown(&walked, name, &known));
        };
        steps.extend(self.of_table(value, rest, &walked)?);
        Ok(steps)
    }

    /// Of everything that is there once.
    fn of_settings(&self, scene: &mut Scene) -> Result<Vec<Step>, Report> {
        let known = scene_keys();
        if !known.iter().any(|key| key == self.first) {
            let report = unknown(self.first, self.first, &known);
            return Err(match named(scene, self.first) {
                Some(list) => report.help(format!("did you mean `{list}.{}`?", self.first)),
                None => report,
            });
        }
        let (lights, materials, textures) =
            (take(&mut scene.lights), take(&mut scene.materials), take(&mut scene.textures));
        let (spheres, meshes, planes) = (take(&mut scene.spheres), take(&mut scene.meshes), take(&mut scene.planes));
        let (boxes, discs, lathes) = (take(&mut scene.boxes), take(&mut scene.discs), take(&mut scene.lathes));
        let keys: Vec<&str> = std::iter::once(self.first).chain(self.path.iter().copied()).collect();
        let steps = self.of_table(scene, &keys, "");
        let lists =
            Scene { lights, materials, textures, spheres, meshes, planes, boxes, discs, lathes, ..scene.clone() };
        *scene = lists;
        steps
    }

    /// Of a value in a table, or in what is in it. Returns the steps to it.
    fn of_table<T: Serialize + DeserializeOwned>(
        &self,
        table: &mut T,
        keys: &[&str],
        walked: &str,
    ) -> Result<Vec<Step>, Report> {
        let written =
            |e: toml_edit::ser::Error| Report::error(format!("this part of the scene cannot be written: {e}"));
        let mut document: DocumentMut = toml_edit::ser::to_document(table).map_err(written)?;
        let Some((last, path)) = keys.split_last() else { return Ok(Vec::new()) };
        let mut steps = Vec::new();
        match find(Place::Table(document.as_table_mut()), path, walked, &mut steps)? {
            Place::Table(table) => {
                table.insert(last, Item::Value(self.value.clone()));
                steps.push(Step::from(*last));
            }
            Place::List(list) => {
                let index = last.parse::<usize>().ok().and_then(|n| n.checked_sub(1)).filter(|&i| i < list.len());
                let Some(index) = index else {
                    let help = format!("it has {} elements, counted from 1", list.len());
                    let all: Vec<&str> =
                        Some(walked).filter(|w| !w.is_empty()).into_iter().chain(keys.iter().copied()).collect();
                    return Err(Report::error(format!("there is no `{}` in this scene", all.join("."))).help(help));
                };
                list.replace(index, self.value.clone());
                steps.push(Step::from(index));
            }
        }
        let text = document.to_string();
        *table = toml_edit::de::from_str(&text).map_err(|e| explain(e.message(), &text[e.span().unwrap_or(0..0)]))?;
        Ok(steps)
    }

    /// The value itself, as a table.
    fn table<T: DeserializeOwned>(&self) -> Result<T, Report> {
        let keys: Vec<&str> = std::iter::once(self.first).chain(self.path.iter().copied()).collect();
        if !self.value.is_inline_table() {
            let message = format!("`{}` is a table", keys.join("."));
            return Err(Report::error(message).help("name a key of it, or write a whole one: { kd = 0.5 }"));
        }
        read(self.value.clone())
    }
}

fn read<T: DeserializeOwned>(value: Value) -> Result<T, Report> {
    T::deserialize(value.into_deserializer()).map_err(|e| explain(e.message(), ""))
}

/// The list or table in which something has this name.
fn named(scene: &Scene, name: &str) -> Option<&'static str> {
    let is = |own: &Option<String>| own.as_deref() == Some(name);
    match () {
        () if scene.materials.contains_key(name) => Some("material"),
        () if scene.spheres.iter().any(|sphere| is(&sphere.name)) => Some("sphere"),
        () if scene.meshes.iter().any(|mesh| is(&mesh.name)) => Some("mesh"),
        () if scene.planes.iter().any(|plane| is(&plane.name)) => Some("plane"),
        () if scene.boxes.iter().any(|cuboid| is(&cuboid.name)) => Some("box"),
        () if scene.discs.iter().any(|disc| is(&disc.name)) => Some("disc"),
        () if scene.lathes.iter().any(|lathe| is(&lathe.name)) => Some("lathe"),
        () if scene.lights.iter().any(|light| is(&light.name)) => Some("light"),
        () if scene.textures.contains_key(name) => Some("texture"),
        () => None,
    }
}

/// The keys of a scene, which it asks its deserializer for.
fn scene_keys() -> Vec<String> {
    struct Asked<'a>(&'a mut Vec<String>);

    impl<'de> Deserializer<'de> for Asked<'_> {
        type Error = de::value::Error;

        fn deserialize_any<V: Visitor<'de>>(self, _: V) -> Result<V::Value, Self::Error> {
            Err(de::Error::custom("there is nothing to read"))
        }

        fn deserialize_struct<V: Visitor<'de>>(
            self,
            _: &'static str,
            fields: &'static [&'static str],
            visitor: V,
        ) -> Result<V::Value, Self::Error> {
            self.0.extend(fields.iter().map(ToString::to_string));
            self.deserialize_any(visitor)
        }

        forward_to_deserialize_any! {
            bool i8 i16 i32 i64 u8 u16 u32 u64 f32 f64 char str string bytes byte_buf option unit unit_struct newtype_struct seq
            tuple tuple_struct map enum identifier ignored_any
        }
    }

    let mut keys = Vec::new();
    // It fails, after it has asked.
    let _ = Scene::deserialize(Asked(&mut keys));
    keys
}

/// Where a value can be put.
enum Place<'a> {
    Table(&'a mut dyn TableLike),
    List(&'a mut Array),
}

/// The table or list at the end of a path. It must exist: a misspelt name would make a new one that nothing uses.
fn find<'a>(place: Place<'a>, path: &[&str], walked: &str, steps: &mut Vec<Step>) -> Result<Place<'a>, Report> {
    let Some((step, rest)) = path.split_first() else { return Ok(place) };
    let walked = if walked.is_empty() { (*step).to_owned() } else { format!("{walked}.{step}") };
    let leaf = |walked: &str| Report::error(format!("`{walked}` has no keys of its own"));
    match place {
        Place::List(list) => {
            let count = list.len();
            let index = step.parse::<usize>().ok().and_then(|n| n.checked_sub(1)).filter(|&i| i < count);
            let Some(index) = index else {
                let known: Vec<String> = (1..=count).map(|i| i.to_string()).collect();
                return Err(unknown(&walked, step, &known));
            };
            steps.push(Step::from(index));
            match list.get_mut(index) {
                Some(Value::InlineTable(table)) => find(Place::Table(table), rest, &walked, steps),
                Some(Value::Array(inner)) => find(Place::List(inner), rest, &walked, steps),
                _ => Err(leaf(&walked)),
            }
        }
        Place::Table(table) => {
            let known: Vec<String> = table.iter().map(|(key, _)| key.to_owned()).collect();
            steps.push(Step::from(*step));
            match table.get_mut(step) {
                None => Err(unknown(&walked, step, &known)),
                Some(Item::Value(Value::Array(list))) => find(Place::List(list), rest, &walked, steps),
                Some(item) => match item.as_table_like_mut() {
                    Some(table) => find(Place::Table(table), rest, &walked, steps),
                    None => Err(leaf(&walked)),
                },
            }
        }
    }
}

pub(super) fn unknown(walked: &str, step: &str, known: &[String]) -> Report {
    let names = known.iter().map(String::as_str);
    let help = if known.is_empty() { "there are none".to_owned() } else { known_names(step, names) };
    Report::error(format!("there is no `{walked}` in this scene")).help(help)
}

/// A TOML value; what is none is taken as a text.
pub(super) fn parse_value(text: &str) -> Value {
    text.trim().parse().unwrap_or_else(|_| Value::from(text.trim()))
}
