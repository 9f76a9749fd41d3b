//! STL, binary and text: triangles and nothing else.

use super::{Model, not_drawn, without_materials};
use crate::given::is_binary_stl;
use crate::report::{Report, Source};
use crate::text::{decode, looks_like_text};
use crate::words::{Word, number, words};
use snell::geometry::{TriangleMesh, Vec3};
use std::collections::HashMap;

/// Bytes before the triangles of a binary file: a title of 80, and their number.
const HEAD: usize = 84;
/// Bytes of a triangle: normal and three corners as `f32`, and two that mean nothing.
const TRIANGLE: usize = 50;

/// Reads an STL file. Corners at the same position become one vertex; normals are those of the corners' order.
///
/// What it holds decides whether it is text or binary: titles of binary files may start with `solid` too.
///
/// # Errors
/// A file that ends too early, a number that is none, a loop without three corners, no triangle at all.
pub fn parse_stl(name: &str, bytes: &[u8]) -> Result<Model, Report> {
    // Old editors and systems end texts with ^Z or zeros.
    let trimmed = &bytes[..bytes.iter().rposition(|b| ![0, 0x1a].contains(b)).map_or(0, |last| last + 1)];
    let (mesh, warning) = if !is_binary_stl(bytes) && looks_like_text(trimmed) && is_stl_text(trimmed) {
        let (source, warning) = decode(name, trimmed);
        (text(&source)?, warning)
    } else {
        binary(name, bytes)?
    };
    if mesh.faces.is_empty() {
        return Err(Report::error(format!("`{name}` has no triangles")));
    }
    Ok(Model { mesh: without_materials(mesh), warnings: warning.into_iter().collect(), ..Model::default() })
}

/// The number of triangles that the head of a binary file promises.
fn promised(bytes: &[u8]) -> Option<u32> {
    bytes.get(80..HEAD)?.try_into().ok().map(u32::from_le_bytes)
}

fn size(triangles: u32) -> u64 {
    HEAD as u64 + TRIANGLE as u64 * u64::from(triangles)
}

/// A text starts with `solid`; one whose head is lost still has facets.
fn is_stl_text(bytes: &[u8]) -> bool {
    let (start, _) = decode("", &bytes[..bytes.len().min(4096)]);
    let lower = start.text.to_ascii_lowercase();
    lower.trim_start().starts_with("solid") || lower.split_ascii_whitespace().any(|word| word == "facet")
}

/// Vertices by position, so that triangles share them.
#[derive(Default)]
struct Builder {
    mesh: TriangleMesh,
    known: HashMap<[u64; 3], u32>,
}

impl Builder {
    fn triangle(&mut self, corners: [Vec3; 3]) {
        let face = corners.map(|v| {
            let key = [v.x, v.y, v.z].map(|c| (c + 0.0).to_bits()); // −0.0 is 0.0
            *self.known.entry(key).or_insert_with(|| {
                self.mesh.vertices.push(v);
                self.mesh.vertices.len() as u32 - 1
            })
        });
        self.mesh.faces.push(face);
    }
}

fn binary(name: &str, bytes: &[u8]) -> Result<(TriangleMesh, Option<Report>), Report> {
    let length = bytes.len() as u64;
    let count = promised(bytes);
    let Some(end) = count.map(size).filter(|&end| end <= length) else {
        let message = match count {
            Some(n) => {
                format!("`{name}` ends too early: {n} triangles need {} bytes, more than its {length} bytes", size(n))
            }
            None => format!("`{name}` has {length} bytes: a binary STL file has at least {HEAD}"),
        };
        let help = "a text STL file starts with `solid`; is it an STL file, and is it complete?";
        return Err(Report::error(message).help(help));
    };
    let mut builder = Builder::default();
    let mut has_attributes = false;
    for (i, triangle) in bytes[HEAD..end as usize].chunks_exact(TRIANGLE).enumerate() {
        let value = |k: usize| {
            let at = 12 + 4 * k;
            f64::from(f32::from_le_bytes([triangle[at], triangle[at + 1], triangle[at + 2], triangle[at + 3]]))
        };
        let corners = [0, 3, 6].map(|k| Vec3::new(value(k), value(k + 1), value(k + 2)));
        if !corners.iter().all(|c| c.is_finite()) {
            let place = format!("triangle {} of `{name}`, at byte {}", i + 1, HEAD + TRIANGLE * i);
            return Err(Report::error(format!("{place}, has a corner that is not finite")));
        }
        builder.triangle(corners);
        has_attributes |= triangle[48..] != [0, 0];
    }
    let behind = format!("the last {} bytes, behind its triangles", length - end);
    let attributes = has_attributes.then_some("the attributes of its triangles, by some programs their colours");
    let things = attributes.into_iter().chain((length > end).then_some(&*behind));
    Ok((builder.mesh, not_drawn(name, things)))
}

