//! PLY (Turk 1994, "The PLY polygon file format"): text and both orders of bytes, polygons and triangle strips.

use super::polygon::Polygons;
use super::{Model, not_drawn, without_materials};
use crate::report::{Report, Source};
use crate::text::{decode, is_utf16};
use crate::words::{Word, number, words};
use snell::geometry::{TriangleMesh, Vec3};
use std::ops::Range;

/// Reads a PLY file: the elements `vertex` (`x`, `y`, `z`, and texture coordinates `s`, `t`, or `u`, `v`, or `texture_u`,
/// `texture_v`), `face` and `tristrips` (lists `vertex_indices` or
/// `vertex_index`); others are passed over. Polygons become triangles. In a strip, −1 starts anew, and triangles with two
/// equal corners only lead on to the next.
///
/// # Errors
/// A header that is none, a file that ends too early, a number that is none, an index out of range, no faces.
pub fn parse_ply(name: &str, bytes: &[u8]) -> Result<Model, Report> {
    let decoded;
    let bytes = match bytes {
        [0xef, 0xbb, 0xbf, rest @ ..] => rest,
        _ if is_utf16(bytes) => {
            decoded = decode(name, bytes).0;
            decoded.text.as_bytes()
        }
        _ => bytes,
    };
    let (header, body) = split(name, bytes)?;
    let (format, elements) = read_header(&header)?;
    let (mesh, warning) = match format {
        Format::Text => {
            let (source, warning) = decode(name, bytes);
            // The header ends with the first line that says so, here too.
            let mut start = 0;
            for line in source.text.split_inclusive('\n') {
                start += line.len();
                if line.trim() == "end_header" {
                    break;
                }
            }
            let words = words(&source.text[start..], start);
            let mut numbers = Text { source: &source, words, last: start..start };
            (read_elements(&header, &elements, &mut numbers)?, warning)
        }
        Format::Bytes { big } => {
            (read_elements(&header, &elements, &mut Bytes { name, data: bytes, at: body, big })?, None)
        }
    };
    let unused = elements.iter().flat_map(Element::unused).collect::<Vec<_>>();
    let has_normals = unused.iter().any(|name| name == "nx of `vertex`");
    let is_normal = |name: &&str| ["nx of `vertex`", "ny of `vertex`", "nz of `vertex`"].contains(name);
    let things = unused.iter().map(String::as_str).filter(|name| !is_normal(name));
    let warnings = not_drawn(name, things).into_iter().chain(warning).collect();
    Ok(Model { mesh, has_normals, warnings, ..Model::default() })
}

