//! Many pictures of one scene: what changes from one to the next, and what each is called. Nothing is read or written here.
//!
//! ```text
//!  material.glass.eta=1.3:1.7:9 ── values ─▶ axes ────┐
//!  key frames, a text           ── keys ───▶ tracks ──┴─▶ picture number n: a list of changes (`--set`), and a name ── pattern
//! ```
//!
//! All combinations of the values of all axes are drawn, the last axis fastest, and each as a whole movie if there are key frames.

mod keys;
mod pattern;
#[cfg(test)]
mod tests;
mod values;

use crate::report::{Report, Source};
use crate::scene_file;
use keys::KeyFrames;
pub use pattern::escaped;
use snell::scene::Scene;
use std::ops::Range;
use values::Axis;

/// More pictures than this are refused.
pub const MOST_PICTURES: usize = 1_000_000;

/// The pictures that are asked for.
#[derive(Debug)]
pub struct Sweep {
    axes: Vec<Axis>,
    keys: Option<KeyFrames>,
    /// The first frame and the last one.
    frames: [u32; 2],
    count: usize,
}

impl Sweep {
    /// All combinations of `axes`, each `KEY=VALUES`, and the frames from the first to the last of `frames` by the key frames in a
    /// text. `VALUES` are `A:B:N`, N numbers evenly from A to B, or a TOML array with an element for each picture. Left out, frames
    /// are those from the first key frame to the last.
    ///
    /// # Errors
    /// When one of them cannot be read, two change the same value, or there would be more than [`MOST_PICTURES`].
    pub fn new(axes: &[String], keys: Option<&Source>, frames: Option<[u32; 2]>) -> Result<Self, Report> {
        let axes: Vec<Axis> = axes.iter().map(|text| Axis::parse(text)).collect::<Result<_, _>>()?;
        let keys = keys.map(KeyFrames::parse).transpose()?;
        refuse_overlap(axes.iter().map(|axis| &axis.key).chain(keys.iter().flat_map(KeyFrames::scene_keys)))?;
        let frames = frames.or(keys.as_ref().map(KeyFrames::range)).unwrap_or([0, 0]);
        if frames[0] > frames[1] {
            let message = format!("frames go from the first to the last, and {} is behind {}", frames[0], frames[1]);
            return Err(Report::error(message));
        }
        let frame_count = usize::try_from(u64::from(frames[1] - frames[0]) + 1).unwrap_or(usize::MAX);
        let count = axes.iter().try_fold(frame_count, |count, axis| count.checked_mul(axis.values.len()));
        let Some(count) = count.filter(|count| *count <= MOST_PICTURES) else {
            let factors = axes.iter().map(|axis| axis.values.len()).chain(keys.is_some().then_some(frame_count));
            let factors: Vec<String> = factors.map(|factor| factor.to_string()).collect();
            let message = format!("{} pictures are more than {MOST_PICTURES}", factors.join(" x "));
            return Err(Report::error(message).help("ask for fewer values or frames"));
        };
        Ok(Self { axes, keys, frames, count })
    }

    /// How many pictures there are, at least one.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The changes of the scene that make picture `number`, counted from 0.
    pub fn changes(&self, number: usize) -> Vec<String> {
        let of_axis = |(axis, value): (&Axis, usize)| format!("{}={}", axis.key.text, axis.values[value].text);
        let mut changes: Vec<String> = self.axes.iter().zip(self.steps(number)).map(of_axis).collect();
        if let Some(keys) = &self.keys {
            changes.extend(keys.changes(self.frame(number)));
        }
        changes
    }

    /// Is any value a text, or made of texts? Others name no files, so that all pictures read the same ones.
    pub fn has_texts(&self) -> bool {
        let is_text = |text: &str| text.contains(['"', '\'']);
        self.axes.iter().flat_map(|axis| &axis.values).any(|value| is_text(&value.text))
            || self.keys.as_ref().is_some_and(|keys| keys.held().any(is_text))
    }

    /// Do all pictures have the same shapes in the same places, so that they may share a tree over them?
    pub fn keeps_shapes(&self) -> bool {
        let keys = self.axes.iter().map(|axis| &axis.key).chain(self.keys.iter().flat_map(KeyFrames::scene_keys));
        let is_shape = |key: &SceneKey| SHAPES.contains(&key.parts[0].as_str());
        !keys.into_iter().any(is_shape)
    }

    /// Makes the changes in a copy of the scene, to find those that it does not take: each of the first values of an axis, and each
    /// key frame.
    ///
    /// # Errors
    /// The first that is none, at its place.
    pub fn check(&self, scene: &Scene) -> Result<(), Report> {
        let mut scene = scene.clone();
        for axis in &self.axes {
            for value in axis.values.iter().take(MOST_CHECKED) {
                let change = format!("{}={}", axis.key.text, value.text);
                scene_file::set(&mut scene, &change)?;
            }
        }
        self.keys.as_ref().map_or(Ok(()), |keys| keys.check(&mut scene))
    }

    fn is_movie(&self) -> bool {
        self.keys.is_some()
    }

    fn frame_count(&self) -> usize {
        (self.frames[1] - self.frames[0]) as usize + 1
    }

    /// The frame that a picture shows, if there are key frames.
    fn frame(&self, number: usize) -> u32 {
        self.frames[0] + (number % self.frame_count()) as u32
    }

    /// The number of the value of each axis.
    fn steps(&self, number: usize) -> Vec<usize> {
        let mut rest = number / self.frame_count();
        let step = |axis: &Axis| {
            let step = rest % axis.values.len();
            rest /= axis.values.len();
            step
        };
        let mut steps: Vec<usize> = self.axes.iter().rev().map(step).collect();
        steps.reverse();
        steps
    }
}

/// The lists of shapes in a scene.
const SHAPES: [&str; 6] = ["sphere", "mesh", "plane", "box", "disc", "lathe"];

/// So many values of an axis are tried before anything is drawn.
const MOST_CHECKED: usize = 1000;

/// A key of the scene, as it is written and taken apart at its dots, and where.
#[derive(Debug)]
struct SceneKey {
    text: String,
    parts: Vec<String>,
    source: Source,
    range: Range<usize>,
}

impl SceneKey {
    fn error(&self, message: impl Into<String>) -> Report {
        Report::error(message).at(&self.source, self.range.clone())
    }
}

/// Refuses two that would change the same value: nobody could tell which one counts.
fn refuse_overlap<'a>(keys: impl Iterator<Item = &'a SceneKey>) -> Result<(), Report> {
    let mut sorted: Vec<&SceneKey> = keys.collect();
    // Whatever begins with a key follows it at once.
    sorted.sort_by(|a, b| a.parts.cmp(&b.parts));
    let twice = sorted.windows(2).find(|pair| pair[1].parts.starts_with(&pair[0].parts));
    twice.map_or(Ok(()), |pair| {
        let (a, b) = (&pair[0].text, &pair[1].text);
        let message =
            if a == b { format!("`{a}` is changed twice") } else { format!("`{a}` and `{b}` change the same value") };
        Err(pair[1].error(message).help("leave one of them out"))
    })
}
