//! Key frames: values of the scene at some frames, and how they go from one to the next.

use super::SceneKey;
use super::values::{MOST_WHOLE, is_finite, number_text, plain};
use crate::report::{Report, Source, known_names};
use crate::scene_file;
use snell::scene::Scene;
use std::collections::BTreeMap;
use std::ops::Range;
use toml_edit::{Document, Item, Key, TableLike, Value};

const EXPECTED: &str = "like [[frame]] with at = 1 and camera.eye = [0, 0, 9]";

/// How values go from one key frame to the next.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Interpolation {
    Step,
    Linear,
    Smooth,
}

const INTERPOLATIONS: [(&str, Interpolation); 3] =
    [("linear", Interpolation::Linear), ("smooth", Interpolation::Smooth), ("step", Interpolation::Step)];

/// A file of key frames.
#[derive(Debug)]
pub(super) struct KeyFrames {
    interpolation: Interpolation,
    tracks: Vec<Track>,
    range: [u32; 2],
}

/// One key of the scene through the key frames that name it, in their order.
#[derive(Debug)]
struct Track {
    key: SceneKey,
    frames: Vec<u32>,
    /// Where each value stands.
    places: Vec<Range<usize>>,
    values: Values,
}

#[derive(Debug)]
enum Values {
    /// Interpolated number by number.
    Numbers { shape: Shape, at: Vec<Vec<f64>> },
    /// Each holds until the next one.
    Others(Vec<String>),
}

/// How numbers are put into lists.
#[derive(Clone, Debug, PartialEq, Eq)]
enum Shape {
    One,
    List(Vec<Shape>),
}

/// What one frame says of one key, and where.
struct Said {
    value: Value,
    range: Range<usize>,
}

impl KeyFrames {
    pub fn parse(source: &Source) -> Result<Self, Report> {
        scene_file::enough_memory(source)?;
        let document = Document::parse(source.text.as_ref()).map_err(|e| {
            let message = e.message().lines().next().unwrap_or_default().to_owned();
            Report::error(message).at(source, e.span().unwrap_or(0..0))
        })?;
        let root = document.as_table();
        if let Some((key, item)) = root.iter().find(|(key, _)| !["interpolation", "frame"].contains(key)) {
            let report = Report::error(format!("unknown key `{key}`"));
            let help =
                format!("{}; keys of the scene stand in a [[frame]]", known_names(key, ["interpolation", "frame"]));
            return Err(report.help(help).at(source, place(root, key, item)));
        }
        let interpolation = interpolation(root.get("interpolation"), source)?;
        let mut frames = BTreeMap::new();
        for (table, range) in tables(root, source)? {
            let frame = at(table, &range, source)?;
            if frames.insert(frame, table).is_some() {
                let report = Report::error(format!("two key frames are at {frame}"));
                return Err(report.help("join them, or move one").at(source, place_of(table, "at", range)));
            }
        }
        let (first, last) = (frames.keys().next().copied(), frames.keys().next_back().copied());
        let (Some(first), Some(last)) = (first, last) else {
            return Err(Report::error("there is no key frame").help(EXPECTED).at(source, 0..0));
        };
        Ok(Self { interpolation, tracks: tracks(&frames, source)?, range: [first, last] })
    }

    /// The first key frame and the last.
    pub fn range(&self) -> [u32; 2] {
        self.range
    }

    pub fn scene_keys(&self) -> impl Iterator<Item = &SceneKey> {
        self.tracks.iter().map(|track| &track.key)
    }

    /// All values that are not made of numbers, as TOML.
    pub fn held(&self) -> impl Iterator<Item = &str> {
        let tracks = self.tracks.iter().filter_map(|track| match &track.values {
            Values::Numbers { .. } => None,
            Values::Others(texts) => Some(texts),
        });
        tracks.flatten().map(String::as_str)
    }

    /// The changes that make a frame.
    pub fn changes(&self, frame: u32) -> impl Iterator<Item = String> {
        self.tracks.iter().map(move |track| format!("{}={}", track.key.text, track.at(frame, self.interpolation)))
    }

    /// Makes the changes of all key frames, one by one.
    pub fn check(&self, scene: &mut Scene) -> Result<(), Report> {
        for track in &self.tracks {
            for (&frame, range) in track.frames.iter().zip(&track.places) {
                let change = format!("{}={}", track.key.text, track.at(frame, self.interpolation));
                scene_file::set(scene, &change).map_err(|report| report.at(&track.key.source, range.clone()))?;
            }
        }
        Ok(())
    }
}

fn interpolation(item: Option<&Item>, source: &Source) -> Result<Interpolation, Report> {
    let Some(item) = item else { return Ok(Interpolation::Linear) };
    let word = item.as_str().unwrap_or_default();
    let found = INTERPOLATIONS.into_iter().find(|(name, _)| *name == word);
    found.map(|(_, interpolation)| interpolation).ok_or_else(|| {
        let read = item.as_value().map(plain).unwrap_or_default();
        let report = Report::error(format!("expected an interpolation, read `{read}`"));
        report.help(known_names(word, INTERPOLATIONS.map(|(name, _)| name))).at(source, item.span().unwrap_or(0..0))
    })
}

