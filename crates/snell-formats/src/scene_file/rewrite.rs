//! Changing values in the text of a scene: comments, order and layout stay.

use super::edit::{parse_value, unknown};
use super::{enough_memory, explain};
use crate::report::{Report, Source};
use toml_edit::{Array, ArrayOfTables, Decor, DocumentMut, InlineTable, Item, Key, RawString, Table, TomlError, Value};

/// What a scene may have many of: a whole new one goes behind the others.
const LISTS: [&str; 7] = ["light", "sphere", "mesh", "plane", "box", "disc", "lathe"];

/// What goes by name: a new name makes a new one.
const NAMES: [&str; 2] = ["material", "texture"];

/// The text of a scene in TOML with other values, all of them or none. Keys and values are those of [`set`](super::set). Without a value
/// the key goes away, or the element of a list; a key of a table that the text leaves out is added to it; and `sphere` with a whole
/// table is one more sphere.
///
/// What comes out is TOML. Whether it is a scene, reading it tells.
///
/// # Errors
/// If the text is no TOML, or a key leads to nothing in it.
pub fn rewrite(source: &Source, changes: &[(String, Option<String>)]) -> Result<String, Report> {
    enough_memory(source)?;
    let mut document: DocumentMut = source.text.parse().map_err(|e: TomlError| {
        let range = e.span().unwrap_or(0..0);
        explain(e.message(), &source.text[range.clone()]).at(source, range)
    })?;
    for (key, value) in changes {
        change(document.as_table_mut(), key, value.as_deref())?;
    }
    Ok(document.to_string())
}

fn change(root: &mut Table, key: &str, value: Option<&str>) -> Result<(), Report> {
    let no_key = || Report::error(format!("`{key}` is no key of a scene")).help("like material.glass.eta");
    let keys = Key::parse(key.trim()).map_err(|_| no_key())?;
    let keys: Vec<&str> = keys.iter().map(Key::get).collect();
    let (last, path) = keys.split_last().ok_or_else(no_key)?;
    let value = value.map(|text| {
        let mut value = parse_value(text);
        value.decor_mut().clear();
        value
    });
    if path.is_empty()
        && LISTS.contains(last)
        && let Some(Value::InlineTable(element)) = value
    {
        append(root, last, element);
        return Ok(());
    }
    if let [names] = path
        && NAMES.contains(names)
        && value.is_some()
        && !root.contains_key(names)
    {
        // `[material]` alone would be an empty header.
        let mut table = Table::new();
        table.set_implicit(true);
        root.insert(names, Item::Table(table));
    }
    let mut place = Place::Table(root);
    for (walked, step) in path.iter().enumerate() {
        place = place.step(step, &keys[..=walked].join("."))?;
    }
    // `[material.glass]` has a header; what is deeper stands in one line.
    let is_section = path.len() < 2;
    match value {
        Some(value) => place.put(last, value, is_section, key),
        None => place.remove(last, key),
    }
}

/// Adds an element to a list, in the layout that the list has.
fn append(root: &mut Table, list: &str, element: InlineTable) {
    match root.get_mut(list) {
        Some(Item::Value(Value::Array(array))) if !array.is_empty() => array.push(element),
        Some(Item::ArrayOfTables(tables)) => tables.push(section(element)),
        _ => {
            root.remove(list);
            root.insert(list, Item::ArrayOfTables([section(element)].into_iter().collect()));
        }
    }
}

/// A table with a header and a line for each key.
fn section(inline: InlineTable) -> Table {
    let mut table = inline.into_table();
    table.fmt();
    table
}

