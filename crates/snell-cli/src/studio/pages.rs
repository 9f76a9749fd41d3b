//! The pages of the studio: in this program, or in a folder that `SNELL_STUDIO_DIST` names while they are worked on.

use super::http::Answer;
use flate2::read::GzDecoder;
use snell_formats::Report;
use std::fs::File;
use std::io::{Read, Write};
use std::path::PathBuf;

/// Names and bytes, compressed with gzip; see `build.rs`.
type Packed = &'static [(&'static str, &'static [u8])];

const PACKED: Packed = include!(concat!(env!("OUT_DIR"), "/studio.rs"));

pub enum Pages {
    Packed(Packed),
    Folder(PathBuf),
}

impl Pages {
    pub fn find() -> Result<Self, Report> {
        if let Some(folder) = std::env::var_os("SNELL_STUDIO_DIST").filter(|folder| !folder.is_empty()) {
            let folder = PathBuf::from(folder);
            // Links that lead out of it are not followed, which takes knowing where it really is.
            return match folder.canonicalize() {
                Ok(real) if real.join("index.html").is_file() => Ok(Self::Folder(real)),
                _ => Err(Report::error(format!(
                    "SNELL_STUDIO_DIST is `{}`, which is no folder with index.html in it",
                    folder.display()
                ))),
            };
        }
        if PACKED.is_empty() {
            let report = Report::error("this `snell` was built without the pages of Snell Studio");
            return Err(report.help("in a clone of Snell, `make studio` builds them and serves them"));
        }
        Ok(Self::Packed(PACKED))
    }

    /// The file that a path of a URL names.
    pub fn get(&self, path: &str, takes_gzip: bool) -> Option<Answer> {
        let name = name_of(path)?;
        let kind = kind_of(&name);
        match self {
            Self::Packed(files) => {
                let (_, bytes) = *files.iter().find(|(known, _)| *known == name)?;
                Some(packed(bytes, kind, takes_gzip))
            }
            Self::Folder(folder) => {
                let file = folder.join(name).canonicalize().ok()?;
                if !file.starts_with(folder) || !file.is_file() {
                    return None;
                }
                let mut file = File::open(file).ok()?;
                let length = file.metadata().ok()?.len();
                // A file that grows meanwhile must not be longer than was said.
                let write = move |out: &mut dyn Write| std::io::copy(&mut (&mut file).take(length), out).map(drop);
                Some(Answer { kind, is_gzip: false, length: Some(length), write: Box::new(write) })
            }
        }
    }
}

fn packed(bytes: &'static [u8], kind: &'static str, takes_gzip: bool) -> Answer {
    if takes_gzip {
        let write = move |out: &mut dyn Write| out.write_all(bytes);
        return Answer { kind, is_gzip: true, length: Some(bytes.len() as u64), write: Box::new(write) };
    }
    // The end of a connection ends what has no length.
    let write = move |out: &mut dyn Write| std::io::copy(&mut GzDecoder::new(bytes), out).map(drop);
    Answer { kind, is_gzip: false, length: None, write: Box::new(write) }
}

/// The name of a file, with `/` between folders; none that leads out of a folder, on any system.
fn name_of(path: &str) -> Option<String> {
    let name = decoded(path.strip_prefix('/')?)?;
    if name.is_empty() {
        return Some("index.html".to_owned());
    }
    let is_plain = |part: &str| !part.is_empty() && !part.starts_with('.') && !part.contains(['\\', ':', '\0']);
    name.split('/').all(is_plain).then_some(name)
}

/// A text with its `%20` as what they stand for.
fn decoded(text: &str) -> Option<String> {
    let mut bytes = Vec::new();
    let mut rest = text.as_bytes();
    while let Some((&first, after)) = rest.split_first() {
        rest = after;
        if first != b'%' {
            bytes.push(first);
            continue;
        }
        let digit = |byte: u8| char::from(byte).to_digit(16);
        let (&[high, low], after) = rest.split_first_chunk()?;
        bytes.push((digit(high)? * 16 + digit(low)?) as u8);
        rest = after;
    }
    String::from_utf8(bytes).ok()
}

/// The MIME type of a file.
fn kind_of(name: &str) -> &'static str {
    match name.rsplit('.').next().unwrap_or_default() {
        "html" => "text/html; charset=utf-8",
        "js" | "mjs" => "text/javascript; charset=utf-8",
        "css" => "text/css; charset=utf-8",
        "wasm" => "application/wasm",
        "json" | "map" => "application/json",
        "webmanifest" => "application/manifest+json",
        "svg" => "image/svg+xml",
        "png" => "image/png",
        "webp" => "image/webp",
        "ico" => "image/x-icon",
        "woff2" => "font/woff2",
        "toml" | "txt" | "obj" | "mtl" => "text/plain; charset=utf-8",
        _ => "application/octet-stream",
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lead_nowhere_else() {
        assert_eq!(name_of("/").as_deref(), Some("index.html"));
        assert_eq!(name_of("/assets/a%20b.js").as_deref(), Some("assets/a b.js"));
        for odd in [
            "",
            "a",
            "//",
            "/a//b",
            "/..",
            "/a/../b",
            "/%2e%2e/b",
            "/..%2fb",
            "/a\\b",
            "/%5c..%5cb",
            "/c:/b",
            "/.git/x",
            "/%",
            "/%g0",
            "/%ff",
            "/a%00",
            "http://x/a",
        ] {
            assert_eq!(name_of(odd), None, "{odd}");
        }
    }

    #[test]
    fn packed_files_are_sent_as_the_client_can_read_them() {
        use flate2::{Compression, write::GzEncoder};
        let mut encoder = GzEncoder::new(Vec::new(), Compression::best());
        encoder.write_all(&[7; 1000]).unwrap();
        let bytes: &'static [u8] = encoder.finish().unwrap().leak();
        let pages = Pages::Packed(vec![("a.wasm", bytes)].leak());
        let sent = |takes_gzip: bool| {
            let answer = pages.get("/a.wasm", takes_gzip).unwrap();
            let (mut sent, about) = (Vec::new(), (answer.kind, answer.is_gzip, answer.length));
            (answer.write)(&mut sent).unwrap();
            (about, sent)
        };
        assert_eq!(sent(true), (("application/wasm", true, Some(bytes.len() as u64)), bytes.to_vec()));
        assert_eq!(sent(false), (("application/wasm", false, None), vec![7; 1000]));
        assert!(pages.get("/b.wasm", true).is_none() && pages.get("/", true).is_none());
    }
}