impl Element {
    /// What of it is not drawn.
    fn unused(&self) -> Vec<String> {
        let places: &[&str] = match &*self.name {
            "vertex" => &["x", "y", "z", "s", "t", "u", "v", "texture_u", "texture_v"],
            "face" | "tristrips" => &["vertex_indices", "vertex_index"],
            name => return vec![format!("element `{name}`")],
        };
        let unused = self.properties.iter().filter(|p| !places.contains(&&*p.name));
        unused.map(|p| format!("{} of `{}`", p.name, self.name)).collect()
    }
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Format {
    Text,
    Bytes { big: bool },
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Type {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
    F64,
}

impl Type {
    fn of(word: &str) -> Option<Self> {
        Some(match word {
            "char" | "int8" => Self::I8,
            "uchar" | "uint8" => Self::U8,
            "short" | "int16" => Self::I16,
            "ushort" | "uint16" => Self::U16,
            "int" | "int32" => Self::I32,
            "uint" | "uint32" => Self::U32,
            "float" | "float32" => Self::F32,
            "double" | "float64" => Self::F64,
            _ => return None,
        })
    }
}

struct Property {
    name: String,
    /// Of the number of values, for a list.
    count: Option<Type>,
    kind: Type,
}

struct Element {
    name: String,
    count: u64,
    properties: Vec<Property>,
    /// Its line in the header.
    range: Range<usize>,
}

/// The header as a text, and where what follows begins. Its lines end with LF, CR LF or CR, as the first one does.
fn split(name: &str, bytes: &[u8]) -> Result<(Source, usize), Report> {
    // A header of a megabyte is none.
    let start = &bytes[..bytes.len().min(1 << 20)];
    let first = start.iter().position(|b| b"\r\n".contains(b)).unwrap_or(0);
    let end_of_line: u8 =
        if start.get(first..first + 2) == Some(b"\r\n") { b'\n' } else { start.get(first).copied().unwrap_or(b'\n') };
    let mut at = 0;
    for line in start.split_inclusive(|&b| b == end_of_line) {
        at += line.len();
        if line.trim_ascii() == b"end_header" {
            return Ok((Source::new(name, String::from_utf8_lossy(&bytes[..at])), at));
        }
    }
    let help = "a PLY file starts with lines like `ply`, `format ascii 1.0`, `element vertex 8`, … `end_header`";
    Err(Report::error(format!("`{name}` has no header that ends with `end_header`")).help(help))
}

fn read_header(source: &Source) -> Result<(Format, Vec<Element>), Report> {
    let mut format = None;
    let mut elements: Vec<Element> = Vec::new();
    let mut start = 0;
    for (number, line) in source.text.split_inclusive('\n').enumerate() {
        let line_words: Vec<Word<'_>> = words(line, start).collect();
        let range = start..start + line.trim_end().len();
        start += line.len();
        let error = |message: &str| Report::error(message.to_owned()).at(source, range.clone());
        let texts: Vec<&str> = line_words.iter().map(|w| w.text).collect();
        match texts[..] {
            ["ply"] if number == 0 => {}
            _ if number == 0 => return Err(error("a PLY file starts with `ply`")),
            [] | ["comment" | "obj_info", ..] | ["end_header"] => {}
            ["format", name, ..] => {
                format = Some(match name {
                    "ascii" => Format::Text,
                    "binary_little_endian" => Format::Bytes { big: false },
                    "binary_big_endian" => Format::Bytes { big: true },
                    _ => return Err(error("the format is ascii, binary_little_endian or binary_big_endian")),
                });
            }
            ["element", name, count] => {
                let count = count.parse().map_err(|_| error("an element has a name and a number"))?;
                elements.push(Element { name: name.to_owned(), count, properties: Vec::new(), range });
            }
            ["property", ref rest @ ..] => {
                let (count, kind, name) = match *rest {
                    ["list", count, kind, name] => (Some(count), kind, name),
                    [kind, name] => (None, kind, name),
                    _ => return Err(error("a property is `property TYPE NAME` or `property list TYPE TYPE NAME`")),
                };
                let known = |word| Type::of(word).ok_or_else(|| error(&format!("`{word}` is not a number type")));
                let property =
                    Property { name: name.to_owned(), count: count.map(known).transpose()?, kind: known(kind)? };
                let element = elements.last_mut().ok_or_else(|| error("a property stands behind its element"))?;
                element.properties.push(property);
            }
            _ => return Err(error("unknown line in the header of a PLY file")),
        }
    }
    let format = format.ok_or_else(|| Report::error("no line says the format").at(source, 0..0))?;
    Ok((format, elements))
}

/// Where numbers come from.
trait Numbers {
    fn next(&mut self, kind: Type) -> Result<f64, Report>;
    /// An error at the number that was read last.
    fn error(&self, message: String) -> Report;
}

struct Text<'a, W> {
    source: &'a Source,
    words: W,
    last: Range<usize>,
}

impl<'a, W: Iterator<Item = Word<'a>>> Numbers for Text<'a, W> {
    fn next(&mut self, _: Type) -> Result<f64, Report> {
        let Some(word) = self.words.next() else {
            let end = self.source.text.len();
            self.last = end..end;
            return Err(self.error("the file ends too early".to_owned()).help("is it complete?"));
        };
        self.last = word.range.clone();
        number(&word).ok_or_else(|| self.error(format!("expected a number, read `{}`", word.text)))
    }

    fn error(&self, message: String) -> Report {
        Report::error(message).at(self.source, self.last.clone())
    }
}