/// Where something can be put.
enum Place<'a> {
    Table(&'a mut Table),
    Inline(&'a mut InlineTable),
    Tables(&'a mut ArrayOfTables),
    Array(&'a mut Array),
}

impl<'a> Place<'a> {
    fn of(item: &'a mut Item) -> Option<Self> {
        match item {
            Item::Table(table) => Some(Self::Table(table)),
            Item::ArrayOfTables(tables) => Some(Self::Tables(tables)),
            Item::Value(value) => Self::within(value),
            Item::None => None,
        }
    }

    fn within(value: &'a mut Value) -> Option<Self> {
        match value {
            Value::InlineTable(table) => Some(Self::Inline(table)),
            Value::Array(array) => Some(Self::Array(array)),
            _ => None,
        }
    }

    /// Goes on by a key, or by the name or number of an element. `walked` are the keys so far, this one included.
    fn step(self, step: &str, walked: &str) -> Result<Self, Report> {
        self.has(step, walked)?;
        let index = self.index(step);
        let inner = match self {
            Self::Table(table) => table.get_mut(step).and_then(Self::of),
            Self::Inline(table) => table.get_mut(step).and_then(Self::within),
            Self::Tables(tables) => index.and_then(|index| tables.get_mut(index)).map(Self::Table),
            Self::Array(array) => index.and_then(|index| array.get_mut(index)).and_then(Self::within),
        };
        inner.ok_or_else(|| Report::error(format!("`{walked}` has no keys of its own")))
    }

    /// The element that has this name, or this number, of a list.
    fn index(&self, step: &str) -> Option<usize> {
        let names = self.names()?;
        let number = || step.parse::<usize>().ok()?.checked_sub(1).filter(|&index| index < names.len());
        names.iter().position(|name| *name == Some(step)).or_else(number)
    }

    /// The names of the elements of a list.
    fn names(&self) -> Option<Vec<Option<&str>>> {
        match self {
            Self::Tables(tables) => Some(tables.iter().map(|table| table.get("name")?.as_str()).collect()),
            Self::Array(array) => {
                Some(array.iter().map(|value| value.as_inline_table()?.get("name")?.as_str()).collect())
            }
            Self::Table(_) | Self::Inline(_) => None,
        }
    }

    fn has(&self, step: &str, walked: &str) -> Result<(), Report> {
        let is_there = match self {
            Self::Table(table) => table.contains_key(step),
            Self::Inline(table) => table.contains_key(step),
            Self::Tables(_) | Self::Array(_) => self.index(step).is_some(),
        };
        if is_there {
            return Ok(());
        }
        let known = match self {
            Self::Table(table) => table.iter().map(|(key, _)| key.to_owned()).collect(),
            Self::Inline(table) => table.iter().map(|(key, _)| key.to_owned()).collect(),
            Self::Tables(_) | Self::Array(_) => {
                let names = self.names().unwrap_or_default().into_iter().enumerate();
                names.map(|(at, name)| name.map_or((at + 1).to_string(), str::to_owned)).collect::<Vec<_>>()
            }
        };
        Err(unknown(walked, step, &known))
    }

    /// Gives a key or an element its value.
    fn put(self, key: &str, value: Value, is_section: bool, walked: &str) -> Result<(), Report> {
        let index = self.index(key);
        if index.is_none() && self.names().is_some() {
            return self.has(key, walked);
        }
        match (self, index) {
            (Self::Table(table), _) => put_in_table(table, key, value, is_section),
            (Self::Inline(table), _) => put_in_line(table, key, value),
            (Self::Tables(tables), index) => match (index.and_then(|index| tables.get_mut(index)), value) {
                (Some(old), Value::InlineTable(new)) => replace_section(old, new),
                _ => return Err(Report::error(format!("`{walked}` is a table"))),
            },
            (Self::Array(array), index) => {
                if let Some(old) = index.and_then(|index| array.get_mut(index)) {
                    replace(old, value);
                }
            }
        }
        Ok(())
    }

    /// Takes a key or an element away.
    fn remove(self, key: &str, walked: &str) -> Result<(), Report> {
        self.has(key, walked)?;
        let index = self.index(key).unwrap_or_default();
        match self {
            Self::Table(table) => drop(table.remove(key)),
            Self::Inline(table) => {
                let end = end_of(table);
                table.remove(key);
                if let Some((_, last)) = table.iter_mut().last() {
                    last.decor_mut().set_suffix(end);
                }
            }
            Self::Tables(tables) => drop(tables.remove(index)),
            Self::Array(array) => {
                let first = array.get(0).map(|value| value.decor().clone());
                array.remove(index);
                if index == 0
                    && let (Some(first), Some(value)) = (first, array.get_mut(0))
                {
                    *value.decor_mut() = first;
                }
            }
        }
        Ok(())
    }
}

fn put_in_table(table: &mut Table, key: &str, value: Value, is_section: bool) {
    let is_dotted = table.is_dotted();
    match (table.get_mut(key), value) {
        (Some(Item::Value(old)), value) => replace(old, value),
        (Some(Item::Table(old)), Value::InlineTable(new)) if !old.is_dotted() => replace_section(old, new),
        (None, Value::InlineTable(new)) if is_section && !is_dotted => {
            table.insert(key, Item::Table(section(new)));
        }
        (_, value) => {
            // Its header goes with it, where it has one.
            table.remove(key);
            table.insert(key, Item::Value(value));
        }
    }
}

/// The last value of a table in one line has the room before its bracket.
fn put_in_line(table: &mut InlineTable, key: &str, mut value: Value) {
    if let Some(old) = table.get_mut(key) {
        return replace(old, value);
    }
    let end = end_of(table);
    if let Some((_, last)) = table.iter_mut().last() {
        last.decor_mut().set_suffix("");
    }
    *value.decor_mut() = Decor::new(" ", end);
    table.insert(key, value);
}

fn end_of(table: &InlineTable) -> RawString {
    let end = table.iter().last().and_then(|(_, value)| value.decor().suffix().cloned());
    end.unwrap_or_else(|| " ".into())
}

/// What stands around a value stays.
fn replace(old: &mut Value, mut new: Value) {
    *new.decor_mut() = old.decor().clone();
    *old = new;
}

fn replace_section(old: &mut Table, new: InlineTable) {
    let mut new = section(new);
    *new.decor_mut() = old.decor().clone();
    new.set_position(old.position());
    *old = new;
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::builtin;
    use crate::scene_file::{Syntax, parse, set};

    /// What a person writes in all the ways that TOML has.
    const SCENE: &str = r#"# At the top.
snell = 1
ambient = 0.2 # dim

[render] # how
integrator = "lecture"
size = [
    4, # wide
    4,
]

[camera]
eye = [0, 0, 10]
look_at = [0, 0, 0]
up = [0, 1, 0]
bounds = [-2, 2, -2, 2] # left, right, bottom, top
near = -5

# The lamp.
[[light]]
name = "lamp"
position = [0, 9, 0]
color = 0.5

[material]
"x.y" = { kd = 0.5 }
"a]b=c" = { kd = 0.1, ks = 0.2 }
dotted.kd = 0.3 # dotted

[[sphere]]
name = "2" # a name like a number
center = [0, 0, 0]
radius = 1
material = "x.y"

[[light]]
position = [9, 9, 0]
color = 0.1

[[sphere]]
center = [3, 0, 0]
radius = 1
material = "dotted"
# At the end.
"#;

    fn changed(text: &str, changes: &[(&str, Option<&str>)]) -> Result<String, Report> {
        let changes: Vec<_> =
            changes.iter().map(|(key, value)| ((*key).to_owned(), value.map(str::to_owned))).collect();
        rewrite(&Source::new("scene.toml", text), &changes)
    }

    fn put(text: &str, key: &str, value: &str) -> String {
        changed(text, &[(key, Some(value))]).unwrap()
    }

    #[track_caller]
    fn assert_differs_in(after: &str, before: &str, from: &str, to: &str) {
        assert!(before.matches(from).count() == 1, "`{from}` is there once");
        assert_eq!(after, before.replace(from, to));
        parse(&Source::new("after", after), Syntax::Toml).unwrap();
    }

    #[test]
    fn nothing_but_the_value_changes() {
        for (key, value, from, to) in [
            ("ambient", "0.25", "0.2 # dim", "0.25 # dim"),
            ("camera.bounds", "[-1, 1, -1, 1]", "[-2, 2, -2, 2] #", "[-1, 1, -1, 1] #"),
            ("camera.bounds.2", "3", "-2, 2, -2, 2", "-2, 3, -2, 2"),
            ("render.size.1", "8", "    4, # wide", "    8, # wide"),
            ("light.lamp.color", "[1, 0, 0]", "color = 0.5", "color = [1, 0, 0]"),
            ("light.2.color", "1", "color = 0.1", "color = 1"),
            ("material.\"x.y\".kd", "0.75", "{ kd = 0.5 }", "{ kd = 0.75 }"),
            ("material.\"a]b=c\".kd", "0.75", "kd = 0.1,", "kd = 0.75,"),
            ("material.dotted.kd", "0.4", "0.3 # dotted", "0.4 # dotted"),
            ("render.integrator", "whitted", "\"lecture\"", "\"whitted\""),
            // The name goes before the number.
            ("sphere.2.center", "[1, 1, 1]", "center = [0, 0, 0]", "center = [1, 1, 1]"),
            ("sphere.1.name", "ball", "name = \"2\" # a", "name = \"ball\" # a"),
        ] {
            assert_differs_in(&put(SCENE, key, value), SCENE, from, to);
        }
    }

    #[test]
    fn what_is_left_out_is_added_to_its_table() {
        for (key, value, from, to) in [
            ("eta_outside", "1.5", "0.2 # dim\n", "0.2 # dim\neta_outside = 1.5\n"),
            ("render.spp", "4", "    4,\n]\n", "    4,\n]\nspp = 4\n"),
            ("material.\"x.y\".ks", "1", "{ kd = 0.5 }", "{ kd = 0.5, ks = 1 }"),
            ("material.dotted.ks", "1", "0.3 # dotted\n", "0.3 # dotted\ndotted.ks = 1\n"),
            ("light.2.name", "fill", "color = 0.1\n", "color = 0.1\nname = \"fill\"\n"),
            (
                "light",
                "{ position = [1, 2, 3], color = 1 }",
                "color = 0.1\n",
                "color = 0.1\n\n[[light]]\nposition = [1, 2, 3]\ncolor = 1\n",
            ),
            (
                "sphere.1.transform",
                "[{ scale = [2, 2, 2] }]",
                "material = \"x.y\"\n",
                "material = \"x.y\"\ntransform = [{ scale = [2, 2, 2] }]\n",
            ),
        ] {
            assert_differs_in(&put(SCENE, key, value), SCENE, from, to);
        }
        // A table that the scene has nothing of yet, and one with a name that needs quotes.
        for (key, value, section) in [
            (
                "disc",
                "{ center = [0, 0, 0], normal = [0, 1, 0], radius = 1, material = \"dotted\" }",
                "\n[[disc]]\ncenter = [0, 0, 0]\n",
            ),
            ("texture.\"a b\"", "{ checker = [0, 1] }", "\n[texture.\"a b\"]\nchecker = [0, 1]\n"),
            ("material.new", "{ kd = 1 }", "\n[material.new]\nkd = 1\n"),
        ] {
            let text = put(SCENE, key, value);
            assert!(text.contains(section), "{text}");
            parse(&Source::new("after", &*text), Syntax::Toml).unwrap();
        }
    }

    #[test]
    fn settings_may_be_dotted_or_in_one_line() {
        let (table, rest) = (SCENE.find("[render]").unwrap(), SCENE.find("[camera]").unwrap());
        for (render, with_spp) in [
            ("render = { integrator = \"lecture\", size = [4, 4] }\n", "size = [4, 4], spp = 4 }\n"),
            ("render.integrator = \"lecture\"\nrender.size = [4, 4]\n", "render.size = [4, 4]\nrender.spp = 4\n"),
        ] {
            let text = format!("{}{render}{}", &SCENE[..table], &SCENE[rest..]);
            let after = put(&text, "render.spp", "4");
            assert!(after.contains(with_spp), "{after}");
            assert_eq!(changed(&after, &[("render.spp", None)]).unwrap(), text);
        }
    }

    #[test]
    fn what_is_taken_away_is_gone_and_nothing_else() {
        for (key, gone) in [
            ("ambient", "ambient = 0.2 # dim\n"),
            ("camera.near", "near = -5\n"),
            ("light.lamp", "\n# The lamp.\n[[light]]\nname = \"lamp\"\nposition = [0, 9, 0]\ncolor = 0.5\n"),
            ("light.2.color", "color = 0.1\n"),
            ("material.\"a]b=c\".ks", ", ks = 0.2"),
            ("material.\"a]b=c\".kd", " kd = 0.1,"),
            ("material.dotted", "dotted.kd = 0.3 # dotted\n"),
        ] {
            assert_eq!(changed(SCENE, &[(key, None)]).unwrap(), SCENE.replace(gone, ""), "{key}");
        }
        let none = changed(SCENE, &[("sphere.1", None), ("sphere.1", None)]).unwrap();
        assert!(!none.contains("sphere") && none.contains("# At the end."), "{none}");
        let again = put(&none, "sphere", "{ center = [0, 0, 0], radius = 1, material = \"dotted\" }");
        assert_eq!(parse(&Source::new("again", &*again), Syntax::Toml).unwrap().spheres.len(), 1);
    }

    #[track_caller]
    fn assert_ends(text: &str, end: &str) {
        assert!(text.trim_end().ends_with(end), "{text}");
    }

    #[test]
    fn lists_in_one_line_stay_so() {
        let text = "snell = 1\nsphere = [{ name = \"a\", radius = 1 }, { radius = 2 }] # two\n";
        assert_ends(&put(text, "sphere.a.radius", "3"), "[{ name = \"a\", radius = 3 }, { radius = 2 }] # two");
        assert_ends(&put(text, "sphere", "{ radius = 3 }"), "radius = 1 }, { radius = 2 }, { radius = 3 }] # two");
        assert_ends(&changed(text, &[("sphere.1", None)]).unwrap(), "sphere = [{ radius = 2 }] # two");
    }

    #[test]
    fn a_list_may_be_replaced() {
        let text = put(SCENE, "light", "[{ position = [1, 2, 3], color = 1 }]");
        let lights = parse(&Source::new("after", &*text), Syntax::Toml).unwrap().lights;
        assert_eq!((lights.len(), lights[0].name.as_deref()), (1, None), "{text}");
    }

    #[test]
    fn what_leads_nowhere_is_refused() {
        for (key, value, message) in [
            ("material.glas.eta", Some("2"), "no `material.glas`"),
            ("sphere.3.radius", Some("2"), "no `sphere.3`"),
            ("sphere.0", Some("{}"), "no `sphere.0`"),
            ("sphere.radius", Some("2"), "no `sphere.radius`"),
            ("sphere.1", Some("2"), "`sphere.1` is a table"),
            ("camera.eye.4", Some("2"), "no `camera.eye.4`"),
            ("camera.eye.0", None, "no `camera.eye.0`"),
            ("camera.near.x", Some("2"), "`camera.near` has no keys"),
            ("camera.far", None, "no `camera.far`"),
            ("mesh.1", None, "no `mesh`"),
            ("sky.color", Some("1"), "no `sky`"),
            ("", Some("1"), "no key"),
            ("a b", Some("1"), "no key"),
        ] {
            let report = changed(SCENE, &[("ambient", Some("1")), (key, value)]).unwrap_err();
            assert!(report.message.contains(message), "{key}: {report}");
        }
        assert!(changed("snell = ", &[]).unwrap_err().place.is_some());
    }

    /// Values cannot break out of their place.
    #[test]
    fn what_is_no_toml_is_a_text() {
        for value in ["1\n[render]", "1 # no", "\"", "{", "]", "", "\u{0}", "1\nspp = 9", "é\"\\"] {
            let text = put(SCENE, "light.lamp.name", value);
            let scene = parse(&Source::new("after", &*text), Syntax::Toml).unwrap();
            assert_eq!(scene.lights[0].name.as_deref(), Some(value.trim()), "{text}");
            assert_eq!(put(&text, "light.1.name", "lamp"), SCENE);
        }
    }

    /// The text with a change means what the scene with that change is, where both take it.
    #[test]
    fn it_agrees_with_set() {
        let mut both = 0;
        for (name, text) in builtin::SCENES.iter().copied().chain([("all ways", SCENE)]) {
            let source = Source::new(name, text);
            let before = parse(&source, Syntax::Toml).unwrap();
            let material = before.materials.keys().next().map_or("", String::as_str);
            for change in [
                "ambient=0.5",
                "background=[0, 0, 1]",
                "eta_outside=1.3",
                "sky={ zenith = [0, 0, 1], horizon = 1 }",
                "render.spp=4",
                "render.max_depth=3",
                "render.integrator=whitted",
                "render.size=[8, 8]",
                "render.size.2=9",
                "render.shadows=off",
                "camera.eye.3=7",
                "camera.near=-4",
                "camera.bounds=[-3, 3, -3, 3]",
                "light.1.color=[1, 0.5, 0]",
                "light.1={ position = [1, 2, 3], color = 1 }",
                "light=[]",
                "light=[{ position = [1, 2, 3], color = 1, name = 'new' }]",
                "sphere.1.radius=0.5",
                "sphere.1.center.2=-1e-3",
                "sphere.1.name=other",
                "mesh.1.transform=[{ scale = [2, 2, 2] }]",
                "mesh.1.smooth_angle=30",
                "plane.1.size=[1, 2]",
                "material.new={ kd = 0.5, eta = 1.5 }",
                &format!("material.\"{material}\".eta=2.42"),
                &format!("material.\"{material}\".kd=[0.1, 0.2, 0.3]"),
                &format!("material.\"{material}\".nothing=1"),
                &format!("material.\"{material}\"={{ ko = 1 }}"),
                "texture.new={ checker = [0, 1] }",
            ] {
                let (key, value) = change.split_once('=').unwrap();
                let mut scene = before.clone();
                let expected = set(&mut scene, change);
                let read = changed(text, &[(key, Some(value))])
                    .and_then(|text| parse(&Source::new("after", text), Syntax::Toml));
                if let (Ok(_), Ok(read)) = (expected, read) {
                    assert_eq!(read, scene, "{name}: {change}");
                    both += 1;
                }
            }
        }
        assert!(both > 18 * builtin::SCENES.len(), "{both}");
    }
}
