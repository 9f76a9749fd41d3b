//! Wavefront OBJ: vertices, faces and the names of their materials.

use super::polygon::Polygons;
use crate::report::{Report, Source};
use crate::words::{Word, number, words};
use snell::geometry::{TriangleMesh, Vec3};
use snell::scene::WarningCode;
use std::collections::{HashMap, HashSet};
use std::ops::Range;

/// What an OBJ file says.
#[derive(Clone, Debug)]
pub struct ObjModel {
    /// The triangles. Slot names are those of `usemtl`; faces before the first have the empty name.
    pub mesh: TriangleMesh,
    /// Files named by `mtllib`.
    pub libraries: Vec<String>,
    /// Odd lines.
    pub warnings: Vec<Report>,
}

/// Keywords that say nothing about the surface as Snell draws it: texture coordinates, normals (smoothing is the
/// scene's own), groups, lines and points.
const IGNORED: &[&str] =
    &["vn", "vt", "vp", "o", "g", "s", "l", "p", "mg", "usemap", "maplib", "shadow_obj", "trace_obj"];

/// Reads an OBJ file. Polygons become triangles.
///
/// # Errors
/// A number that is none, an index out of range, a face with fewer than three corners.
pub fn parse_obj(source: &Source) -> Result<ObjModel, Report> {
    let mut reader = Reader {
        source,
        mesh: TriangleMesh::default(),
        libraries: Vec::new(),
        slots: HashMap::new(),
        slot: None,
        later: Vec::new(),
        corners: Vec::new(),
        ends: Vec::new(),
        unknown: HashSet::new(),
        warnings: Vec::new(),
    };
    let mut start = 0;
    let mut line: Vec<Word<'_>> = Vec::new();
    for physical in source.text.split_inclusive('\n') {
        let content = physical.split('#').next().unwrap_or_default().trim_end();
        // A backslash at the end joins a line with the next; one in a comment does not.
        let joined = content.strip_suffix('\\');
        line.extend(words(joined.unwrap_or(content), start));
        start += physical.len();
        if joined.is_none() || start == source.text.len() {
            if let Some((keyword, rest)) = line.split_first() {
                reader.line(keyword, rest)?;
            }
            line.clear();
        }
    }
    reader.finish()
}

struct Reader<'a> {
    source: &'a Source,
    mesh: TriangleMesh,
    libraries: Vec<String>,
    slots: HashMap<String, u32>,
    /// Slot of the current `usemtl`.
    slot: Option<u32>,
    /// Vertices that a face named before they came, to be checked at the end.
    later: Vec<(u32, Range<usize>)>,
    /// Corners of all polygons, and where each ends, with its slot. They become triangles when all vertices are there.
    corners: Vec<u32>,
    ends: Vec<(usize, u32)>,
    unknown: HashSet<String>,
    warnings: Vec<Report>,
}