struct Bytes<'a> {
    name: &'a str,
    data: &'a [u8],
    at: usize,
    big: bool,
}

impl Bytes<'_> {
    fn take<const N: usize>(&mut self) -> Result<[u8; N], Report> {
        let bytes = self.data.get(self.at..self.at + N).and_then(|b| <[u8; N]>::try_from(b).ok());
        let Some(mut bytes) = bytes else {
            return Err(self.error("the file ends too early".to_owned()).help("is it complete?"));
        };
        self.at += N;
        if self.big {
            bytes.reverse();
        }
        Ok(bytes)
    }
}

impl Numbers for Bytes<'_> {
    fn next(&mut self, kind: Type) -> Result<f64, Report> {
        let value = match kind {
            Type::I8 => f64::from(i8::from_le_bytes(self.take()?)),
            Type::U8 => f64::from(u8::from_le_bytes(self.take()?)),
            Type::I16 => f64::from(i16::from_le_bytes(self.take()?)),
            Type::U16 => f64::from(u16::from_le_bytes(self.take()?)),
            Type::I32 => f64::from(i32::from_le_bytes(self.take()?)),
            Type::U32 => f64::from(u32::from_le_bytes(self.take()?)),
            Type::F32 => f64::from(f32::from_le_bytes(self.take()?)),
            Type::F64 => f64::from_le_bytes(self.take()?),
        };
        Ok(value)
    }

    fn error(&self, message: String) -> Report {
        Report::error(format!("`{}`, before byte {}: {message}", self.name, self.at))
    }
}

fn read_elements(header: &Source, elements: &[Element], numbers: &mut impl Numbers) -> Result<TriangleMesh, Report> {
    let mut mesh = TriangleMesh::default();
    // Corners of all polygons and strips, and where each ends. They become triangles when all vertices are there.
    let (mut corners, mut ends): (Vec<u32>, Vec<(usize, bool)>) = (Vec::new(), Vec::new());
    // What has no properties takes no room, and would let a header promise vertices that never come.
    let elements: Vec<&Element> = elements.iter().filter(|e| !e.properties.is_empty()).collect();
    let vertices = elements.iter().find(|e| e.name == "vertex");
    let vertex_count = vertices.map_or(0, |e| e.count);
    if vertex_count > u64::from(u32::MAX) {
        let range = vertices.map_or(0..0, |e| e.range.clone());
        return Err(Report::error("more vertices than can be numbered").at(header, range));
    }
    for element in elements {
        let place = |name| element.properties.iter().position(|p| p.name == name && p.count.is_none());
        let positions = match (&*element.name, place("x"), place("y"), place("z")) {
            ("vertex", Some(x), Some(y), Some(z)) => Some([x, y, z]),
            ("vertex", ..) => {
                let message = "a vertex needs the properties x, y and z";
                return Err(Report::error(message).at(header, element.range.clone()));
            }
            _ => None,
        };
        let uvs = UV_NAMES.iter().find_map(|&[u, v]| Some([place(u)?, place(v)?])).filter(|_| positions.is_some());
        let strips = element.name == "tristrips";
        let mut row = vec![0.0; element.properties.len()];
        for _ in 0..element.count {
            for (property, value) in element.properties.iter().zip(&mut row) {
                let Some(count) = property.count else {
                    *value = numbers.next(property.kind)?;
                    continue;
                };
                let length = numbers.next(count)?;
                if !(length >= 0.0 && length.fract() == 0.0) {
                    return Err(numbers.error(format!("the length of a list is a whole number from 0, read {length}")));
                }
                let wanted =
                    (element.name == "face" || strips) && matches!(&*property.name, "vertex_indices" | "vertex_index");
                let start = corners.len();
                for _ in 0..length as u64 {
                    let index = numbers.next(property.kind)?;
                    if wanted {
                        corners.push(corner(index, vertex_count, strips).map_err(|m| numbers.error(m))?);
                    }
                }
                if wanted && !strips && length < 3.0 {
                    return Err(numbers.error(format!("a face has at least 3 corners, read {length}")));
                }
                if corners.len() > start {
                    ends.push((corners.len(), strips));
                }
            }
            if let Some(positions) = positions {
                let [x, y, z] = positions.map(|i| row[i]);
                let vertex = Vec3::new(x, y, z);
                if !vertex.is_finite() {
                    return Err(numbers.error(format!("a vertex is not finite: {x} {y} {z}")));
                }
                mesh.vertices.push(vertex);
            }
            if let Some(uvs) = uvs {
                let uv = uvs.map(|i| row[i]);
                if !uv.iter().all(|c| c.is_finite()) {
                    let [u, v] = uv;
                    return Err(numbers.error(format!("texture coordinates are not finite: {u} {v}")));
                }
                mesh.uvs.push(uv);
            }
        }
    }
    let mut triangulate = Polygons::default();
    let mut start = 0;
    for (end, strip) in ends {
        let corners = &corners[start..end];
        if strip {
            mesh.faces.extend(strip_triangles(corners));
        } else {
            mesh.faces.extend(triangulate.triangles(corners, &mesh.vertices));
        }
        start = end;
    }
    if mesh.faces.is_empty() {
        let help = "a model needs an element `face` or `tristrips` with a list `vertex_indices`";
        return Err(Report::error(format!("`{}` has no faces", header.name)).help(help));
    }
    // A second element `vertex` need not have them too.
    if mesh.uvs.len() == mesh.vertices.len() {
        mesh.face_uvs.clone_from(&mesh.faces);
    } else {
        mesh.uvs.clear();
    }
    Ok(without_materials(mesh))
}

