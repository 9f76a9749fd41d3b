//! What pictures are called: `glass_{frame}_{eta}.exr`.

use super::Sweep;
use crate::report::{Report, Source, known_names, list};
use std::collections::HashMap;
use std::path::{Component, Path, PathBuf};
use toml_edit::Key;

/// Longer names of files are refused: most disks take 255 bytes, of which claims need some.
const MOST_BYTES: usize = 240;

/// A part of a pattern.
enum Part {
    Text(String),
    Frame,
    Index,
    /// The value of an axis.
    Axis(usize),
}

impl Sweep {
    /// The pattern of who names none: the scene, the frame, and all values.
    pub fn usual_pattern(&self, stem: &str, ending: &str) -> String {
        let frame = self.is_movie().then(|| "frame".to_owned());
        let keys = self.axes.iter().map(|axis| axis.key.text.clone());
        let parts: Vec<String> = frame.into_iter().chain(keys).map(|part| format!("_{{{part}}}")).collect();
        format!("{}{}.{ending}", escaped(stem), parts.concat())
    }

    /// The names of all pictures, by a pattern: `{frame}` and `{index}` are padded with zeros, `{KEY}` is the value of a key, which
    /// may be named by its last part, and `{{` and `}}` are braces.
    ///
    /// # Errors
    /// When a placeholder is unknown, a value is no part of a name, two pictures would get one name, or a picture of that ending
    /// could not tell whether it is finished.
    pub fn names(&self, pattern: &str) -> Result<Vec<PathBuf>, Report> {
        let source = Source::new("-o", pattern);
        let at = |report: Report| report.at(&source, 0..pattern.len());
        let parts = self.parts(pattern).map_err(at)?;
        let mut names = Vec::with_capacity(self.count);
        let mut taken: HashMap<PathBuf, usize> = HashMap::with_capacity(self.count);
        for number in 0..self.count {
            let name = PathBuf::from(self.name(&parts, number).map_err(at)?);
            check(&name, Path::new(pattern)).map_err(at)?;
            if let Some(other) = taken.insert(name.clone(), number) {
                let message = format!("pictures {other} and {number} would both be `{}`", name.display());
                let help = format!(
                    "put what tells them apart into -o: {}",
                    list(self.placeholders().iter().map(String::as_str))
                );
                return Err(at(Report::error(message).help(help)));
            }
            names.push(name);
        }
        Ok(names)
    }

    fn name(&self, parts: &[Part], number: usize) -> Result<String, Report> {
        let steps = self.steps(number);
        let padded = |number: usize, largest: usize| format!("{number:0w$}", w = largest.to_string().len());
        let mut name = String::new();
        for part in parts {
            match part {
                Part::Text(text) => name += text,
                Part::Frame => name += &padded(self.frame(number) as usize, self.frames[1] as usize),
                Part::Index => name += &padded(number, self.count - 1),
                Part::Axis(axis) => match &self.axes[*axis].values[steps[*axis]].name {
                    Ok(value) => name += value,
                    Err(why) => {
                        let help = "name the pictures by {index}, which counts them from 0";
                        return Err(Report::error(why.as_str()).help(help));
                    }
                },
            }
        }
        Ok(name)
    }

    /// Takes a pattern apart.
    fn parts(&self, pattern: &str) -> Result<Vec<Part>, Report> {
        let (mut parts, mut text, mut rest) = (Vec::new(), String::new(), pattern);
        while let Some(brace) = rest.find(['{', '}']) {
            text += &rest[..brace];
            let (this, behind) = (&rest[brace..=brace], &rest[brace + 1..]);
            if behind.starts_with(this) {
                text += this;
                rest = &behind[1..];
                continue;
            }
            let end = behind.find('}').filter(|_| this == "{");
            let Some(end) = end else {
                let message = format!("`{this}` in `{pattern}` has no other brace");
                return Err(Report::error(message).help("for a brace in a name write two of them: {{ or }}"));
            };
            parts.push(Part::Text(std::mem::take(&mut text)));
            parts.push(self.part(&behind[..end])?);
            rest = &behind[end + 1..];
        }
        parts.push(Part::Text(text + rest));
        Ok(parts)
    }

