//! What a file is, by its content and its name: for those who give a command a file that it does not take.

use crate::report::{Remedy, Report};
use crate::text::{decode, looks_like_text};
use crate::{model, picture};
use std::path::Path;

/// What somebody has given.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Given {
    /// A model that Snell reads.
    Model(model::Format),
    /// A library of materials, which models name.
    Materials,
    /// A picture that Snell reads.
    Picture(picture::Format),
    /// Sums of samples of a picture.
    Part,
    /// Something known that Snell does not read, and what to do with it.
    Foreign(&'static str, &'static str),
    /// A text; whether it is a scene shows when it is read.
    Text,
    /// Bytes that say nothing.
    Bytes,
}

const MAKE_OBJ: &str = "export it as OBJ or PLY, and name that in a scene";
const MAKE_PNG: &str = "convert it to PNG, like: magick picture.jpg picture.png";
const UNPACK: &str = "unpack it first";
const WRITE_ANEW: &str = "write it anew as a scene of Snell: docs/scenes.md shows how";

/// How binary files start.
const MAGIC: &[(&[u8], Given)] = &[
    (b"ply\n", Given::Model(model::Format::Ply)),
    (b"ply\r", Given::Model(model::Format::Ply)),
    (b"glTF", Given::Foreign("a glTF model", MAKE_OBJ)),
    (b"Kaydara FBX", Given::Foreign("an FBX model", MAKE_OBJ)),
    (b"BLENDER", Given::Foreign("a Blender file", MAKE_OBJ)),
    (b"\xff\xd8\xff", Given::Foreign("a JPEG picture", MAKE_PNG)),
    (b"GIF8", Given::Foreign("a GIF picture", MAKE_PNG)),
    (b"RIFF", Given::Foreign("a WebP picture or a film", MAKE_PNG)),
    (b"II*\0", Given::Foreign("a TIFF picture", MAKE_PNG)),
    (b"MM\0*", Given::Foreign("a TIFF picture", MAKE_PNG)),
    (b"#?RADIANCE", Given::Foreign("a Radiance HDR picture", "convert it to EXR, and name that as the sky of a scene")),
    (b"PK\x03\x04", Given::Foreign("a ZIP archive", UNPACK)),
    (b"\x1f\x8b", Given::Foreign("a gzip archive", UNPACK)),
    (b"%PDF", Given::Foreign("a PDF document", "")),
];

/// What texts are whose first lines look like anything.
const ENDINGS: &[(&str, Given)] = &[
    ("obj", Given::Model(model::Format::Obj)),
    ("stl", Given::Model(model::Format::Stl)),
    ("ply", Given::Model(model::Format::Ply)),
    ("mtl", Given::Materials),
    ("gltf", Given::Foreign("a glTF model", MAKE_OBJ)),
    ("fbx", Given::Foreign("an FBX model", MAKE_OBJ)),
    ("dae", Given::Foreign("a Collada model", MAKE_OBJ)),
    ("usd", Given::Foreign("a USD scene", MAKE_OBJ)),
    ("usda", Given::Foreign("a USD scene", MAKE_OBJ)),
    ("pov", Given::Foreign("a POV-Ray scene", WRITE_ANEW)),
    ("pbrt", Given::Foreign("a pbrt scene", WRITE_ANEW)),
    ("xml", Given::Foreign("an XML file", WRITE_ANEW)),
    ("ipynb", Given::Foreign("a notebook", "open it in Jupyter")),
    ("py", Given::Foreign("a Python program", "run it with python")),
];

/// What a file is, by its first bytes and its name; a text, if it cannot be read.
#[cfg(feature = "disk")]
pub fn given_file(path: &Path) -> Given {
    use std::io::Read;
    let mut start = Vec::new();
    let read = std::fs::File::open(path).and_then(|file| file.take(START as u64).read_to_end(&mut start));
    if read.is_ok() { given(path, &start) } else { Given::Text }
}