/// What the texture coordinates of a vertex are called: in the format's first description, by Blender, by `MeshLab`.
const UV_NAMES: [[&str; 2]; 3] = [["s", "t"], ["u", "v"], ["texture_u", "texture_v"]];

/// Where a strip starts anew.
const RESTART: u32 = u32::MAX;

fn corner(index: f64, count: u64, strip: bool) -> Result<u32, String> {
    match index {
        _ if index >= 0.0 && index < count as f64 && index.fract() == 0.0 => Ok(index as u32),
        _ if strip && index == -1.0 => Ok(RESTART),
        _ => Err(format!("there is no vertex {index}: the file has {count}, counted from 0")),
    }
}

/// Every other triangle of a strip is turned around.
fn strip_triangles(corners: &[u32]) -> impl Iterator<Item = [u32; 3]> {
    let parts = corners.split(|&c| c == RESTART);
    parts.flat_map(|part| part.windows(3).enumerate()).filter_map(|(i, t)| {
        let [a, b, c] = if i % 2 == 0 { [t[0], t[1], t[2]] } else { [t[1], t[0], t[2]] };
        (a != b && b != c && c != a).then_some([a, b, c])
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    const TEXT: &str = "ply\nformat ascii 1.0\ncomment a square\nelement vertex 4\nproperty float x\nproperty float y\nproperty \
                        uchar red\nproperty float z\nelement face 1\nproperty list uchar int vertex_indices\nproperty list uchar \
                        float uv\nelement odd 2\nproperty int a\nend_header\n0 0 255 0\n1 0 255 0\n1 1 255 0\n0 1 255 0\n4 0 1 2 3 2 .5 \
                        .5\n7 8\n";

    fn as_bytes(big: bool, last: u32) -> Vec<u8> {
        let (head, _) = TEXT.split_at(TEXT.find("0 0 255").unwrap());
        let name = if big { "binary_big_endian" } else { "binary_little_endian" };
        let mut bytes = head.replace("ascii", name).into_bytes();
        let f = |v: f32| if big { v.to_be_bytes() } else { v.to_le_bytes() };
        let i = |v: u32| if big { v.to_be_bytes() } else { v.to_le_bytes() };
        for [x, y] in [[0., 0.], [1., 0.], [1., 1.], [0., 1.]] {
            bytes.extend([&f(x)[..], &f(y), &[255], &f(0.0)].concat());
        }
        bytes.push(4);
        bytes.extend([0, 1, 2, last].map(i).concat());
        bytes.push(2);
        bytes.extend([f(0.5), f(0.5), i(7), i(8)].concat());
        bytes
    }

    fn mesh_of(bytes: &[u8]) -> TriangleMesh {
        parse_ply("m.ply", bytes).unwrap().mesh
    }

    #[test]
    fn every_format_says_the_same() {
        let mesh = mesh_of(TEXT.as_bytes());
        assert_eq!((mesh.vertices.len(), &mesh.faces[..]), (4, &[[0, 1, 2], [0, 2, 3]][..]));
        assert_eq!(mesh.vertices[2], Vec3::new(1.0, 1.0, 0.0));
        assert_eq!(mesh_of(TEXT.replace('\n', "\r\n").as_bytes()), mesh);
        assert_eq!(mesh_of(TEXT.replace('\n', "\r").as_bytes()), mesh);
        let utf16: Vec<u8> = TEXT.encode_utf16().flat_map(u16::to_le_bytes).collect();
        for text in [&[b"\xff\xfe", &utf16[..]].concat(), &utf16, &[b"\xef\xbb\xbf", TEXT.as_bytes()].concat()] {
            assert_eq!(mesh_of(text), mesh);
        }
        for big in [false, true] {
            let bytes = as_bytes(big, 3);
            assert_eq!(mesh_of(&bytes), mesh);
            let (head, body) = bytes.split_at(bytes.windows(11).position(|w| w == b"end_header\n").unwrap() + 11);
            let head = String::from_utf8(head.to_vec()).unwrap();
            for end in ["\r\n", "\r"] {
                assert_eq!(mesh_of(&[head.replace('\n', end).as_bytes(), body].concat()), mesh, "{end:?}");
            }
        }
        let warnings = parse_ply("m.ply", TEXT.as_bytes()).unwrap().warnings;
        assert!(warnings[0].message.contains("red of `vertex`, uv of `face`, element `odd`"), "{}", warnings[0]);
    }

    #[test]
    fn texture_coordinates_by_any_of_their_names() {
        let plain = mesh_of(TEXT.as_bytes());
        assert!(plain.uvs.is_empty() && plain.face_uvs.is_empty(), "the list `uv` of the face is another thing");
        for [u, v] in UV_NAMES {
            // z first, so that the last two numbers of a vertex are its texture coordinates.
            let text = TEXT
                .replace(
                    "property uchar red\nproperty float z",
                    &format!("property float z\nproperty float {v}\nproperty float {u}"),
                )
                .replace(" 255 0\n", " 0 .25 1e9\n");
            let mesh = mesh_of(text.as_bytes());
            assert_eq!((&mesh.vertices, &mesh.faces), (&plain.vertices, &plain.faces));
            assert_eq!((&mesh.uvs[..], &mesh.face_uvs), (&[[1e9, 0.25]; 4][..], &mesh.faces), "{u} {v}");
            let half = text.replace(&format!("float {u}\n"), "float other\n");
            assert!(mesh_of(half.as_bytes()).face_uvs.is_empty());
        }
    }

    #[test]
    fn texture_coordinates_that_are_none_are_refused() {
        let head = TEXT.split_at(TEXT.find("element face").unwrap()).0.replace("vertex 4", "vertex 1");
        let head = head
            .replace("ascii", "binary_little_endian")
            .replace("uchar red\nproperty float z", "float s\nproperty float t\nproperty float z");
        let bytes =
            [head.as_bytes(), b"end_header\n", &[0.0, 0.0, f32::NAN, 0.0, 0.0].map(f32::to_le_bytes).concat()].concat();
        let report = parse_ply("m.ply", &bytes).unwrap_err();
        assert!(report.message.contains("texture coordinates are not finite: NaN 0"), "{report}");
    }

    #[test]
    fn strips_turn_every_other_triangle_and_start_anew() {
        assert_eq!(strip_triangles(&[0, 1, 2, 3, 4]).collect::<Vec<_>>(), [[0, 1, 2], [2, 1, 3], [2, 3, 4]]);
        let restarted = [0, 1, 2, 3, RESTART, 4, 5, 6, 6, 7, 8];
        // The last one is the fourth of its strip, and so turned around.
        let expected = [[0, 1, 2], [2, 1, 3], [4, 5, 6], [7, 6, 8]];
        assert_eq!(strip_triangles(&restarted).collect::<Vec<_>>(), expected);
        let text = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\nelement \
                    tristrips 1\nproperty list int int vertex_indices\nend_header\n0 0 0 1 0 0 0 1 0 1 1 0\n6 0 1 2 3 -1 0\n";
        assert_eq!(mesh_of(text.as_bytes()).faces, [[0, 1, 2], [2, 1, 3]]);
    }

    #[test]
    fn errors_name_the_place() {
        for (from, to, line, message) in [
            ("ply\n", "plyx\n", 1, "starts with `ply`"),
            ("format ascii 1.0", "format utf8 1.0", 2, "the format is"),
            ("element vertex 4", "element vertex four", 4, "a name and a number"),
            ("element vertex 4", "element vertex 99999999999", 4, "more vertices"),
            ("property uchar red", "property byte red", 7, "`byte` is not a number type"),
            ("property float x", "property float w", 4, "x, y and z"),
            ("element odd 2", "elephant odd 2", 12, "unknown line"),
            ("1 1 255 0", "1 1 255 x", 17, "read `x`"),
            ("4 0 1 2 3", "4 0 1 2 4", 19, "no vertex 4: the file has 4"),
            ("4 0 1 2 3", "4 0 1 2 -1", 19, "no vertex -1"),
            ("4 0 1 2 3 2", "2 0 1 2", 19, "3 corners, read 2"),
            ("7 8\n", "7\n", 21, "ends too early"),
        ] {
            assert!(TEXT.contains(from), "{from}");
            let report = parse_ply("m.ply", TEXT.replacen(from, to, 1).as_bytes()).unwrap_err();
            let (source, range) = report.place.clone().unwrap();
            assert!(report.message.contains(message), "{report}");
            assert_eq!(source.line_column(range.start).0, line, "{report}");
        }
        let bytes = as_bytes(false, 4);
        assert!(parse_ply("m.ply", &bytes).unwrap_err().message.contains("no vertex 4"));
        let cut = parse_ply("m.ply", &bytes[..bytes.len() - 30]).unwrap_err();
        assert!(cut.message.contains("before byte") && cut.message.contains("too early"), "{cut}");
        assert!(parse_ply("m.ply", b"hello").unwrap_err().message.contains("no header"));
        let promised = "ply\nformat ascii 1.0\nelement vertex 3\nelement face 1\nproperty list int int vertex_index\nend_header\n3 0 1 2";
        assert!(parse_ply("m.ply", promised.as_bytes()).unwrap_err().message.contains("the file has 0"));
        // Promises of more than there is cost nothing.
        let many = "ply\nformat ascii 1.0\nelement none 18446744073709551615\nelement vertex 4294967295\nproperty float x\nproperty \
                    float y\nproperty float z\nend_header\n1 2 3";
        assert!(parse_ply("m.ply", many.as_bytes()).unwrap_err().message.contains("too early"));
    }

    proptest! {
        #[test]
        fn no_bytes_break_the_reader(cut in 0usize..700, change in 0usize..700, to in 0u8..=255, big in prop::bool::ANY) {
            for mut bytes in [TEXT.as_bytes().to_vec(), as_bytes(big, 3)] {
                bytes.truncate(cut.max(100));
                if let Some(byte) = bytes.get_mut(change) {
                    *byte = to;
                }
                if let Ok(Model { mesh, .. }) = parse_ply("m.ply", &bytes) {
                    prop_assert!(mesh.faces.iter().flatten().all(|&v| (v as usize) < mesh.vertices.len()));
                    prop_assert!(mesh.face_uvs.iter().flatten().all(|&v| (v as usize) < mesh.uvs.len()));
                }
            }
        }
    }
}