/// A key frame, and where it stands.
type PlacedTable<'a> = (&'a dyn TableLike, Range<usize>);

/// The key frames, as they stand in the file.
fn tables<'a>(root: &'a dyn TableLike, source: &Source) -> Result<Vec<PlacedTable<'a>>, Report> {
    match root.get("frame") {
        None => Ok(Vec::new()),
        Some(Item::ArrayOfTables(tables)) => {
            Ok(tables.iter().map(|table| (table as &dyn TableLike, table.span().unwrap_or(0..0))).collect())
        }
        Some(item) => {
            let wrong = || {
                let report = Report::error("`frame` is a list of key frames");
                report.help("write [[frame]] with two brackets").at(source, item.span().unwrap_or(0..0))
            };
            let of = |value: &'a Value| {
                let table = value.as_inline_table().ok_or_else(wrong)?;
                Ok((table as &dyn TableLike, value.span().unwrap_or(0..0)))
            };
            item.as_array().ok_or_else(wrong)?.iter().map(of).collect()
        }
    }
}

/// The number of a key frame.
fn at(table: &dyn TableLike, range: &Range<usize>, source: &Source) -> Result<u32, Report> {
    let help = "a key frame says where it is, with a whole number from 0: at = 1";
    let Some(item) = table.get("at") else {
        return Err(Report::error("`at` is missing").help(help).at(source, range.clone()));
    };
    let number = item.as_integer().and_then(|number| u32::try_from(number).ok());
    number.ok_or_else(|| {
        let read = item.as_value().map(plain).unwrap_or_default();
        let message = format!("expected the number of a frame from 0 to {}, read `{read}`", u32::MAX);
        Report::error(message).help(help).at(source, place_of(table, "at", range.clone()))
    })
}

fn place(table: &dyn TableLike, key: &str, item: &Item) -> Range<usize> {
    item.span().or_else(|| table.key(key).and_then(Key::span)).unwrap_or(0..0)
}

/// Where the value of a key stands, or else the whole.
fn place_of(table: &dyn TableLike, key: &str, whole: Range<usize>) -> Range<usize> {
    table.get(key).and_then(Item::span).unwrap_or(whole)
}

fn tracks(frames: &BTreeMap<u32, &dyn TableLike>, source: &Source) -> Result<Vec<Track>, Report> {
    let mut said: BTreeMap<Vec<String>, Vec<(u32, Said)>> = BTreeMap::new();
    for (&frame, table) in frames {
        let mut found = Vec::new();
        walk(*table, &mut Vec::new(), source, &mut found)?;
        for (parts, value) in found.into_iter().filter(|(parts, _)| *parts != ["at"]) {
            said.entry(parts).or_default().push((frame, value));
        }
    }
    if said.is_empty() {
        return Err(Report::error("no key frame changes anything").help(EXPECTED).at(source, 0..0));
    }
    said.into_iter().map(|(parts, said)| Track::new(parts, said, source)).collect()
}

/// The values in a table and in the tables in it: `camera.eye = …` and `camera = { eye = … }` are the same.
fn walk(
    table: &dyn TableLike,
    path: &mut Vec<String>,
    source: &Source,
    found: &mut Vec<(Vec<String>, Said)>,
) -> Result<(), Report> {
    for (key, item) in table.iter() {
        path.push(key.to_owned());
        let range = place(table, key, item);
        match (item.as_table_like(), item) {
            (Some(inner), _) => walk(inner, path, source, found)?,
            (None, Item::Value(value)) => {
                if !is_finite(value) {
                    let message = format!("expected finite numbers, read `{}`", plain(value));
                    return Err(Report::error(message).at(source, range));
                }
                found.push((path.clone(), Said { value: value.clone(), range }));
            }
            (None, _) => {
                let message =
                    format!("a key frame changes single values, and `{}` is a list of tables", path.join("."));
                let help = format!("name an element by its name or number, like {}.1.KEY", path.join("."));
                return Err(Report::error(message).help(help).at(source, range));
            }
        }
        path.pop();
    }
    Ok(())
}