fn text(source: &Source) -> Result<TriangleMesh, Report> {
    let mut builder = Builder::default();
    let mut corners: Vec<Vec3> = Vec::new();
    let mut start = 0;
    for line in source.text.split_inclusive('\n') {
        let mut line_words = words(line, start);
        start += line.len();
        let Some(keyword) = line_words.next() else { continue };
        let error = |word: &Word<'_>, message: String| Report::error(message).at(source, word.range.clone());
        match keyword.text.to_ascii_lowercase().as_str() {
            "vertex" => {
                let mut coordinate = || {
                    let word = line_words.next().ok_or_else(|| {
                        error(&keyword, "a vertex has 3 numbers, and this line ends before".to_owned())
                    })?;
                    number(&word).ok_or_else(|| error(&word, format!("expected a number, read `{}`", word.text)))
                };
                corners.push(Vec3::new(coordinate()?, coordinate()?, coordinate()?));
            }
            "endloop" => match corners[..] {
                [a, b, c] => {
                    builder.triangle([a, b, c]);
                    corners.clear();
                }
                _ => return Err(error(&keyword, format!("a loop has 3 vertices, read {}", corners.len()))),
            },
            "solid" | "facet" | "outer" | "endfacet" | "endsolid" => {}
            word => {
                return Err(error(&keyword, format!("unknown word `{word}` in an STL file"))
                    .help("its lines start with solid, facet, outer loop, vertex, endloop, endfacet or endsolid"));
            }
        }
    }
    if corners.is_empty() {
        return Ok(builder.mesh);
    }
    let end = source.text.len();
    Err(Report::error("the file ends within a triangle").at(source, end..end).help("is it complete?"))
}

#[cfg(test)]
mod tests {
    use super::*;

    const TEXT: &str = "solid two\n facet normal 0 0 1\n  outer loop\n   vertex 0 0 0\n   vertex 1 0 0\n   vertex 0 1e0 0\n  endloop\n \
                        endfacet\n facet normal 0 0 1\n outer loop\n vertex 1 0 -0.0\n vertex 1 1 0\n vertex 0 1 0\n endloop\n \
                        endfacet\nendsolid two\n";

    fn as_binary(title: &[u8], triangles: &[[[f32; 3]; 3]]) -> Vec<u8> {
        let mut bytes = title.to_vec();
        bytes.resize(80, b' ');
        bytes.extend((triangles.len() as u32).to_le_bytes());
        for t in triangles {
            bytes.extend([0; 12]);
            bytes.extend(t.iter().flatten().flat_map(|v| v.to_le_bytes()));
            bytes.extend([7, 7]);
        }
        bytes
    }

    const TWO: [[[f32; 3]; 3]; 2] =
        [[[0., 0., 0.], [1., 0., 0.], [0., 1., 0.]], [[1., 0., 0.], [1., 1., 0.], [0., 1., 0.]]];

    fn mesh_of(bytes: &[u8]) -> TriangleMesh {
        parse_stl("t.stl", bytes).unwrap().mesh
    }

    #[test]
    fn text_and_bytes_say_the_same() {
        let mesh = mesh_of(TEXT.as_bytes());
        assert_eq!((mesh.vertices.len(), &mesh.faces[..]), (4, &[[0, 1, 2], [1, 3, 2]][..]));
        for title in [&b"made by nobody"[..], b"solid says nothing"] {
            let mut bytes = as_binary(title, &TWO);
            assert_eq!(mesh_of(&bytes), mesh);
            bytes.extend([0; 92]);
            let longer = parse_stl("t.stl", &bytes).unwrap();
            assert_eq!(longer.mesh, mesh, "what is behind is no triangle");
            let warnings: Vec<String> = longer.warnings.iter().map(ToString::to_string).collect();
            assert!(
                warnings.len() == 1 && warnings[0].contains("92 bytes") && warnings[0].contains("attributes"),
                "{warnings:?}"
            );
            let cut = parse_stl("t.stl", &bytes[..150]).unwrap_err();
            assert!(cut.message.contains("2 triangles need 184 bytes, more than its 150 bytes"), "{cut}");
        }
    }

    #[test]
    fn errors_name_the_place() {
        for (from, to, line, message) in [
            ("vertex 1 0 0", "vertex 1 O 0", 5, "read `O`"),
            ("vertex 1 0 0", "vertex 1 0", 5, "3 numbers"),
            ("vertex 1 0 0", "vertex 1 0 inf", 5, "read `inf`"),
            ("   vertex 1 0 0\n", "", 6, "3 vertices, read 2"),
            ("outer loop", "outre loop", 3, "unknown word `outre`"),
        ] {
            let report = parse_stl("t.stl", TEXT.replacen(from, to, 1).as_bytes()).unwrap_err();
            let (source, range) = report.place.clone().unwrap();
            assert!(report.message.contains(message) && source.line_column(range.start).0 == line, "{report}");
        }
        for text in
            [format!("\u{feff}{TEXT}"), TEXT.replacen("solid two\n", "", 1), TEXT.to_uppercase(), format!("\n  {TEXT}")]
        {
            assert_eq!(mesh_of(text.as_bytes()), mesh_of(TEXT.as_bytes()), "{text}");
        }
        let cut = &TEXT[..TEXT.find("endloop").unwrap()];
        assert!(parse_stl("t.stl", cut.as_bytes()).unwrap_err().message.contains("ends within"));
        let mut bytes = as_binary(b"", &TWO);
        let message = |bytes: &[u8]| parse_stl("t.stl", bytes).unwrap_err().message;
        assert!(message(&bytes[..150]).contains("2 triangles need 184 bytes"));
        assert!(message(&bytes[..9]).contains("at least 84"));
        bytes[80..84].copy_from_slice(&[255; 4]);
        assert!(message(&bytes).contains("4294967295 triangles"));
        assert!(message(&as_binary(b"", &[])).contains("no triangles"));
        assert!(message(b"solid nothing\nendsolid\n").contains("no triangles"));
        let bad = [TWO[0], [[0., 0., f32::NAN], [0.; 3], [0.; 3]]];
        assert!(message(&as_binary(b"", &bad)).contains("triangle 2 of `t.stl`, at byte 134"));
    }
}