impl Reader<'_> {
    fn error(&self, word: &Word<'_>, message: String) -> Report {
        Report::error(message).at(self.source, word.range.clone())
    }

    fn line(&mut self, keyword: &Word<'_>, rest: &[Word<'_>]) -> Result<(), Report> {
        match keyword.text {
            "v" => self.vertex(keyword, rest),
            "f" | "fo" => self.face(keyword, rest),
            "usemtl" => {
                self.use_material(&joined(self.source, rest));
                Ok(())
            }
            "mtllib" => {
                self.libraries.push(joined(self.source, rest));
                Ok(())
            }
            word if IGNORED.contains(&word) => Ok(()),
            word => {
                // Once per word: a file of the wrong kind has thousands.
                if self.unknown.len() < 5 && self.unknown.insert(word.to_owned()) {
                    let message = format!("unknown keyword `{word}` in a model: such lines are ignored");
                    let report = Report::warning(WarningCode::UnknownKeyword, message);
                    self.warnings.push(report.at(self.source, keyword.range.clone()));
                }
                Ok(())
            }
        }
    }

    fn vertex(&mut self, keyword: &Word<'_>, rest: &[Word<'_>]) -> Result<(), Report> {
        let [x, y, z, ..] = rest else {
            return Err(self.error(keyword, format!("`v` takes 3 numbers, read {}", rest.len())));
        };
        let coordinate = |word: &Word<'_>| {
            number(word).ok_or_else(|| self.error(word, format!("expected a number, read `{}`", word.text)))
        };
        let vertex = Vec3::new(coordinate(x)?, coordinate(y)?, coordinate(z)?);
        self.mesh.vertices.push(vertex);
        Ok(())
    }

    fn use_material(&mut self, name: &str) {
        let next = self.slots.len() as u32;
        let slot = *self.slots.entry(name.to_owned()).or_insert(next);
        if slot == next {
            self.mesh.slots.push(name.to_owned());
        }
        self.slot = Some(slot);
    }

    fn face(&mut self, keyword: &Word<'_>, rest: &[Word<'_>]) -> Result<(), Report> {
        if rest.len() < 3 {
            return Err(self.error(keyword, format!("a face has at least 3 corners, read {}", rest.len())));
        }
        for word in rest {
            let index = self.corner(word)?;
            self.corners.push(index);
        }
        if self.slot.is_none() {
            self.use_material("");
        }
        let slot = self.slot.unwrap_or(0);
        self.ends.push((self.corners.len(), slot));
        Ok(())
    }

    /// The vertex of a corner `a`, `a/b`, `a//c` or `a/b/c`: counted from 1, or from the end if negative.
    fn corner(&mut self, word: &Word<'_>) -> Result<u32, Report> {
        let text = word.text.split('/').next().unwrap_or_default();
        let count = self.mesh.vertices.len() as i64;
        let Ok(index) = text.parse::<i64>() else {
            return Err(self.error(word, format!("expected the number of a vertex, read `{}`", word.text)));
        };
        let from_zero = if index < 0 { count.saturating_add(index) } else { index - 1 };
        match u32::try_from(from_zero) {
            Ok(vertex) if from_zero < count => Ok(vertex),
            // A vertex may come after the face that names it.
            Ok(vertex) if index > 0 => {
                self.later.push((vertex, word.range.clone()));
                Ok(vertex)
            }
            _ => Err(self.out_of_range(index, word.range.clone())),
        }
    }

    fn out_of_range(&self, index: i64, range: Range<usize>) -> Report {
        let count = self.mesh.vertices.len();
        let so_far = if index <= 0 { " so far" } else { "" };
        Report::error(format!("there is no vertex {index}: the file has {count}{so_far}"))
            .at(self.source, range)
            .help("vertices are counted from 1, or backwards from -1, the latest")
    }

    fn finish(mut self) -> Result<ObjModel, Report> {
        let count = self.mesh.vertices.len();
        if let Some((vertex, range)) = self.later.iter().find(|(v, _)| *v as usize >= count) {
            return Err(self.out_of_range(i64::from(*vertex) + 1, range.clone()));
        }
        let mut polygons = Polygons::default();
        let mut start = 0;
        for &(end, slot) in &self.ends {
            let triangles = polygons.triangles(&self.corners[start..end], &self.mesh.vertices);
            self.mesh.face_slots.extend(triangles.iter().map(|_| slot));
            self.mesh.faces.extend(triangles);
            start = end;
        }
        if self.mesh.faces.is_empty() {
            let help = "is it an OBJ file? Its faces are lines that start with `f`";
            return Err(Report::error(format!("`{}` has no faces", self.source.name)).at(self.source, 0..0).help(help));
        }
        Ok(ObjModel { mesh: self.mesh, libraries: self.libraries, warnings: self.warnings })
    }
}