    fn part(&self, name: &str) -> Result<Part, Report> {
        match name {
            "frame" if self.is_movie() => return Ok(Part::Frame),
            "index" => return Ok(Part::Index),
            _ => {}
        }
        let keys = Key::parse(name).unwrap_or_default();
        let keys: Vec<&str> = keys.iter().map(Key::get).collect();
        if let Some(axis) = self.axes.iter().position(|axis| axis.key.parts == keys) {
            return Ok(Part::Axis(axis));
        }
        let ends = |parts: &[String]| matches!(keys.as_slice(), [key] if parts.last().is_some_and(|last| last == key));
        let found: Vec<usize> = (0..self.axes.len()).filter(|axis| ends(&self.axes[*axis].key.parts)).collect();
        match found.as_slice() {
            [axis] => Ok(Part::Axis(*axis)),
            [] => {
                let known = self.placeholders();
                let names = known.iter().map(|name| name.trim_matches(['{', '}']));
                let mut help = known_names(name, names);
                if name == "frame" {
                    help += "; frames come with --keys";
                }
                Err(Report::error(format!("`{{{name}}}` is nothing that changes from picture to picture")).help(help))
            }
            several => {
                let full: Vec<String> =
                    several.iter().map(|axis| format!("{{{}}}", self.axes[*axis].key.text)).collect();
                Err(Report::error(format!("`{{{name}}}` may be {}", full.join(" or "))).help("name one in full"))
            }
        }
    }

    /// All placeholders that make a difference; keys by their last part where no other ends with it.
    fn placeholders(&self) -> Vec<String> {
        let is_alone = |last: &String| self.axes.iter().filter(|axis| axis.key.parts.last() == Some(last)).count() == 1;
        let short = |last: &&String| is_alone(last) && Key::new(last.as_str()).display_repr() == last.as_str();
        let keys = self.axes.iter().map(|axis| match axis.key.parts.last().filter(short) {
            Some(last) => format!("{{{last}}}"),
            None => format!("{{{}}}", axis.key.text),
        });
        let frame = self.is_movie().then(|| "{frame}".to_owned());
        frame.into_iter().chain(keys).chain(["{index}".to_owned()]).collect()
    }
}

/// A text in which braces are meant as they are.
pub fn escaped(text: &str) -> String {
    text.replace('{', "{{").replace('}', "}}")
}

/// Refuses names that are no files, lead elsewhere than the pattern, or end wrongly.
fn check(name: &Path, pattern: &Path) -> Result<(), Report> {
    let shown = name.display();
    let ending = name.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    if !["png", "exr"].contains(&ending.as_str()) {
        let report = Report::error(format!("`{shown}` does not end with .png or .exr"));
        return Err(report.help("only these remember how they were made, by which one that is finished is known"));
    }
    let is_too_long = |part: &std::ffi::OsStr| part.len() > MOST_BYTES;
    if name.iter().any(is_too_long) || name.as_os_str().len() > 16 * MOST_BYTES {
        let message = format!("`{shown}` is too long for the name of a file");
        return Err(
            Report::error(message).help(format!("a part of it may have {MOST_BYTES} bytes; {{index}} is short"))
        );
    }
    // A value that is `.` or `..` leaves fewer names, or leads up.
    let leads_up =
        |(part, of_pattern): (Component<'_>, Component<'_>)| part == Component::ParentDir && of_pattern != part;
    if name.components().count() != pattern.components().count()
        || name.components().zip(pattern.components()).any(leads_up)
    {
        let report = Report::error(format!("`{shown}` would lie in another folder than -o says"));
        return Err(report.help("a value is no name of a folder; name the pictures by {index}"));
    }
    Ok(())
}