/// What a file of this name with these bytes is.
pub fn given(path: &Path, bytes: &[u8]) -> Given {
    // The name of the first file of an archive stands behind 30 bytes.
    if bytes.starts_with(b"PK\x03\x04") && bytes.get(30..).is_some_and(|name| name.starts_with(b"sums.npy")) {
        return Given::Part;
    }
    if let Some((_, known)) = MAGIC.iter().find(|(magic, _)| bytes.starts_with(magic)) {
        return *known;
    }
    if let Some(format) = picture::Format::in_bytes(bytes) {
        return Given::Picture(format);
    }
    if is_binary_stl(bytes) {
        return Given::Model(model::Format::Stl);
    }
    let ending = path.extension().map(|e| e.to_string_lossy().to_lowercase()).unwrap_or_default();
    if !looks_like_text(bytes) {
        return ENDINGS.iter().find(|(known, _)| *known == ending).map_or(Given::Bytes, |(_, known)| *known);
    }
    let (start, _) = decode("", &bytes[..bytes.len().min(START)]);
    if start.text.trim_start().is_empty() && !ending.is_empty() {
        // An empty file is what it is called.
        return ENDINGS.iter().find(|(known, _)| *known == ending).map_or(Given::Text, |(_, known)| *known);
    }
    text_of_a_kind(&start.text)
        .or_else(|| ENDINGS.iter().find(|(known, _)| *known == ending).map(|(_, known)| *known))
        .unwrap_or(Given::Text)
}

/// Do these bytes have just the length that a binary STL of their number of triangles has: 84, and 50 for each?
pub(crate) fn is_binary_stl(bytes: &[u8]) -> bool {
    let count = bytes.get(80..84).and_then(|b| b.try_into().ok()).map_or(0, u32::from_le_bytes);
    count > 0 && 84 + 50 * u64::from(count) == bytes.len() as u64
}

/// So much of a text is looked at.
const START: usize = 4096;

/// What a text that is no scene says of itself.
fn text_of_a_kind(text: &str) -> Option<Given> {
    let lower = text.trim_start().to_ascii_lowercase();
    let mut lines = text.lines().map(str::trim).filter(|line| !line.is_empty() && !line.starts_with('#')).take(20);
    let keyword = |line: &str| line.split_whitespace().next().unwrap_or_default().to_owned();
    let of_obj = |line: &str| {
        ["v", "vt", "vn", "f", "o", "g", "s", "usemtl", "mtllib"].contains(&&*keyword(line))
            && line.contains(char::is_whitespace)
    };
    match () {
        () if lower.starts_with("ply\n") => Some(Given::Model(model::Format::Ply)),
        () if lower.starts_with("solid") && lower.contains("facet") => Some(Given::Model(model::Format::Stl)),
        () if lower.starts_with('<') => Some(Given::Foreign("an XML file", WRITE_ANEW)),
        () if lower.starts_with("off\n") => Some(Given::Foreign("an OFF model", MAKE_OBJ)),
        () if lower.starts_with('{') && lower.contains("\"asset\"") && !lower.contains("\"snell\"") => {
            Some(Given::Foreign("a glTF model", MAKE_OBJ))
        }
        () if lower.starts_with('{') && lower.contains("\"cells\"") && !lower.contains("\"snell\"") => {
            Some(Given::Foreign("a notebook", "open it in Jupyter"))
        }
        () if text.lines().any(|line| keyword(line) == "newmtl") => Some(Given::Materials),
        // `v x y z` is a vertex; an NFF has its `v` alone.
        () if lines.clone().any(|line| keyword(line) == "v" && line.split_whitespace().count() >= 4)
            && lines.all(of_obj) =>
        {
            Some(Given::Model(model::Format::Obj))
        }
        () => None,
    }
}