/// The words as one name, with the spaces between them.
fn joined(source: &Source, words: &[Word<'_>]) -> String {
    match (words.first(), words.last()) {
        (Some(first), Some(last)) => source.text[first.range.start..last.range.end].to_owned(),
        _ => String::new(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn read(text: &str) -> ObjModel {
        parse_obj(&Source::new("m.obj", text)).unwrap()
    }

    const SQUARE: &str = "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\n";

    #[test]
    fn every_form_of_a_face() {
        for face in [
            "1 2 3 4",
            "1/9 2/9 3/9 4/9",
            "1//9 2//9 3//9 4//9",
            "1/9/9 2/9/9 3/9/9 4/9/9",
            "-4 -3 -2 -1",
            "1 2 \\\n 3 4",
            "1 2\\\n3 4 # a comment joins nothing \\",
        ] {
            assert_eq!(read(&format!("{SQUARE}f {face}")).mesh.faces, [[0, 1, 2], [0, 2, 3]], "{face}");
        }
        assert_eq!(read(&format!("# C:\\models\\\n{SQUARE}f 1 2 3")).mesh.vertices.len(), 4, "a comment joins nothing");
        assert_eq!(read(&format!("f 1 2 3\n{SQUARE}")).mesh.faces, [[0, 1, 2]], "vertices may come later");
    }

    #[test]
    fn materials_by_name_and_libraries_with_spaces() {
        let text = format!(
            "mtllib my lib.mtl\n{SQUARE}f 1 2 3\nusemtl a b\nf 1 2 3\nusemtl c\nf 1 2 3\nusemtl a b\nf 1 2 4 # x\n"
        );
        let model = read(&text);
        assert_eq!(model.libraries, ["my lib.mtl"]);
        assert_eq!(model.mesh.slots, ["", "a b", "c"]);
        assert_eq!(model.mesh.face_slots, [0, 1, 2, 1]);
    }

    #[test]
    fn a_concave_polygon_is_covered_once() {
        // An arrow head: the fan from its first corner would cover area outside it.
        let text = "v 0 0 0\nv 2 -1 0\nv 0 3 0\nv -2 -1 0\nf 2 3 4 1\nf 3 4 1 2\nf 4 1 2 3\nf 1 2 3 4\n";
        let mesh = read(text).mesh;
        let area = |f: usize| {
            let [a, b, c] = mesh.corners(f);
            (b - a).cross(c - a).z / 2.0
        };
        let (vertices, faces) = text.split_at(text.find('f').unwrap());
        assert_eq!(read(&format!("{faces}{vertices}")).mesh.faces, mesh.faces, "also before its vertices");
        // At 1e9 products of coordinates have lost the last hundred, ten times the area.
        let moved = mesh.vertices.iter().map(|v| format!("v {} {} 0\n", v.x + 1e9, v.y + 1e9));
        let far = read(&format!("{}{faces}", moved.collect::<String>()));
        assert_eq!(far.mesh.faces, mesh.faces, "also far from the origin");
        // Shoelace: 6. Every triangle counter-clockwise, and the areas of each polygon add up to it.
        for polygon in 0..4 {
            let areas = [area(2 * polygon), area(2 * polygon + 1)];
            assert!(areas.iter().all(|&a| a > 0.0) && areas[0] + areas[1] == 6.0, "{areas:?}");
        }
    }

    #[test]
    fn errors_name_the_place() {
        for (text, line, message) in [
            (format!("{SQUARE}f 1 2 5\n"), 5, "no vertex 5: the file has 4"),
            (format!("{SQUARE}f 1 2 0\n"), 5, "no vertex 0"),
            (format!("{SQUARE}f 1 2 -5\n"), 5, "no vertex -5"),
            (format!("{SQUARE}f 1 2 99999999999999999999\n"), 5, "number of a vertex"),
            (format!("{SQUARE}f 1 2\n"), 5, "at least 3 corners, read 2"),
            (format!("{SQUARE}f 1 x 3\n"), 5, "read `x`"),
            ("v 1 2\n".to_owned(), 1, "3 numbers, read 2"),
            ("v 1 2 nan\n".to_owned(), 1, "read `nan`"),
            (SQUARE.to_owned(), 1, "no faces"),
        ] {
            let report = parse_obj(&Source::new("m.obj", text.as_str())).unwrap_err();
            assert!(report.message.contains(message), "{report}");
            let (source, range) = report.place.unwrap();
            assert_eq!(source.line_column(range.start).0, line, "{text}");
        }
    }

    proptest! {
        #[test]
        fn no_text_breaks_the_reader(words in prop::collection::vec(
            prop::sample::select(vec!["v", "f", "usemtl", "mtllib", "s", "1", "2", "-1", "0", "3/1", "1e308", "\\", "\n", "\r\n", "#", "é"]),
            0..120,
        )) {
            if let Ok(model) = parse_obj(&Source::new("m.obj", words.join(" "))) {
                let count = model.mesh.vertices.len();
                prop_assert!(model.mesh.faces.iter().flatten().all(|&v| (v as usize) < count));
                prop_assert_eq!(model.mesh.faces.len(), model.mesh.face_slots.len());
            }
        }
    }
}