impl Track {
    fn new(parts: Vec<String>, said: Vec<(u32, Said)>, source: &Source) -> Result<Self, Report> {
        let text: Vec<_> = parts.iter().map(|part| Key::new(part).display_repr().into_owned()).collect();
        let range = said.first().map_or(0..0, |(_, said)| said.range.clone());
        let key = SceneKey { text: text.join("."), parts, source: source.clone(), range };
        let mut numbers = Vec::new();
        for (frame, Said { value, range }) in &said {
            let mut values = Vec::new();
            let Some(shape) = shape(value, &mut values) else { continue };
            if let Some(odd) = values.iter().find(|number| number.abs() > MOST_NUMBER) {
                let message = format!("expected numbers of at most {MOST_NUMBER:e}, read {odd:e}");
                return Err(Report::error(message).at(source, range.clone()));
            }
            numbers.push((*frame, shape, values, range.clone()));
        }
        let values = match numbers.first() {
            Some((first, shape, ..)) if numbers.len() == said.len() => {
                if let Some((frame, other, _, range)) = numbers.iter().find(|(_, other, ..)| other != shape) {
                    let (a, b) = (shape.words(), other.words());
                    let message = format!("`{}` is {a} at frame {first} and {b} at frame {frame}", key.text);
                    let help = "nothing lies between them: write both alike";
                    return Err(Report::error(message).help(help).at(source, range.clone()));
                }
                let shape = shape.clone();
                Values::Numbers { shape, at: numbers.into_iter().map(|(_, _, values, _)| values).collect() }
            }
            _ => Values::Others(said.iter().map(|(_, said)| plain(&said.value)).collect()),
        };
        let (frames, places) = said.into_iter().map(|(frame, said)| (frame, said.range)).unzip();
        Ok(Self { key, frames, places, values })
    }

    /// The value at a frame, as TOML.
    fn at(&self, frame: u32, interpolation: Interpolation) -> String {
        let behind = self.frames.partition_point(|at| *at <= frame);
        // Before the first key frame it is what it is there.
        let before = behind.saturating_sub(1);
        let is_at_key = behind == 0 || behind == self.frames.len() || self.frames[before] == frame;
        let (shape, at) = match &self.values {
            Values::Others(texts) => return texts[before].clone(),
            Values::Numbers { shape, at } => (shape, at),
        };
        let value = |part: usize| match interpolation {
            _ if is_at_key => at[before][part],
            Interpolation::Step => at[before][part],
            Interpolation::Linear => {
                let (a, b) = (at[before][part], at[behind][part]);
                let [start, end] = [before, behind].map(|key| f64::from(self.frames[key]));
                a + (b - a) * ((f64::from(frame) - start) / (end - start))
            }
            Interpolation::Smooth => {
                let keys = before.saturating_sub(1)..(behind + 2).min(at.len());
                let points: Vec<[f64; 2]> =
                    keys.clone().map(|key| [f64::from(self.frames[key]), at[key][part]]).collect();
                smooth(&points, before - keys.start, frame.into())
            }
        };
        let mut parts = 0..at[before].len();
        shape.text(&mut || parts.next().map_or_else(String::new, |part| number_text(value(part))))
    }
}

/// Larger numbers could overflow between key frames.
const MOST_NUMBER: f64 = 1e300;

/// A cubic from point `start` to the next one: time and value each. Its slope at a point is that of the parabola through the point and
/// its neighbours (Catmull-Rom for uneven times); at the ends of a track that of the parabola through the three points there.
/// Parabolas and lines stay what they are.
fn smooth(points: &[[f64; 2]], start: usize, time: f64) -> f64 {
    let [[t0, v0], [t1, v1]] = [points[start], points[start + 1]];
    let slope = |key: usize| {
        let first = key.saturating_sub(1).min(points.len().saturating_sub(3));
        match points[first..] {
            [a, b, c, ..] => parabola_slope([a, b, c], points[key][0]),
            _ => (v1 - v0) / (t1 - t0),
        }
    };
    let length = t1 - t0;
    let u = (time - t0) / length;
    let (slope0, slope1) = (slope(start), slope(start + 1));
    // Hermite's form, written so that what does not change stays what it is.
    v0 + (v1 - v0) * (u * u * (3.0 - 2.0 * u)) + length * u * (1.0 - u) * (slope0 * (1.0 - u) - slope1 * u)
}

/// The slope of the parabola through three points at a time.
fn parabola_slope([[ta, a], [tb, b], [tc, c]]: [[f64; 2]; 3], time: f64) -> f64 {
    let (left, right) = ((b - a) / (tb - ta), (c - b) / (tc - tb));
    left + (right - left) * ((2.0 * time - ta - tb) / (tc - ta))
}

/// The numbers of a value, if it is made of numbers only.
fn shape(value: &Value, numbers: &mut Vec<f64>) -> Option<Shape> {
    match value {
        // A whole number that is none of `f64` holds, bits included.
        Value::Integer(whole) => {
            (whole.value().unsigned_abs() <= MOST_WHOLE as u64).then(|| numbers.push(*whole.value() as f64))?;
            Some(Shape::One)
        }
        Value::Float(float) => {
            numbers.push(*float.value());
            Some(Shape::One)
        }
        Value::Array(array) => Some(Shape::List(array.iter().map(|v| shape(v, numbers)).collect::<Option<_>>()?)),
        _ => None,
    }
}

impl Shape {
    fn text(&self, number: &mut impl FnMut() -> String) -> String {
        match self {
            Self::One => number(),
            Self::List(shapes) => {
                let parts: Vec<String> = shapes.iter().map(|shape| shape.text(number)).collect();
                format!("[{}]", parts.join(", "))
            }
        }
    }

    fn words(&self) -> String {
        match self {
            Self::One => "a number".to_owned(),
            Self::List(shapes) => format!("a list of {}", shapes.len()),
        }
    }
}