impl Given {
    /// Why this is no scene, and what to do with it; `None` for what may be one.
    pub fn no_scene(self, shown: &str) -> Option<Report> {
        let what = self.words().unwrap_or("binary data");
        let report = Report::error(format!("`{shown}` is {what}, not a scene"));
        Some(match self {
            Self::Text => return None,
            Self::Model(_) => report
                .help(format!(
                    "name it in a scene: `[[mesh]]` with `file = \"{shown}\"` (docs/scenes.md has a whole one)"
                ))
                .remedy(Remedy::CheckModel(shown.to_owned())),
            Self::Materials => report.help("name the model that uses it in a scene"),
            Self::Picture(_) => report.remedy(Remedy::MakeAgain(shown.to_owned())),
            Self::Part => report.help("join it with the other parts of its picture, or go on with its render"),
            Self::Foreign(_, help) => with_help(report, help),
            Self::Bytes => report.help("scenes are text files: TOML, JSON, drivers of the course, or NFF"),
        })
    }

    /// Says of what Snell does not read that it does not; `None` for all else.
    pub fn not_read(self, shown: &str) -> Option<Report> {
        let Self::Foreign(what, help) = self else { return None };
        Some(with_help(Report::error(format!("`{shown}` is {what}, which Snell does not read")), help))
    }

    /// What it is, in words, if that is known.
    pub fn words(self) -> Option<&'static str> {
        match self {
            Self::Model(format) => Some(format.words()),
            Self::Picture(format) => Some(format.words()),
            Self::Foreign(what, _) => Some(what),
            Self::Materials => Some("a library of materials"),
            Self::Part => Some("a part of a picture"),
            Self::Text | Self::Bytes => None,
        }
    }
}

fn with_help(report: Report, help: &str) -> Report {
    if help.is_empty() { report } else { report.help(help) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn content_comes_before_the_name() {
        for (name, bytes, expected) in [
            ("a.toml", &b"\x89PNG\r\n\x1a\n"[..], "a PNG picture, not a scene"),
            ("spot.obj", b"v 0 0 0\n", "OBJ model, not a scene"),
            ("SPOT.OBJ", b"v 0 0 0\n", "OBJ model, not a scene"),
            ("a", b"ply\nformat ascii 1.0\n", "a PLY model"),
            ("a.glb", b"glTF\x02\0\0\0", "a glTF model"),
            ("a.bin", &[0, 1, 2, 200], "is binary data"),
            ("a", b"P6 1 1 255 \0\0\0", "a PPM picture"),
            ("a", b"PK\x03\x04..........................sums.npy", "a part of a picture"),
            ("a", b"PK\x03\x04..........................else.npy", "a ZIP archive"),
            ("a.xml", b"<scene/>", "an XML file"),
        ] {
            let report = given(Path::new(name), bytes).no_scene(name).unwrap();
            assert!(report.message.contains(expected), "{report}");
        }
        for (bytes, expected) in [
            (&b"# cube\nmtllib a.mtl\no cube\nv 0 0 0\nv 1 0 0\n"[..], "a Wavefront OBJ model"),
            (b"solid a\n facet normal 0 0 1\n", "an STL model"),
            (b"\xef\xbb\xbfply\nformat ascii 1.0\n", "a PLY model"),
            (b"\n# m\nnewmtl a\nKd 1 1 1\n", "a library of materials"),
            (b"<?xml version=\"1.0\"?>", "an XML file"),
            (b"{ \"asset\": { \"version\": \"2.0\" } }", "a glTF model"),
        ] {
            assert_eq!(given(Path::new("a.txt"), bytes).words(), Some(expected));
            assert_eq!(given(Path::new("a"), bytes).words(), Some(expected));
        }
        assert_eq!(given(Path::new("a"), b"v\nfrom 0 0 9\n"), Given::Text, "NFF");
        assert_eq!(given(Path::new("a.json"), b"{ \"snell\": 1 }"), Given::Text);
        assert_eq!(given(Path::new("a.toml"), b"snell = 1\n"), Given::Text);
        assert_eq!(given(Path::new("d.txt"), b"PPM 3\n"), Given::Text);
    }
}
